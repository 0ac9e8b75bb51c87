// Terms of third order: of poly6, whose derivatives are smooth inside its support. Expansions of the other kernels end
// with the second order.

fn has_cubic() -> bool {
    return KERNEL == 0u;
}

// The factors of a³, a²b and so on.
struct Cubic {
    aaa: vec4<f32>,
    aab: vec4<f32>,
    abb: vec4<f32>,
    bbb: vec4<f32>,
    aas: vec4<f32>,
    abs: vec4<f32>,
    bbs: vec4<f32>,
    ass: vec4<f32>,
    bss: vec4<f32>,
    sss: vec4<f32>,
}

fn no_cubic() -> Cubic {
    let none = vec4(0.0);
    return Cubic(none, none, none, none, none, none, none, none, none, none);
}

// Those of poly6 around the middles of bricks: 8β³ − 12xβγ (jets.wgsl).
fn cubic_of(jet: Jet, inverse_radius: f32, ways: Ways, direction: vec3<f32>) -> Cubic {
    if !has_cubic() {
        return no_cubic();
    }
    let unit = inverse_radius * inverse_radius * inverse_radius;
    let straight = unit * jet.cube;
    let bent = -0.5 * unit * jet.stretch;
    let x = ways.x;
    let y = ways.y;
    let s = ways.along;
    let xx = straight * x * x;
    let yy = straight * y * y;
    let across = 3.0 * straight * x * y;
    let along = straight * s * s + dot(direction, direction) * bent;
    let further = 3.0 * straight * s * s + dot(direction, direction) * bent;
    let turn = 2.0 * bent * s;
    return Cubic(
        x * (xx + bent),
        across * x + bent * y,
        across * y + bent * x,
        y * (yy + bent),
        s * (3.0 * xx + bent) + 2.0 * direction.x * bent * x,
        2.0 * (across * s + bent * (direction.x * y + direction.y * x)),
        s * (3.0 * yy + bent) + 2.0 * direction.y * bent * y,
        x * further + direction.x * turn,
        y * further + direction.y * turn,
        s * along,
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
        sum.aaa + factor * term.aaa,
        sum.aab + factor * term.aab,
        sum.abb + factor * term.abb,
        sum.bbb + factor * term.bbb,
        sum.aas + factor * term.aas,
        sum.abs + factor * term.abs,
        sum.bbs + factor * term.bbs,
        sum.ass + factor * term.ass,
        sum.bss + factor * term.bss,
        sum.sss + factor * term.sss,
    );
}

// By how much these terms may exceed zero, or fall below it. Of 2 × 2 rays, all have a² = b².
fn twist(f: Cubic, column: Column) -> vec4<f32> {
    if !has_cubic() {
        return vec4(0.0);
    }
    let width = column.half_width;
    let depth = column.half_depth;
    var sideways = abs(f.aaa + f.abb) + abs(f.bbb + f.aab);
    var leaning = abs(f.aas + f.bbs);
    if COLUMN_SIDE > 2u {
        sideways = abs(f.aaa) + abs(f.abb) + abs(f.bbb) + abs(f.aab);
        leaning = abs(f.aas) + abs(f.bbs);
    }
    let across = width * (width * sideways + depth * (leaning + abs(f.abs)));
    return width * across + depth * depth * (depth * abs(f.sss) + width * (abs(f.ass) + abs(f.bss)));
}
