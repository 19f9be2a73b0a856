//! Units of a law's parameters when a free motion gives them per unit of inertia.

/// A unit of the laws per kg, or per kg m² if it has a moment: `N s/m` becomes `1/s`. Other units stay.
pub fn per_inertia(unit: &str) -> String {
    let of_angle = unit.strip_prefix("N m").filter(|rest| rest.is_empty() || rest.starts_with([' ', '/']));
    let found = of_angle.map(|rest| ("rad", rest)).or_else(|| Some(("m", unit.strip_prefix('N')?)));
    let Some((length, rest)) = found else { return unit.to_owned() };
    // N = kg m/s², N m = kg m² rad/s².
    let (mut of_length, mut of_time) = (1.0, -2.0);
    let (above, below) = rest.split_once('/').unwrap_or((rest, ""));
    if let Some(power) = above.trim().strip_prefix('s').map(exponent) {
        of_time += power;
        // N m s is a moment per rad/s.
        of_length -= if length == "rad" { power } else { 0.0 };
    }
    if let Some(power) = below.strip_prefix(length).map(exponent) {
        of_length -= power;
    } else if let Some(power) = below.strip_prefix('s').map(exponent) {
        of_time -= power;
    }
    quotient(&[(length, of_length), ("s", of_time)])
}

/// The number that an exponent in words means.
fn exponent(words: &str) -> f64 {
    match words {
        "²" => 2.0,
        "³" => 3.0,
        _ => words.strip_prefix('^').and_then(|number| number.parse().ok()).unwrap_or(1.0),
    }
}

/// Powers of units as a quotient.
fn quotient(powers: &[(&str, f64)]) -> String {
    let written = |(unit, power): (&str, f64)| match power {
        1.0 => unit.to_owned(),
        2.0 => format!("{unit}²"),
        3.0 => format!("{unit}³"),
        _ => format!("{unit}^{power}"),
    };
    let of = |sign: f64| -> Vec<String> {
        powers
            .iter()
            .filter(|(_, power)| sign * power > 0.0)
            .map(|(unit, power)| written((unit, sign * power)))
            .collect()
    };
    let (above, below) = (of(1.0), of(-1.0));
    let above = if above.is_empty() { "1".to_owned() } else { above.join(" ") };
    match &below[..] {
        [] => above,
        [one] => format!("{above}/{one}"),
        several => format!("{above}/({})", several.join(" ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_forces_and_moments_lose_the_inertia() {
        for (unit, per) in [
            ("N m", "rad/s²"),
            ("N m s", "1/s"),
            ("N m s²", "1/rad"),
            ("N m s³", "s/rad²"),
            ("N m/rad", "1/s²"),
            ("N m/rad³", "1/(rad² s²)"),
            ("N", "m/s²"),
            ("N s/m", "1/s"),
            ("N s²/m²", "1/m"),
            ("N s³/m³", "s/m²"),
            ("N/m", "1/s²"),
            ("N/m³", "1/(m² s²)"),
            ("N/m^1.5", "1/(m^0.5 s²)"),
            ("N/s", "m/s³"),
            ("rad", "rad"),
            ("1", "1"),
        ] {
            assert_eq!(per_inertia(unit), per, "{unit}");
        }
    }
}
