//! The tests of the guarantee would notice: each bound that is wrong on purpose makes some picture
//! that breaks its promise.

use reference::device::open;
use reference::guarantee::{case, hard_cases, try_out};
use reference::scenes::Scene;
use renderer::{BrickWidth, Gpu, GpuOptions, Kernel, RenderError, Renderer};

/// What is changed, and the texts of the shaders that make it so: from, to.
struct Change {
    what: &'static str,
    edits: &'static [(&'static str, &'static str)],
}

/// Where a shader is rewritten, the text of its mutant is to follow.
const MUTANTS: [Change; 28] = [
    Change {
        what: "the remainder of the expansion is dropped",
        edits: &[("kernel_rest(ways) + 1e-6 * jet.bend", "vec4(0.0)")],
    },
    Change {
        what: "particles whose support ends in a brick are taken to be without or within",
        edits: &[("above * above * above, rest + below * below * below", "vec4(0.0), rest")],
    },
    Change {
        what: "the terms of third order are dropped",
        edits: &[("return width * across + depth * depth *", "return vec4(0.0) * depth *")],
    },
    Change {
        what: "the terms of second order are dropped",
        edits: &[("return 0.5 * squares + width *", "return vec4(0.0) * width *")],
    },
    Change {
        what: "the gradient of the sums is dropped",
        edits: &[("column.half_width * (abs(f.a) + abs(f.b))", "vec4(0.0)")],
    },
    Change {
        what: "particles that only touch a brick are left out of it",
        edits: &[("+ ways.nearing > vec4(-2e-5)", "+ ways.nearing > vec4(0.3)")],
    },
    Change {
        what: "a column has the expansion of its sheaf, unmoved",
        edits: &[("return leant(shifted(f, way), way.lean);", "return f;")],
    },
    Change {
        what: "a sheaf's expansion is moved as if it ended with the first order",
        edits: &[("0.5 * (square_a * a + square_b * b) + cubic_value", "0.0")],
    },
    Change {
        what: "of a sheaf only what a column's expansion leaves out is charged",
        edits: &[("sqrt(f32(columns))", "1.0")],
    },
    Change {
        what: "of all of a cell as one sheaf only what a sheaf of four leaves out is charged",
        edits: &[AS_ONE_SHEAF, ("sqrt(f32(columns))", "sqrt(f32(min(columns, 4u)))")],
    },
    Change {
        what: "a particle is taken to weigh as much anywhere in a brick as in its middle",
        edits: &[("Share(term, least, left_out", "Share(term, jet.value, left_out")],
    },
    Change {
        what: "a brick is half as wide as it is",
        edits: &[("let half_width = aside * frame.pitch", "let half_width = 0.5 * aside * frame.pitch")],
    },
    Change {
        what: "a brick is one sample too short",
        edits: &[("vec4(at[0].w, at[1].w, at[2].w, at[3].w)", "vec4(at[0].z, at[1].z, at[2].z, at[3].z)")],
    },
    Change {
        what: "every sample is taken to meet a particle",
        edits: &[("let covered = values.y >= COVERED;", "let covered = true;")],
    },
    Change {
        what: "the nodes between the ends of a range are overlooked",
        edits: &[("if between > 0u {", "if between > 1000000u {")],
    },
    Change {
        what: "values are rounded inward",
        edits: &[
            ("reference + low - 2e-6", "reference + low + 2e-3"),
            ("reference + high + 2e-6", "reference + high - 2e-3"),
        ],
    },
    Change {
        what: "most particles of a cell are left out of its extremes",
        edits: &[(
            "place < end; place += LANES_OF_WHOLE",
            "place < min(end, cell.first + 4u); place += LANES_OF_WHOLE",
        )],
    },
    Change {
        what: "half of the charge",
        edits: &[("select(0.0, charge, seen)", "select(0.0, 0.5 * charge, seen)")],
    },
    Change {
        what: "the lower bound of the transparency in place of the upper",
        edits: &[("width, seen), 1.0 - thin)", "width, seen), 1.0 - thick)")],
    },
    Change {
        what: "no light comes through from behind",
        edits: &[("width, seen), 1.0 - thin)", "width, seen), 0.0)")],
    },
    Change {
        what: "the largest charge in place of the sum",
        edits: &[("        spent += more;", "        spent = max(spent, more);")],
    },
    Change { what: "half as much again as the budget", edits: &[("chunk.budget", "(1.5 * chunk.budget)")] },
    Change {
        what: "a slope is taken for exact",
        edits: &[(
            "let all_off = min(off / least_weight + rounding, vec4(WIDEST))",
            "let all_off = vec4(0.0)",
        )],
    },
    Change {
        what: "a slope falls where it rises",
        edits: &[(
            "dot(unpack_slope(values.across[brick]), side)",
            "dot(unpack_slope(values.across[brick]), -side)",
        )],
    },
    Change {
        what: "the transfer function is taken for flat",
        edits: &[("return steepest * (1.0 + ROUNDING);", "return vec4(0.0);")],
    },
    Change {
        what: "level 2 is free of charge, however wide the hull",
        edits: &[
            ("hull.between * (1.0 - chunk.relaxation)", "hull.between * 0.0"),
            ("hull.between < vec4(chunk.budget)", "hull.between < vec4(2.0)"),
        ],
    },
    Change {
        what: "level 2 is sampled at the front of a brick",
        edits: &[("layer == LEVEL_2);", "false);"), ("add_samples(level_2_offsets(),", "add_samples(at[0],")],
    },
    Change {
        what: "columns end early, free of charge",
        edits: &[
            ("return light <= OCCLUDED * chunk.budget;", "return light <= 0.25;"),
            ("let budget = chunk.budget - reserve;", "let budget = chunk.budget;"),
        ],
    },
];

