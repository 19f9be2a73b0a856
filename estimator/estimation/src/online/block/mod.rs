//! Blocks and barrels while they are carried: weight, width, give of the pads, slip margin, and changes of the weight.
//!
//! The rows are those of the batch fit ([`crate::identify::block`]): the vertical sum over a constant and the acceleration, the width
//! over the grip. The pads count as linear here; the batch fit also averages over pads that bend.

mod candidates;
mod grasp_record;
pub mod pull;
mod report;

use super::decimating_store::DecimatingStore;
use super::filter::{Filters, Sample};
use super::information::problem::Problem;
use super::leak::{LeakAnswer, Series, Verdict, Weighing, leak_or_drift};
use super::report::{Event, Report};
use super::settings::Settings;
use super::state_tracker::{FREE_ROW_S, Now, StateTracker};
use candidates::block_problems;
use foundation::estimate::Parameter;
use foundation::tasks::SystemState;
use grasp_record::{GraspRecord, Row};
use haptics::Vec2;
use haptics::recording::Task;
use pull::Left;
pub(crate) use report::leak_parameter;
use report::{friction, grip_stiffness, mean_width, weight, width};

/// The ends of a state are left out, s: contacts ring there.
const GUARD_S: f64 = 0.12;
/// Rows wait here until their state has gone on for [`GUARD_S`].
const WAITING: usize = 16;
/// Different objects that are kept apart.
const MOST_OBJECTS: usize = 6;
/// Time of release after which the next grasp may be of another object, s.
const LET_GO_S: f64 = 0.25;
/// Number of carried rows after which an object is told by width and weight.
const TELL_ROWS: u64 = 16;
/// Largest relative differences of width and weight of one object.
const SAME_WIDTH: f64 = 0.02;
const SAME_WEIGHT: f64 = 0.1;
/// Events that are kept.
const MOST_EVENTS: usize = 32;

/// Blocks of one session.
#[derive(Clone, Debug)]
pub struct Blocks {
    task: Task,
    gravity: f64,
    row_s: f64,
    objects: Vec<GraspRecord>,
    /// Number of objects seen.
    count: usize,
    current: Option<usize>,
    waiting: [Row; WAITING],
    waits: usize,
    next_row_s: f64,
    let_go: bool,
    held: bool,
    free: DecimatingStore<2>,
    events: Vec<Event>,
    margin: Option<f64>,
    /// Sum of the sensors' biases and its standard error, N, once known; noise of a sum from row to row, N.
    bias: Option<(Vec2, f64)>,
    noise_n: f64,
}

impl Blocks {
    /// `row_s`: distance of rows, s: a filter window.
    pub(super) fn new(task: Task, settings: &Settings, row_s: f64) -> Self {
        let memory_rows = settings.memory_s / row_s;
        let block_rows = (0.09 / row_s).ceil() as u32;
        Self {
            task,
            gravity: settings.gravity_m_s2,
            row_s,
            // A clone keeps no spare room in its store: each is made.
            objects: (0..MOST_OBJECTS)
                .map(|_| GraspRecord::new(memory_rows, block_rows, settings.false_alarms_per_hour, row_s))
                .collect(),
            count: 0,
            current: None,
            waiting: [Row::default(); WAITING],
            waits: 0,
            next_row_s: f64::NEG_INFINITY,
            let_go: true,
            held: false,
            free: DecimatingStore::new(400),
            events: Vec::with_capacity(MOST_EVENTS),
            margin: None,
            bias: None,
            noise_n: 0.0,
        }
    }

    pub(super) fn interrupt(&mut self) {
        self.waits = 0;
        self.next_row_s = f64::NEG_INFINITY;
    }

    pub(super) fn update(&mut self, now: Now, filters: &Filters, sense: &StateTracker, free_row: Option<(f64, f64)>) {
        if let Some((t, lift)) = free_row {
            self.free.push([t, lift]);
        }
        if now.since_s == now.time_s {
            self.waits = 0;
        }
        let carried = now.state == SystemState::HoldAboveGround;
        self.held = carried || matches!(now.state, SystemState::HoldOnGround | SystemState::SlidingOnGround);
        if !self.held {
            self.margin = None;
            if now.state == SystemState::FreeMotion && now.time_s - now.since_s > LET_GO_S {
                self.let_go = true;
                self.objects.iter_mut().for_each(|o| o.hold.let_go());
            }
            return;
        }
        if now.time_s < self.next_row_s {
            return;
        }
        self.next_row_s = now.time_s + self.row_s - 0.5 * filters.period_s();
        let row = row(now.time_s, carried, filters, sense);
        self.margin = self.margin_of(&row);
        if now.time_s - now.since_s > GUARD_S {
            self.wait(row, now.time_s, sense);
        }
    }

