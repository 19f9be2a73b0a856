//! A step of the force channel as a hypothesis: its times come from a scan of all times.

use super::candidate::Candidate;
use super::change_scan::{Scan, dot, widen_between, widen_time};
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

/// Sets of channels of two fingers whose zeros may jump at once: one, both of a finger, all.
pub(crate) const OF_FINGERS: [&[&str]; 7] =
    [&["bx1"], &["by1"], &["bx2"], &["by2"], &["bx1", "by1"], &["bx2", "by2"], &["bx1", "by1", "bx2", "by2"]];
/// The one channel of a force along a line.
pub(crate) const ALONG: [&[&str]; 1] = [&[SYMBOLS[0].along]];

/// Rows of a task in which the zero of a sensor may have jumped.
pub(crate) struct Jumps<F> {
    pub recording: Vec<usize>,
    pub time_s: Vec<f64>,
    /// Share of the zero of a channel in a row.
    pub share: F,
}

/// Jumps of the zeros of two fingers. `rows`: recording and time of each row, s; `share`: of a finger's axis in a row.
pub(crate) fn jumps_of_fingers(
    rows: impl Iterator<Item = (usize, f64)>,
    share: impl Fn(usize, usize, usize) -> f64,
) -> Jumps<impl Fn(&str, usize) -> f64> {
    let (recording, time_s) = rows.unzip();
    let of_channel =
        move |name: &str, i: usize| share(usize::from(name.ends_with('2')), usize::from(name.starts_with("by")), i);
    Jumps { recording, time_s, share: of_channel }
}

impl<F: Fn(&str, usize) -> f64> Jumps<F> {
    /// Steps of sets of channels, each at the time that explains most beside a model, and one row earlier and later.
    pub(crate) fn candidates(&self, sets: &[&[&'static str]], model: &[Vec<f64>], target: &[f64]) -> Vec<Candidate> {
        let recordings = self.recording.iter().max().map_or(0, |last| last + 1);
        (0..recordings).flat_map(|recording| self.of_recording(recording, sets, model, target)).collect()
    }

    fn of_recording(
        &self,
        recording: usize,
        sets: &[&[&'static str]],
        model: &[Vec<f64>],
        target: &[f64],
    ) -> Vec<Candidate> {
        let mut own: Vec<usize> = (0..self.time_s.len()).filter(|i| self.recording[*i] == recording).collect();
        own.sort_by(|a, b| self.time_s[*a].total_cmp(&self.time_s[*b]));
        let of = |column: &dyn Fn(usize) -> f64| own.iter().map(|i| column(*i)).collect::<Vec<f64>>();
        let model = model.iter().map(|column| of(&|i| column[i])).collect();
        let scan = Scan::beside(model, of(&|i| self.time_s[i]), of(&|i| target[i]));
        let best_s = |set: &[&'static str]| {
            let axes = set.iter().take(2).map(|name| of(&|i| (self.share)(name, i))).collect();
            scan.along(axes).best_time_s()
        };
        let steps = |set: &&[&'static str]| best_s(set).map_or_else(Vec::new, |at_s| self.near(recording, set, at_s));
        sets.iter().flat_map(steps).collect()
    }

    /// Steps between the rows about a time.
    fn near(&self, recording: usize, set: &[&'static str], best_s: f64) -> Vec<Candidate> {
        let times = self.times(recording, set);
        let at = times.partition_point(|time_s| *time_s < best_s);
        let between = times.windows(2).map(|pair| HALF * (pair[0] + pair[1]));
        between.skip(at.saturating_sub(2)).take(3).map(|at_s| self.step(recording, set, at_s)).collect()
    }

    fn step(&self, recording: usize, set: &[&'static str], at_s: f64) -> Candidate {
        let since = |i: usize| self.recording[i] == recording && self.time_s[i] >= at_s;
        let column = |name: &&'static str| -> Vec<f64> {
            (0..self.time_s.len()).map(|i| if since(i) { (self.share)(name, i) } else { 0.0 }).collect()
        };
        let linear = set.iter().map(|name| (*name, "N")).collect();
        let mut step = Candidate::several(ID, Kind::Instrument, set.iter().map(column).collect(), linear);
        step.cost += 1.0;
        step.within(recording).at(SYMBOLS[0].time, at_s, "s")
    }

    /// Times of the rows of a recording in which some channels show.
    fn times(&self, recording: usize, set: &[&str]) -> Vec<f64> {
        let shows = |i: usize| set.iter().any(|name| (self.share)(name, i) != 0.0);
        let own = (0..self.time_s.len()).filter(|i| self.recording[*i] == recording && shows(*i));
        let mut times: Vec<f64> = own.map(|i| self.time_s[i]).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Widens the standard error of the time of a step that was found: nothing shows it between two rows.
    pub(crate) fn widen(&self, step: &Candidate, found: &mut [CauseParameter]) {
        let set: Vec<&str> = step.linear.iter().map(|(name, _)| *name).collect();
        let times = self.times(step.part, &set);
        found.iter_mut().filter(|p| p.name == SYMBOLS[0].time).for_each(|time| widen_between(time, &times));
    }
}

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
