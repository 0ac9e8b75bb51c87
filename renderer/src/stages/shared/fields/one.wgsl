// One field decides both colour and opacity. (two.wgsl has the same names for two fields.)

// A particle's quantity, or that of a sample.
alias Quantity = f32;
// Weight, and quantity or weight times quantity.
alias Load = vec2<f32>;
// Sums of weights times quantity at four samples.
alias Charges = vec4<f32>;

fn is_rejected(quantity: Quantity) -> bool {
    return quantity > REJECTED;
}

fn in_range(quantity: Quantity) -> Quantity {
    return clamp(quantity, 0.0, 1.0);
}

// The quantity, or 0 on a logarithmic scale.
fn zero_on_log_scale(quantity: Quantity) -> Quantity {
    return select(quantity, 0.0, (frame.logarithmic & 1u) != 0u);
}

// What a load adds at four samples with these kernel values.
fn charges_of(load: Load, k: vec4<f32>) -> Charges {
    return load.y * k;
}

fn charge_at(charges: Charges, sample: u32) -> Quantity {
    return charges[sample];
}

fn relative_to(charges: Charges, reference: Quantity) -> Charges {
    return charges - reference;
}

fn select_charges(otherwise: Charges, charges: Charges, condition: bool) -> Charges {
    return select(otherwise, charges, condition);
}

// Colour and opacity of a sample.
fn shade_of(quantity: Quantity) -> vec4<f32> {
    return transfer_at(in_range(quantity));
}

// Those of four samples with these sums, where any particle is.
fn shades_of_four(weights: vec4<f32>, charges: Charges, reference: Quantity) -> mat4x4<f32> {
    let places = clamp(reference + charges / weights, vec4(0.0), vec4(1.0));
    return transfer_at_four(places, weights > vec4(0.0));
}
