//! Where the operator means to go: a speed over time, in knots that are joined smoothly.

use super::chance::Chance;

/// How the recording goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Log {
    /// Turns both ways, strokes, small to-and-fro, at many speeds.
    Mixed,
    /// One way at speeds that vary.
    OneWay,
    /// One way at one speed.
    Steady,
    /// As mixed, five times as slow.
    Slow,
    /// As mixed, with a pull of one sign only.
    PullOnly,
}

impl Log {
    /// Every kind.
    pub const ALL: [Self; 5] = [Self::Mixed, Self::OneWay, Self::Steady, Self::Slow, Self::PullOnly];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mixed => "mixed",
            Self::OneWay => "one-way",
            Self::Steady => "steady",
            Self::Slow => "slow",
            Self::PullOnly => "pull-only",
        }
    }

    /// True where the motion changes its direction.
    pub fn reverses(self) -> bool {
        !matches!(self, Self::OneWay | Self::Steady)
    }
}

/// A planned motion: rad/s (or m/s divided by the mechanism's length) over time.
#[derive(Clone, Debug)]
pub struct Plan {
    knots: Vec<(f64, f64)>,
    at: usize,
    /// Pull across the motion that is meant, N over time; nothing where none is.
    pulls: Vec<(f64, f64)>,
}

impl Plan {
    pub(super) fn starting(start_s: f64) -> Self {
        Self { knots: vec![(0.0, 0.0), (start_s, 0.0)], at: 0, pulls: Vec::new() }
    }

    pub(super) fn end(&self) -> f64 {
        self.knots.last().map_or(0.0, |k| k.0)
    }

    pub(super) fn knot(&mut self, after_s: f64, speed: f64) {
        let time = self.end() + after_s.max(0.02);
        self.knots.push((time, speed));
    }

    /// Means to pull `force_n` across the motion from now on.
    pub(super) fn pull(&mut self, force_n: f64) {
        self.pulls.push((self.end(), force_n));
    }

    /// The pull across the motion that is meant, N, outward.
    pub fn pull_n(&self, time_s: f64) -> Option<f64> {
        let last = *self.pulls.last()?;
        let next = self.pulls.partition_point(|p| p.0 <= time_s);
        let (Some((t0, p0)), Some((t1, p1))) = (next.checked_sub(1).map(|k| self.pulls[k]), self.pulls.get(next))
        else {
            return Some(if next == 0 { self.pulls[0].1 } else { last.1 });
        };
        Some(p0 + (p1 - p0) * (time_s - t0) / (t1 - t0).max(1e-9))
    }

    /// From one rest to the next by `angle` within `duration_s`.
    pub(super) fn stroke(&mut self, angle: f64, duration_s: f64) {
        // A smooth rise and fall of the speed: the area is half of peak times duration.
        self.knot(0.5 * duration_s, 2.0 * angle / duration_s);
        self.knot(0.5 * duration_s, 0.0);
    }

