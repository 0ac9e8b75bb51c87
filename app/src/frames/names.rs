//! Field names: what the solvers call a thing, and what it is called here (contract, section 2).

/// Canonical names with what files write for them, all in lower case.
const ALIASES: [(&str, &[&str]); 8] = [
    ("velocity", &["velocity", "velocities", "vel", "vxyz"]),
    ("density", &["density", "densities", "rho"]),
    ("mass", &["mass", "masses", "m"]),
    ("smoothing_length", &["smoothing_length", "smoothinglength", "smoothinglengths", "h", "hsml"]),
    ("pressure", &["pressure", "pressures", "press", "p"]),
    ("temperature", &["temperature", "temperatures", "temp"]),
    ("id", &["id", "ids", "particleids", "particleid", "particle_id", "gid"]),
    ("radius", &["radius", "pscale"]),
];

/// Columns that together are one vector, in lower case; the first set that is complete wins.
pub const VELOCITY_COMPONENTS: [[&str; 3]; 5] = [
    ["vx", "vy", "vz"],
    ["velocity:0", "velocity:1", "velocity:2"],
    ["velocity_x", "velocity_y", "velocity_z"],
    ["velocity.x", "velocity.y", "velocity.z"],
    ["u", "v", "w"],
];

/// The one name that a field answers to: canonical where it is a usual one, else as written, in lower case.
pub fn canonical(name: &str) -> String {
    let lower = name.trim().to_lowercase();
    ALIASES
        .iter()
        .find(|(_, aliases)| aliases.contains(&lower.as_str()))
        .map_or(lower, |(canonical, _)| (*canonical).to_owned())
}

/// Splits `velocity.x` into a name and a component; components are x, y, z or 0, 1, 2, ...
pub fn split_component(name: &str) -> Option<(&str, usize)> {
    let (field, component) = name.rsplit_once('.')?;
    let index = match component.to_lowercase().as_str() {
        "x" => 0,
        "y" => 1,
        "z" => 2,
        digits => digits.parse().ok()?,
    };
    Some((field, index))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_names_are_one() {
        for name in ["Velocities", "velocity", " VEL "] {
            assert_eq!(canonical(name), "velocity");
        }
        assert_eq!(canonical("ParticleIDs"), "id");
        assert_eq!(canonical("Concentration"), "concentration");
    }

    #[test]
    fn components_split_off() {
        assert_eq!(split_component("velocity.x"), Some(("velocity", 0)));
        assert_eq!(split_component("a.b.2"), Some(("a.b", 2)));
        assert_eq!(split_component("velocity"), None);
        assert_eq!(split_component("v1.size"), None);
    }
}
