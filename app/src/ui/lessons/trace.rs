//! What a hand did, thinned for pictures: the expert's and the trainee's beside each other.

use crate::text::sentence::sentence;
use estimator::training::lesson::Lesson;
use estimator::training::lesson::perform::perform;
use haptics::Vec2;
use haptics::device::{HandImpedance, Skill};
use haptics::recording::Recording;

/// Points a second.
const RATE_HZ: f64 = 30.0;
/// A finger that presses more than this touches, N.
pub(super) const TOUCH_N: f64 = 0.05;
/// The expert of the ghost always does it the same way.
const SEED: u64 = 7;

/// One moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Since the beginning, s.
    pub time_s: f64,
    /// Where the tips are, m in the world.
    pub tips_in_world: [Vec2; 2],
    /// Force of each tip on the world, N.
    pub tip_force_n: [Vec2; 2],
}

/// What a hand did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// At even times.
    pub points: Vec<Point>,
}

impl Trace {
    /// Where the hand is at a time since the hand's first motion, s; after the end where it ended.
    pub fn at(&self, time_s: f64) -> Option<&Point> {
        let index = (time_s.max(0.0) * RATE_HZ) as usize;
        self.points.get(index).or(self.points.last())
    }

    /// Length, s.
    pub fn duration_s(&self) -> f64 {
        self.points.last().map_or(0.0, |p| p.time_s)
    }

    /// Middle between the tips, m.
    pub fn middles(&self) -> impl Iterator<Item = Vec2> {
        self.points.iter().map(Point::middle_m)
    }

    fn push(&mut self, time_s: f64, tips_in_world: [Vec2; 2], tip_force_n: [Vec2; 2]) {
        if self.points.last().is_none_or(|last| time_s - last.time_s >= 1.0 / RATE_HZ - 1e-9) {
            self.points.push(Point { time_s, tips_in_world, tip_force_n });
        }
    }
}

impl Point {
    /// Middle between the tips, m in the world.
    pub fn middle_m(&self) -> Vec2 {
        0.5 * (self.tips_in_world[0] + self.tips_in_world[1])
    }

    /// True while something is touched.
    pub fn touches(&self) -> bool {
        self.tip_force_n.iter().any(|f| f.norm() > TOUCH_N)
    }

    /// How hard both fingers press against each other, N.
    pub fn grip_n(&self) -> f64 {
        let [left, right] = [self.tip_force_n[0].x, -self.tip_force_n[1].x];
        if left.min(right) > 0.0 { 0.5 * (left + right) } else { 0.0 }
    }

    /// Where the middle between the fingers is wanted, m in the world: the arms' springs give by the force on them.
    pub fn wanted_m(&self) -> Vec2 {
        let give = (self.tip_force_n[0] + self.tip_force_n[1]) / (2.0 * HandImpedance::default().stiffness_n_m);
        self.middle_m() + give
    }
}

/// The scripted expert does a lesson, unseen.
pub(super) fn of_expert(lesson: &Lesson) -> Result<Trace, String> {
    let done = perform(lesson, 0, Skill::expert(), SEED).map_err(|error| sentence(&error.to_string()))?;
    let mut trace = Trace::default();
    let first_s = done.ticks.first().map_or(0.0, |tick| tick.time_s);
    for tick in &done.ticks {
        trace.push(tick.time_s - first_s, tick.input.tip_in_world, tick.tip_force_n);
    }
    Ok(trace)
}

/// What the hand in a recording did; nothing without two fingers and a clock.
pub fn trace_of(recording: &Recording) -> Trace {
    let mut trace = Trace::default();
    let Some(time_s) = &recording.time_s else { return trace };
    let channel = |name: &str| recording.channel(name).unwrap_or_default();
    let [x1, y1, x2, y2] = ["x1_m", "y1_m", "x2_m", "y2_m"].map(channel);
    let [fx1, fy1, fx2, fy2] = ["fx1_N", "fy1_N", "fx2_N", "fy2_N"].map(channel);
    let pair = |x: &[f64], y: &[f64], i: usize| x.get(i).zip(y.get(i)).map(|(x, y)| Vec2::new(*x, *y));
    let first_s = time_s.first().copied().unwrap_or_default();
    for (i, now_s) in time_s.iter().enumerate() {
        let (Some(left), Some(right)) = (pair(x1, y1, i), pair(x2, y2, i)) else { continue };
        let force = |x: &[f64], y: &[f64]| pair(x, y, i).unwrap_or_default();
        trace.push(now_s - first_s, [left, right], [force(fx1, fy1), force(fx2, fy2)]);
    }
    trace
}