/// However smooth a cell is, its bricks are bounded as one sheaf, where particles are large enough.
const AS_ONE_SHEAF: (&str, &str) = ("const LOSS_OF_ALL: f32 = 1e-5;", "const LOSS_OF_ALL: f32 = 1e9;");

/// What is not wrong, whichever is the fastest: ways in which bricks are bounded.
const WAYS: [Change; 3] = [
    Change { what: "cells as one sheaf", edits: &[AS_ONE_SHEAF] },
    Change {
        what: "sheaves of four columns",
        edits: &[
            ("const LOSS_OF_FOUR: f32 = 2e-4;", "const LOSS_OF_FOUR: f32 = 1e9;"),
            ("const LOSS_OF_ALL: f32 = 1e-5;", "const LOSS_OF_ALL: f32 = -1.0;"),
        ],
    },
    Change {
        what: "columns",
        edits: &[
            ("const LOSS_OF_FOUR: f32 = 2e-4;", "const LOSS_OF_FOUR: f32 = -1.0;"),
            ("const LOSS_OF_ALL: f32 = 1e-5;", "const LOSS_OF_ALL: f32 = -1.0;"),
        ],
    },
];

/// What every mutant is tried on, with one kernel: pipelines are made when they are first used.
fn cases() -> impl Iterator<Item = Scene> {
    let random = (0..60).flat_map(|seed| [case(seed), with_other_bricks(case(seed))]);
    hard_cases().into_iter().chain(random).chain((60..90).map(only_levels)).map(|mut scene| {
        scene.view.particles.kernel = Kernel::Poly6;
        scene
    })
}

fn with_other_bricks(mut scene: Scene) -> Scene {
    let width = &mut scene.view.sampling.brick_width;
    *width = if *width == BrickWidth::Two { BrickWidth::Four } else { BrickWidth::Two };
    scene.name += ", but for the width of the bricks";
    scene
}

fn only_levels(seed: u64) -> Scene {
    let mut scene = case(seed);
    scene.view.sampling.super_pixels = false;
    scene
}

fn edited(edits: &[(&str, &str)]) -> GpuOptions {
    let shader_edits = edits.iter().map(|(from, to)| (from.to_string(), to.to_string())).collect();
    GpuOptions { shader_edits, ..GpuOptions::default() }
}

/// The first broken promise of a mutant.
fn first_violation(mutant: &Change) -> Option<String> {
    let mut renderer = open(&edited(mutant.edits));
    cases().find_map(|scene| try_out(&mut renderer, &scene).violation())
}

#[test]
fn every_mutant_is_noticed() {
    let unnoticed: Vec<&str> = MUTANTS
        .iter()
        .filter_map(|mutant| match first_violation(mutant) {
            Some(violation) => {
                println!("{}: {violation}", mutant.what);
                None
            }
            None => Some(mutant.what),
        })
        .collect();
    assert!(unnoticed.is_empty(), "unnoticed: {}", unnoticed.join("; "));
}

#[test]
fn whichever_way_bricks_are_bounded_nothing_is_noticed() {
    for way in &WAYS {
        assert_eq!(first_violation(way), None, "{}", way.what);
    }
}

#[test]
fn without_a_mutant_nothing_is_noticed() {
    let mut renderer = open(&GpuOptions::default());
    let violations: Vec<String> =
        cases().filter_map(|scene| try_out(&mut renderer, &scene).violation()).collect();
    assert!(violations.is_empty(), "{}", violations.join("\n"));
}

#[test]
fn an_edit_of_a_text_that_is_not_there_is_an_error() {
    let gpu = Gpu::new(&edited(&[("no such text", "")])).expect("an adapter");
    match Renderer::new(gpu).map(drop) {
        Err(RenderError::Device(reason)) => assert!(reason.contains("no such text"), "{reason}"),
        other => panic!("{other:?}"),
    }
}
