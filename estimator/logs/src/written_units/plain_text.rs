//! One spelling of each sign in the text of a unit, and numbers beside a unit.

use unicode_normalization::UnicodeNormalization as _;

/// Raised digits and signs, in the order of `0` to `9`, `-`, `+`.
const RAISED: [char; 12] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹', '⁻', '⁺'];
const LEVEL: [char; 12] = ['0', '1', '2', '3', '4', '5', '6', '7', '8', '9', '-', '+'];

/// Brackets and blanks taken off, one spelling for each sign, and powers behind `^`.
pub(super) fn tidied(text: &str) -> String {
    let inner = text.trim().trim_matches(['[', ']', '(', ')', '{', '}', '<', '>']).trim();
    let inner = inner.strip_prefix("in ").unwrap_or(inner).trim();
    let mut leveled = String::new();
    for c in inner.chars() {
        let Some(at) = RAISED.iter().position(|raised| *raised == c) else {
            leveled.push(c);
            continue;
        };
        let follows = leveled.contains('^') && leveled.ends_with(|last: char| last == '^' || LEVEL.contains(&last));
        leveled.push_str(if follows { "" } else { "^" });
        leveled.push(LEVEL[at]);
    }
    // Compatible forms of Unicode: `㎜` and `ｍｍ` are `mm`. The degree sign is none of them.
    let signs = [("°C", "degc"), ("℃", "degc"), ("°", "deg"), ("º", "deg")];
    let leveled: String = signs.into_iter().fold(leveled, |text, (from, to)| text.replace(from, to)).nfkc().collect();
    let signs = [
        ("-force", "force"),
        (" force", "force"),
        ("μ", "u"),
        ("\u{2212}", "-"),
        ("\u{2215}", "/"),
        ("\u{2044}", "/"),
        ("·", "."),
        ("⋅", "."),
        (" per ", "/"),
    ];
    signs.into_iter().fold(leveled, |text, (from, to)| text.replace(from, to))
}

/// The number that a unit is multiplied by, and the unit alone: `0.1 N`, `10^-3 m`, `x1000 N`, `1/10 mm`, `m*1e-3`. A number
/// above one behind a unit makes none of it: `N x10` may count tens of newtons, or state newtons that were multiplied.
pub(super) fn times(text: &str) -> (f64, String) {
    let unit = |text: &str| text.replace('^', "").replace(['*', '×'], ".");
    let leading = text.trim_start_matches(is_times).trim_start();
    let end = leading.find(|c: char| c.is_alphabetic() && !matches!(c, 'e' | 'E')).unwrap_or(leading.len());
    if let Some(number) = number(leading[..end].trim_end_matches([' ', '*', '.', '×'])).filter(|_| end < leading.len())
    {
        return (number, unit(&leading[end..]));
    }
    if let Some((before, behind)) = text.rsplit_once(is_times)
        && let Some(number) = number(behind.trim()).filter(|number| *number <= 1.0)
    {
        return (number, unit(before.trim_end()));
    }
    (1.0, unit(text))
}

fn is_times(c: char) -> bool {
    matches!(c, '*' | '×' | 'x' | 'X')
}

/// True for a factor alone: `x10`.
pub(super) fn is_factor(text: &str) -> bool {
    text.trim().strip_prefix(is_times).is_some_and(|behind| number(behind.trim()).is_some())
}

/// A number, a power of ten, or a part: `1000`, `1e-3`, `10^-3`, `1/10`.
fn number(text: &str) -> Option<f64> {
    let is_factor = |value: &f64| value.is_finite() && *value > 0.0;
    let plain = |text: &str| text.parse().ok().filter(is_factor);
    if let Some(power) = text.strip_prefix("10^") {
        return Some(10_f64.powi(power.parse().ok()?)).filter(is_factor);
    }
    match text.split_once('/') {
        Some((above, below)) => Some(plain(above)? / plain(below)?),
        None => plain(text),
    }
}
