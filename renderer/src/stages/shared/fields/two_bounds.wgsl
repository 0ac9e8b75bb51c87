// Bounds in the bricks of a column, for two fields. (one_bounds.wgsl has the same names for one.)

// What is known of a column's bricks. The two are alike in which bricks are empty or covered.
struct FieldValues {
    colour: ColumnValues,
    opacity: ColumnValues,
}

fn no_field_values() -> FieldValues {
    return FieldValues(no_values(), no_values());
}

// What is seen in a brick.
struct Seen {
    // Bounds of the quantity that decides the opacity, as a brick has them.
    values: vec2<f32>,
    // Of the colour over its field's bounds, of the opacity over its own. How steep each is has been
    // multiplied by how far its field may be from its slope.
    shades: Shades,
    off: f32,
}

fn seen_in(column: FieldValues, brick: u32) -> Seen {
    let values = vec2(column.opacity.low[brick], column.opacity.high[brick]);
    let colour = shades_over(vec2(column.colour.low[brick], column.colour.high[brick]));
    let opacity = shades_over(values);
    let off = vec2(
        unpack_slope(column.colour.along[brick]).y,
        unpack_slope(column.opacity.along[brick]).y,
    );
    let range = Extremes(
        vec4(colour.range.low.rgb, opacity.range.low.a),
        vec4(colour.range.high.rgb, opacity.range.high.a),
    );
    let strays = vec4(colour.steepness.rgb * off.x, opacity.steepness.a * off.y);
    return Seen(values, Shades(range, strays), 1.0);
}

// The quantities at a ray's samples in a brick, by the brick's slopes. `ray`: its number in the column.
fn charges_on_slope(column: FieldValues, brick: u32, ray: u32) -> Charges {
    return Charges(values_on_slope(column.colour, brick, ray), values_on_slope(column.opacity, brick, ray));
}
