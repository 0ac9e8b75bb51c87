//! The transfer function on the device's axis: colours and opacities, each with nodes of its own, become
//! one list of control points, exact at all nodes of both.
//!
//! On a logarithmic scale the function is linear in ln Q between its nodes, but the device's is linear in Q.
//! A segment of width Δu in which a channel changes by Δv is cut into n parts of equal ratio. Over one of
//! them ln Q changes by t = Δu·Λ/n, with Λ = ln(q_max/q_min), and a line in Q differs from ln Q by at most
//! ln(sinh x/x) + x·coth x − 1 ≤ x²/6 + x²/3 = t²/8, with x = t/2. So a channel is off by at most
//! Δv/Δu · t²/(8Λ) = Δv·Δu·Λ/(8n²), which is no more than 1/4096 for n ≥ √(512·Δv·Δu·Λ).
//!
//! Where colour and opacity are read at two fields, each has a scale, a range and so a Λ of its own: colours
//! and opacities are cut apart from each other before they are joined, and a node of one is on the line of
//! the other. Opacities add up along a ray, so theirs count as a share of the larger one at the segment's
//! ends: one of 0.001 is as sharp as one of 1.

use crate::particles::Quantity;
use crate::placement::Placement;
use crate::view::{OutsideView, TransferView, ViewError};

use super::{ColourPoint, ControlPoint, TransferFunction};

/// A place, and N channels there.
type Node<const N: usize> = (f32, [f32; N]);

/// Values closer than this share of the range to one of its ends count as that end.
const GRACE: f64 = 1.0 / 262_144.0;

impl TransferFunction {
    /// The function of `view` as the device is to have it, for `quantity`; `outside`: what is shown below and
    /// above its range. Where colour and opacity are of two fields, only the colours know values outside.
    ///
    /// # Errors
    /// Names the key of what is out of range, or where there are too many points.
    pub(crate) fn on_device(
        view: &TransferView,
        quantity: &Quantity,
        outside: [Option<OutsideView>; 2],
    ) -> Result<TransferFunction, ViewError> {
        let function = view.function()?;
        let [of_colour, of_opacity] = quantity.placements();
        if of_colour.is_plain() && of_opacity.is_plain() {
            return Ok(function);
        }
        let colours: Vec<Node<3>> = view.colours()?.iter().map(|point| (point.u, point.rgb)).collect();
        let mut colours = placed(&colours, &of_colour, largest_change);
        let mut opacities = placed(&opacities(function.points()), &of_opacity, share_of_change);
        add_outside(&mut colours, &of_colour, outside.map(|side| side.map(|side| side.rgb)));
        if quantity.opacity_placement().is_none() {
            add_outside(&mut opacities, &of_opacity, outside.map(|side| side.map(|side| [side.opacity])));
        }
        checked(merged(&colours, &opacities))
    }
}

/// Puts steps to what lies below and above around a function.
fn add_outside<const N: usize>(
    nodes: &mut Vec<Node<N>>,
    placement: &Placement,
    [below, above]: [Option<[f32; N]>; 2],
) {
    if let (Some(below), Some(first)) = (below, nodes.first().copied()) {
        let step = grace(placement, 0.0, -1.0);
        nodes.splice(0..0, [(0.0, below), (step, below), (step, first.1)]);
    }
    if let (Some(above), Some(last)) = (above, nodes.last().copied()) {
        let step = grace(placement, 1.0, 1.0);
        nodes.extend([(step, last.1), (step, above)]);
    }
}

/// A little outside the range's end `u`, on the device.
fn grace(placement: &Placement, u: f64, side: f64) -> f32 {
    let end = placement.device(u);
    let ratio = match placement.log_width() {
        Some(_) => end,
        None => 0.5,
    };
    (end + side * GRACE * ratio) as f32
}

fn opacities(points: &[ControlPoint]) -> Vec<Node<1>> {
    let mut nodes: Vec<Node<1>> = points.iter().map(|point| (point.u, [point.opacity])).collect();
    nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
    nodes
}

/// Colours of one list and opacities of another, both in ascending order of u, as one function.
///
/// # Errors
/// Where the two have too many points together.
pub(crate) fn joined(
    colours: &[ColourPoint],
    points: &[ControlPoint],
) -> Result<TransferFunction, ViewError> {
    let colours: Vec<Node<3>> = colours.iter().map(|point| (point.u, point.rgb)).collect();
    checked(merged(&colours, &opacities(points)))
}

