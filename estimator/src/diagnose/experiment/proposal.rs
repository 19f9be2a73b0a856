//! Recording that would settle the open questions: regressors of the candidates on motions that have not been recorded
//! yet.
//!
//! Predicted rows of a motion that has not been made yet, with the forces of the base model.

use super::separation::{Imagined, separation};
use super::strokes::Course;
use super::strokes::{Excitation, HANG, LIBRARY};
use crate::diagnose::contract::{Alternative, Experiment, NextExperiment};
use crate::diagnose::data::direction::blur;
use crate::diagnose::data::limits::AMBIGUOUS;
use crate::diagnose::data::regression_data::{Bearing, Model, Place, Row, Track};
use crate::diagnose::data::row_means::column;
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::{eccentric_mass, friction_asymmetry, gravity_tilt};
use crate::diagnose::selection::comparison::ChannelFit;
use foundation::words::amount;
use haptics::Vec2;
use haptics::law::Motion;
use statrs::distribution::{ContinuousCDF, Normal};

/// Lengths of a proposed recording, s. The shortest that is likely to suffice is proposed.
/// Choice: no case of the ablation reads it.
const RECORDING_LENGTHS_S: Axis = Axis::geometric(20.0, 80.0, 3);
/// Expected power from which a proposed motion is likely to suffice.
/// Source: the usual power of a test, 0.8 (Cohen 1988).
pub(crate) const LIKELY: f64 = 0.8;
/// Share of questions that a motion settles although the evidence is sure to suffice. It is below one because neither
/// answer may be true.
/// Source: measured, `docs/diagnosis.md`.
pub(crate) const SURE_BY_MOTION: f64 = 0.85;
/// The same share for a weight that is hung on.
/// Source: measured, `docs/diagnosis.md`.
pub(crate) const SURE_HUNG: f64 = 0.95;
/// Largest turn of a crank to either side, rad.
/// Choice: no case of the ablation reads it.
const TURN_RAD: f64 = 7.0;
/// Heaviest weight to hang on, N, which fingers can still lift.
/// Choice: no case of the ablation reads it.
const HEAVIEST_N: f64 = 1.2;
/// Weight to hang on, as a multiple of the object's weight or moment.
/// Choice: no case of the ablation reads it.
const HUNG_MULTIPLE: f64 = 10.0;
/// Lever of the weight that is hung on a mechanism, m.
/// Choice: no case of the ablation reads it.
const LEVER_M: f64 = 0.1;

/// Next experiment, which separates the found causes from the `open` alternatives; `None` if no question is open.
pub fn propose(track: &Track, model: &Model, study: &ChannelFit, open: &[Alternative]) -> Option<NextExperiment> {
    let solved = study.solved.as_ref()?;
    let pairs: Vec<(&str, &str)> = open.iter().map(|a| (a.instead_of.as_str(), a.id.as_str())).collect();
    pairs.first()?;
    let values = &solved.values[..study.baseline.len()];
    if let Some(pair) = pairs.iter().find(|p| matches!(p, (eccentric_mass::ID, gravity_tilt::ID))) {
        return hang(track, model, study, *pair);
    }
    let mut best: Option<(f64, NextExperiment)> = None;
    for seconds in RECORDING_LENGTHS_S.values() {
        for excitation in LIBRARY.iter().filter(|e| track.planar || e.free_s == 0.0) {
            let asked = asked(track, excitation, seconds);
            let imagined = Imagined::along(&imagine(track, model, values, excitation, &asked), model, study);
            let least =
                pairs.iter().filter_map(|pair| separation(&imagined, study, *pair)).fold(f64::INFINITY, f64::min);
            if least.is_finite() && best.as_ref().is_none_or(|(most, _)| least > *most) {
                let next = proposal(excitation.words.to_owned(), &pairs, SURE_BY_MOTION * power(least), asked);
                best = Some((least, next));
            }
        }
        if best.as_ref().is_some_and(|(_, next)| next.expected_power > LIKELY) {
            break;
        }
    }
    best.map(|(_, next)| next)
}

/// Proposed recording: the experiment in words, and the predicted rows of each channel with its fit.
pub(crate) type Asked<'a> = (Experiment, String, Vec<(Imagined, &'a ChannelFit)>);

