//! Values that no object has that a hand or a machine moves: a unit of the file is wrong.

use foundation::estimate::Fit;
use foundation::words::CLOCK_UNITS;

/// Least and largest size of parameters in SI units, by their names.
/// Choice: from a grain of sand to a locomotive. A wrong prefix of the time alone changes a mass by a million.
const SIZES: [(&str, f64, f64); 3] = [("mass_kg", 1e-6, 1e5), ("weight_N", 1e-5, 1e6), ("inertia_kg_m2", 1e-10, 1e6)];

/// Least acceleration, m/s² or rad/s², by which an inertia is seen: a slope of 0.06° does the same to a mass.
/// Choice: the least of the golden recordings of measured inertia has 0.49, of the real ones 0.57 (EMPS).
const LEAST_ACCELERATION: f64 = 0.01;
/// Largest acceleration, in the same units, that a clock in the right unit shows.
const LARGEST_ACCELERATION: f64 = 1e3;
/// Names of the inertias of mechanisms.
const INERTIAS: [&str; 2] = ["mass_kg", "inertia_kg_m2"];

/// A sentence if all of the force would hardly accelerate the identified inertia, with the unit of the times that makes it plausible.
fn slow_motion(fit: &Fit) -> Option<String> {
    let quality = fit.quality.as_ref()?;
    let inertia = fit.parameters.iter().find(|p| p.identified && INERTIAS.contains(&p.name.as_str()))?;
    let value = inertia.value.filter(|value| *value > 0.0)?;
    let acceleration = quality.heldout_rms / quality.heldout_relative / value;
    if acceleration.is_nan() || acceleration >= LEAST_ACCELERATION {
        return None;
    }
    let is_plausible = |unit: f64| (LEAST_ACCELERATION..LARGEST_ACCELERATION).contains(&(acceleration / (unit * unit)));
    let (clock, unit) = CLOCK_UNITS.into_iter().find(|(_, unit)| is_plausible(*unit))?;
    Some(format!(
        "{} {} comes out at {value:.1e}: the force accelerates that by {acceleration:.0e} {} at most, too slowly to be seen; if the times \
         are {clock}, state \"scale\": {{\"t_s\": {unit:e}}} in the sidecar, and it is {:.3e}",
        inertia.object,
        inertia.name,
        if quality.unit == "N" { "m/s²" } else { "rad/s²" },
        value * unit * unit
    ))
}

/// Warns of each identified value that is out of all reason.
pub fn doubt(fit: &mut Fit) {
    if let Some(text) = slow_motion(fit) {
        fit.warnings.push(text);
        return;
    }
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
    use foundation::estimate::{Parameter, Quality};

    #[test]
    fn a_clock_in_milliseconds_is_doubted_by_the_mass() {
        let of = |mass: f64| {
            let quality = Quality {
                rms: 0.01,
                heldout_rms: 0.01,
                heldout_relative: 0.01,
                heldout_share: 0.3,
                noise: None,
                unit: "N".into(),
            };
            let parameters = vec![Parameter::identified("mechanism", "mass_kg", mass, 1e-3 * mass, 1000, "made")];
            let mut fit = Fit { parameters, quality: Some(quality), ..Fit::default() };
            doubt(&mut fit);
            fit.warnings
        };
        assert!(of(5e4)[0].contains("\"t_s\": 1e-3") && of(5e4)[0].contains("5.000e-2"), "{:?}", of(5e4));
        assert!(of(5e10)[0].contains("microseconds") && of(90.0).is_empty());
    }

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
