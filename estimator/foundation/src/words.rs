//! Quantities as people write them.

/// Three significant digits with the prefix that keeps the number readable: `13.4 mN`, `0.12 mm`.
///
/// `unit`: an SI unit that takes a prefix in front (`N`, `m`, `N m`, `m/s`); any other text, or none, is put behind the plain number.
pub fn amount(value: f64, unit: &str) -> String {
    let prefixes: &[(f64, &str)] = &[(1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n")];
    let takes_prefix = unit.starts_with(['N', 'm', 'V', 's']);
    // 0.1 and more stays in the unit itself.
    let (scale, prefix) = prefixes
        .iter()
        .copied()
        .find(|(scale, _)| !takes_prefix || value == 0.0 || !value.is_finite() || value.abs() >= 0.1 * scale)
        .unwrap_or((1e-9, "n"));
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
        assert_eq!(amount(2.0e-6, "rad"), "0.00000200 rad");
        assert_eq!(amount(0.0, "N"), "0 N");
        assert_eq!(amount(f64::NAN, "N"), "NaN N");
        assert_eq!(amount(0.25, ""), "0.250");
    }
}
