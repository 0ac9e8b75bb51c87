//! Smoothing kernels (contract, section 1): compact support h, unit integral.

use serde::{Deserialize, Serialize};

/// A radial kernel W(r, h) that is zero for r ≥ h.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kernel {
    /// 315/(64π h³)·(1 − ρ²)³, Müller et al. 2003.
    #[default]
    Poly6,
    /// The cubic B-spline of Monaghan 1992, stretched to support h.
    Cubic,
    /// Wendland's C² kernel of 1995.
    WendlandC2,
}

impl Kernel {
    pub const ALL: [Kernel; 3] = [Kernel::Poly6, Kernel::Cubic, Kernel::WendlandC2];

    /// The name that `view.json` and the command line use.
    pub fn name(self) -> &'static str {
        match self {
            Kernel::Poly6 => "poly6",
            Kernel::Cubic => "cubic",
            Kernel::WendlandC2 => "wendland-c2",
        }
    }

    /// The number by which the shaders know it (`kernel.wgsl`).
    pub(crate) fn code(self) -> u32 {
        self as u32
    }
}

impl std::str::FromStr for Kernel {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Kernel::ALL.into_iter().find(|kernel| kernel.name() == name).ok_or_else(|| {
            let names = Kernel::ALL.map(Kernel::name).join(", ");
            format!("unknown kernel `{name}`, expected one of {names}")
        })
    }
}
