//! Margin of a held object against slipping.
//!
//! The friction of a thing is unknown before it slips. Two things are known. It has held so far, so the friction is
//! above the largest ratio of shear to grip that held ([`estimation::online`]). And fingertips of foam or rubber have a
//! friction against wood, metal, paper or plastic that nineteen times of twenty lies between 0.4 and 1.6 (a log-normal
//! distribution about 0.8). The second, cut off below the first, is the belief about the friction. It leads to the free
//! share now, its limits, and the probability that a jolt would make it slip.

use super::known::Known;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, LogNormal};

/// Median of the friction of pads before anything is known, and its spread: ln 2 over 1.96.
const MEDIAN: f64 = 0.8;
const SPREAD: f64 = 0.3536;
/// Factor of a jolt on the present shear.
const JOLT: f64 = 1.25;

/// Free part of the friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Slip {
    /// Share of the friction that is free now, as likely too high as too low.
    pub free: f64,
    /// Lower limit of the free share for nineteen of twenty frictions.
    pub least: f64,
    /// Upper limit of the free share for nineteen of twenty frictions.
    pub most: f64,
    /// Probability that a quarter more shear would make it slip.
    pub by_a_jolt: f64,
}

/// From the ratio of shear to grip now and the largest that surely held (with its error). `None` where these are no ratios.
pub fn slip(ratio: f64, held: Known) -> Option<Slip> {
    let belief = LogNormal::new(MEDIAN.ln(), SPREAD).ok()?;
    // A grip that holds now holds; a bound is good to its error.
    let bound = (held.value - held.std_error).max(0.0);
    if !(ratio >= 0.0 && ratio.is_finite() && bound.is_finite()) {
        return None;
    }
    let below = belief.cdf(bound);
    // Above almost all frictions of pads the belief says nothing: the free part is then the one above the bound, and it
    // is unknown.
    if below > 0.9999 {
        return Some(Slip { free: 0.0, least: 0.0, most: 1.0, by_a_jolt: 1.0 });
    }
    let quantile = |p: f64| belief.inverse_cdf(below + p * (1.0 - below));
    let free = |friction: f64| (1.0 - ratio / friction.max(1e-9)).clamp(0.0, 1.0);
    let by_a_jolt = ((belief.cdf(JOLT * ratio) - below) / (1.0 - below)).clamp(0.0, 1.0);
    Some(Slip { free: free(quantile(0.5)), least: free(quantile(0.025)), most: free(quantile(0.975)), by_a_jolt })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SURE: f64 = 0.01;

    #[test]
    fn a_firmer_grip_frees_more_and_a_jolt_becomes_harmless() {
        let loose = slip(0.7, Known { value: 0.7, std_error: SURE }).expect("ratios");
        let firm = slip(0.35, Known { value: 0.7, std_error: SURE }).expect("ratios");
        assert!(firm.free > loose.free + 0.2 && firm.by_a_jolt < 0.01 && loose.by_a_jolt > 0.2, "{loose:?} {firm:?}");
        assert!(loose.least < 0.05 && loose.least <= loose.free && loose.free <= loose.most);
    }

    #[test]
    fn what_has_held_is_never_said_to_slip() {
        for ratio in [0.1, 0.5, 1.0, 2.0, 6.0] {
            let now = slip(0.8 * ratio, Known { value: ratio, std_error: 0.0 }).expect("ratios");
            assert!((0.0..=1.0).contains(&now.free) && now.least <= now.most, "{ratio}: {now:?}");
            assert!(
                ratio > 3.0 || now.by_a_jolt < 1e-9,
                "{ratio}: a quarter more than 0.8 of it is what held: {now:?}"
            );
        }
        assert_eq!(slip(f64::NAN, Known { value: 0.5, std_error: 0.1 }), None);
    }

    #[test]
    fn limits_hold_the_frictions_of_tables() {
        // Foam, silicone and rubber on wood, paper, steel, glass and plastic.
        const TABLES: [f64; 14] = [0.45, 0.5, 0.55, 0.6, 0.62, 0.7, 0.75, 0.8, 0.85, 0.95, 1.0, 1.1, 1.2, 1.5];
        let mut within = 0;
        for friction in TABLES {
            let ratio = 0.6 * friction;
            let now = slip(ratio, Known { value: ratio, std_error: SURE }).expect("ratios");
            within += usize::from((now.least..=now.most).contains(&0.4));
        }
        assert!(within + 1 >= TABLES.len(), "{within} of {}", TABLES.len());
    }
}
