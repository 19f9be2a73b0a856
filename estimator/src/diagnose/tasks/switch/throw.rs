//! Force during the travel of a throw, relative to the curve at the same position and direction: effects of speed and
//! time, and readings of fingers without touch. The curve itself is estimated here, one per direction. Its comparison
//! with the world's is a separate channel.

use super::held_knob::Knob;
use super::measured_curve::{APART, Curve, along_m};
use super::rows::{KNOB_REST_HZ, Place, Row, Seen, direction};
use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::limits::LEAST_ROWS_OF_A_FIT;
use crate::diagnose::experiment::separation::Imagined;
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::force_step::{Jumps, jumps_of_fingers};
use crate::diagnose::hypotheses::sensor_fault::{BIAS, DRIFT, of_fingers};
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{force_bias, force_drift, force_step, friction_change, time_delay, viscous_friction};
use crate::diagnose::model_error::competition::settle;
use crate::diagnose::model_error::of_channel::beside_errors;
use crate::diagnose::model_error::twin::{Force, Placed};
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{ChannelFit, Compared, View};
use crate::diagnose::selection::layout::Layout;
use crate::diagnose::selection::rules::Rules;
use estimation::regression::linear::least_squares;
use foundation::estimate::EstimateError;
use foundation::words::amount;
use haptics::Vec2;
use haptics::law::Kind;

/// Distance from the top of the curve within which rows are left out, as a share of the fingers' range: fast throws
/// round its corner more than slow ones.
/// Choice: halved, 5 of 21 answers change; doubled, 11 of 21 answers change (2 to wrong).
const TOP_CORNER: f64 = 0.023;
/// Tried times of a sudden change of friction, in shares of the recording.
/// Choice: halved, 3 of 21 answers change; doubled, 3 of 21 answers change.
const CHANGES: Axis = Axis::even(0.05, 0.95, 19);
/// Least force of viscous friction at the highest speed, as a share of the largest force. Pads with damping, and corners
/// that a fast throw rounds, look like nearly half of it.
/// Choice: halved or doubled, none of 21 answers changes.
const LEAST_VISCOUS: f64 = 0.045;

/// The comparison.
pub struct Push {
    pub compared: Compared,
    /// Rows of the comparison.
    all: Vec<Row>,
    /// Rows of the throws used, and the contribution of the found causes to the force along the travel there, N.
    pub rows: Vec<(Row, f64)>,
    curves: Vec<Curve>,
    /// Forces of the curves in a first fit, N.
    forces_n: Vec<Vec<f64>>,
    pub thrown: Knob,
}

/// Force of the knob along the travel, or that of a free finger, N.
fn force_n(row: &Row) -> f64 {
    match row.place {
        Place::Push(side) => direction(side) * row.force.x,
        Place::Stop(_) => 0.0,
        Place::Free(_, axis) => row.force[axis],
    }
}

/// Curves of both directions, over their observed range.
fn curves(rows: &[Row], range_m: f64) -> Vec<Curve> {
    [0, 1].into_iter().filter_map(|side| Curve::of(rows, side, APART * range_m)).collect()
}

/// Node forces of all curves in a plain fit.
fn first_look(rows: &[Row], curves: &[Curve]) -> Result<Vec<Vec<f64>>, EstimateError> {
    curves
        .iter()
        .map(|curve| {
            let own: Vec<Row> = rows.iter().filter(|r| r.place == Place::Push(curve.side)).copied().collect();
            let y: Vec<f64> = own.iter().map(force_n).collect();
            Ok(least_squares(&curve.columns(&own), &y, None)?.values.clone())
        })
        .collect()
}

