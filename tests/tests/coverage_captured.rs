//! Stated errors of needles, switches and mechanisms are true: see `tests::coverage`.

use rayon::prelude::*;
use tests::captured::{needle_scores, switch_scores};
use tests::coverage::{Scores, demand, over, seeds};
use tests::mechanisms::mechanism_scores;
use tests::reaching::slide_scores;

/// Much of these errors is what is assumed of pads, levers and holes: intervals may hold more than they promise, not less.
fn cautious(_: &str) -> f64 {
    1.0
}

#[test]
fn needles_are_covered() {
    let least = |name: &str| if name == "hardening_N_m3" { 0.4 } else { 0.95 };
    demand(&over(seeds(5_000, 40), needle_scores), &least, &cautious);
}

#[test]
fn switches_are_covered() {
    // A stop that was not pressed has no place.
    demand(&over(seeds(5_000, 40), switch_scores), &|_| 0.9, &cautious);
}

/// A hand that trembles stops for moments that no filter shows: what they leave behind must not pass for mass.
#[test]
fn short_stops_do_not_pass_for_mass() {
    let scores: Vec<Scores> = seeds(6_000, 150).into_par_iter().map(slide_scores).collect();
    let mass = ("mechanism".to_owned(), "mass_kg".to_owned());
    let z: Vec<f64> = scores.iter().filter_map(|s| s.get(&mass)).map(|s| s.0).collect();
    let n = z.len() as f64;
    let (mean, held) = (z.iter().sum::<f64>() / n, z.iter().filter(|z| z.abs() <= 1.96).count() as f64 / n);
    println!("masses of {n} slides: {mean:+.2} standard errors too large on the average, {held:.3} held");
    let slack = 0.05 + 3.0 / n.sqrt();
    assert!(n > 40.0 && mean.abs() < slack, "{mean} of {n}: {z:?}");
    assert!(held > 0.92 - 3.0 * (0.92 * 0.08 / n).sqrt(), "{held} of {n}");
}

#[test]
fn mechanisms_are_covered() {
    // Slides and axes have parameters of their own, about half of the recordings each; half of the axes hang.
    demand(&over(seeds(5_000, 40), mechanism_scores), &|_| 0.2, &|_| 0.0);
}
