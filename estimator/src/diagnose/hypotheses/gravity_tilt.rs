//! A tilt as a hypothesis: of a crank's plane, of an axis, or of a slope under a linear motion.

use super::axis::Axis;
use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::Relation;
use crate::diagnose::data::known_weight::{column, level, of};
use crate::diagnose::data::regression_data::{Place, Row, Track};
use estimation::regression::linear::least_squares;
use haptics::law::{Coordinate, Effect, GravityTilt, Kind};

pub(crate) const ID: &str = "gravity-tilt";

/// Tried tilts, rad: a larger one would be noticed.
/// Choice: no case of the ablation reads it.
const TILTS: Axis = Axis::even(-1.4, 1.4, 25);
/// Tried tilts of a plane that was assumed to be level, as their sines.
/// Choice: no case of the ablation reads it.
const SINES: Axis = Axis::even(0.0, 0.6, 31);

impl Hypothesis for GravityTilt {
    fn about(&self) -> About {
        About { id: ID, relations: &[Relation::NeedsBothWays], ..About::PLAIN }
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let turns = data.track.radius_m.and_then(|_| tilt(data.track));
        turns.into_iter().chain(slope(data.track)).collect()
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        let track = found.track;
        if track.planar && found.weight_n > 0.0 {
            return vec![Effect::new(&GravityTilt, &[found.weight_n, found.value(0), found.radius_m()])];
        }
        let of_slope = track.freely.map(|free| {
            let sine = found.value(0).clamp(-1.0, 1.0);
            Effect::new(&GravityTilt, &[free.inertia * free.gravity_m_s2, sine.asin(), 0.0])
        });
        of_slope.into_iter().collect()
    }
}

/// Slope under a linear motion, as the sine of its angle. `None` if the object rotates or is driven.
fn slope(track: &Track) -> Option<Candidate> {
    let free = track.freely.filter(|_| track.coordinate == Coordinate::Linear)?;
    let pull = free.inertia * free.gravity_m_s2;
    Some(Candidate::one(ID, Kind::Plant, "angle", "rad", vec![pull; track.rows.len()]))
}

/// The tilt of the plane as a cause, if a hung weight separates it from an eccentric mass.
fn tilt(track: &Track) -> Option<Candidate> {
    let known = column(track)?;
    if track.planar { tilted_crank(track, &known) } else { tilted_axis(track, &known) }
}

/// Regressors of a plain fit, their rows, and the residual force beside the hung weight.
struct Plain {
    columns: Vec<Vec<f64>>,
    y: Vec<f64>,
    used: Vec<f64>,
}

impl Plain {
    fn of(track: &Track, known: &[f64]) -> Self {
        let column = |of: &dyn Fn(&Row) -> f64| track.rows.iter().map(of).collect::<Vec<f64>>();
        let load = |r: &Row| if track.planar { r.motion.normal_force_n.abs() } else { 1.0 };
        let mut columns = vec![column(&|r| r.motion.velocity), column(&|r| load(r) * r.motion.direction)];
        if !track.planar {
            columns.push(column(&|r| r.motion.acceleration));
        }
        Self {
            columns,
            y: track.rows.iter().zip(known).map(|(r, k)| r.target - k).collect(),
            // An uncertain direction makes the friction uncertain, too.
            used: column(&|r| if r.place == Place::Along { r.motion.direction.powi(4) } else { 0.0 }),
        }
    }

    /// Residual RMS with additional regressors, after subtraction of `taken`, and the coefficients of the additional
    /// ones.
    fn left(&self, more: Vec<Vec<f64>>, taken: &[f64]) -> Option<(f64, Vec<f64>)> {
        let first = self.columns.len();
        let columns: Vec<Vec<f64>> = self.columns.iter().cloned().chain(more).collect();
        let y: Vec<f64> = self.y.iter().zip(taken).map(|(y, t)| y - t).collect();
        let fit = least_squares(&columns, &y, Some(&self.used)).ok()?;
        Some((fit.rms, fit.values[first..].to_vec()))
    }
}

/// Crank: the tilt rotates all weights, the object's own and the hung one.
fn tilted_crank(track: &Track, known: &[f64]) -> Option<Candidate> {
    let plain = Plain::of(track, known);
    let turned = |tilt: f64| -> Vec<f64> {
        let along = |r: &Row| {
            // Up may be recorded as down.
            let up = (r.motion.up_along * r.along.y).signum();
            if r.place == Place::Along { up * (r.angle_rad - tilt).cos() } else { 0.0 }
        };
        track.rows.iter().map(along).collect()
    };
    let upright = turned(0.0);
    let hung_on = |tilted: &[f64]| -> Vec<f64> {
        let force = track.rows.iter().map(|r| of(track, r).map_or(0.0, |h| h.force));
        force.zip(tilted.iter().zip(&upright)).map(|(w, (t, u))| w * (t - u)).collect()
    };
    // Tilts around one, closer by a factor: the one with the smallest residual, and its weight.
    let best = |around: f64, closer: f64| {
        let tried = TILTS.values().filter_map(|value| {
            // The tilt is never exactly zero, because the regressor is the effect per radian.
            let tilt = around + closer * (value + 0.05 * TILTS.spacing());
            let tilted = turned(tilt);
            let (left, values) = plain.left(vec![tilted.clone()], &hung_on(&tilted))?;
            (values[0] > 0.0).then_some((left, tilt, values[0]))
        });
        tried.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let rough = best(0.0, 1.0)?;
    let (_, tilt, weight) = best(rough.1, 0.1)?;
    let tilted = turned(tilt);
    // The model's own weight already contains the vertical part of the object's.
    let own = tilted.iter().zip(&upright).map(|(t, u)| weight * (t - tilt.cos() * u));
    let column = own.zip(hung_on(&tilted)).map(|(own, hung)| (own + hung) / tilt).collect();
    let found = Candidate::one(ID, Kind::Plant, "angle", "rad", column);
    Some(found)
}

/// A mechanism whose axis was assumed to be vertical: the hung weight acts with the sine of the tilt only.
fn tilted_axis(track: &Track, known: &[f64]) -> Option<Candidate> {
    let plain = Plain::of(track, known);
    let column = |of: &dyn Fn(&Row) -> f64| track.rows.iter().map(of).collect::<Vec<f64>>();
    let waves = vec![column(&|r| r.motion.position.cos()), column(&|r| r.motion.position.sin())];
    let missing = |sine: f64| column(&|r| of(track, r).map_or(0.0, |h| (sine - 1.0) * h.force * level(track, r, h)));
    let tried = SINES.values().filter_map(|sine| {
        let (left, values) = plain.left(waves.clone(), &missing(sine))?;
        Some((left, sine, values))
    });
    let (_, sine, values) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let own = waves[0].iter().zip(&waves[1]).map(|(c, s)| values[0] * c + values[1] * s);
    let along = track.rows.iter().map(|r| f64::from(u8::from(r.place == Place::Along)));
    let whole = own.zip(missing(sine)).zip(along).map(|((own, hung), along)| along * (own + hung)).collect();
    let found = Candidate::one(ID, Kind::Plant, "share", "1", whole).positive();
    Some(found.at("sine of the tilt", sine, "1"))
}