fn checked(points: Vec<ControlPoint>) -> Result<TransferFunction, ViewError> {
    if points.len() > TransferFunction::MAX_POINTS {
        let what = format!(
            "with its map, on this scale, needs {} points, more than {}",
            points.len(),
            TransferFunction::MAX_POINTS
        );
        return Err(ViewError::new("transfer.points", what));
    }
    TransferFunction::new(&points)
}

/// Nodes on the device's axis, as many as a logarithmic scale needs; `change` is Δv from one to the next.
fn placed<const N: usize>(
    nodes: &[Node<N>],
    placement: &Placement,
    change: fn([f64; N], [f64; N]) -> f64,
) -> Vec<Node<N>> {
    let place = |u: f64| placement.device(u) as f32;
    let mut all: Vec<Node<N>> = nodes.first().map(|(u, v)| (place(f64::from(*u)), *v)).into_iter().collect();
    for pair in nodes.windows(2) {
        let [(u0, a), (u1, b)] = [pair[0], pair[1]].map(|(u, v)| (f64::from(u), v.map(f64::from)));
        let parts = parts(change(a, b), u1 - u0, placement);
        all.extend((1..=parts).map(|part| {
            let share = f64::from(part) / f64::from(parts);
            let value = std::array::from_fn(|c| (a[c] + share * (b[c] - a[c])) as f32);
            (place(u0 + share * (u1 - u0)), value)
        }));
    }
    all
}

/// Of any channel.
fn largest_change<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (b - a).abs()).fold(0.0, f64::max)
}

/// Of the larger of two opacities.
fn share_of_change([a]: [f64; 1], [b]: [f64; 1]) -> f64 {
    if a == b { 0.0 } else { (b - a).abs() / a.max(b) }
}

/// How many parts a segment is cut into. More than a function may have points are an error anyway.
fn parts(change: f64, width: f64, placement: &Placement) -> u32 {
    let log_width = placement.log_width().unwrap_or(0.0);
    (512.0 * change * width * log_width).sqrt().ceil().clamp(1.0, TransferFunction::MAX_POINTS as f64) as u32
}

fn merged(colours: &[Node<3>], opacities: &[Node<1>]) -> Vec<ControlPoint> {
    let mut places: Vec<f32> =
        colours.iter().map(|node| node.0).chain(opacities.iter().map(|node| node.0)).collect();
    places.sort_by(f32::total_cmp);
    places.dedup();
    let mut points = Vec::with_capacity(places.len());
    for u in places {
        let point = |rgb, [opacity]: [f32; 1]| ControlPoint { u, rgb, opacity };
        let before = point(up_to(colours, u), up_to(opacities, u));
        let here = point(from(colours, u), from(opacities, u));
        if before != here {
            points.push(before);
        }
        points.push(here);
    }
    points
}

/// What a function comes to from below.
fn up_to<const N: usize>(nodes: &[Node<N>], u: f32) -> [f32; N] {
    let next = nodes.partition_point(|node| node.0 < u);
    match (next.checked_sub(1).map(|last| nodes[last]), nodes.get(next)) {
        (Some(a), Some(b)) if b.0 > u => between(a, *b, u),
        (_, Some(b)) => b.1,
        (Some(a), None) => a.1,
        (None, None) => [0.0; N],
    }
}

/// What a function is from here on.
fn from<const N: usize>(nodes: &[Node<N>], u: f32) -> [f32; N] {
    let next = nodes.partition_point(|node| node.0 <= u);
    match (next.checked_sub(1).map(|last| nodes[last]), nodes.get(next)) {
        (Some(a), Some(b)) if a.0 < u => between(a, *b, u),
        (Some(a), _) => a.1,
        (None, Some(b)) => b.1,
        (None, None) => [0.0; N],
    }
}

