//! Steps hand and load together, 20 000 times a second: implicit where it is stiff (the hand's spring and damper, viscous and dry
//! friction), with dry friction as a set-valued force: a handle that sticks, sticks exactly.

use super::effect::Effect;
use super::hand::{Habits, Hand};
use super::plan::Plan;
use super::plant::{Hidden, Instant, Loads, Memory, Plant};
use super::structure::{Push, Wake};

/// Steps a second.
pub const STEPS_HZ: f64 = 20_000.0;
/// The hand takes hold within this, s.
const GRASP_S: f64 = 0.25;
/// Longest delay that is remembered, in steps.
const LONGEST_DELAY: usize = 4096;

/// Everything that a run needs to know.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The known part.
    pub plant: Plant,
    /// Centre of a crank, m; nothing for a mechanism.
    pub center_m: Option<[f64; 2]>,
    /// Angle at the beginning, rad.
    pub start_angle: f64,
    /// Where the free tip starts and ends, seen from the handle, m.
    pub away_m: [[f64; 2]; 2],
    /// What is hidden.
    pub hidden: Vec<Hidden>,
    /// The person.
    pub habits: Habits,
    /// What the person means to do.
    pub plan: Plan,
    /// Length, s.
    pub seconds: f64,
    /// What changes in the course of a recording has run its course in this time, s: the length of the first recording.
    pub effects_s: f64,
    /// When the hand takes hold and when it lets go, s.
    pub hold_s: [f64; 2],
    /// Samples a second.
    pub rate_hz: f64,
    /// Corner of the filter in front of every channel, Hz.
    pub filter_hz: f64,
    /// Seed of everything random in the run.
    pub seed: u64,
}

/// What an ideal instrument behind the filter sees, and what only the generator knows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    /// Time, s.
    pub time_s: f64,
    /// Tip, m; a mechanism's path is the first number.
    pub tip_m: [f64; 2],
    /// Its speed, m/s.
    pub tip_speed: [f64; 2],
    /// Force of the tip on the handle, N.
    pub force_n: [f64; 2],
    /// The same force where its channel is late.
    pub late_n: [f64; 2],
    /// What the known part takes of the force along the motion, inertia included, N.
    pub base_n: f64,
    /// What each hidden effect takes, N.
    pub extra_n: [f64; 2],
    /// Acceleration along the path, m/s².
    pub acceleration: f64,
    /// Speed along the path, m/s.
    pub speed: f64,
    /// Angle from the horizontal (not wrapped), rad.
    pub angle: f64,
    /// Force across the motion, N.
    pub across_n: f64,
    /// Dry friction of the known part, N.
    pub dry_n: f64,
    /// Traces of the past in a sensor or a pad with structure, for a size of 1.
    pub wake_n: [f64; 2],
    /// True while the hand holds on.
    pub held: bool,
}

/// Channels that go through the filter: tip, speed, force, late force, base, extras, acceleration, speed, angle, across, dry,
/// wake.
const FILTERED: usize = 18;

/// State of a run between two steps.
struct Course {
    turned: f64,
    speed: f64,
    memory: [Memory; 2],
    tip_m: [f64; 2],
    filtered: [f64; FILTERED],
    past: Vec<[f64; 2]>,
    lag_n: [f64; 2],
    wake: Wake,
    wake_n: [f64; 2],
}

/// What a step ends with.
#[derive(Default)]
struct Outcome {
    along_n: f64,
    across_n: f64,
    base_n: f64,
    extra_n: [f64; 2],
    acceleration: f64,
    dry_n: f64,
}

/// Smooth from 0 to 1.
fn ramp(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)
}

impl Setup {
    fn find(&self, effect: Effect) -> Option<&Hidden> {
        self.hidden.iter().find(|h| h.effect == effect)
    }

