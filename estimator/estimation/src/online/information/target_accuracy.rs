//! Wanted accuracies.

use std::collections::BTreeMap;

/// Default relative standard errors that are wanted, and the size below which a value counts as that size: the accuracy
/// of values near zero is absolute.
const USUAL: [(&str, f64, f64); 28] = [
    ("weight_N", 0.01, 0.02),
    ("mass_kg", 0.01, 0.002),
    ("width_m", 0.005, 0.005),
    ("height_m", 0.01, 0.005),
    ("friction", 0.05, 0.1),
    ("friction_mu", 0.05, 0.02),
    ("viscous_N_s_m", 0.05, 0.2),
    ("coulomb_N", 0.05, 0.02),
    ("inertia_kg_m2", 0.10, 2e-6),
    ("radius_m", 0.002, 0.005),
    ("center_x_m", 0.01, 0.01),
    ("center_y_m", 0.01, 0.01),
    ("stiffness_N_m", 0.05, 100.0),
    ("puncture_force_N", 0.02, 0.1),
    ("viscous_Nm_s", 0.05, 1e-3),
    ("coulomb_Nm", 0.05, 1e-3),
    ("gravity_moment_Nm", 0.02, 1e-3),
    ("shaft_friction_N", 0.1, 0.05),
    ("hardening_N_m3", 0.25, 1e5),
    ("peak_force_N", 0.05, 0.1),
    ("return_peak_force_N", 0.05, 0.1),
    ("trough_force_N", 0.1, 0.1),
    ("return_trough_force_N", 0.1, 0.1),
    ("friction_N", 0.2, 0.05),
    ("damping_N_s_m", 0.2, 0.2),
    ("travel_m", 0.01, 0.005),
    ("knob_width_m", 0.01, 0.005),
    ("length_m", 0.05, 0.02),
];
/// Positions are wanted to a share of this length, m, wherever the origin is.
const LENGTH_M: f64 = 0.02;

/// Wanted relative accuracy of each parameter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wanted {
    /// Relative standard errors by parameter name, instead of the usual ones.
    pub relative: BTreeMap<String, f64>,
    /// Everything this many times as coarse; 0 counts as 1.
    pub coarser: f64,
}

impl Wanted {
    /// The relative standard error that is wanted of a parameter.
    pub fn relative(&self, name: &str) -> Option<f64> {
        let usual = || USUAL.iter().find(|(known, ..)| *known == name).map(|(_, share, _)| *share);
        let factor = if self.coarser > 0.0 { self.coarser } else { 1.0 };
        self.relative.get(name).copied().or_else(usual).map(|share| share * factor)
    }

    /// True if an accuracy is stated for it.
    pub fn asks_for(&self, name: &str) -> bool {
        self.relative(name).is_some()
    }

    /// The standard error that is wanted of a parameter with this value, in its unit.
    pub fn absolute(&self, name: &str, value: f64) -> Option<f64> {
        let least = USUAL.iter().find(|(known, ..)| *known == name).map_or(0.0, |(_, _, least)| *least);
        let size = if name.starts_with("center_") { LENGTH_M } else { value.abs().max(least) };
        self.relative(name).map(|share| share * size)
    }

    /// Reads `name=share` with a share like `0.01` or `1%`; the error is a sentence.
    pub fn state(&mut self, text: &str) -> Result<(), String> {
        let bad = || format!("a wanted accuracy is written as weight_N=1% or weight_N=0.01, not `{text}`");
        let (name, share) = text.split_once('=').ok_or_else(bad)?;
        let (number, factor) = share.trim().strip_suffix('%').map_or((share.trim(), 1.0), |n| (n.trim(), 0.01));
        let share = number.parse::<f64>().map_err(|_| bad())? * factor;
        if !(share > 0.0 && share.is_finite()) {
            return Err(bad());
        }
        self.relative.insert(name.trim().to_owned(), share);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accuracies_are_read_and_bad_ones_refused() {
        let mut wanted = Wanted::default();
        wanted.state("weight_N = 2 %").expect("a share");
        wanted.state("radius_m=0.001").expect("a share");
        assert_eq!((wanted.absolute("weight_N", 0.5), wanted.absolute("radius_m", 0.02)), (Some(0.01), Some(2e-5)));
        assert!(wanted.state("weight_N").is_err() && wanted.state("a=-1").is_err() && wanted.state("a=x%").is_err());
        assert_eq!(wanted.absolute("label", 1.0), None);
    }
}
