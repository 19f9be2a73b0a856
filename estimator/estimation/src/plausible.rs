//! Values that no object has that a hand or a machine moves: a unit of the file is wrong.

use foundation::estimate::Fit;

/// Least and largest size of parameters in SI units, by their names.
/// Choice: from a grain of sand to a locomotive. A wrong prefix of the time alone changes a mass by a million.
const SIZES: [(&str, f64, f64); 3] = [("mass_kg", 1e-6, 1e5), ("weight_N", 1e-5, 1e6), ("inertia_kg_m2", 1e-10, 1e6)];

/// Warns of each identified value that is out of all reason.
pub fn doubt(fit: &mut Fit) {
    for parameter in fit.parameters.iter().filter(|p| p.identified) {
        let Some(&(_, least, most)) = SIZES.iter().find(|(name, ..)| *name == parameter.name) else { continue };
        let Some(value) = parameter.value.filter(|v| *v != 0.0 && !(least..=most).contains(&v.abs())) else { continue };
        let text = format!(
            "{} {} comes out at {value:.1e}: nothing that a hand or a machine moves is so {}; check the units of force, length, \
             and time, and give \"scale\" in the sidecar",
            parameter.object,
            parameter.name,
            if value.abs() > most { "large" } else { "small" }
        );
        fit.warnings.push(text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foundation::estimate::Parameter;

    #[test]
    fn a_mountain_and_a_speck_are_doubted() {
        let of = |name: &str, value: f64| {
            let parameter = Parameter::identified("mechanism", name, value, 1e-3 * value, 1000, "made");
            let mut fit = Fit { parameters: vec![parameter], ..Fit::default() };
            doubt(&mut fit);
            fit.warnings
        };
        assert!(of("mass_kg", 1.5e18)[0].contains("1.5e18") && of("mass_kg", 1.5e-9)[0].contains("so small"));
        for (name, value) in [("mass_kg", 24.7), ("inertia_kg_m2", 3e-7), ("weight_N", 0.0), ("coulomb_N", 1e9)] {
            assert!(of(name, value).is_empty(), "{name}");
        }
    }
}
