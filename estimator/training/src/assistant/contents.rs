//! Possible contents of a vessel, by their density.
//!
//! Each kind of content has a range of densities, evenly likely on a logarithmic scale, and all kinds are as likely as
//! each other before anything is weighed. A density with a normal error makes some of them more likely (Bayes); a
//! density of no kind stays unnamed.

use super::known::Known;
use serde::Serialize;
use statrs::distribution::{Continuous, Normal};

/// A kind of content and its usual densities, kg/m³.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind {
    /// In words.
    pub name: &'static str,
    /// From and to, kg/m³.
    pub density_kg_m3: [f64; 2],
}

/// Usual contents of vessels (bulk densities of loose ones).
pub const KINDS: [Kind; 6] = [
    Kind { name: "nothing or a gas", density_kg_m3: [0.5, 25.0] },
    Kind { name: "foam, chips or rags", density_kg_m3: [25.0, 450.0] },
    Kind { name: "fuel or oil", density_kg_m3: [700.0, 930.0] },
    Kind { name: "water or something like it", density_kg_m3: [960.0, 1080.0] },
    Kind { name: "acid, brine, sand or soil", density_kg_m3: [1100.0, 2000.0] },
    Kind { name: "metal or slurry", density_kg_m3: [2100.0, 12_000.0] },
];
/// Steps over a range.
const STEPS: usize = 64;
/// The density of something that is not in the list: anything between a gas and a heavy metal.
const ANYTHING: [f64; 2] = [0.5, 12_000.0];
/// Prior likelihood of that relative to one kind of the list.
const UNLISTED: f64 = 0.1;

/// Kinds that may be in it, the likeliest first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Guess {
    /// Density of the content, kg/m³.
    pub density: Known,
    /// Names with their probabilities, above one in ten.
    pub kinds: Vec<(&'static str, f64)>,
}

/// Possible contents of this density. An error of zero is taken for a thousandth of the value.
pub fn guess(density: Known) -> Guess {
    /// Less likely kinds are not named.
    const NAMED: f64 = 0.1;
    let likelihoods: Vec<f64> = KINDS.iter().map(|kind| likelihood(density, kind.density_kg_m3)).collect();
    let total = likelihoods.iter().sum::<f64>() + UNLISTED * likelihood(density, ANYTHING);
    let mut kinds: Vec<(&'static str, f64)> = KINDS
        .iter()
        .zip(likelihoods)
        .map(|(kind, l)| (kind.name, if total > 0.0 { l / total } else { 0.0 }))
        .filter(|(_, p)| *p > NAMED)
        .collect();
    kinds.sort_by(|a, b| b.1.total_cmp(&a.1));
    Guess { density, kinds }
}

/// Probability density of the measurement if the truth lies evenly (in its logarithm) within a range.
fn likelihood(density: Known, [low, high]: [f64; 2]) -> f64 {
    let least = 1e-3 * density.value.abs().max(1.0);
    let Ok(error) = Normal::new(density.value, density.std_error.max(least)) else { return 0.0 };
    let step = (high / low).ln() / STEPS as f64;
    (0..STEPS).map(|k| error.pdf(low * ((k as f64 + 0.5) * step).exp())).sum::<f64>() / STEPS as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn a_density_names_its_kind_and_a_coarse_one_names_several() {
        let water = guess(Known { value: 1000.0, std_error: 15.0 });
        assert_eq!(water.kinds[0].0, "water or something like it");
        assert!(water.kinds[0].1 > 0.9, "{water:?}");
        let coarse = guess(Known { value: 950.0, std_error: 150.0 });
        assert!(coarse.kinds.len() >= 2 && coarse.kinds[0].1 < 0.9, "{coarse:?}");
        let empty = guess(Known { value: -5.0, std_error: 30.0 });
        assert_eq!(empty.kinds[0].0, "nothing or a gas");
    }

    #[test]
    fn probabilities_are_as_often_right_as_they_say() {
        // Contents drawn by hand from tables of materials, weighed with errors of 2 to 20 %.
        const MATERIALS: [(f64, usize); 12] = [
            (1.2, 0),
            (6.0, 0),
            (60.0, 1),
            (240.0, 1),
            (745.0, 2),
            (870.0, 2),
            (998.0, 3),
            (1030.0, 3),
            (1600.0, 4),
            (1260.0, 4),
            (2800.0, 5),
            (7800.0, 5),
        ];
        let mut rng = StdRng::seed_from_u64(11);
        let (mut said, mut right) = (0.0, 0.0);
        for _ in 0..4000 {
            let (truth, kind) = MATERIALS[rng.random_range(0..MATERIALS.len())];
            let error: f64 = rng.random_range(0.02..0.2) * truth + 5.0;
            let normal: f64 = (0..12).map(|_| rng.random_range(0.0..1.0)).sum::<f64>() - 6.0;
            let found = guess(Known { value: truth + error * normal, std_error: error });
            let Some((name, p)) = found.kinds.first() else { continue };
            said += p;
            right += f64::from(u8::from(*name == KINDS[kind].name));
        }
        assert!((said - right).abs() / 4000.0 < 0.06, "said {said:.0}, right {right:.0} of 4000");
    }
}
