// Expansions of one field. (two_fields.wgsl has the same names for two.)

alias Expansions = Expansion;

fn no_expansions() -> Expansions {
    return no_expansion();
}

// Adds a particle.
fn add_particle(expansion: ptr<function, Expansions>, column: Column, ball: vec4<f32>, load: Load) {
    let share = share_of(column, ball, load.x);
    add_share(expansion, share, load.y);
}

fn field_values_of(expansion: Expansions, column: Column, reference: Quantity) -> FieldValues {
    return values_of(expansion, column, reference);
}

// The quantity that decides the opacity.
fn for_opacity(quantity: Quantity) -> f32 {
    return quantity;
}

// What the quantities of a cell are relative to, where the least of those that decide the opacity is known.
fn reference_in(cell: Cell, least: f32) -> Quantity {
    return least;
}
