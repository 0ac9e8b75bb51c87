// Intervals of irradiance and opacity, of samples, cells and whole rays (HPG 2016, Sec. 4.2 and 4.3).
//
// Irradiance and transparency are taken as independent, as in the paper. Opacity stands for
// transparency, since it loses nothing where it is tiny, and it is the picture's fourth channel.

struct Interval {
    // Premultiplied colour and opacity.
    low: vec4<f32>,
    high: vec4<f32>,
}

// What a stretch without particles does to light.
fn nothing() -> Interval {
    return Interval(vec4(0.0), vec4(0.0));
}

// One stretch behind another: I + T·I', T·T'. The least light comes through where the opacity is greatest.
fn behind(front: Interval, back: Interval) -> Interval {
    let least = vec4(vec3(1.0 - front.high.a), 1.0 - front.low.a);
    let greatest = vec4(vec3(1.0 - front.low.a), 1.0 - front.high.a);
    return Interval(front.low + least * back.low, front.high + greatest * back.high);
}

fn widths(interval: Interval) -> vec4<f32> {
    return interval.high - interval.low;
}

// w: the largest of the four channels.
fn width(interval: Interval) -> f32 {
    let w = widths(interval);
    return max(max(w.r, w.g), max(w.b, w.a));
}

// Takes `slack` from the widths (Sec. 5.1): it raises the lower bounds of irradiance and transparency,
// and leaves the upper ones. The lower bound of the transparency is the upper one of the opacity. What is
// relaxed to nothing must not be turned inside out by rounding.
fn relaxed(interval: Interval, slack: vec4<f32>) -> Interval {
    let low = min(interval.low.rgb + slack.rgb, interval.high.rgb);
    let high = max(interval.high.a - slack.a, interval.low.a);
    return Interval(vec4(low, interval.low.a), vec4(interval.high.rgb, high));
}

// Extremes of colour and opacity over the values of a slab. None of its own where no particle is; and
// the opacity may be zero where a ray may miss all particles.
fn extremes_of_slab(values: vec2<f32>) -> Extremes {
    if values.x < 0.0 {
        return Extremes(vec4(vec3(1.0), 0.0), vec4(0.0));
    }
    var extremes = shades_over(values).range;
    extremes.low.a = select(0.0, extremes.low.a, values.y >= COVERED);
    return extremes;
}

// A sample on a path between two lengths, in reference lengths.
fn sample_interval(extremes: Extremes, paths: vec2<f32>) -> Interval {
    let thin = path_opacity(extremes.low.a, paths.x) * (1.0 - ROUNDING);
    let thick = min(path_opacity(extremes.high.a, paths.y) * (1.0 + ROUNDING), 1.0);
    return Interval(vec4(extremes.low.rgb * thin, thin), vec4(extremes.high.rgb * thick, thick));
}

// Bounds of the length of the bundle's rays in a slab, in reference lengths per unit of depth of the
// cell's middle and of `slab_depth`.
fn lengths_in_bundle(slope: vec2<f32>) -> vec2<f32> {
    let nearest = max(abs(slope) - 3.5 * frame.pitch, vec2(0.0));
    let farthest = abs(slope) + 3.5 * frame.pitch;
    let lengths = vec2(length(vec3(nearest, 1.0)), length(vec3(farthest, 1.0)));
    return frame.path_scale * lengths * vec2(1.0 - ROUNDING, 1.0 + ROUNDING);
}