/// Compares the causes that depend on speed and time.
pub fn push(seen: &Seen, rules: Rules) -> Result<Push, EstimateError> {
    let moves = |r: &Row| !matches!(r.place, Place::Push(_)) || r.speed_m_s() > KNOB_REST_HZ * seen.range_m;
    let on = |r: &&Row| !matches!(r.place, Place::Stop(_)) && moves(r);
    let all: Vec<Row> = seen.rows.iter().filter(on).copied().collect();
    let rough = curves(&all, seen.range_m);
    let forces = first_look(&all, &rough)?;
    let tops: Vec<(usize, f64)> = rough.iter().zip(&forces).map(|(c, f)| (c.side, c.top_m(f))).collect();
    let corner = |r: &Row| {
        tops.iter()
            .any(|(side, top)| r.place == Place::Push(*side) && (along_m(r) - top).abs() < TOP_CORNER * seen.range_m)
    };
    let kept = |i: usize| {
        let r = &seen.rows[i];
        !matches!(r.place, Place::Stop(_)) && moves(r) && !corner(r)
    };
    let indices: Vec<usize> = (0..seen.rows.len()).filter(|i| kept(*i)).collect();
    let rows: Vec<Row> = indices.iter().map(|i| seen.rows[*i]).collect();
    // A gap left by removed rows ends a segment.
    let mut number = 0;
    let stretch: Vec<usize> = (0..rows.len())
        .map(|k| {
            let follows =
                k > 0 && seen.stretch[indices[k]] == seen.stretch[indices[k - 1]] && indices[k] == indices[k - 1] + 1;
            number += usize::from(k > 0 && !follows);
            number
        })
        .collect();
    let pushed = rows.iter().filter(|r| matches!(r.place, Place::Push(_))).count();
    if pushed < LEAST_ROWS_OF_A_FIT {
        return Err(EstimateError::Other(format!(
            "only {pushed} hundredths of a second of pushing a moving knob were seen, {LEAST_ROWS_OF_A_FIT} are needed: throw the switch over more often"
        )));
    }
    let curves = curves(&rows, seen.range_m);
    let forces = first_look(&rows, &curves)?;
    let base = base(&rows, &curves);
    let y: Vec<f64> = rows.iter().map(force_n).collect();
    let mut candidates = candidates(seen, &rows, &curves, &forces);
    candidates.extend(jumps(&rows).candidates(&force_step::OF_FINGERS, &base, &y));
    let testable: Vec<bool> = (0..rows.len()).map(|i| i % 2 == 0).collect();
    let layout = Layout::of(stretch.clone(), &testable, seen.period_s);
    let view = view(&rows);
    let channel = Channel::new(y, base, candidates, layout, rules);
    let study = settle(beside_errors(channel, &view, &[Variable::Place]).fit()?);
    let found = of_found(&study, rows.len());
    let along = rows.iter().map(|r| matches!(r.place, Place::Push(_))).collect();
    let state = rows.iter().map(Row::state).collect();
    let is_push = |(r, _): &(Row, f64)| matches!(r.place, Place::Push(_));
    let thrown = Knob::thrown(&rows, &stretch, seen.period_s, &curves);
    let kept = rows.iter().copied().zip(found).filter(is_push).collect();
    let (channel, unit, floor) = ("force on the knob", "N", seen.noise_n);
    let compared = Compared { study, channel, unit, floor, along, state, view };
    Ok(Push { compared, all: rows, rows: kept, curves, forces_n: forces, thrown })
}

/// Base model: the curves of both directions and the knob's mass, which falls over faster than the hand moves.
fn base(rows: &[Row], curves: &[Curve]) -> Vec<Vec<f64>> {
    let mut base: Vec<Vec<f64>> = curves.iter().flat_map(|c| c.columns(rows)).collect();
    let of_mass = |r: &Row| if let Place::Push(side) = r.place { direction(side) * r.acceleration_m_s2 } else { 0.0 };
    base.push(rows.iter().map(of_mass).collect());
    base
}

/// Variables of the plots. Fingers without touch are sensors of their own.
fn view(rows: &[Row]) -> View {
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let sensor = |r: &Row| match r.place {
        Place::Free(finger, axis) => 1 + 2 * finger + axis,
        Place::Push(_) | Place::Stop(_) => 0,
    };
    let over = vec![
        (Variable::Time, of(&|r| r.time_s)),
        (Variable::Place, of(&|r| r.tip.x)),
        (Variable::Velocity, of(&Row::speed_m_s)),
    ];
    let way = of(&|r| r.side().map_or(0.0, direction));
    let sensor = rows.iter().map(sensor).collect();
    View { sensor, way, ..View::of(rows.iter().map(|r| r.recording).collect(), over, best_seen) }
}

/// Contribution of the chosen causes to the rows.
fn of_found(study: &ChannelFit, rows: usize) -> Vec<f64> {
    let mut sum = vec![0.0; rows];
    let Some(solved) = &study.solved else { return sum };
    let columns = study.chosen.iter().flat_map(|c| &study.candidates[c.candidate].regressors);
    for (column, value) in columns.zip(&solved.values[study.baseline.len()..]) {
        sum.iter_mut().zip(column.iter()).for_each(|(s, c)| *s += value * c);
    }
    sum
}