    /// Planned speed at `time_s`; times must come in order.
    pub fn speed(&mut self, time_s: f64) -> f64 {
        while self.at + 1 < self.knots.len() && self.knots[self.at + 1].0 <= time_s {
            self.at += 1;
        }
        let (t0, w0) = self.knots[self.at];
        let Some(&(t1, w1)) = self.knots.get(self.at + 1) else { return w0 };
        let x = ((time_s - t0) / (t1 - t0)).clamp(0.0, 1.0);
        w0 + (w1 - w0) * x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)
    }

    /// A crank turned between two instants.
    pub fn turning(log: Log, start_s: f64, end_s: f64, chance: &mut Chance) -> Self {
        let mut plan = Self::starting(start_s);
        let pace = if log == Log::Slow { 0.2 } else { 1.0 } * chance.of_order(0.8, 1.25);
        let way = chance.sign();
        if log.reverses() {
            let mut way = way;
            let mut action = 0;
            while plan.end() < end_s - 0.8 {
                let left = end_s - 0.4 - plan.end();
                plan.some_turning(action, way, pace, left, chance);
                way = if action < 2 { -way } else { chance.sign() };
                action += 1;
            }
        } else {
            let speed = way * pace * chance.between(3.0, 6.0);
            plan.knot(0.6, speed);
            while plan.end() < end_s - 1.6 {
                let factor = if log == Log::Steady { 1.0 } else { chance.of_order(0.3, 1.7) };
                plan.knot(chance.between(0.4, 1.1), speed * factor);
            }
            let rest = end_s - 0.5 - plan.end();
            plan.knot(rest, 0.0);
        }
        plan
    }

    /// Full turns first, both ways; then anything.
    fn some_turning(&mut self, action: u32, way: f64, pace: f64, left_s: f64, chance: &mut Chance) {
        let end = self.end() + left_s;
        let kind = if action < 2 { 0.0 } else { chance.between(0.0, 1.0) };
        if kind < 0.5 {
            let speed = way * pace * chance.of_order(2.5, 8.5);
            let angle = chance.between(1.1, 2.6) * std::f64::consts::TAU;
            let duration = (angle / speed.abs()).min((0.45 * left_s).max(1.0)).min((end - self.end() - 0.8).max(0.2));
            self.knot(chance.between(0.25, 0.5), speed);
            let stop = self.end() + duration;
            while self.end() + 0.3 < stop {
                self.knot(chance.between(0.3, 0.8), speed * chance.of_order(0.5, 1.5));
            }
            self.knot(chance.between(0.25, 0.5), 0.0);
        } else {
            let small = kind > 0.82;
            let strokes = chance.whole(3, 8);
            let mut way = way;
            for _ in 0..strokes {
                let angle = if small { chance.of_order(0.06, 0.4) } else { chance.of_order(0.4, 3.0) };
                let duration = (angle / (pace * chance.between(1.2, 4.0))).max(0.22 / pace.min(1.0));
                if self.end() + duration > end {
                    break;
                }
                self.stroke(way * angle, duration);
                way = -way;
                if chance.happens(0.2) {
                    self.knot(chance.between(0.05, 0.3), 0.0);
                }
            }
        }
        self.knot(chance.between(0.05, 0.25), 0.0);
    }

    /// A mechanism moved to and fro within ±`range` of where it starts, or on and on one way.
    pub fn stroking(log: Log, range: f64, start_s: f64, end_s: f64, chance: &mut Chance) -> Self {
        let mut plan = Self::starting(start_s);
        let pace = if log == Log::Slow { 0.2 } else { 1.0 };
        let way = chance.sign();
        let mut place = 0.0;
        if !log.reverses() {
            // A long slide, or a spindle: it goes on as long as the recording.
            let speed = way * range / 3.0;
            plan.knot(0.4, speed);
            while plan.end() < end_s - 1.2 {
                let factor = if log == Log::Steady { 1.0 } else { chance.of_order(0.3, 1.8) };
                plan.knot(chance.between(0.3, 0.8), speed * factor);
            }
            plan.knot(0.4, 0.0);
            return plan;
        }
        let mut first = true;
        while plan.end() < end_s - 0.7 {
            let small = !first && chance.happens(0.2);
            let target: f64 = if small {
                place + chance.sign() * range * chance.of_order(0.02, 0.15)
            } else if first {
                way * range
            } else {
                chance.between(-range, range)
            };
            first = false;
            let target = target.clamp(-range, range);
            let by = target - place;
            let duration = (by.abs() / (range * pace * chance.of_order(0.4, 1.7))).max(0.25 / pace.min(1.0));
            let duration = duration.min(end_s - 0.1 - plan.end());
            if duration < 0.2 {
                break;
            }
            plan.stroke(by, duration);
            place = target;
            if chance.happens(0.25) {
                plan.knot(chance.between(0.05, 0.4), 0.0);
            }
        }
        plan
    }
}