    /// One step of hand and load.
    fn advance(&self, hand: &mut Hand, course: &mut Course, time_s: f64, softness: f64) -> Outcome {
        let step_s = 1.0 / STEPS_HZ;
        let plant = &self.plant;
        let held = time_s >= self.hold_s[0] && time_s < self.hold_s[1];
        if self.center_m.is_some() && !held {
            course.speed = 0.0;
            return Outcome::default();
        }
        let angle = self.start_angle + course.turned;
        let pull = if held {
            let firmly = ramp((time_s - self.hold_s[0]) / GRASP_S);
            hand.pull(time_s, course.turned, self.center_m.map(|_| angle.sin_cos()), firmly, softness, step_s)
        } else {
            super::hand::Pull::default()
        };
        let across_n = if self.center_m.is_some() { pull.across_n } else { 1.0 };
        let now = Instant {
            turned: course.turned,
            angle,
            speed: course.speed,
            across_n,
            time_s,
            share: time_s / self.effects_s,
        };
        let base = plant.loads(&now);
        let mut extra = [Loads::default(); 2];
        let mut all = base;
        let mut inertia_kg = plant.inertia_kg + plant.hung.inertia;
        for (k, hidden) in self.hidden.iter().enumerate().take(2) {
            extra[k] = hidden.loads(plant, &base, &now, &course.memory[k]);
            all = all.with(extra[k]);
            inertia_kg += hidden.inertia_kg();
        }
        let drive = inertia_kg * course.speed / step_s + pull.along_n - all.smooth_n;
        let (forward, backward) = (all.forward_n.max(0.0), all.backward_n.max(0.0));
        let give = inertia_kg / step_s + pull.per_speed + all.viscous;
        let speed = if drive > forward {
            (drive - forward) / give
        } else if drive < -backward {
            (drive + backward) / give
        } else {
            0.0
        };
        let acceleration = (speed - course.speed) * STEPS_HZ;
        course.speed = speed;
        course.turned += speed * step_s / plant.radius_m;
        for (k, hidden) in self.hidden.iter().enumerate().take(2) {
            hidden.remember(&mut course.memory[k], plant.radius_m * course.turned, speed * step_s);
        }
        let taken = |k: usize| extra[k].at(speed) + self.hidden.get(k).map_or(0.0, Hidden::inertia_kg) * acceleration;
        Outcome {
            along_n: pull.along_n - pull.per_speed * speed,
            across_n,
            base_n: base.at(speed) + (plant.inertia_kg + plant.hung.inertia) * acceleration,
            extra_n: [taken(0), taken(1)],
            acceleration,
            dry_n: base.forward_n,
        }
    }

    /// Where the tip is: on the handle (give of the pad and slips included), or on its way.
    fn tip(&self, course: &Course, time_s: f64, force_n: [f64; 2]) -> [f64; 2] {
        let Some(center) = self.center_m else { return [self.plant.radius_m * course.turned, 0.0] };
        let (sin, cos) = (self.start_angle + course.turned).sin_cos();
        let handle = [center[0] + self.plant.radius_m * cos, center[1] + self.plant.radius_m * sin];
        let [from, until] = self.hold_s;
        let mut away = [0.0; 2];
        if time_s < from {
            let way = 1.0 - ramp((time_s - 0.15) / (from - 0.35));
            away = self.away_m[0].map(|d| d * way);
        } else if time_s >= until {
            let way = ramp((time_s - until - 0.05) / 0.7);
            away = self.away_m[1].map(|d| d * way);
        }
        for hidden in &self.hidden {
            let give = match hidden.effect {
                // Force over stiffness; the hardening one gives more to the first newton.
                Effect::Pad if hidden.form == 0 => force_n.map(|f| f * hidden.size),
                Effect::Pad => {
                    let size = force_n[0].hypot(force_n[1]).max(1e-6);
                    force_n.map(|f| f * hidden.size * size.powf(-1.0 / 3.0))
                }
                Effect::Slip => {
                    let way = self.slipped(hidden, time_s);
                    [hidden.size * way * hidden.shape[0].cos(), hidden.size * way * hidden.shape[0].sin()]
                }
                Effect::GraspCreep => hidden.grasp_m(time_s, course.wake_n),
                _ => [0.0; 2],
            };
            away = [away[0] + give[0], away[1] + give[1]];
        }
        [handle[0] + away[0], handle[1] + away[1]]
    }

    fn slipped(&self, hidden: &Hidden, time_s: f64) -> f64 {
        let share = time_s / self.effects_s;
        let at = |when: f64| ramp((share - when) * self.effects_s / 0.06);
        match hidden.form {
            0 => at(hidden.shape[1]),
            1 => 0.5 * at(0.6 * hidden.shape[1]) + 0.5 * at(hidden.shape[1] + 0.15),
            _ => ((share - hidden.shape[1] * 0.5) / 0.5).clamp(0.0, 1.0),
        }
    }

