//! Lines of a parameter table in a terminal: the same names, units and digits as in the window.

use crate::text::format;
use estimator::estimate::Parameter;

/// `value ± error`, the error to two significant digits.
pub fn with_error(value: f64, error: f64) -> String {
    match format::with_error(value, Some(error)) {
        (value, Some(error)) => format!("{value} ± {error}"),
        (value, None) => value,
    }
}

/// One line of a parameter table.
pub fn parameter_line(parameter: &Parameter) -> String {
    let quantity = format::parameter(&parameter.name, parameter.value);
    let what = format!("{}  {}", format::object(&parameter.object), quantity.label);
    match (parameter.value, parameter.std_error) {
        (Some(value), error) => {
            let number = with_error(value * quantity.factor, error.unwrap_or(0.0) * quantity.factor);
            format!("  {what:<34} {number:>24} {}", quantity.unit)
        }
        (None, _) => format!("  {what:<34} {:>24} ({})", "not identified", parameter.how),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_value_error_and_unit() {
        let line = parameter_line(&Parameter::identified("block-1", "width_m", 0.015_873_2, 82.1e-6, 10, ""));
        assert!(line.contains("Block 1") && line.contains("15.873 ± 0.082 mm"), "{line}");
    }

    #[test]
    fn what_is_not_shown_gives_its_reason() {
        let line = parameter_line(&Parameter::unidentified("crank", "coulomb_N", 0, "no reversal"));
        assert!(line.contains("not identified (no reversal)"), "{line}");
    }
}