fn candidates(seen: &Seen, rows: &[Row], curves: &[Curve], forces: &[Vec<f64>]) -> Vec<Candidate> {
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let pushed = |f: &dyn Fn(&Row) -> f64| of(&|r| if matches!(r.place, Place::Push(_)) { f(r) } else { 0.0 });
    let most = |f: &dyn Fn(&Row) -> f64| pushed(f).into_iter().fold(0.0, f64::max);
    let (largest_n, fastest_m_s) = (most(&force_n), most(&|r| r.speed_m_s()));
    let mut found = vec![
        Candidate::one(viscous_friction::ID, Kind::Plant, "c", "N s/m", pushed(&|r| r.speed_m_s()))
            .positive()
            .at_least(LEAST_VISCOUS * largest_n / fastest_m_s.max(f64::MIN_POSITIVE)),
    ];
    let late = |r: &Row| {
        let slope: f64 = curves.iter().zip(forces).map(|(c, f)| c.slope(r, f)).sum();
        -slope * r.speed_m_s()
    };
    // Damping of the pads puts the force slightly ahead, which is no fault of the clocks.
    found.push(Candidate::one(time_delay::ID, Kind::Instrument, "tau", "s", pushed(&late)).positive());
    let span_s = rows.iter().map(|r| r.time_s).fold(0.0, f64::max).max(1e-9);
    if seen.recordings == 1 {
        found.push(Candidate::one(friction_change::ID, Kind::Plant, "rate", "N/s", pushed(&|r| r.time_s)));
        for t0 in CHANGES.values().map(|share| span_s * share) {
            let column = pushed(&|r| f64::from(u8::from(r.time_s >= t0)));
            found.push(Candidate::one(friction_change::ID, Kind::Plant, "change", "N", column).at("t0", t0, "s"));
        }
    }
    for recording in 1..seen.recordings {
        let column = pushed(&|r| f64::from(u8::from(r.recording >= recording)));
        let change = Candidate::one(friction_change::ID, Kind::Plant, "change", "N", column);
        found.push(change.at("from recording", (recording + 1) as f64, "1"));
    }
    found.extend(of_fingers(force_bias::ID, &BIAS, &|finger, axis| of(&|r| r.share(finger, axis))));
    found.extend(of_fingers(force_drift::ID, &DRIFT, &|finger, axis| of(&|r| r.share(finger, axis) * r.time_s)));
    found
}

/// The rows as those in which a sensor's zero may have jumped.
fn jumps(rows: &[Row]) -> Jumps<impl Fn(&str, usize) -> f64> {
    let of_rows = rows.iter().map(|row| (row.recording, row.time_s));
    jumps_of_fingers(of_rows, |finger, axis, i| rows[i].share(finger, axis))
}

impl Push {
    /// Places of the rows in their recordings.
    pub fn placed(&self) -> Vec<Placed> {
        let force = |row: &Row| match row.place {
            Place::Push(side) => Force::Finger(side, direction(side) * Vec2::x()),
            Place::Free(finger, axis) => Force::Finger(finger, [Vec2::x(), Vec2::y()][axis]),
            Place::Stop(_) => Force::None,
        };
        let placed = |row: &Row| Placed { recording: row.recording, time_s: row.time_s, force: force(row) };
        self.all.iter().map(placed).collect()
    }

    /// Predicted regressors on rows that have not been measured yet.
    pub fn imagined(&self, seen: &Seen) -> Imagined {
        let candidates = candidates(seen, &seen.rows, &self.curves, &self.forces_n);
        Imagined::of(base(&seen.rows, &self.curves), candidates, seen.stretch.clone())
    }

    /// Range of the travel seen in the throws of a side, m.
    pub fn seen_m(&self, side: usize) -> Option<(f64, f64)> {
        let curve = self.curves.iter().find(|c| c.side == side)?;
        curve.places.first().copied().zip(curve.places.last().copied())
    }
}

/// Variable that best shows a cause.
fn best_seen(id: &str) -> Variable {
    match id {
        viscous_friction::ID => Variable::Velocity,
        time_delay::ID => Variable::Place,
        _ => Variable::Time,
    }
}

impl Told for Push {
    fn states(&self, _: usize, candidate: &Candidate, mut found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        if candidate.id == force_step::ID {
            jumps(&self.all).widen(candidate, &mut found);
        }
        found
    }

    fn shows(&self, found: &Found<'_>) -> String {
        let value = found.value();
        match found.candidate.id {
            viscous_friction::ID => {
                format!("fast throws ask for more force than slow ones at the same place ({})", amount(value, "N s/m"))
            }
            friction_change::ID => {
                "at the same place the knob asks for another force, the same way in both directions, as time goes on"
                    .to_owned()
            }
            time_delay::ID => {
                format!("the force comes {:.1} ms after the motion: fast throws have their peak elsewhere", 1e3 * value)
            }
            force_bias::ID => "fingers that touch nothing feel a force".to_owned(),
            force_drift::ID => "the forces of fingers that touch nothing go with time".to_owned(),
            force_step::ID => "the forces of fingers that touch nothing jump".to_owned(),
            other => format!("{other} shows on the way of the throws"),
        }
    }

    fn hidden_by(&self, candidate: &Candidate) -> Option<&'static str> {
        Some(match (candidate.id, candidate.linear[0].0) {
            (viscous_friction::ID | time_delay::ID, _) => "the throws were all of one speed; throw it slowly and fast",
            (friction_change::ID, "change") => "there were few throws; go on for longer",
            (force_bias::ID, _) => "no finger was ever free; start and end with a second of free motion",
            _ => return None,
        })
    }
}