    /// Rows go in once their state has lasted on.
    fn wait(&mut self, row: Row, time_s: f64, sense: &StateTracker) {
        self.bias = sense.net_bias();
        self.noise_n = sense.lift_noise_n();
        if self.waits == WAITING {
            self.waiting.copy_within(1.., 0);
            self.waits -= 1;
        }
        self.waiting[self.waits] = row;
        self.waits += 1;
        while self.waits > 0 && self.waiting[0].time_s <= time_s - GUARD_S {
            let ready = self.waiting[0];
            self.waiting.copy_within(1.., 0);
            self.waits -= 1;
            self.take(&ready);
        }
    }

    fn take(&mut self, row: &Row) {
        // A grasp of something that was let go may be of another object; it is one when it is carried.
        if self.let_go && row.carried {
            self.let_go = false;
            self.begin();
        }
        let Some(index) = self.current.filter(|_| !self.let_go) else { return };
        let left = self.left(index, row);
        let changed = self.objects[index].take(row, left.as_ref());
        if let Some((change, before)) = changed {
            if self.events.len() == MOST_EVENTS {
                self.events.remove(0);
            }
            // In the first moments the regressor of the acceleration may explain a change of weight as well. It is a
            // change either way, and the reading tells which.
            let (noticed_s, began_s, grows) = (change.noticed_s, change.began_s, row.lift_n > before);
            self.events.push(Event { object: index, parameter: "weight_N", grows, noticed_s, began_s, before });
        }
        self.tell(index);
    }

    /// Residual force on a carried object after weight and inertia; `None` before both are known.
    fn left(&self, index: usize, row: &Row) -> Option<Left> {
        let (bias, bias_error) = self.bias.filter(|_| row.carried)?;
        let object = &self.objects[index];
        let weight_error = object.weight.std_errors()[0];
        let weight_n = object.weight.values()[0] - bias.y;
        if !weight_error.is_finite() {
            return None;
        }
        let [ax, ay] = row.acceleration;
        let inertia = weight_n / self.gravity * Vec2::new(ax, ay);
        Some(Left {
            time_s: row.time_s,
            at_m: row.at_m,
            force_n: Vec2::new(row.across_n, row.lift_n) - bias - Vec2::new(0.0, weight_n) - inertia,
            noise_n: self.noise_n.max(1e-4),
            common_n: Vec2::new(ax * weight_error / self.gravity, weight_error)
                .map(|e| e.hypot(bias_error).hypot(Left::model_n(weight_n))),
        })
    }

    fn begin(&mut self) {
        let index = if self.task == Task::Barrel { 0 } else { self.count.min(MOST_OBJECTS - 1) };
        if self.task == Task::Barrel && self.count > 0 {
            return;
        }
        self.objects[index].clear();
        self.current = Some(index);
        self.count = (index + 1).max(self.count);
    }

    /// Once it was carried for a moment: is it one that was carried before?
    fn tell(&mut self, index: usize) {
        if self.objects[index].told || self.objects[index].carried_rows < TELL_ROWS {
            return;
        }
        self.objects[index].told = true;
        let signature = |o: &GraspRecord| (mean_width(o), o.weight.values()[0]);
        let (width, weight) = signature(&self.objects[index]);
        let near = |a: f64, b: f64, share: f64| (a - b).abs() < share * b.abs();
        let same = (0..self.count).find(|k| {
            let (w, g) = signature(&self.objects[*k]);
            *k != index && near(width, w, SAME_WIDTH) && near(weight, g, SAME_WEIGHT)
        });
        if let Some(same) = same {
            self.objects[index].clear();
            (self.current, self.count) = (Some(same), self.count - usize::from(index + 1 == self.count));
        }
    }

    fn margin_of(&self, row: &Row) -> Option<f64> {
        let object = &self.objects[self.current?];
        let (bound, error) = object.bound?;
        let (ratio, _) = row.ratio?;
        let held = bound - error;
        (held > 0.0).then(|| 1.0 - ratio / held)
    }

    fn name(&self, index: usize) -> String {
        if self.task == Task::Barrel { "barrel".to_owned() } else { format!("block-{}", index + 1) }
    }

