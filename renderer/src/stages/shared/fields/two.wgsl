// Two fields: one decides the colour, the other one the opacity. (one.wgsl has the same names for one.)

// A particle's quantities, or those of a sample: colour, opacity.
alias Quantity = vec2<f32>;
// Weight, and quantities or weight times quantities.
alias Load = vec3<f32>;
// Sums of weights times quantity at four samples: a column each for colour and opacity.
alias Charges = mat2x4<f32>;

// Where one of the two is no number, both say so.
fn is_rejected(quantity: Quantity) -> bool {
    return quantity.x > REJECTED;
}

fn in_range(quantity: Quantity) -> Quantity {
    return clamp(quantity, vec2(0.0), vec2(1.0));
}

// The quantities, 0 in place of those on a logarithmic scale.
fn zero_on_log_scale(quantity: Quantity) -> Quantity {
    return select(quantity, vec2(0.0), (vec2(frame.logarithmic) & vec2(1u, 2u)) != vec2(0u));
}

// What a load adds at four samples with these kernel values.
fn charges_of(load: Load, k: vec4<f32>) -> Charges {
    return Charges(load.y * k, load.z * k);
}

fn charge_at(charges: Charges, sample: u32) -> Quantity {
    return vec2(charges[0][sample], charges[1][sample]);
}

fn relative_to(charges: Charges, reference: Quantity) -> Charges {
    return Charges(charges[0] - reference.x, charges[1] - reference.y);
}

fn select_charges(otherwise: Charges, charges: Charges, condition: bool) -> Charges {
    return Charges(select(otherwise[0], charges[0], condition), select(otherwise[1], charges[1], condition));
}

// Colour and opacity of a sample.
fn shade_of(quantity: Quantity) -> vec4<f32> {
    let place = in_range(quantity);
    return vec4(transfer_at(place.x).rgb, transfer_at(place.y).a);
}

// Those of four samples with these sums, where any particle is.
fn shades_of_four(weights: vec4<f32>, charges: Charges, reference: Quantity) -> mat4x4<f32> {
    let hues = clamp(reference.x + charges[0] / weights, vec4(0.0), vec4(1.0));
    let densities = clamp(reference.y + charges[1] / weights, vec4(0.0), vec4(1.0));
    let colours = transfer_at_four(hues, weights > vec4(0.0));
    let opacities = transfer_at_four(densities, weights > vec4(0.0));
    return mat4x4(
        vec4(colours[0].rgb, opacities[0].a),
        vec4(colours[1].rgb, opacities[1].a),
        vec4(colours[2].rgb, opacities[2].a),
        vec4(colours[3].rgb, opacities[3].a),
    );
}
