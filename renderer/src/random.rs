//! Random numbers of tests: from a seed, the same on every machine.

pub(crate) struct Random(pub u64);

impl Random {
    /// In [0, 1), and exact: 24 bits.
    pub(crate) fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }
}
