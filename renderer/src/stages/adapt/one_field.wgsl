// Expansions of one field. (two_fields.wgsl has the same names for two.)

alias Expansions = Expansion;

fn no_expansions() -> Expansions {
    return no_expansion();
}

// Adds a particle; returns the evaluations that it took.
fn add_particle(expansion: ptr<function, Expansions>, column: Column, ball: vec4<f32>, load: Load) -> u32 {
    let ways = ways_to(column, ball);
    if !any(reached_on(ways)) {
        return 0u;
    }
    add_share(expansion, share_of(column, ways, ball.w, load.x), load.y);
    return EVALUATIONS_OF_SHARE;
}

fn moved_expansions(expansions: Expansions, way: Move) -> Expansions {
    return moved_expansion(expansions, way);
}

fn field_values_of(expansion: Expansions, column: Column, reference: Quantity) -> FieldValues {
    return values_of(expansion, column, reference);
}

// The quantity that decides the opacity.
fn for_opacity(quantity: Quantity) -> f32 {
    return quantity;
}

// How far another quantity is from its origin.
fn stray_of(quantity: Quantity, origin: Quantity) -> f32 {
    return 0.0;
}

// What the quantities of a cell are relative to, where the least of those that decide the opacity is known.
fn reference_in(cell: Cell, least: f32) -> Quantity {
    return least;
}
