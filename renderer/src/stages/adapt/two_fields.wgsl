// Expansions of two fields, which share the sums of the weights. (one_field.wgsl has the same names for one.)

struct Expansions {
    colour: Expansion,
    // As in Expansion, of the field that decides the opacity.
    charge: Taylor,
    rest_q: vec4<f32>,
    rest_qq: vec4<f32>,
    low: vec4<f32>,
    high: vec4<f32>,
}

fn no_expansions() -> Expansions {
    let none = no_expansion();
    return Expansions(none, none.charge, none.rest_q, none.rest_qq, none.low, none.high);
}

// Adds a particle; returns the evaluations that it took.
fn add_particle(expansion: ptr<function, Expansions>, column: Column, ball: vec4<f32>, load: Load) -> u32 {
    let ways = ways_to(column, ball);
    if !any(reached_on(ways)) {
        return 0u;
    }
    let share = share_of(column, ways, ball.w, load.x);
    var colour = (*expansion).colour;
    add_share(&colour, share, load.y);
    (*expansion).colour = colour;
    let q = load.z;
    (*expansion).charge = plus((*expansion).charge, q, share.term);
    (*expansion).rest_q += q * share.left_out;
    (*expansion).rest_qq += q * q * share.left_out;
    (*expansion).low = select((*expansion).low, min((*expansion).low, vec4(q)), share.reached);
    (*expansion).high = select((*expansion).high, max((*expansion).high, vec4(q)), share.reached);
    return EVALUATIONS_OF_SHARE;
}

fn moved_expansions(e: Expansions, way: Move) -> Expansions {
    var result = e;
    result.colour = moved_expansion(e.colour, way);
    result.charge = moved(e.charge, way);
    return result;
}

fn field_values_of(expansion: Expansions, column: Column, reference: Quantity) -> FieldValues {
    var opacity = expansion.colour;
    opacity.charge = expansion.charge;
    opacity.rest_q = expansion.rest_q;
    opacity.rest_qq = expansion.rest_qq;
    opacity.low = expansion.low;
    opacity.high = expansion.high;
    return FieldValues(
        values_of(expansion.colour, column, reference.x),
        values_of(opacity, column, reference.y),
    );
}

// The quantity that decides the opacity.
fn for_opacity(quantity: Quantity) -> f32 {
    return quantity.y;
}

// How far another quantity is from its origin.
fn stray_of(quantity: Quantity, origin: Quantity) -> f32 {
    return abs(quantity.x - origin.x);
}

// What the quantities of a cell are relative to, where the least of those that decide the opacity is known.
// Of the others, a particle's: where all have the same one, sums are exact.
fn reference_in(cell: Cell, least: f32) -> Quantity {
    return vec2(in_range(quantities[pairs[cell.first]]).x, least);
}