/// The shortest of several recordings that is likely to settle the open questions, or the one that settles most. `None`
/// if none settles any. `asked`: the recording with this many movements.
pub(crate) fn shortest<'a>(
    open: &[Alternative],
    counts: [usize; 3],
    asked: &dyn Fn(usize) -> Option<Asked<'a>>,
) -> Option<NextExperiment> {
    let mut best: Option<NextExperiment> = None;
    for count in counts {
        let (experiment, motion, channels) = asked(count)?;
        let seen = |pair| channels.iter().find_map(|(rows, study)| separation(rows, study, pair));
        let pairs = open.iter().map(|a| (a.instead_of.as_str(), a.id.as_str()));
        let (told, evidence): (Vec<_>, Vec<f64>) = pairs.filter_map(|pair| Some((pair, seen(pair)?))).unzip();
        let power = SURE_BY_MOTION * power(evidence.into_iter().reduce(f64::min)?);
        if best.as_ref().is_none_or(|b| power > b.expected_power + 1e-3) {
            best = Some(proposal(motion, &told, power, experiment));
        }
        if best.as_ref().is_some_and(|b| b.expected_power > LIKELY) {
            break;
        }
    }
    best
}

fn proposal(motion: String, pairs: &[(&str, &str)], power: f64, experiment: Experiment) -> NextExperiment {
    let mut separates: Vec<String> = Vec::new();
    for id in pairs.iter().flat_map(|(found, other)| [*found, *other]) {
        if !separates.iter().any(|s| s == id) {
            separates.push(id.to_owned());
        }
    }
    NextExperiment { motion, separates, expected_power: power, experiment: Some(experiment) }
}

/// A motion of the library with the range and speed of the recorded motion.
fn asked(track: &Track, excitation: &Excitation, seconds: f64) -> Experiment {
    let scale = if track.planar { track.radius_m.unwrap_or(1.0) } else { 1.0 };
    let at = |share| track.quantile(share, |r| r.motion.position) / scale;
    let (low, high) = (at(0.02), at(0.98));
    let half = 0.5 * (high - low);
    Experiment {
        id: excitation.id.to_owned(),
        seconds,
        free_s: excitation.free_s,
        middle: 0.5 * (low + high),
        half_range: if track.planar { half.min(TURN_RAD) } else { half },
        fast: track.quantile(0.95, |r| r.motion.velocity.abs()) / scale,
        across_n: if track.planar { track.quantile(0.7, |r| r.motion.normal_force_n.abs()) } else { 0.0 },
        ..Experiment::default()
    }
}

/// An eccentric mass and a tilted plane are equivalent in every motion of the object. A known weight on it separates
/// them.
fn hang(track: &Track, model: &Model, study: &ChannelFit, pair: (&str, &str)) -> Option<NextExperiment> {
    let solved = study.solved.as_ref()?;
    let picks = study.picks();
    let chosen = picks.iter().position(|p| study.candidates[*p].id == pair.0)?;
    let mut asked = asked(track, &HANG, RECORDING_LENGTHS_S.low());
    let in_steps = |weight: f64| (20.0 * weight.clamp(0.1, HEAVIEST_N)).round() / 20.0;
    if track.planar {
        let own = model.iter().zip(&solved.values).filter(|(e, _)| e.role() == haptics::law::Role::Gravity);
        let own_n: f64 = own.map(|(e, share)| share * e.values[0]).sum();
        asked.added_weight_n = in_steps(HUNG_MULTIPLE * own_n.max(0.02));
        asked.added_lever_m = track.radius_m?;
        // Factor by which the weight enlarges the sine of a tilt.
        let times = 1.0 + asked.added_weight_n / own_n.max(0.02);
        let share = asked.seconds / track.span_s.max(1.0);
        let lambda = study.chosen[chosen].lambda * share * (times - 1.0).powi(2) / (1.0 + share * times * times);
        return Some(hung_proposal(&asked, &[pair], power(lambda), "the handle"));
    }
    let first = study.system.own(&picks, chosen).start;
    let moment = solved.values[first..first + 2].iter().map(|v| v * v).sum::<f64>().sqrt();
    asked.added_lever_m = LEVER_M;
    asked.added_weight_n = in_steps(HUNG_MULTIPLE * moment / LEVER_M);
    let hung = asked.added_weight_n * LEVER_M;
    // Either all of it acts, or the sine of a small tilt; nothing in between is considered.
    let noise = track.force_noise.max(f64::MIN_POSITIVE);
    let lambda = asked.seconds / track.period_s * 0.5 * (0.4 * hung / noise).powi(2);
    Some(hung_proposal(&asked, &[pair], power(lambda), "a lever"))
}

fn hung_proposal(asked: &Experiment, pairs: &[(&str, &str)], power: f64, on: &str) -> NextExperiment {
    let weight = amount(asked.added_weight_n, "N");
    let note = if on == "the handle" {
        format!(
            "hang a known weight of about {weight} on the handle and state it in the sidecar (known: added_weight_N)"
        )
    } else {
        format!(
            "hang a known weight of about {weight} on a lever of {:.2} m and state both in the sidecar (known: added_weight_N, \
             added_lever_m, and added_level_rad, the coordinate at which the lever is level)",
            asked.added_lever_m
        )
    };
    proposal(format!("{note}; {}", HANG.words), pairs, SURE_HUNG * power, asked.clone())
}

