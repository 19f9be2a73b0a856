//! A step of the force channel as a hypothesis: its times come from a scan of all times.

use super::candidate::Candidate;
use super::change_scan::{Scan, dot, widen_time};
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Hypothesis};
use super::relations::{Form, Over, Relation};
use super::sensor_fault::{SensorFault, add_each, add_halved};
use super::variable::Variable;
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::limits::HALF;
use crate::diagnose::data::regression_data::{Row, Track};
use haptics::Vec2;
use haptics::law::{ForceStep, Kind};

pub(crate) const ID: &str = "force-step";

/// Points: none; a scan finds the times.
const SCAN: &str = "scan";
/// Points: time, recording.
const TIMES: &str = "time";

impl Hypothesis for ForceStep {
    fn about(&self) -> About {
        About {
            id: ID,
            form: Form::Exact(&[Over::Time]),
            relations: &[Relation::NeedsForce],
            seen: Variable::Time,
            ..About::PLAIN
        }
    }

    fn coarse(&self, _ranges: &Ranges<'_>) -> Vec<Point> {
        vec![Point::one(SCAN, 0.0)]
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let apart_s = HALF * near.step * near.ranges.track.period_s;
        let times = near.of(ID).filter_map(|found| Some((found.value("t0")?, found.part as f64)));
        let beside = [-1.5, -1.0, -0.5, 0.5, 1.0, 1.5];
        times.flat_map(|(time, part)| beside.map(|k| Point::two(TIMES, time + k * apart_s, part))).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let near = data.points(ID, TIMES).map(|[time_s, part, ..]| step(data, &[(part as usize, time_s)]));
        let jumps = if data.points(ID, SCAN).next().is_some() { jumps(data) } else { Vec::new() };
        near.chain((1..=jumps.len()).map(|n| step(data, &jumps[..n]))).collect()
    }

    fn widen(&self, parameters: &mut [CauseParameter], track: &Track) {
        for parameter in parameters.iter_mut().filter(|p| SYMBOLS.iter().any(|symbols| symbols.time == p.name)) {
            widen_time(parameter, track);
        }
    }

    fn add_to_fault(&self, fault: &mut SensorFault, candidate: &Candidate, values: &[f64]) -> bool {
        for (step, searched) in fault.steps.iter_mut().zip(&candidate.searched) {
            step.at_s = searched.value;
        }
        add_each(candidate, values, |name, value| {
            SYMBOLS.iter().enumerate().any(|(k, symbols)| {
                if name == symbols.along {
                    fault.steps[k].along = value;
                    return true;
                }
                add_halved(&mut fault.steps[k].force_n, symbols.axes, name, value)
            })
        })
    }
}

/// Least gain of a further step, over that of the first.
/// Derived: between 0.15, the gain of a second step for a straight slope, and 0.33, that for a staircase of two equal
/// steps (piecewise constant least squares).
const LEAST_GAIN: f64 = 0.25;

/// Names of the parameters of one step.
struct Symbols {
    along: &'static str,
    axes: [&'static str; 2],
    time: &'static str,
}

/// Names of the first, second and third step.
const SYMBOLS: [Symbols; 3] = [
    Symbols { along: "step", axes: ["bx", "by"], time: "t0" },
    Symbols { along: "second step", axes: ["second bx", "second by"], time: "second t0" },
    Symbols { along: "third step", axes: ["third bx", "third by"], time: "third t0" },
];

/// Sum of the steps of a candidate with two axes until a time, N. `values`: two for each step.
pub(crate) fn vector_at(candidate: &Candidate, values: &[f64], time_s: f64) -> Vec2 {
    let steps = values.chunks_exact(2).zip(&candidate.searched);
    steps.filter(|(_, at)| time_s >= at.value).map(|(step, _)| Vec2::new(step[0], step[1])).sum()
}

/// Steps of one recording at these times. `jumps`: recording and time, s.
fn step(data: &Dictionary<'_>, jumps: &[(usize, f64)]) -> Candidate {
    let (mut columns, mut linear) = (Vec::new(), Vec::new());
    for ((recording, time_s), symbols) in jumps.iter().zip(&SYMBOLS) {
        let of = |row: &Row| if row.recording == *recording { 1.0 } else { 0.0 };
        let since: Vec<f64> = if data.track.planar {
            data.every(&|r| if r.motion.time_s >= *time_s { of(r) } else { 0.0 })
        } else {
            let law = data.law(&ForceStep, &[1.0, *time_s]);
            data.track.rows.iter().zip(law.iter()).map(|(r, x)| of(r) * x).collect()
        };
        let along = |axis: Vec2| -> Vec<f64> {
            data.track.rows.iter().zip(&since).map(|(r, x)| r.along.dot(&axis) * x).collect()
        };
        if data.track.planar {
            columns.extend([along(Vec2::x()), along(Vec2::y())]);
            linear.extend(symbols.axes.map(|name| (name, "N")));
        } else {
            columns.push(since);
            linear.push((symbols.along, data.unit(&ForceStep, 0)));
        }
    }
    let mut candidate = Candidate::several(ID, Kind::Instrument, columns, linear).within(jumps[0].0);
    // The time of a change counts twice, because it is the best of all times (Zhang & Siegmund 2007).
    candidate.cost += jumps.len() as f64;
    jumps.iter().zip(&SYMBOLS).fold(candidate, |made, ((_, time_s), symbols)| made.at(symbols.time, *time_s, "s"))
}

/// Recordings and times of up to three steps, each the best one beside those before it. The first takes half of the
/// power of the residual.
fn jumps(data: &Dictionary<'_>) -> Vec<(usize, f64)> {
    let recordings = data.track.rows.iter().map(|row| row.recording).max().map_or(0, |last| last + 1);
    let rows = &data.track.rows;
    let sensor = |i: usize| if data.track.planar { [rows[i].along.x, rows[i].along.y] } else { [1.0, 0.0] };
    let axes = if data.track.planar { 2 } else { 1 };
    let scans = (0..recordings).map(|recording| (recording, Scan::of(data, recording, axes, &sensor)));
    let steps = |(recording, mut scan): (usize, Scan)| -> (f64, Vec<(usize, f64)>) {
        let power = dot(&scan.residual, &scan.residual);
        let mut found: Vec<(f64, f64)> = SYMBOLS.iter().map_while(|_| scan.next_step()).collect();
        let first = found.first().map_or(0.0, |(gain, _)| *gain);
        let enough =
            |(k, (gain, _)): &(usize, &(f64, f64))| *gain > if *k == 0 { HALF * power } else { LEAST_GAIN * first };
        let steps = found.iter().enumerate().take_while(enough).count();
        found.truncate(steps);
        (first, found.iter().map(|(_, time_s)| (recording, *time_s)).collect())
    };
    // A step has a recording of its own.
    scans.map(steps).max_by(|a, b| a.0.total_cmp(&b.0)).map_or_else(Vec::new, |(_, steps)| steps)
}
