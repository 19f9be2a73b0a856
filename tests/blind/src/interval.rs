//! Shares with exact intervals (Clopper & Pearson 1934).

use std::fmt;

/// So many of so many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Share {
    /// How many.
    pub hits: usize,
    /// Of how many.
    pub of: usize,
}

impl Share {
    /// Counts those for which `hit` is true.
    pub fn count<T>(of: impl IntoIterator<Item = T>, hit: impl Fn(T) -> bool) -> Self {
        of.into_iter()
            .fold(Self::default(), |share, x| Self { hits: share.hits + usize::from(hit(x)), of: share.of + 1 })
    }

    /// The share itself; not a number without cases.
    pub fn value(self) -> f64 {
        self.hits as f64 / self.of as f64
    }

    /// The interval that holds the true share with the probability `confidence`, whatever it is.
    pub fn interval(self, confidence: f64) -> [f64; 2] {
        let tail = 0.5 * (1.0 - confidence);
        [self.at_least(tail), self.at_most(tail)]
    }

    /// Lower bound: true shares below it give so many hits with a probability below `tail`.
    pub fn at_least(self, tail: f64) -> f64 {
        if self.hits == 0 { 0.0 } else { bisect(|p| tail_above(self.hits, self.of, p) < tail) }
    }

    /// Upper bound: true shares above it give so few hits with a probability below `tail`.
    pub fn at_most(self, tail: f64) -> f64 {
        if self.hits == self.of { 1.0 } else { bisect(|p| 1.0 - tail_above(self.hits + 1, self.of, p) > tail) }
    }
}

impl fmt::Display for Share {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.of == 0 {
            return write!(out, "{:>22}", "no cases");
        }
        let [low, high] = self.interval(0.95);
        write!(out, "{:.3} [{low:.3}, {high:.3}] {}/{}", self.value(), self.hits, self.of)
    }
}

/// The place in 0..1 up to which `below` holds.
fn bisect(below: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if below(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Probability of at least `least` hits of `of` at a true share `p`.
fn tail_above(least: usize, of: usize, p: f64) -> f64 {
    if p <= 0.0 {
        return f64::from(u8::from(least == 0));
    }
    if p >= 1.0 {
        return f64::from(u8::from(least <= of));
    }
    let odds = p.ln() - (1.0 - p).ln();
    let mut log_term = of as f64 * (1.0 - p).ln();
    let mut sum = if least == 0 { log_term.exp() } else { 0.0 };
    for k in 1..=of {
        log_term += ((of - k + 1) as f64 / k as f64).ln() + odds;
        if k >= least {
            sum += log_term.exp();
        }
    }
    sum.min(1.0)
}

/// The value below which the share `part` of the values lies.
pub fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    if sorted.is_empty() {
        return f64::NAN;
    }
    let place = part * (sorted.len() - 1) as f64;
    let (low, high) = (place.floor() as usize, place.ceil() as usize);
    sorted[low] + (sorted[high] - sorted[low]) * place.fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_the_tables() {
        // Published exact 95 % intervals: 0 of 400, 5 of 20, 20 of 20.
        let [low, high] = Share { hits: 0, of: 400 }.interval(0.95);
        assert!(low == 0.0 && (high - 0.00918).abs() < 1e-5, "{high}");
        let [low, high] = Share { hits: 5, of: 20 }.interval(0.95);
        assert!((low - 0.08657).abs() < 1e-5 && (high - 0.49105).abs() < 1e-5, "{low} {high}");
        let [low, high] = Share { hits: 20, of: 20 }.interval(0.95);
        assert!((low - 0.83157).abs() < 1e-5 && high == 1.0, "{low}");
    }

    #[test]
    fn quantiles_leave_out_what_is_no_number() {
        assert_eq!(quantile(&[3.0, 1.0, f64::NAN, 2.0], 0.5), 2.0);
        assert!(quantile(&[], 0.5).is_nan());
    }
}
