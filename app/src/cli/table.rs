//! Numbers for people: values with their error to two significant digits, in the unit one would say.

use estimator::estimate::Parameter;

/// Factor and unit in which a parameter is shown, from its name's unit.
pub fn display_unit(name: &str) -> (f64, &'static str) {
    const UNITS: [(&str, f64, &str); 13] = [
        ("_N_s_m", 1.0, "N s/m"),
        ("_Nm_s", 1.0, "N m s"),
        ("_N_m", 1.0, "N/m"),
        ("_Nm", 1.0, "N m"),
        ("_kg_m2", 1.0, "kg m²"),
        ("_kg", 1.0, "kg"),
        ("_N", 1.0, "N"),
        ("_m", 1e3, "mm"),
        ("_rad", 180.0 / std::f64::consts::PI, "°"),
        ("_s", 1.0, "s"),
        ("_mu", 1.0, ""),
        ("_bound", 1.0, ""),
        ("friction", 1.0, ""),
    ];
    UNITS.iter().find(|(ending, ..)| name.ends_with(ending)).map_or((1.0, ""), |(_, factor, unit)| (*factor, unit))
}

/// `value ± error` with the error to two significant digits and the value to the same place.
pub fn with_error(value: f64, error: f64) -> String {
    if !error.is_finite() || error <= 0.0 {
        return significant(value, 5);
    }
    let place = 1 - error.abs().log10().floor() as i32;
    if !(-3..=7).contains(&place) || value.abs() >= 1e6 {
        return format!("{value:.3e} ± {error:.1e}");
    }
    let digits = place.max(0) as usize;
    format!("{value:.digits$} ± {error:.digits$}")
}

/// A number to so many significant digits.
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let place = digits - 1 - value.abs().log10().floor() as i32;
    if (0..=9).contains(&place) {
        format!("{value:.*}", place as usize)
    } else if place < 0 {
        format!("{value:.0}")
    } else {
        format!("{value:.*e}", (digits - 1) as usize)
    }
}

/// One line of a parameter table.
pub fn parameter_line(parameter: &Parameter) -> String {
    let (factor, unit) = display_unit(&parameter.name);
    let what = format!("{} {}", parameter.object, plain_name(&parameter.name));
    match (parameter.value, parameter.std_error) {
        (Some(value), error) => {
            let number = with_error(value * factor, error.unwrap_or(0.0) * factor);
            format!("  {what:<32} {number:>24} {unit}")
        }
        (None, _) => format!("  {what:<32} {:>24} ({})", "not identified", parameter.how),
    }
}

/// A parameter's name without its unit, in words.
pub fn plain_name(name: &str) -> String {
    let endings = ["_N_s_m", "_Nm_s", "_N_m", "_Nm", "_kg_m2", "_kg", "_N", "_m", "_rad", "_s"];
    let bare = endings.iter().find_map(|ending| name.strip_suffix(ending)).unwrap_or(name);
    match bare {
        "friction_mu" => "load friction µ".to_owned(),
        "coulomb" => "Coulomb friction".to_owned(),
        "viscous" => "viscous friction".to_owned(),
        other => other.replace('_', " "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_set_the_digits() {
        assert_eq!(with_error(0.352_31, 0.0241), "0.352 ± 0.024");
        assert_eq!(with_error(95.108, 0.42), "95.11 ± 0.42");
        assert_eq!(with_error(12_345.6, 230.0), "12346 ± 230");
        assert_eq!(with_error(0.5, 0.0), "0.50000");
    }

    #[test]
    fn units_by_name() {
        assert_eq!(display_unit("width_m"), (1e3, "mm"));
        assert_eq!(display_unit("viscous_N_s_m").1, "N s/m");
        assert_eq!(display_unit("constraint_stiffness_N_m").1, "N/m");
        assert_eq!(display_unit("inertia_kg_m2").1, "kg m²");
        assert_eq!(plain_name("friction_lower_bound"), "friction lower bound");
        assert_eq!(plain_name("center_x_m"), "center x");
    }
}
