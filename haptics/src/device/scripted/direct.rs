//! The scripted operator at a directly driven mechanism, without fingers: a spring and a damper between the wanted and
//! the actual coordinate. The result is the motion and its drive, as in a recording of a mechanism.

use super::noise::{Tremor, Wander};
use crate::law::{Coordinate, Memories, Motion, drive_force, inertia, step_coordinate_with};
use crate::recording::{Channel, Recording, Task};
use crate::world::Mechanism;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, Normal};

/// Longest step, s, and in radians of the hand's own swing.
const LONGEST_STEP_S: f64 = 2e-4;
const STEP_RAD: f64 = 0.05;
/// Least natural frequency of a hand with the load it holds, rad/s; [`AHEAD`] is its least ratio to that of the motion
/// it follows.
const SLOWEST_RAD_S: f64 = 30.0;
const AHEAD: f64 = 12.0;
/// Largest deflection of the hand by the resistance, as a share of the way.
const YIELD: f64 = 0.05;
/// Damping ratio of the hand.
const DAMPED: f64 = 0.75;
/// Slow wandering (in those of a pinch) and tremor of where it is wanted, as shares of the way.
const WANDERS: f64 = 0.15;
const TREMBLES: f64 = 7e-4;
/// The wish to end is looked at so often, samples.
const LOOKS: usize = 200;

/// Experiment to be done with a mechanism.
pub struct Pull<'a> {
    /// Mechanism that is driven.
    pub mechanism: &'a Mechanism,
    /// Duration, s.
    pub seconds: f64,
    /// Samples a second.
    pub rate_hz: f64,
    /// Wanted coordinate at a time, m or rad.
    pub wanted: &'a dyn Fn(f64) -> f64,
    /// Largest excursion to either side, m or rad.
    pub half_range: f64,
    /// Its fastest speed, m/s or rad/s.
    pub fast: f64,
}

/// One sample of a pulled mechanism.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pulled {
    /// Since the beginning, s.
    pub time_s: f64,
    /// m or rad.
    pub position: f64,
    /// m/s or rad/s.
    pub rate: f64,
    /// Drive along the coordinate, N or N m.
    pub drive: f64,
}

/// White noise of the sensors at a mechanism, one a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PullSensor {
    /// Of the coordinate, m or rad.
    pub position: f64,
    /// Of its rate, m/s or rad/s; absent: no rate is recorded.
    pub rate: Option<f64>,
    /// Of the drive, N or N m.
    pub drive: f64,
}

impl Pull<'_> {
    /// Stiffness and damping of the hand, N/m and N s/m (N m/rad and N m s/rad); an error says why nothing can be pulled.
    fn hand(&self) -> Result<(f64, f64), String> {
        let effects = &self.mechanism.effects;
        let mass = inertia(effects);
        let sane = [self.seconds, self.rate_hz, self.half_range, self.fast].iter().all(|v| v.is_finite() && *v > 0.0);
        if !sane {
            return Err("The experiment has no length, rate, way or speed; nothing can be done with it.".to_owned());
        }
        if !(mass.is_finite() && mass > 0.0) {
            return Err(
                "This mechanism has no inertia, so nothing says how it moves; record it with faster motions and fit again."
                    .to_owned(),
            );
        }
        let (position, velocity) = ((self.wanted)(0.0), self.fast);
        let motion = Motion { position, velocity, direction: 1.0, ..Motion::default() };
        let resists = drive_force(effects, &motion).abs();
        let swing_rad_s = SLOWEST_RAD_S.max(AHEAD * self.fast / self.half_range);
        let stiffness = (mass * swing_rad_s.powi(2)).max(resists / (YIELD * self.half_range));
        Ok((stiffness, 2.0 * DAMPED * (stiffness * mass).sqrt()))
    }

    /// Does it. `seed` draws the hand's wandering; nothing when `goes_on` (which is told the share done) says no.
    pub fn run(&self, seed: u64, goes_on: &dyn Fn(f64) -> bool) -> Result<Option<Vec<Pulled>>, String> {
        let (stiffness, damping) = self.hand()?;
        let mut rng = StdRng::seed_from_u64(seed);
        let (wander, tremor) = (Wander::new(WANDERS, &mut rng), Tremor::new(TREMBLES * self.half_range, &mut rng));
        let wanted = |t: f64| (self.wanted)(t) + self.half_range * wander.at(t) + tremor.at(t).x;
        let swing_rad_s = (stiffness / inertia(&self.mechanism.effects)).sqrt();
        let period_s = 1.0 / self.rate_hz;
        let parts = (period_s / LONGEST_STEP_S.min(STEP_RAD / swing_rad_s)).ceil().max(1.0);
        let step_s = period_s / parts;
        let count = (self.seconds * self.rate_hz) as usize;
        let mut memories = Memories::default();
        let (mut position, mut rate) = (wanted(0.0), 0.0);
        let drive = |t: f64, position: f64, rate: f64| {
            let speed = (wanted(t + step_s) - wanted(t - step_s)) / (2.0 * step_s);
            stiffness * (wanted(t) - position) + damping * (speed - rate)
        };
        let mut seen = Vec::with_capacity(count);
        for sample in 0..count {
            let begun_s = sample as f64 * period_s;
            seen.push(Pulled { time_s: begun_s, position, rate, drive: drive(begun_s, position, rate) });
            for part in 0..parts as usize {
                let time_s = begun_s + part as f64 * step_s;
                let motion =
                    Motion { time_s, position, velocity: rate, direction: f64::signum(rate), ..Motion::default() };
                let pulled = drive(time_s, position, rate);
                (position, rate) =
                    step_coordinate_with(&self.mechanism.effects, &motion, &mut memories, pulled, 0.0, step_s);
            }
            if sample % LOOKS == 0 && !goes_on(sample as f64 / count as f64) {
                return Ok(None);
            }
        }
        Ok(Some(seen))
    }
}

