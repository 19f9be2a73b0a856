//! Stribeck friction as a hypothesis: the speed at which static friction decays is searched, for two exponents.

use super::axis::Axis;
use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over, Relation};
use super::variable::Variable;
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::regression_data::{Place, Row, Track};
use haptics::law::{Effect, Stribeck};

pub(crate) const ID: &str = "stribeck";

/// Speeds of the decay of static friction, as shares of the usual speed.
/// Choice: halved or doubled, none of 68 answers changes.
pub(crate) const SPEEDS: Axis = Axis::geometric(0.06, 0.9, 12);
/// Exponents of that decay; 0 is the Gaussian.
/// Source: the Gaussian and the exponential form of the Stribeck curve (Armstrong-Hélouvry, Dupont & Canudas de Wit
/// 1994).
const FALLING: Axis = Axis::even(0.0, 1.0, 2);
/// Ratio of speeds at which a Gaussian is most like an exponential.
/// Choice: no case of the ablation reads it.
const LIKE_EXPONENTIAL: f64 = 1.5;
/// Number of rows, on either side, over which an acceleration is evaluated.
/// Derived: the shortest window of an acceleration, two rows on either side (`FINER`).
const RATE_ROWS: f64 = 2.0;
/// Share of the rows that count as slow.
/// Choice: no case of the ablation reads it.
const SLOW_ROWS_SHARE: f64 = 0.25;
/// Ratio by which a narrower peak is higher at equal area.
/// Choice: no case of the ablation reads it.
const HIGHER: f64 = 1.5;
/// Points: speed and exponent.
const DECAY: &str = "decay";

impl Hypothesis for Stribeck {
    fn about(&self) -> About {
        About {
            id: ID,
            form: Form::Curve(&[Over::Motion]),
            relations: &[Relation::OfDryFriction],
            seen: Variable::Velocity,
            ..About::PLAIN
        }
    }

    fn coarse(&self, ranges: &Ranges<'_>) -> Vec<Point> {
        let of = |alpha: f64| SPEEDS.values().map(move |share| Point::two(DECAY, share * ranges.fast, alpha));
        FALLING.values().flat_map(of).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let refined = |found: &Candidate| {
            let (vs, alpha) = (found.value("vs").unwrap_or(0.0), found.value("alpha").unwrap_or(0.0));
            // The other exponent is tried as finely: on the coarse grid the wrong one may fit better.
            let [gaussian, exponential] =
                if alpha == 1.0 { [vs * LIKE_EXPONENTIAL, vs] } else { [vs, vs / LIKE_EXPONENTIAL] };
            let of = |(vs, alpha)| SPEEDS.around(vs, 1.0, near.step).map(|vs| Point::two(DECAY, vs, alpha));
            [(gaussian, 0.0), (exponential, 1.0)].map(of).concat()
        };
        near.of(ID).flat_map(refined).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let of = |[vs, alpha, _]: [f64; 3]| {
            let falls = data.plain(&Stribeck, &[1.0, vs, alpha], 0).at("vs", vs, data.unit(&Stribeck, 1)).positive();
            // Without an exponent, the Gaussian form is meant.
            if alpha > 0.0 { falls.at("alpha", alpha, "1") } else { falls }
        };
        data.points(ID, DECAY).map(of).collect()
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        vec![Effect::new(&Stribeck, &[found.value(0), found.searched(0), found.searched(1)])]
    }

    /// Widens the standard errors of friction that falls off below the lowest resolved speed: of motion within one
    /// averaged row only the sum is known. Only the area of the peak is then known, so its size and its speed are
    /// uncertain by as much as they are.
    fn widen(&self, parameters: &mut [CauseParameter], track: &Track) {
        let from = told_from(track);
        let Some(speed) = parameters.iter().find(|p| p.name == "vs").map(|p| p.value).filter(|vs| *vs > 0.0) else {
            return;
        };
        let open = (0.5 * from * (from / speed).powi(2)).min(from);
        for p in parameters {
            match p.name.as_str() {
                "vs" => p.std_error = p.std_error.hypot(open),
                "dFs" => p.std_error = p.std_error.hypot(p.value * HIGHER * (open / speed).min(1.0)),
                _ => {}
            }
        }
    }
}

/// Speed that a slow motion reaches within the time over which its acceleration is evaluated, m/s or rad/s.
fn told_from(track: &Track) -> f64 {
    let slow = track.quantile(SLOW_ROWS_SHARE, |r| r.motion.velocity.abs());
    let is_slow = |r: &&Row| r.place == Place::Along && r.motion.velocity.abs() <= slow;
    let mut rates: Vec<f64> = track.rows.iter().filter(is_slow).map(|r| r.motion.acceleration.abs()).collect();
    rates.sort_by(f64::total_cmp);
    rates.get(rates.len() / 2).map_or(0.0, |median| median * RATE_ROWS * track.period_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stated(vs: f64) -> Vec<CauseParameter> {
        let one = |name: &str, value| CauseParameter {
            name: name.to_owned(),
            value,
            std_error: 0.01 * value,
            unit: String::new(),
        };
        vec![one("dFs", 1.0), one("vs", vs)]
    }

    #[test]
    fn a_peak_that_is_gone_through_within_a_row_is_open_and_a_wide_one_is_not() {
        let row = |i: u32| {
            let mut row = Row::default();
            row.motion.velocity = 0.01 * f64::from(i) - 0.5;
            row.motion.acceleration = 1.0;
            row
        };
        let track = Track::of_rows((0..100).map(row).collect());
        for (vs, least, most) in [(0.2, 0.009, 0.03), (0.01, 0.8, 2.0)] {
            let mut parameters = stated(vs);
            Stribeck.widen(&mut parameters, &track);
            assert!((least..most).contains(&parameters[0].std_error), "{vs}: {parameters:?}");
        }
    }
}
