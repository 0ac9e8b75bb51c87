// Functions around the middles of the four bricks of a column, up to their second derivatives or what is of third
// order, and how far they stray in a brick.

// Derivatives with respect to a, b and s (bricks.wgsl).
struct Taylor {
    value: vec4<f32>,
    a: vec4<f32>,
    b: vec4<f32>,
    s: vec4<f32>,
    aa: vec4<f32>,
    bb: vec4<f32>,
    ss: vec4<f32>,
    ab: vec4<f32>,
    sa: vec4<f32>,
    sb: vec4<f32>,
    cubic: Cubic,
}

fn no_taylor() -> Taylor {
    let none = vec4(0.0);
    return Taylor(none, none, none, none, none, none, none, none, none, none, no_cubic());
}

fn plus(sum: Taylor, factor: f32, term: Taylor) -> Taylor {
    return Taylor(
        sum.value + factor * term.value,
        sum.a + factor * term.a,
        sum.b + factor * term.b,
        sum.s + factor * term.s,
        sum.aa + factor * term.aa,
        sum.bb + factor * term.bb,
        sum.ss + factor * term.ss,
        sum.ab + factor * term.ab,
        sum.sa + factor * term.sa,
        sum.sb + factor * term.sb,
        cubic_plus(sum.cubic, vec4(factor), term.cubic),
    );
}

fn less(f: Taylor, factor: vec4<f32>, g: Taylor) -> Taylor {
    return Taylor(
        f.value - factor * g.value,
        f.a - factor * g.a,
        f.b - factor * g.b,
        f.s - factor * g.s,
        f.aa - factor * g.aa,
        f.bb - factor * g.bb,
        f.ss - factor * g.ss,
        f.ab - factor * g.ab,
        f.sa - factor * g.sa,
        f.sb - factor * g.sb,
        cubic_plus(f.cubic, -factor, g.cubic),
    );
}

// By how much the linear part of a function may exceed its value in the middle.
fn swing(f: Taylor, column: Column) -> vec4<f32> {
    return column.half_width * (abs(f.a) + abs(f.b)) + column.half_depth * abs(f.s);
}

// By how much the quadratic part exceeds zero at most (side 1), or falls below it (side −1); less than 0 where it
// always does the opposite.
fn sag(f: Taylor, column: Column, side: f32) -> vec4<f32> {
    let width = column.half_width;
    let depth = column.half_depth;
    let along = side * f.ss;
    let least_along = along * column.least_depth * column.least_depth;
    let squares = across_sag(f, column, side) + max(along * depth * depth, least_along);
    return 0.5 * squares + width * (width * abs(f.ab) + depth * (abs(f.sa) + abs(f.sb)));
}

// The same of what is quadratic across the column. Of 2 × 2 rays, each lies as far aside to a as to b.
fn across_sag(f: Taylor, column: Column, side: f32) -> vec4<f32> {
    let greatest = column.half_width * column.half_width;
    let least = column.least_width * column.least_width;
    if COLUMN_SIDE == 2u {
        let across = side * (f.aa + f.bb);
        return max(across * greatest, across * least);
    }
    let a = side * f.aa;
    let b = side * f.bb;
    return max(a * greatest, a * least) + max(b * greatest, b * least);
}

fn sag_either_way(f: Taylor, column: Column) -> vec4<f32> {
    return max(sag(f, column, 1.0), sag(f, column, -1.0));
}

// What is quadratic in n/w, times w in the middle, where n is 0 there. (Linear parts are not looked at.)
fn bend_of_quotient(n: Taylor, w: Taylor) -> Taylor {
    let a = n.a / w.value;
    let b = n.b / w.value;
    let s = n.s / w.value;
    var bend = no_taylor();
    bend.aa = n.aa - 2.0 * a * w.a;
    bend.bb = n.bb - 2.0 * b * w.b;
    bend.ss = n.ss - 2.0 * s * w.s;
    bend.ab = n.ab - a * w.b - b * w.a;
    bend.sa = n.sa - s * w.a - a * w.s;
    bend.sb = n.sb - s * w.b - b * w.s;
    return bend;
}
