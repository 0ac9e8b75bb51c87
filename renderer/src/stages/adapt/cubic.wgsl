// Terms of third order: of poly6, whose derivatives are smooth inside its support. Expansions of the other kernels end
// with the second order.

fn has_cubic() -> bool {
    return KERNEL == 0u;
}

// All samples have a² = b² = r² (bricks.wgsl). So ten terms are seven: the factors of a·r², b·r², s·r², s³, a·s²,
// b·s² and a·b·s.
struct Cubic {
    arr: vec4<f32>,
    brr: vec4<f32>,
    srr: vec4<f32>,
    sss: vec4<f32>,
    ass: vec4<f32>,
    bss: vec4<f32>,
    asb: vec4<f32>,
}

fn no_cubic() -> Cubic {
    let none = vec4(0.0);
    return Cubic(none, none, none, none, none, none, none);
}

// Those of poly6 around the middles of bricks: 8β³ − 12xβγ (jets.wgsl).
fn cubic_of(jet: Jet, inverse_radius: f32, ways: Ways, direction: vec3<f32>) -> Cubic {
    if !has_cubic() {
        return no_cubic();
    }
    let unit = inverse_radius * inverse_radius * inverse_radius;
    let straight = unit * jet.cube;
    let bent = -unit * jet.stretch;
    let bent_along = 0.5 * dot(direction, direction) * bent;
    let xx = ways.x * ways.x;
    let yy = ways.y * ways.y;
    let ss = ways.along * ways.along;
    let turned = 3.0 * straight * ss + bent_along;
    let bent_by = bent * ways.along;
    return Cubic(
        ways.x * (straight * (xx + 3.0 * yy) + bent),
        ways.y * (straight * (yy + 3.0 * xx) + bent),
        3.0 * straight * ways.along * (xx + yy) + bent_by + bent * (direction.x * ways.x + direction.y * ways.y),
        ways.along * (straight * ss + bent_along),
        ways.x * turned + direction.x * bent_by,
        ways.y * turned + direction.y * bent_by,
        6.0 * straight * ways.x * ways.y * ways.along + bent * (direction.x * ways.y + direction.y * ways.x),
    );
}

// By how much they lower a kernel that falls as much as it may in a brick.
fn cubic_fall(jet: Jet, ways: Ways) -> vec4<f32> {
    if !has_cubic() {
        return vec4(0.0);
    }
    return ways.product * (jet.cube * ways.product * ways.product - 0.5 * jet.stretch * ways.reach * ways.reach);
}

fn cubic_plus(sum: Cubic, factor: vec4<f32>, term: Cubic) -> Cubic {
    if !has_cubic() {
        return sum;
    }
    return Cubic(
        sum.arr + factor * term.arr,
        sum.brr + factor * term.brr,
        sum.srr + factor * term.srr,
        sum.sss + factor * term.sss,
        sum.ass + factor * term.ass,
        sum.bss + factor * term.bss,
        sum.asb + factor * term.asb,
    );
}

// By how much these terms may exceed zero, or fall below it.
fn twist(f: Cubic, column: Column) -> vec4<f32> {
    if !has_cubic() {
        return vec4(0.0);
    }
    let width = column.half_width;
    let depth = column.half_depth;
    let across = width * (width * (abs(f.arr) + abs(f.brr)) + depth * (abs(f.srr) + abs(f.asb)));
    return width * across + depth * depth * (depth * abs(f.sss) + width * (abs(f.ass) + abs(f.bss)));
}
