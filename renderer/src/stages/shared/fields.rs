//! How many fields decide what a sample looks like, and what the shaders make of that.

/// One field for colour and opacity, or one for each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Fields {
    #[default]
    One,
    Two,
}

impl Fields {
    /// Numbers of a particle, and sums of a sample beside that of the weights.
    pub(crate) const fn count(self) -> u64 {
        match self {
            Fields::One => 1,
            Fields::Two => 2,
        }
    }

    /// WGSL of the quantities of particles and samples, for shaders with `bundle.wgsl`.
    pub(crate) const fn wgsl(self) -> &'static str {
        match self {
            Fields::One => include_str!("fields/one.wgsl"),
            Fields::Two => include_str!("fields/two.wgsl"),
        }
    }

    /// WGSL of what is known of bricks, for shaders with `hull.wgsl` too.
    pub(crate) const fn bounds_wgsl(self) -> &'static str {
        match self {
            Fields::One => include_str!("fields/one_bounds.wgsl"),
            Fields::Two => include_str!("fields/two_bounds.wgsl"),
        }
    }
}
