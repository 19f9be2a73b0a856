//! Numbers as people write them: value ± error with sensible units.

use estimator::online::information::Enough;

/// A quantity on the screen: what it is called, in which unit, and the factor from SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// For people.
    pub label: String,
    /// Shown unit; empty for a pure number.
    pub unit: &'static str,
    /// Shown value = SI value × factor.
    pub factor: f64,
}

/// Unit suffixes of parameter names, the longest first, with the shown unit and its factor.
const SUFFIXES: &[(&str, &str, f64)] = &[
    ("_kg_m2", "g·cm²", 1e7),
    ("_kg_m3", "kg/m³", 1.0),
    ("_kg_s", "g/s", 1e3),
    ("_kg_m", "kg·m", 1.0),
    ("_rad_s2", "rad/s²", 1.0),
    ("_rad_Nm", "°/N·m", 180.0 / std::f64::consts::PI),
    ("_N_s_m", "N·s/m", 1.0),
    ("_N_m3", "N/mm³", 1e-9),
    ("_Nm_s", "N·m·s", 1.0),
    ("_N_s", "N/s", 1.0),
    ("_N_m", "N/m", 1.0),
    ("_Nm", "N·m", 1.0),
    ("_m_s2", "m/s²", 1.0),
    ("_m_s", "mm/s", 1e3),
    ("_1_m", "1/m", 1.0),
    ("_1_s", "1/s", 1.0),
    ("_kg", "g", 1e3),
    ("_rad", "°", 180.0 / std::f64::consts::PI),
    ("_m", "mm", 1e3),
    ("_N", "N", 1.0),
    ("_s", "s", 1.0),
];

/// How a parameter such as `weight_N` is shown; `value` decides between small and large units.
pub fn parameter(name: &str, value: Option<f64>) -> Quantity {
    let (stem, unit, factor) = SUFFIXES
        .iter()
        .find_map(|(suffix, unit, factor)| name.strip_suffix(suffix).map(|stem| (stem, *unit, *factor)))
        .unwrap_or((name, "", 1.0));
    let size = value.unwrap_or(0.0).abs();
    let (unit, factor) = match unit {
        // A viscous friction has the same letters.
        "N·m·s" if stem.contains("drift") => ("N·m/s", 1.0),
        "g" if size >= 1.0 => ("kg", 1.0),
        "g·cm²" if size >= 1e-2 => ("kg·m²", 1.0),
        other => extreme(other, size).unwrap_or((other, factor)),
    };
    // A force, and no coefficient that a slip shows.
    let label = if name == "friction_N" { "Friction".to_owned() } else { words(stem) };
    Quantity { label, unit, factor }
}

/// Unit of numbers that would have four zeros behind the point, or six digits before it, with its factor from SI.
fn extreme(unit: &str, size: f64) -> Option<(&'static str, f64)> {
    let of = |[micro, nano, kilo]: [&'static str; 3]| match size {
        s if s > 0.0 && s < 1e-7 => Some((nano, 1e9)),
        s if s > 0.0 && s < 1e-4 => Some((micro, 1e6)),
        s if s >= 1e5 => Some((kilo, 1e-3)),
        _ => None,
    };
    match unit {
        "N" => of(["µN", "nN", "kN"]),
        "N/m" => of(["µN/m", "nN/m", "kN/m"]),
        "N·m" => of(["µN·m", "nN·m", "kN·m"]),
        "N·s/m" => of(["µN·s/m", "nN·s/m", "kN·s/m"]),
        "mm" if size > 0.0 && size < 1e-7 => Some(("nm", 1e9)),
        "mm" if size > 0.0 && size < 1e-5 => Some(("µm", 1e6)),
        "mm" if size >= 10.0 => Some(("m", 1.0)),
        _ => None,
    }
}

/// How the samples of a channel with an SI unit are shown.
pub fn channel_unit(unit: &str) -> (&str, f64) {
    let degrees = 180.0 / std::f64::consts::PI;
    match unit {
        "m" => ("mm", 1e3),
        "m/s" | "m_s" => ("mm/s", 1e3),
        "rad" => ("°", degrees),
        "rad/s" | "rad_s" => ("°/s", degrees),
        "m/s²" | "m_s2" => ("m/s²", 1.0),
        "Nm" => ("N·m", 1.0),
        "degC" => ("°C", 1.0),
        other => (other, 1.0),
    }
}

/// `center_x` → `Center x`; the usual names are spelt out.
fn words(stem: &str) -> String {
    match stem {
        "friction_mu" => return "Friction coefficient".to_owned(),
        "friction_lower_bound" => return "Friction, at least".to_owned(),
        "friction" => return "Friction at the slip".to_owned(),
        "coulomb" => return "Coulomb friction".to_owned(),
        "viscous" => return "Viscous friction".to_owned(),
        // What the give of the hand hides is in it: the object's own stiffness stands beside its constraint.
        "constraint_stiffness" => return "Radial stiffness with the pads".to_owned(),
        "center_x" => return "Centre x".to_owned(),
        "center_y" => return "Centre y".to_owned(),
        _ => {}
    }
    capitalised(&stem.replace('_', " "))
}

