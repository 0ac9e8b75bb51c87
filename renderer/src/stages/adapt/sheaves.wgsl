// Sheaves: four neighbouring columns of a cell, or all of them, that share an expansion, about the axis in the middle of
// them.
//
// What is known of a polynomial in one place is known everywhere: a sheaf's sums are moved to the bricks of each of
// its columns. Only what the expansion leaves out is bounded for the sheaf, and so is wider than for a column.

const SHEAF_COLUMNS: u32 = 4u;
// Of a cell.
override SHEAVES: u32 = COLUMNS / SHEAF_COLUMNS;
// Where a cell has no more columns, each has its own expansion: a lane does no more for it than for a sheaf, and other
// lanes would wait for that one.
override HAS_SHEAVES: bool = COLUMNS > SHEAF_COLUMNS;
// The terms of a particle's weight, moved by up to NEAR radii (survey.wgsl), have magnitudes that add up to no more
// than so many times its largest weight, whatever the kernel.
const MOST_MOVED: f32 = 2.0;

// From the middles of a sheaf's bricks to those of a column.
struct Move {
    a: vec4<f32>,
    b: vec4<f32>,
    // What the column's direction has more.
    lean: vec2<f32>,
}

fn move_to(column: Column, sheaf: Column) -> Move {
    let lean = column.from_axis - sheaf.from_axis;
    return Move(lean.x * (1.0 + column.depth), lean.y * (1.0 + column.depth), lean);
}

// A polynomial about another place: f(a + way.a, b + way.b, s).
fn shifted(f: Taylor, way: Move) -> Taylor {
    let a = way.a;
    let b = way.b;
    let c = f.cubic;
    let square_a = f.aa * a + f.ab * b;
    let square_b = f.ab * a + f.bb * b;
    let cubic_value = a * (a * (c.aaa * a + c.aab * b) + c.abb * b * b) + c.bbb * b * b * b;
    return Taylor(
        f.value + f.a * a + f.b * b + 0.5 * (square_a * a + square_b * b) + cubic_value,
        f.a + square_a + 2.0 * (c.aaa * a + c.aab * b) * a + c.aaa * a * a + c.abb * b * b,
        f.b + square_b + 2.0 * (c.bbb * b + c.abb * a) * b + c.bbb * b * b + c.aab * a * a,
        f.s + f.sa * a + f.sb * b + (c.aas * a + c.abs * b) * a + c.bbs * b * b,
        f.aa + 6.0 * c.aaa * a + 2.0 * c.aab * b,
        f.bb + 6.0 * c.bbb * b + 2.0 * c.abb * a,
        f.ss + 2.0 * (c.ass * a + c.bss * b),
        f.ab + 2.0 * (c.aab * a + c.abb * b),
        f.sa + 2.0 * c.aas * a + c.abs * b,
        f.sb + 2.0 * c.bbs * b + c.abs * a,
        c,
    );
}

// A polynomial along another direction: f(a + lean.x·s, b + lean.y·s, s).
fn leant(f: Taylor, lean: vec2<f32>) -> Taylor {
    let x = lean.x;
    let y = lean.y;
    let c = f.cubic;
    return Taylor(
        f.value,
        f.a,
        f.b,
        f.s + x * f.a + y * f.b,
        f.aa,
        f.bb,
        f.ss + x * (2.0 * f.sa + x * f.aa + y * f.ab) + y * (2.0 * f.sb + x * f.ab + y * f.bb),
        f.ab,
        f.sa + x * f.aa + y * f.ab,
        f.sb + x * f.ab + y * f.bb,
        Cubic(
            c.aaa,
            c.aab,
            c.abb,
            c.bbb,
            c.aas + 3.0 * x * c.aaa + y * c.aab,
            c.abs + 2.0 * (x * c.aab + y * c.abb),
            c.bbs + 3.0 * y * c.bbb + x * c.abb,
            c.ass + 2.0 * x * c.aas + y * c.abs + 3.0 * x * x * c.aaa + 2.0 * x * y * c.aab + y * y * c.abb,
            c.bss + 2.0 * y * c.bbs + x * c.abs + 3.0 * y * y * c.bbb + 2.0 * x * y * c.abb + x * x * c.aab,
            c.sss + x * (c.ass + x * (c.aas + x * c.aaa + y * c.aab)) + y * (c.bss + y * (c.bbs + y * c.bbb + x * c.abb))
                + x * y * c.abs,
        ),
    );
}

fn moved(f: Taylor, way: Move) -> Taylor {
    return leant(shifted(f, way), way.lean);
}

fn moved_expansion(e: Expansion, way: Move) -> Expansion {
    var result = e;
    result.weight = moved(e.weight, way);
    result.charge = moved(e.charge, way);
    result.moved = select(MOST_MOVED * e.mass, 0.0, all(way.lean == vec2(0.0)));
    return result;
}
