//! Quantities as people write them.

/// Names and lengths, s, of the units that a clock may count in place of seconds.
pub const CLOCK_UNITS: [(&str, f64); 3] = [("milliseconds", 1e-3), ("microseconds", 1e-6), ("nanoseconds", 1e-9)];

/// Prefix, with its factor, that keeps a number of this size readable: `(1e-3, "m")` for 13 mN.
///
/// Only SI units that take a prefix in front have one (`N`, `m`, `N m`, `m/s`); lengths and speeds have none above 1.
pub fn prefix(size: f64, unit: &str) -> (f64, &'static str) {
    const ABOVE: [(f64, &str); 2] = [(1e6, "M"), (1e3, "k")];
    const BELOW: [(f64, &str); 5] = [(1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p")];
    let size = size.abs();
    if !unit.starts_with(['N', 'm', 'V', 's']) || size == 0.0 || !size.is_finite() {
        return (1.0, "");
    }
    // Four digits and a tenth stay in the unit itself.
    let above = ABOVE.into_iter().find(|(scale, _)| unit.starts_with('N') && size >= 10.0 * scale);
    let below = || BELOW.into_iter().find(|(scale, _)| size >= 0.1 * scale);
    above.or_else(below).unwrap_or((1e-12, "p"))
}

/// Three significant digits with the prefix that keeps the number readable: `13.4 mN`, `0.12 mm`. Behind a unit without
/// prefixes, or none, the number stands as it is.
pub fn amount(value: f64, unit: &str) -> String {
    let (scale, prefix) = prefix(value, unit);
    let shown = value / scale;
    let digits = if shown == 0.0 || !shown.is_finite() { 0.0 } else { 2.0 - shown.abs().log10().floor() };
    let decimals = digits.clamp(0.0, 9.0) as usize;
    let number = format!("{shown:.decimals$}").replace('-', "−");
    format!("{number} {prefix}{unit}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::amount;

    #[test]
    fn amounts_read_like_a_persons() {
        assert_eq!(amount(0.0134, "N"), "13.4 mN");
        assert_eq!(amount(-1.234e-4, "m"), "−0.123 mm");
        assert_eq!(amount(12.34, "N m"), "12.3 N m");
        assert_eq!(amount(1234.0, "m/s"), "1234 m/s");
        assert_eq!(amount(35_200.0, "N"), "35.2 kN");
        assert_eq!(amount(6.2e-12, "N m"), "6.20 pN m");
        assert_eq!(amount(2.0e-6, "rad"), "0.00000200 rad");
        assert_eq!(amount(0.0, "N"), "0 N");
        assert_eq!(amount(f64::NAN, "N"), "NaN N");
        assert_eq!(amount(0.25, ""), "0.250");
    }
}