/// Probability that a log likelihood ratio of mean λ/2 and variance λ settles it.
pub(crate) fn power(lambda: f64) -> f64 {
    let lambda = lambda.clamp(0.0, f64::MAX);
    let sure = (0.5 * lambda - 0.5 * AMBIGUOUS) / lambda.max(1e-9).sqrt();
    Normal::new(0.0, 1.0).map_or(0.0, |n| n.cdf(sure))
}

/// Next experiment of a free motion in words: it cannot be driven.
pub(crate) fn turned_track(open: &[Alternative]) -> Option<NextExperiment> {
    let pair = [gravity_tilt::ID, friction_asymmetry::ID];
    let asks = |a: &&Alternative| pair.contains(&a.id.as_str()) && pair.contains(&a.instead_of.as_str());
    open.iter().find(asks)?;
    let motion = "turn the track end for end, release it again as before, and count the coordinate along the thing, not along the room: a \
                  slope then pulls the other way, friction stays";
    Some(NextExperiment::in_words(motion, pair.map(str::to_owned).to_vec(), SURE_BY_MOTION))
}

/// Predicted rows of an experiment on the object of `track`. `values`: estimates of the model's laws.
pub fn imagine(track: &Track, model: &Model, values: &[f64], excitation: &Excitation, asked: &Experiment) -> Track {
    let scale = if track.planar { track.radius_m.unwrap_or(1.0) } else { 1.0 };
    let step = track.period_s;
    let course = Course::of(excitation, asked.fast / asked.half_range.max(f64::MIN_POSITIVE), asked.seconds);
    let place = |t: f64| scale * (asked.middle + asked.half_range * course.at(t.max(0.0)).0);
    let count = (asked.seconds / step) as usize;
    let rows = (0..count).map(|i| {
        let t = i as f64 * step;
        let position = place(t);
        let angle_rad = track.radius_m.map_or(position, |r| position / r);
        let along = if track.planar { Vec2::new(-angle_rad.sin(), angle_rad.cos()) } else { Vec2::x() };
        let motion = Motion {
            time_s: t + asked.free_s,
            position,
            velocity: (place(t + step) - place(t - step)) / (2.0 * step),
            acceleration: (place(t + step) - 2.0 * position + place(t - step)) / (step * step),
            direction: 0.0,
            normal_force_n: if track.planar { asked.across_n * course.at(t).1 } else { 0.0 },
            up_along: if track.planar { along.y } else { 0.0 },
        };
        Row { motion, angle_rad, along, ..Row::default() }
    });
    let mut imagined = Track {
        rows: rows.collect(),
        fine: Vec::new(),
        span_s: asked.seconds + 2.0 * asked.free_s,
        hung: Vec::new(),
        bearing: Bearing::default(),
        slope: None,
        extra: Vec::new(),
        freely: None,
        ..track.clone()
    };
    blur(&mut imagined);
    let base: Vec<Vec<f64>> = model.iter().map(|e| column(&imagined, e)).collect();
    for i in 0..imagined.rows.len() {
        let y: f64 = base.iter().zip(values).map(|(c, v)| c[i] * v).sum();
        let row = &mut imagined.rows[i];
        let outward = Vec2::new(row.along.y, -row.along.x);
        row.target = y;
        row.force = if track.planar { row.along * y + outward * row.motion.normal_force_n } else { Vec2::new(y, 0.0) };
    }
    for i in 1..imagined.rows.len().saturating_sub(1) {
        let rate = (imagined.rows[i + 1].force - imagined.rows[i - 1].force) / (2.0 * step);
        imagined.rows[i].force_rate = rate;
    }
    if track.planar {
        add_free(&mut imagined, asked.free_s);
    }
    imagined
}

fn add_free(track: &mut Track, free_s: f64) {
    let count = (free_s / track.period_s) as usize;
    for (k, (axis, place)) in [(Vec2::x(), Place::FreeX), (Vec2::y(), Place::FreeY)].into_iter().enumerate() {
        for end in 0..2 {
            let start_s = if end == 0 { 0.0 } else { track.span_s - free_s };
            let period_s = track.period_s;
            track.rows.extend((0..count).map(|i| {
                let motion = Motion { time_s: start_s + i as f64 * period_s, ..Motion::default() };
                Row { segment: 1 + 2 * k + end, place, motion, along: axis, ..Row::default() }
            }));
        }
    }
}
