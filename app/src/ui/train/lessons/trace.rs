//! Trace of a hand, thinned for pictures: the expert's and the trainee's side by side.

use crate::text::sentence::sentence;
use estimator::training::lesson::Lesson;
use estimator::training::lesson::perform::perform;
use haptics::Vec2;
use haptics::device::{HandImpedance, Skill};
use haptics::recording::Recording;

/// Points per second.
const RATE_HZ: f64 = 30.0;
/// Force above which a finger is in contact, N.
pub(super) const TOUCH_N: f64 = 0.05;
/// Seed of the ghost's expert, so that it always performs the same way.
const SEED: u64 = 7;

/// State of the hand at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Time since the start, s.
    pub time_s: f64,
    /// Positions of the tips, m in the world.
    pub tips_in_world: [Vec2; 2],
    /// Force of each tip on the world, N.
    pub tip_force_n: [Vec2; 2],
}

/// Trace of a hand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// Points at even times.
    pub points: Vec<Point>,
}

impl Trace {
    /// State of the hand at a time since its first motion, s; the last one after the end.
    pub fn at(&self, time_s: f64) -> Option<&Point> {
        let index = (time_s.max(0.0) * RATE_HZ) as usize;
        self.points.get(index).or(self.points.last())
    }

    /// Length, s.
    pub fn duration_s(&self) -> f64 {
        self.points.last().map_or(0.0, |p| p.time_s)
    }

    /// Midpoints between the tips, m in the world.
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
    /// Midpoint between the tips, m in the world.
    pub fn middle_m(&self) -> Vec2 {
        0.5 * (self.tips_in_world[0] + self.tips_in_world[1])
    }

    /// True while one finger is in contact.
    pub fn touches(&self) -> bool {
        self.tip_force_n.iter().any(|f| f.norm() > TOUCH_N)
    }

    /// Grip force between both fingers, N.
    pub fn grip_n(&self) -> f64 {
        let [left, right] = [self.tip_force_n[0].x, -self.tip_force_n[1].x];
        if left.min(right) > 0.0 { 0.5 * (left + right) } else { 0.0 }
    }

    /// Desired midpoint between the fingers, m in the world: the arms' springs deflect under the force on them.
    pub fn wanted_m(&self) -> Vec2 {
        let give = (self.tip_force_n[0] + self.tip_force_n[1]) / (2.0 * HandImpedance::default().stiffness_n_m);
        self.middle_m() + give
    }
}

/// Trace of the scripted expert in a lesson, performed unseen.
pub(super) fn of_expert(lesson: &Lesson) -> Result<Trace, String> {
    let done = perform(lesson, 0, Skill::expert(), SEED).map_err(|error| sentence(&error.to_string()))?;
    let mut trace = Trace::default();
    let first_s = done.ticks.first().map_or(0.0, |tick| tick.time_s);
    for tick in &done.ticks {
        trace.push(tick.time_s - first_s, tick.input.tip_in_world, tick.tip_force_n);
    }
    Ok(trace)
}

/// Trace of the hand in a recording; empty without two fingers and a clock.
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