fn between<const N: usize>(a: Node<N>, b: Node<N>, u: f32) -> [f32; N] {
    let share = (u - a.0) / (b.0 - a.0);
    std::array::from_fn(|c| (a.1[c] + share * (b.1[c] - a.1[c])).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particles::{ParticleSet, RawParticle};
    use crate::placement::{LARGEST_RATIO, Scale, Spread};
    use crate::random::Random;
    use crate::view::MapView;

    impl Random {
        fn view(&mut self) -> TransferView {
            let mut channel = || self.unit();
            let points = (0..9).map(|_| ControlPoint {
                u: channel(),
                rgb: [channel(), channel(), channel()],
                opacity: channel(),
            });
            let points = points.collect();
            let colours =
                (0..7).map(|_| ColourPoint { u: channel(), rgb: [channel(), channel(), channel()] });
            let map = Some(MapView { points: colours.collect(), ..MapView::default() });
            TransferView { reference_length: None, points, map }
        }
    }

    /// A quantity without particles, at its place.
    fn quantity(range: [f64; 2], scale: Scale, outside: bool) -> Quantity {
        let nothing = ParticleSet::new(0, |_| unreachable!("there are no particles"));
        Quantity::new(&nothing, Spread { range: Some(range), scale, outside }, |_| 0.0)
    }

    fn apart(a: [f32; 4], b: [f32; 4]) -> f32 {
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    }

    /// Where neither function has a step close to `u`.
    fn is_smooth(function: &TransferFunction, u: f32) -> bool {
        apart(function.sample((u - 1e-5).max(0.0)), function.sample((u + 1e-5).min(1.0))) < 0.01
    }

    #[test]
    fn a_join_has_the_channels_of_both() {
        let mut random = Random(1);
        for _ in 0..50 {
            let mut view = random.view();
            let step = ControlPoint { opacity: 0.9, ..view.points[3] };
            view.points.push(step);
            let both = view.function().unwrap();
            let opacities = TransferFunction::new(&view.points).unwrap();
            let colours: Vec<ControlPoint> = view
                .colours()
                .unwrap()
                .iter()
                .map(|point| ControlPoint { u: point.u, rgb: point.rgb, opacity: 0.0 })
                .collect();
            let colours = TransferFunction::new(&colours).unwrap();
            for i in 0..=500 {
                let u = i as f32 / 500.0;
                let ([r, g, b, _], [.., a]) = (colours.sample(u), opacities.sample(u));
                assert!(apart(both.sample(u), [r, g, b, a]) < 1e-5, "{u}");
            }
            assert_eq!(both.sample(step.u)[3], 0.9);
        }
    }

    #[test]
    fn a_logarithmic_scale_is_kept_to_a_4096th() {
        let mut random = Random(2);
        for decades in [0.1, 1.0, 3.0, 6.0, 30.0] {
            for outside in [false, true] {
                let view = random.view();
                let range = [0.37, 0.37 * 10.0_f64.powf(decades)];
                let quantity = quantity(range, Scale::Log, outside);
                let placement = quantity.placement();
                let device = TransferFunction::on_device(&view, &quantity, [None; 2]).unwrap();
                let function = view.function().unwrap();
                for _ in 0..2000 {
                    let u = f64::from(random.unit());
                    if is_smooth(&function, u as f32) {
                        let (found, expected) =
                            (device.sample(placement.device(u) as f32), function.sample(u as f32));
                        assert!(apart(found, expected) < 1.0 / 4096.0 + 2e-5, "{decades} decades, u = {u}");
                    }
                }
                assert!(device.points().len() < 1500, "{}", device.points().len());
            }
        }
    }

    #[test]
    fn the_smallest_of_numbers_makes_no_endless_scale() {
        let values = [1e-310, 0.5, 0.8];
        let place = |row: usize| [row as f64, 0.0, 0.0];
        let three =
            ParticleSet::new(3, |row| RawParticle { position: place(row), support_radius: 1.0, volume: 1.0 });
        for outside in [false, true] {
            let spread = Spread { range: None, scale: Scale::Log, outside };
            let quantity = Quantity::new(&three, spread, |row| values[row]);
            assert_eq!(quantity.range(), [0.8 / LARGEST_RATIO, 0.8]);
            let device = TransferFunction::on_device(&Random(4).view(), &quantity, [None; 2]).unwrap();
            assert!(device.points().len() < 1500, "{}", device.points().len());
            // Not even where nobody looks at the range.
            let wide = self::quantity([1e-300, 1e300], Scale::Log, outside);
            let device = TransferFunction::on_device(&Random(4).view(), &wide, [None; 2]);
            assert!(device.is_err() || device.unwrap().points().len() <= TransferFunction::MAX_POINTS);
        }
    }

    #[test]
    fn colour_and_opacity_keep_scales_of_their_own() {
        let mut random = Random(3);
        for (decades, scales) in [
            (3.0, [Scale::Linear, Scale::Log]),
            (6.0, [Scale::Log, Scale::Linear]),
            (2.0, [Scale::Log, Scale::Log]),
            (30.0, [Scale::Linear, Scale::Log]),
        ] {
            let mut view = random.view();
            // Small opacities are kept as well as large ones.
            let factor = 1e-3;
            view.points.iter_mut().for_each(|point| point.opacity *= factor);
            let [colour, opacity] = [[5.0, 5.0 * 10.0_f64.powf(1.5)], [2e-4, 2e-4 * 10.0_f64.powf(decades)]];
            let both = quantity(colour, scales[0], false).with_opacity(&quantity(opacity, scales[1], false));
            let device = TransferFunction::on_device(&view, &both, [None; 2]).unwrap();
            let function = view.function().unwrap();
            let at = |placement: &Placement, u: f64| device.sample(placement.device(u) as f32);
            for _ in 0..2000 {
                let u = f64::from(random.unit());
                let [of_colour, of_opacity] = both.placements();
                let ([r, g, b, _], [.., a]) = (at(&of_colour, u), at(&of_opacity, u));
                let expected = function.sample(u as f32);
                if is_smooth(&function, u as f32) {
                    let off = apart([r, g, b, expected[3]], expected);
                    assert!(off < 1.0 / 4096.0 + 2e-5, "colour, {decades} decades, {scales:?}, u = {u}");
                    let off = (a - expected[3]).abs();
                    let most = factor * (1.0 / 4096.0 + 2e-5);
                    assert!(off < most, "opacity, {decades} decades, {scales:?}, u = {u}: {off}");
                }
            }
        }
    }

    #[test]
    fn with_fewer_parts_it_would_not_be() {
        let ramp = TransferView {
            points: [0.0, 1.0].map(|u| ControlPoint { u, rgb: [u; 3], opacity: u }).to_vec(),
            ..TransferView::default()
        };
        let quantity = quantity([1.0, 1e6], Scale::Log, false);
        let placement = quantity.placement();
        let device = TransferFunction::on_device(&ramp, &quantity, [None; 2]).unwrap();
        let every_other: Vec<ControlPoint> = device.points().iter().step_by(2).copied().collect();
        let coarse = TransferFunction::new(&every_other).unwrap();
        let off = |function: &TransferFunction| {
            let at = |i: u32| f64::from(i) / 10_000.0;
            (0..=10_000)
                .map(|i| (function.sample(placement.device(at(i)) as f32)[3] - at(i) as f32).abs())
                .fold(0.0, f32::max)
        };
        assert!(off(&device) <= 1.0 / 4096.0 + 1e-6, "{}", off(&device));
        assert!(off(&coarse) > 1.0 / 4096.0, "{}", off(&coarse));
    }

    #[test]
    fn what_lies_outside_has_colours_of_its_own() {
        let view = TransferView::default();
        let outside = |value| Some(OutsideView { rgb: [value; 3], opacity: value });
        for scale in [Scale::Linear, Scale::Log] {
            let quantity = quantity([2.0, 10.0], scale, true);
            let device = TransferFunction::on_device(&view, &quantity, [outside(0.1), outside(0.9)]).unwrap();
            let at = |q: f64| {
                device.sample(match scale {
                    Scale::Linear => 0.25 + 0.5 * (q - 2.0) / 8.0,
                    Scale::Log => q / 20.0,
                } as f32)
            };
            assert_eq!(at(1.999), [0.1; 4], "{scale:?}");
            assert_eq!(at(-50.0), [0.1; 4], "{scale:?}");
            assert_eq!(at(10.001), [0.9; 4], "{scale:?}");
            assert_eq!(at(99.0), [0.9; 4], "{scale:?}");
            for (q, u) in [(2.0, 0.0), (10.0, 1.0)] {
                assert!(apart(at(q), view.function().unwrap().sample(u)) < 1e-6, "{scale:?} {q}");
            }
            let off = TransferFunction::on_device(&view, &quantity, [None, outside(0.9)]).unwrap();
            assert_eq!(off.sample(0.0), view.function().unwrap().sample(0.0), "{scale:?}");
        }
    }

    #[test]
    fn too_many_points_are_told() {
        let point =
            |i: u16| ControlPoint { u: f32::from(i) / 4095.0, rgb: [0.5; 3], opacity: f32::from(i % 2) };
        let view = TransferView {
            points: (0..4096).map(point).collect(),
            map: Some(MapView::named("vik")),
            ..TransferView::default()
        };
        assert_eq!(view.function().unwrap_err().key, "transfer.points");
    }
}
