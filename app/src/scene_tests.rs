//! Frames with and without radii, masses and fields.

use renderer::{OpacityView, Placement, Quantity};

use super::*;
use crate::frames::Metadata;

/// Four particles in the corners of a square of side 0.5, with the given fields.
fn frame(fields: &[(&str, Vec<f64>)], metadata: Metadata) -> Frame {
    let positions = vec![0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5, 0.0, 0.5, 0.5, 0.0];
    let field = |(name, values): &(&str, Vec<f64>)| Field {
        name: (*name).to_owned(),
        column: Column::new(values.len() / 4, values.clone()).unwrap(),
    };
    let fields = fields.iter().map(field).collect();
    Frame::new(Column::new(3, positions).unwrap(), fields, metadata).unwrap()
}

fn bare(fields: &[(&str, Vec<f64>)]) -> Frame {
    frame(fields, Metadata::default())
}

fn support(frame: &Frame) -> (SupportSource, f64) {
    let support = Support::new(frame, None);
    (support.source, support.radius(1))
}

#[test]
fn support_radii_come_from_the_best_source_there_is() {
    let h = ("SmoothingLength", vec![0.1; 4]);
    let radius = ("radius", vec![0.01, 0.02, 0.03, 0.04]);
    let metadata = |support_radius, particle_radius| Metadata {
        support_radius,
        particle_radius,
        support_per_smoothing_length: Some(2.0),
        ..Metadata::default()
    };
    let all = frame(&[h.clone(), radius.clone()], metadata(Some(0.3), Some(0.05)));
    assert_eq!(Support::new(&all, Some(0.7)).radius(3), 0.7);
    assert_eq!(support(&all), (SupportSource::SmoothingLength, 0.2));
    let frame_wide = frame(std::slice::from_ref(&radius), metadata(Some(0.3), Some(0.05)));
    assert_eq!(support(&frame_wide), (SupportSource::Metadata, 0.3));
    let each = frame(&[radius], metadata(None, Some(0.05)));
    assert_eq!(support(&each), (SupportSource::RadiusField, 0.08));
    assert_eq!(support(&frame(&[], metadata(None, Some(0.05)))), (SupportSource::ParticleRadius, 0.2));
    assert_eq!(support(&frame(&[], metadata(Some(-1.0), Some(f64::NAN)))), (SupportSource::Spacing, 1.0));
    assert_eq!(support(&bare(&[("h", vec![0.1; 4])])), (SupportSource::SmoothingLength, 0.1));
}

#[test]
fn particles_in_one_place_get_a_radius_all_the_same() {
    let positions = Column::new(3, vec![2.0; 9]).unwrap();
    let frame = Frame::new(positions, Vec::new(), Metadata::default()).unwrap();
    assert_eq!(support(&frame), (SupportSource::Unknown, 1.0));
    let nothing = Column::new(3, Vec::<f64>::new()).unwrap();
    let empty = Frame::new(nothing, Vec::new(), Metadata::default()).unwrap();
    assert!(particles(&empty, None).unwrap().is_empty());
}

#[test]
fn a_bad_radius_leaves_out_its_particle_only() {
    let frame = bare(&[("radius", vec![0.1, -0.1, 0.0, f64::NAN]), ("q", vec![1.0; 4])]);
    let set = particles(&frame, None).unwrap();
    assert_eq!((set.len(), set.rejected().bad_radius), (1, 3));
    let q = quantity(&frame, &set, &QuantityView::default()).unwrap();
    let warning = rejected_warning(&frame, &set, &q).unwrap();
    assert_eq!(warning, "3 of 4 particles are left out: support radius not positive and finite (3)");

    let metadata = Metadata { support_radius: Some(0.3), ..Metadata::default() };
    let set = particles(&self::frame(&[("radius", vec![0.1, -0.1, 0.2, 0.3])], metadata), None).unwrap();
    assert_eq!((set.len(), set.rejected().bad_radius, set.support_radii()), (3, 1, [0.3; 2]));
}

#[test]
fn a_mass_that_is_not_above_zero_leaves_out_its_particle_with_a_warning() {
    let frame = bare(&[("mass", vec![2.0, 0.0, -1.0, 3.0]), ("density", vec![1.0; 4]), ("q", vec![1.0; 4])]);
    let set = particles(&frame, Some(0.1)).unwrap();
    assert_eq!((set.len(), set.weightless(), set.rejected().total()), (2, 2, 0));
    assert_eq!([set.source_row(0), set.source_row(1)], [0, 3]);
    let q = quantity(&frame, &set, &QuantityView::default()).unwrap();
    let warning = rejected_warning(&frame, &set, &q).unwrap();
    assert_eq!(warning, "2 of 4 particles are left out: no weight, since mass/density is not above 0 (2)");
}