/// The first letter in upper case.
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// `block-1` → `Block 1`.
pub fn object(name: &str) -> String {
    capitalised(&name.replace('-', " "))
}

/// Value and error as text, rounded to two digits of the error; a true minus sign.
pub fn with_error(value: f64, error: Option<f64>) -> (String, Option<String>) {
    match error.filter(|e| e.is_finite() && *e > 0.0) {
        Some(error) => {
            let decimals = (1 - error.log10().floor() as i32).clamp(0, 9) as usize;
            (number(value, decimals), Some(number(error, decimals)))
        }
        None => (significant(value, 4), None),
    }
}

/// What is missing for a parameter, in words.
pub fn missing(enough: &Enough) -> String {
    if enough.share >= 1.0 {
        return "enough".to_owned();
    }
    let seconds = |s: f64| format!("{} s", number(s.max(1.0).ceil(), 0));
    match (&enough.missing, enough.more_seconds) {
        (Some(missing), _) => match missing.seconds {
            Some(s) if s >= 1.0 => format!("{}, about {}", missing.words, seconds(s)),
            _ => missing.words.clone(),
        },
        (None, Some(s)) => format!("go on for about {}", seconds(s)),
        (None, None) => "more data is needed; which motion is not known".to_owned(),
    }
}

/// With a fixed number of decimals and a true minus sign.
pub fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
    if zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "−") }
}

/// With a number of significant digits.
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { "–".to_owned() };
    }
    let decimals = (digits - 1 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
    number(value, decimals)
}

/// A duration as a stop-watch would show it.
pub fn clock(seconds: f64) -> String {
    let seconds = seconds.max(0.0);
    let minutes = (seconds / 60.0).floor();
    format!("{minutes:.0}:{:05.2}", seconds - 60.0 * minutes)
}

/// Microseconds or milliseconds.
pub fn short_time(seconds: f64) -> String {
    let (value, unit) = if seconds < 1e-3 { (seconds * 1e6, "µs") } else { (seconds * 1e3, "ms") };
    let decimals = if value < 10.0 { 2 } else { usize::from(value < 100.0) };
    format!("{} {unit}", number(value, decimals))
}

/// `12345` → `12 345`.
pub fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(c);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_decide_the_digits() {
        assert_eq!(with_error(15.8732, Some(0.0821)), ("15.873".to_owned(), Some("0.082".to_owned())));
        assert_eq!(with_error(-203.4, Some(12.3)), ("−203".to_owned(), Some("12".to_owned())));
        assert_eq!(with_error(0.352, None), ("0.3520".to_owned(), None));
        assert_eq!(number(-0.0001, 2), "0.00");
    }

    #[test]
    fn units_are_sensible() {
        let width = parameter("width_m", Some(0.0159));
        assert_eq!((width.label.as_str(), width.unit, width.factor), ("Width", "mm", 1e3));
        assert_eq!(parameter("mass_kg", Some(0.035)).unit, "g");
        assert_eq!(parameter("mass_kg", Some(95.1)).unit, "kg");
        assert_eq!(parameter("viscous_N_s_m", None).unit, "N·s/m");
        assert_eq!(
            (parameter("force_drift_x_N_s", None).unit, parameter("torque_drift_x_Nm_s", None).unit),
            ("N/s", "N·m/s")
        );
        let hardening = parameter("hardening_N_m3", Some(1.5e6));
        assert_eq!(
            (hardening.label.as_str(), hardening.unit, hardening.factor * 1.5e6),
            ("Hardening", "N/mm³", 0.0015)
        );
        assert_eq!(parameter("constraint_stiffness_N_m", None).label, "Radial stiffness with the pads");
        assert_eq!(parameter("friction_mu", Some(0.05)).unit, "");
        let resistance = parameter("friction_N", Some(0.1));
        assert_eq!((resistance.label.as_str(), resistance.unit), ("Friction", "N"));
        let unit = |name: &str, value: f64| parameter(name, Some(value)).unit;
        assert_eq!(
            (unit("stiffness_N_m", 3e-6), unit("surface_m", -2e-8), unit("friction_N", 3.5e5)),
            ("µN/m", "nm", "kN")
        );
        assert_eq!((parameter("leak_kg_s", None).unit, parameter("free_fall_m_s2", None).unit), ("g/s", "m/s²"));
        assert_eq!(
            (parameter("drag_per_mass_1_m", None).unit, parameter("viscous_per_mass_1_s", None).unit),
            ("1/m", "1/s")
        );
        assert_eq!(parameter("coulomb_per_inertia_rad_s2", None).unit, "rad/s²");
    }

    #[test]
    fn a_clock_reads_like_one() {
        assert_eq!(clock(75.5), "1:15.50");
        assert_eq!(short_time(2.5e-5), "25.0 µs");
    }
}