impl PullSensor {
    /// The recording that comes of it.
    pub fn recording(&self, name: &str, coordinate: Coordinate, pulled: &[Pulled], seed: u64) -> Recording {
        let mut rng = StdRng::seed_from_u64(seed ^ 0x5e45);
        let names = match coordinate {
            Coordinate::Linear => [("q_m", "m"), ("dq_m_s", "m/s"), ("f_N", "N")],
            Coordinate::Angular => [("q_rad", "rad"), ("dq_rad_s", "rad/s"), ("tau_Nm", "N m")],
        };
        let mut channel = |(name, unit): (&str, &str), noise: f64, of: &dyn Fn(&Pulled) -> f64| {
            let white = Normal::new(0.0, noise.max(0.0)).ok();
            let values = pulled.iter().map(|p| of(p) + white.map_or(0.0, |white| white.sample(&mut rng))).collect();
            Channel { name: name.to_owned(), unit: unit.to_owned(), values }
        };
        let mut channels = vec![channel(names[0], self.position, &|p| p.position)];
        channels.extend(self.rate.map(|noise| channel(names[1], noise, &|p| p.rate)));
        channels.push(channel(names[2], self.drive, &|p| p.drive));
        let mut recording = Recording {
            name: name.to_owned(),
            time_s: Some(pulled.iter().map(|p| p.time_s).collect()),
            channels,
            ..Recording::default()
        };
        recording.meta.task = Some(Task::Mechanism);
        recording
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::{CoulombFriction, Effect, Inertia, ViscousFriction};

    fn cart() -> Mechanism {
        let effects = vec![
            Effect::new(&Inertia, &[2.0]),
            Effect::new(&ViscousFriction, &[5.0]),
            Effect::new(&CoulombFriction, &[1.5]),
        ];
        Mechanism { coordinate: Coordinate::Linear, path: None, effects, direction_blur: 0.0 }
    }

    fn pull<'a>(mechanism: &'a Mechanism, wanted: &'a dyn Fn(f64) -> f64) -> Pull<'a> {
        Pull { mechanism, seconds: 10.0, rate_hz: 200.0, wanted, half_range: 0.1, fast: 0.2 }
    }

    #[test]
    fn the_drive_does_the_work_that_friction_and_inertia_take() {
        let wanted = |t: f64| 0.1 * (2.0 * t).sin();
        let cart = cart();
        let seen = pull(&cart, &wanted).run(3, &|_| true).expect("it moves").expect("not ended");
        let worst = seen.iter().map(|p| (p.position - wanted(p.time_s)).abs()).fold(0.0, f64::max);
        assert!(worst < 0.025 && worst > 1e-4, "a hand follows, and not exactly: {worst}");
        // Energy: the input is in the cart or went into friction.
        let (mut put_in, mut lost) = (0.0, 0.0);
        for pair in seen.windows(2) {
            let way = pair[1].position - pair[0].position;
            let rate = 0.5 * (pair[0].rate + pair[1].rate);
            put_in += 0.5 * (pair[0].drive + pair[1].drive) * way;
            lost += 1.5 * way.abs() + 5.0 * rate * way;
        }
        let last = seen.last().expect("samples");
        let kept = 0.5 * 2.0 * last.rate * last.rate;
        assert!((put_in - lost - kept).abs() < 0.02 * put_in, "{put_in} J in, {lost} lost, {kept} kept");
    }

    #[test]
    fn every_seed_is_another_performance_and_the_columns_are_those_of_a_mechanism() {
        let (cart, wanted) = (cart(), |t: f64| 0.1 * (2.0 * t).sin());
        let pull = pull(&cart, &wanted);
        let run = |seed| pull.run(seed, &|_| true).expect("it moves").expect("not ended");
        assert_ne!(run(1), run(2));
        assert_eq!(run(1), run(1));
        assert_eq!(pull.run(1, &|share| share < 0.5), Ok(None), "it can be ended");
        let sensor = PullSensor { position: 1e-4, rate: None, drive: 0.05 };
        let recording = sensor.recording("cart", Coordinate::Linear, &run(1), 1);
        let names: Vec<&str> = recording.channels.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["q_m", "f_N"]);
        assert_eq!(recording.len(), 2_000);
    }

    #[test]
    fn what_has_no_inertia_is_not_pulled() {
        let mut light = cart();
        light.effects.remove(0);
        let wanted = |_: f64| 0.0;
        let why = pull(&light, &wanted).run(1, &|_| true).expect_err("no inertia");
        assert!(why.contains("no inertia") && why.ends_with('.'), "{why}");
    }
}
