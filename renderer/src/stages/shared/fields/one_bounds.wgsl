// Bounds in the bricks of a column, for one field. (two_bounds.wgsl has the same names for two.)

// What is known of a column's bricks.
alias FieldValues = ColumnValues;

fn no_field_values() -> FieldValues {
    return no_values();
}

// What is seen in a brick.
struct Seen {
    // Bounds of the quantity that decides the opacity, as a brick has them.
    values: vec2<f32>,
    shades: Shades,
    // How far the quantity may be from its slope.
    off: f32,
}

fn seen_in(column: FieldValues, brick: u32) -> Seen {
    let values = vec2(column.low[brick], column.high[brick]);
    return Seen(values, shades_over(values), unpack_slope(column.along[brick]).y);
}

// The quantity at a ray's samples in a brick, by the brick's slope. `ray`: its number in the column.
fn charges_on_slope(column: FieldValues, brick: u32, ray: u32) -> Charges {
    return values_on_slope(column, brick, ray);
}
