//! The tests of the guarantee would notice bounds of two fields that are wrong on purpose.

use reference::guarantee::{case, hard_cases, try_out, with_opacity};
use reference::scenes::Scene;
use renderer::{Gpu, GpuOptions, Kernel, Renderer};

use super::{log_opacity, swapped};

/// What is wrong, and the texts of the shaders that make it so: from, to.
const MUTANTS: [(&str, &str, &str); 6] = [
    ("the opacity over the bounds of the colour", "opacity.range.low.a)", "colour.range.low.a)"),
    (
        "the colour over the bounds of the opacity",
        "colour.range.high.rgb, opacity",
        "opacity.range.high.rgb, opacity",
    ),
    ("the slope of the opacity is exact", "opacity.steepness.a * off.y", "0.0"),
    ("the slope of the colour is exact", "colour.steepness.rgb * off.x", "vec3(0.0)"),
    (
        "what the expansion of the opacity leaves out",
        "(*expansion).rest_qq += q * q * share.left_out;\n    (*expansion).low = select((*expansion).low, min((*expansion).low, vec4(q))",
        "(*expansion).low = select((*expansion).low, min((*expansion).low, vec4(q))",
    ),
    ("the opacity of a cell from the other field", "return quantity.y;", "return quantity.x;"),
];

#[test]
fn wrong_bounds_are_noticed() {
    let steps = hard_cases().into_iter().zip(0..).flat_map(|(scene, seed)| {
        let other = with_opacity(seed, scene);
        [swapped(&other), other]
    });
    let random = (0..80).map(|seed| with_opacity(seed, case(seed)));
    assert_noticed(&steps.chain(random).collect::<Vec<_>>());
}

#[test]
fn opacities_at_ratios_alone_notice_them() {
    assert_noticed(&log_opacity::hard().chain(log_opacity::cases(500..580)).collect::<Vec<_>>());
}

/// Fails unless each mutant breaks its promise in one of `cases`.
fn assert_noticed(cases: &[Scene]) {
    // With one kernel: pipelines are made when they are first used.
    let cases = || {
        cases.iter().cloned().map(|mut scene| {
            scene.view.particles.kernel = Kernel::Poly6;
            scene
        })
    };
    let unnoticed = |(what, from, to): &(&'static str, &str, &str)| {
        let shader_edits = vec![(from.to_string(), to.to_string())];
        let gpu = Gpu::new(&GpuOptions { shader_edits, ..GpuOptions::default() }).expect("an adapter");
        let mut renderer = Renderer::new(gpu).unwrap_or_else(|error| panic!("{what}: {error}"));
        let violation = cases().find_map(|scene| try_out(&mut renderer, &scene).violation());
        println!("{what}: {}", violation.as_deref().unwrap_or("nobody notices"));
        violation.is_none().then_some(*what)
    };
    let unnoticed: Vec<&str> = MUTANTS.iter().filter_map(unnoticed).collect();
    assert!(unnoticed.is_empty(), "unnoticed: {}", unnoticed.join("; "));
}