    pub(super) fn report(&self, sense: &StateTracker, report: &mut Report) {
        for (index, object) in self.objects[..self.count].iter().enumerate() {
            let name = self.name(index);
            report.parameters.extend(weight(&name, object, sense, self.gravity));
            report.parameters.push(width(&name, object));
            report.parameters.push(grip_stiffness(&name, object));
            report.parameters.push(friction(&name, object));
            if self.task != Task::Barrel {
                let why = "only a slip shows it; the lower bound is the largest ratio that held";
                report.parameters.push(Parameter::unidentified(&name, "friction", 0, why));
            }
            if let Some(answer) = self.leak(index).filter(|a| a.verdict != Verdict::Steady) {
                report.parameters.push(leak_parameter(&name, &answer, object.carried_rows as usize));
                report.leaks.push((name, answer));
            }
        }
        report.events.extend_from_slice(&self.events);
        report.slip_margin = self.margin;
        report.held = self.current.filter(|_| self.held).map(|index| self.name(index));
        report.pulls = (0..self.count).filter_map(|k| self.objects[k].hold.pull(k)).collect();
    }

    /// Leak or drift of one object, from its readings and those of the others; `None` while there are too few.
    fn leak(&self, index: usize) -> Option<LeakAnswer> {
        const LEAST_ROWS: usize = 40;
        let object = &self.objects[index];
        if object.reading.rows().len() < LEAST_ROWS {
            return None;
        }
        // The mass that belongs to the weight: better known than that of the accelerations.
        let rows = object.reading.rows();
        let mass = rows.iter().map(|r| r[1]).sum::<f64>() / rows.len() as f64 / self.gravity;
        let time = object.reading.column(0);
        let lift: Vec<f64> = rows.iter().map(|r| r[1] - mass * r[2]).collect();
        let across: Vec<f64> = rows.iter().map(|r| r[4] - mass * r[3]).collect();
        let fingers = [5, 6].map(|k| rows.iter().map(|r| r[k] - 0.5 * mass * r[2]).collect::<Vec<f64>>());
        let (free_s, free_n) = (self.free.column(0), self.free.column(1));
        let others: Vec<(Vec<f64>, Vec<f64>)> = (0..self.count)
            .filter(|k| *k != index)
            .map(|k| (self.objects[k].reading.column(0), self.objects[k].reading.column(1)))
            .collect();
        let others: Vec<Series<'_>> = others.iter().map(|(t, f)| Series { time_s: t, force_n: f }).collect();
        let weighing = Weighing {
            others: &others,
            across_n: Some(&across),
            fingers_n: Some([&fingers[0], &fingers[1]]),
            ..Weighing::new(
                Series { time_s: &time, force_n: &lift },
                Series { time_s: &free_s, force_n: &free_n },
                self.gravity,
            )
        };
        leak_or_drift(&weighing).ok()
    }

    pub(super) fn problems(&self, sense: &StateTracker) -> Vec<Problem> {
        let bias_error = sense.lift_bias().map(|(_, error)| error);
        let each = |(index, object): (usize, &GraspRecord)| {
            block_problems(&self.name(index), object, bias_error, sense.lift_noise_n(), self.row_s, FREE_ROW_S)
        };
        self.objects[..self.count].iter().enumerate().flat_map(each).collect()
    }
}

fn row(time_s: f64, carried: bool, filters: &Filters, sense: &StateTracker) -> Row {
    let pick = |s: &Sample| {
        [
            s[9] + s[11],
            s[8] + s[10],
            s[9],
            s[11],
            0.5 * (s[8] - s[10]),
            s[2] - s[0],
            0.5 * (s[4] + s[6]),
            0.5 * (s[5] + s[7]),
            0.5 * (s[0] + s[2]),
            0.5 * (s[1] + s[3]),
        ]
    };
    let (value, slope) = filters.smooth(pick);
    let bias = sense.bias_n();
    let calm = filters.calm(|s: &Sample| [s[8], s[9], s[10], s[11]]);
    let force = [Vec2::new(calm[0], calm[1]) - bias[0], Vec2::new(calm[2], calm[3]) - bias[1]];
    let grip_n = value[4] - 0.5 * (bias[0].x - bias[1].x);
    let noise = (0.7 * sense.lift_noise_n()).max(1e-4);
    let ratios = [(force[0], 1.0), (force[1], -1.0)].map(|(f, way): (Vec2, f64)| (f.y.abs(), way * f.x));
    let ratio = ratios
        .into_iter()
        .filter(|(_, normal)| *normal > (10.0 * noise).max(0.25 * grip_n))
        .map(|(shear, normal)| (shear / normal, noise * (shear / normal).hypot(1.0) / normal))
        .reduce(|a, b| if b.0 > a.0 { b } else { a });
    Row {
        time_s,
        lift_n: value[0],
        across_n: value[1],
        fingers_n: [value[2], value[3]],
        grip_n,
        width_m: value[5],
        width_rate_m_s: slope[5],
        acceleration: [slope[6], slope[7]],
        at_m: Vec2::new(value[8], value[9]),
        ratio,
        carried,
    }
}
