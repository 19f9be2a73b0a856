//! Slow measured channels that a force may follow: causes without a law.

use super::candidate::Candidate;
use crate::diagnose::data::regression_data::{Place, Track};
use haptics::law::Coordinate;

/// A candidate for each channel beside motion and force: the force in proportion to its deviation from its mean.
pub fn covariates(track: &Track) -> Vec<Candidate> {
    let force = if track.coordinate == Coordinate::Angular { "N m" } else { "N" };
    let one = |(name, unit, values): (String, String, Vec<f64>)| {
        let rows = track.rows.iter().zip(values);
        let column = rows.map(|(row, value)| if row.place == Place::Along { value } else { 0.0 }).collect();
        Candidate::term(name.clone(), force, vec![column]).with((name, unit))
    };
    track.extras().into_iter().map(one).collect()
}