    /// The force as a late channel has it.
    fn late(&self, course: &mut Course, count: usize, force_n: [f64; 2]) -> [f64; 2] {
        let Some(delay) = self.find(Effect::Delay) else { return force_n };
        if delay.form == 1 {
            let keep = (-1.0 / (STEPS_HZ * delay.size.max(1e-6))).exp();
            course.lag_n = [0, 1].map(|k: usize| force_n[k] + keep * (course.lag_n[k] - force_n[k]));
            return course.lag_n;
        }
        course.past[count % LONGEST_DELAY] = force_n;
        let back = (delay.size * STEPS_HZ).clamp(0.0, (LONGEST_DELAY - 2) as f64);
        let (whole, part) = (back as usize, back.fract());
        let at = |steps: usize| course.past[(count + LONGEST_DELAY - steps) % LONGEST_DELAY];
        let (near, far) = (at(whole), at(whole + 1));
        [0, 1].map(|k| near[k] + part * (far[k] - near[k]))
    }

    /// Runs and samples.
    pub fn run(&self) -> Vec<Sample> {
        let step_s = 1.0 / STEPS_HZ;
        let every = (STEPS_HZ / self.rate_hz).round() as usize;
        let steps = (self.seconds * STEPS_HZ) as usize;
        let keep = (-std::f64::consts::TAU * self.filter_hz * step_s).exp();
        let mut hand = Hand::new(self.habits, self.plan.clone(), self.plant.radius_m, self.seed);
        let mut course = Course {
            turned: 0.0,
            speed: 0.0,
            memory: [Memory::default(); 2],
            tip_m: [0.0; 2],
            filtered: [0.0; FILTERED],
            past: vec![[0.0; 2]; LONGEST_DELAY],
            lag_n: [0.0; 2],
            wake: Wake::default(),
            wake_n: [0.0; 2],
        };
        course.tip_m = self.tip(&course, 0.0, [0.0; 2]);
        let softness = self.find(Effect::Pad).map_or(1.0, |pad| 1.0 / (1.0 + self.habits.stiffness * pad.size));
        let mut samples = Vec::with_capacity(steps / every + 1);
        for count in 0..steps {
            let time_s = count as f64 * step_s;
            hand.think(time_s, course.turned);
            hand.advance(time_s, step_s);
            let outcome = self.advance(&mut hand, &mut course, time_s, softness);
            let raw = self.channels(&mut course, count, time_s, &outcome);
            for (slow, fast) in course.filtered.iter_mut().zip(raw) {
                *slow = if count == 0 { fast } else { fast + keep * (*slow - fast) };
            }
            if count % every == every - 1 {
                samples.push(self.sample(&course, time_s));
            }
        }
        samples
    }

    fn channels(&self, course: &mut Course, count: usize, time_s: f64, outcome: &Outcome) -> [f64; FILTERED] {
        let (sin, cos) = (self.start_angle + course.turned).sin_cos();
        let force = if self.center_m.is_some() {
            [outcome.across_n * cos - outcome.along_n * sin, outcome.across_n * sin + outcome.along_n * cos]
        } else {
            [outcome.along_n, 0.0]
        };
        if let Some(hidden) = self.hidden.iter().find(|h| h.effect.is_structure()) {
            let along = if self.center_m.is_some() { [-sin, cos] } else { [1.0, 0.0] };
            let speed = course.speed / self.plant.radius_m;
            course.wake_n = course.wake.follow(hidden, &Push { force_n: force, along, speed, step_s: 1.0 / STEPS_HZ });
        }
        let tip = self.tip(course, time_s, force);
        let speed = [0, 1].map(|k: usize| (tip[k] - course.tip_m[k]) * STEPS_HZ);
        course.tip_m = tip;
        let late = self.late(course, count, force);
        [
            tip[0],
            tip[1],
            speed[0],
            speed[1],
            force[0],
            force[1],
            late[0],
            late[1],
            outcome.base_n,
            outcome.extra_n[0],
            outcome.extra_n[1],
            outcome.acceleration,
            course.speed,
            course.turned,
            outcome.across_n,
            outcome.dry_n,
            course.wake_n[0],
            course.wake_n[1],
        ]
    }

    fn sample(&self, course: &Course, time_s: f64) -> Sample {
        let f = &course.filtered;
        Sample {
            time_s,
            tip_m: [f[0], f[1]],
            tip_speed: [f[2], f[3]],
            force_n: [f[4], f[5]],
            late_n: [f[6], f[7]],
            base_n: f[8],
            extra_n: [f[9], f[10]],
            acceleration: f[11],
            speed: f[12],
            angle: self.start_angle + f[13],
            across_n: f[14],
            dry_n: f[15],
            wake_n: [f[16], f[17]],
            held: time_s >= self.hold_s[0] && time_s < self.hold_s[1],
        }
    }
}
