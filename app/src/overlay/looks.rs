//! Names and colours of the classes of cells.

use renderer::CellClass;

/// How a class is shown and called.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    pub name: &'static str,
    /// sRGB.
    pub rgb: [u8; 3],
    pub meaning: &'static str,
}

/// In the order of [`CellClass::ALL`]. The colours are told apart by people who lack one kind of cone,
/// too: see the test below.
const LOOKS: [Look; CellClass::ALL.len()] = [
    Look { name: "Full", rgb: [0xe0, 0x60, 0x1f], meaning: "Sampled wherever it makes a difference" },
    Look {
        name: "Mixed",
        rgb: [0xf6, 0xbf, 0x4a],
        meaning: "Sampled in some bricks, shown without a sample in the others",
    },
    Look { name: "Level 1", rgb: [0xbb, 0xff, 0xad], meaning: "Sampled once for 2 slices" },
    Look { name: "Level 2", rgb: [0x91, 0xae, 0x8b], meaning: "Sampled once for 4 slices" },
    Look { name: "Level 3", rgb: [0x2f, 0x8f, 0x8a], meaning: "Sampled once for 8 slices" },
    Look { name: "Level 4", rgb: [0x1b, 0x5b, 0x8b], meaning: "Sampled once for 16 slices" },
    Look {
        name: "Super-pixel",
        rgb: [0x54, 0xb4, 0xf4],
        meaning: "Shown by single colours or slopes of the quantity, without a sample",
    },
    Look { name: "Transparent", rgb: [0xe0, 0xd3, 0xe3], meaning: "With nothing to be seen in them" },
    Look { name: "Occluded", rgb: [0x44, 0x47, 0x4d], meaning: "Behind what lets no light through" },
];

pub fn look(class: CellClass) -> &'static Look {
    &LOOKS[class.index()]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is left of linear sRGB without one kind of cone (Machado, Oliveira and Fernandes 2009), and
    /// with all.
    const EYES: [(&str, [[f32; 3]; 3]); 4] = [
        ("all", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        (
            "no long",
            [
                [0.152_286, 1.052_583, -0.204_868],
                [0.114_503, 0.786_281, 0.099_216],
                [-0.003_882, -0.048_116, 1.051_998],
            ],
        ),
        (
            "no middle",
            [
                [0.367_322, 0.860_646, -0.227_968],
                [0.280_085, 0.672_501, 0.047_413],
                [-0.011_820, 0.042_940, 0.968_881],
            ],
        ),
        (
            "no short",
            [
                [1.255_528, -0.076_749, -0.178_779],
                [-0.078_411, 0.930_809, 0.147_602],
                [0.004_733, 0.691_367, 0.303_900],
            ],
        ),
    ];

    fn linear(rgb: [u8; 3]) -> [f32; 3] {
        rgb.map(|channel| crate::image_file::to_linear(f32::from(channel) / 255.0))
    }

    fn apply(matrix: [[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
        matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }

    /// Oklab (Ottosson 2020): distances are about as large as they are seen.
    fn oklab(linear: [f32; 3]) -> [f32; 3] {
        let cones = apply(
            [
                [0.412_221_46, 0.536_332_55, 0.051_445_995],
                [0.211_903_5, 0.680_699_5, 0.107_396_96],
                [0.088_302_46, 0.281_718_85, 0.629_978_7],
            ],
            linear.map(|channel| channel.clamp(0.0, 1.0)),
        );
        apply(
            [
                [0.210_454_26, 0.793_617_8, -0.004_072_047],
                [1.977_998_5, -2.428_592_2, 0.450_593_7],
                [0.025_904_037, 0.782_771_77, -0.808_675_77],
            ],
            cones.map(f32::cbrt),
        )
    }

    #[test]
    fn everyone_can_tell_the_colours_apart() {
        for (eyes, matrix) in EYES {
            let seen = LOOKS.map(|look| oklab(apply(matrix, linear(look.rgb))));
            for (a, b) in (0..LOOKS.len()).flat_map(|b| (0..b).map(move |a| (a, b))) {
                let distance = (0..3).map(|i| (seen[a][i] - seen[b][i]).powi(2)).sum::<f32>().sqrt();
                // A fiftieth is what an eye just notices.
                assert!(distance > 0.095, "{eyes}: {} and {}: {distance}", LOOKS[a].name, LOOKS[b].name);
            }
        }
    }
}