#[test]
fn names_select_fields_components_and_lengths() {
    let velocity: Vec<f64> = [3.0, 4.0, 0.0].repeat(4);
    let frame = bare(&[("Velocities", velocity), ("rho", vec![2.0; 4])]);
    let value = |name: &str| Selection::new(&frame, Some(name)).map(|selection| selection.value(2));
    assert_eq!(value("velocity"), Ok(5.0));
    assert_eq!(value("VEL.y"), Ok(4.0));
    assert_eq!(value("velocity.2"), Ok(0.0));
    assert_eq!(value("Density"), Ok(2.0));
    let message = |name: &str| value(name).unwrap_err().to_string();
    assert_eq!(message("dye"), "there is no field `dye`; there are: Velocities, rho");
    assert_eq!(message("velocity.3"), "field `Velocities` has 3 components, there is no `velocity.3`");
    let names = quantity_names(&frame);
    assert_eq!(names, ["velocity", "velocity.x", "velocity.y", "velocity.z", "density"]);
    for name in &names {
        assert_eq!(Selection::new(&frame, Some(name)).unwrap().name().as_ref(), Some(name));
    }
    let twice = bare(&[("rho", vec![1.0; 4]), ("Density", vec![2.0; 4])]);
    assert_eq!(quantity_names(&twice), ["rho", "density"]);
}

#[test]
fn another_field_may_decide_the_opacity() {
    let frame = bare(&[("dye", vec![0.0, 1.0, 2.0, f64::NAN]), ("rho", vec![f64::INFINITY, 5.0, 6.0, 7.0])]);
    let set = particles(&frame, Some(0.1)).unwrap();
    let both = |name: Option<&str>| {
        let opacity = Some(OpacityView { name: name.map(str::to_owned), ..OpacityView::default() });
        quantity(&frame, &set, &QuantityView { name: Some("dye".into()), opacity, ..Default::default() })
    };
    let opacity_range = |both: &Quantity| both.opacity_placement().map(Placement::range);
    let by_density = both(Some("density")).unwrap();
    assert_eq!((by_density.range(), opacity_range(&by_density)), ([0.0, 2.0], Some([5.0, 7.0])));
    let warning = rejected_warning(&frame, &set, &by_density).unwrap();
    assert_eq!(warning, "2 of 4 particles are left out: quantity of colour or opacity not finite (2)");
    assert_eq!(opacity_range(&both(None).unwrap()), Some([0.0, 2.0]), "without a name, the same field");
    let message = both(Some("heat")).map(drop).unwrap_err().to_string();
    assert_eq!(message, "there is no field `heat`; there are: dye, rho");
}

#[test]
fn the_first_meaningful_field_is_shown() {
    let of = |names: &[&str]| {
        let fields: Vec<_> = names.iter().map(|&name| (name, vec![1.0; 4])).collect();
        Selection::default_of(&bare(&fields)).name()
    };
    assert_eq!(of(&["id", "density", "Concentration"]).as_deref(), Some("concentration"));
    assert_eq!(of(&["id", "rho", "vel"]).as_deref(), Some("velocity"));
    assert_eq!(of(&["id", "m", "hsml", "alpha"]).as_deref(), Some("alpha"));
    assert_eq!(of(&["id", "mass"]), None);
    assert_eq!(Selection::default_of(&bare(&[])).value(0), 0.5);
}

#[test]
fn a_frame_without_particles_has_every_field() {
    let nothing = Column::new(3, Vec::<f64>::new()).unwrap();
    let empty = Frame::new(nothing, Vec::new(), Metadata::default()).unwrap();
    assert!(Selection::new(&empty, Some("dye")).is_ok());
}

#[test]
fn volumes_need_a_sound_density() {
    let volume = |fields: &[(&str, Vec<f64>)], row| volumes(&bare(fields))(row);
    let (mass, density) = (("mass", vec![6.0; 4]), ("density", vec![1.0, 2.0, 3.0, 4.0]));
    assert_eq!(volume(&[mass.clone(), density.clone()], 2), 2.0);
    assert_eq!(volume(&[density], 1), 0.5);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(volume(&[mass.clone(), ("density", vec![1.0, 2.0, 3.0, bad])], 0), 1.0);
    }
    assert_eq!(volume(&[mass], 0), 1.0);
}
