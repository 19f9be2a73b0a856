//! Pendulums that are let go, carts that coast and masses on springs, with something hidden in them: an integrator and sensors that share
//! nothing with the estimator.
//!
//! RK4 at 20 kHz with set-valued dry friction (what stops sticks until what pulls exceeds it). Units are SI; angles are from hanging plus
//! `Case::zero_rad`.

use haptics::recording::{Channel, Meta, Recording, Task};
use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};

/// Steps a second of the integrator.
const STEPS_HZ: f64 = 20_000.0;

/// What is in the object beside its inertia, gravity, viscous and dry friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hidden {
    /// Nothing.
    Nothing,
    /// Nothing either: the model is what lacks it.
    Viscous,
    /// The same.
    Coulomb,
    /// Air.
    Drag,
    /// A spring about hanging (about some place of a slide).
    Spring,
    /// Friction that falls with speed (`1/(1 + (v/vs)²)`: not the form of the catalogue).
    Stribeck,
    /// Friction that is another one from some time on.
    Change,
    /// A place that rubs (a cosine's hump: not the form of the catalogue).
    Place,
    /// Cogging.
    Ripple,
    /// A stop on one side, with some damping of its own.
    Wall,
    /// Friction that is larger in one direction.
    Asymmetry,
    /// A slope.
    Tilt,
}

/// One object, its motion and the instruments.
#[derive(Clone, Debug)]
pub struct Case {
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Angle or length.
    pub is_angular: bool,
    /// kg m² or kg.
    pub inertia: f64,
    /// N m
    pub moment: f64,
    /// N m s or N s/m.
    pub viscous: f64,
    /// N m or N.
    pub dry: f64,
    /// What is hidden …
    pub hidden: Hidden,
    /// … its size, in the unit of its law …
    pub size: f64,
    /// … and what else it needs: a speed, a time, a place, a length.
    pub more: f64,
    /// Coordinate at which it hangs.
    pub zero_rad: f64,
    /// From where, and how fast, it is let go.
    pub start: [f64; 2],
    /// s
    pub seconds: f64,
    /// Hz
    pub rate_hz: f64,
    /// White noise of the place, …
    pub noise: f64,
    /// … its steps, …
    pub step: f64,
    /// … and noise of the recorded rate, if one is.
    pub rate_noise: Option<f64>,
    /// What the sidecar knows.
    pub known: Vec<(String, f64)>,
}

impl Case {
    /// A pendulum of random make with its instruments. `size`: how large what is hidden is, 1 being a usual size.
    pub fn pendulum(seed: u64, hidden: Hidden, size: f64) -> Self {
        let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(7919) ^ 0x5eed);
        let mut draw = |low: f64, high: f64| low * (high / low).powf(rng.random::<f64>());
        let inertia = draw(2e-3, 5e-2);
        let swing = draw(3.0, 8.0);
        let moment = inertia * swing * swing;
        let amplitude = draw(0.1, 3.0_f64);
        let top_speed = 2.0 * swing * (0.5 * amplitude).sin();
        let viscous = inertia * draw(0.02, 0.15);
        let dry = moment * draw(0.0008, 0.004) * amplitude.min(1.0);
        let (size, more) = match hidden {
            Hidden::Nothing => (0.0, 0.0),
            Hidden::Viscous => (viscous, 0.0),
            Hidden::Coulomb => (dry, 0.0),
            Hidden::Drag => (size * draw(0.5, 2.0) * viscous / top_speed, 0.0),
            Hidden::Spring => (size * draw(0.05, 0.3) * moment, 0.0),
            Hidden::Stribeck => (size * draw(0.7, 1.5) * dry, draw(0.1, 0.3) * top_speed),
            Hidden::Change => (size * draw(0.5, 1.0), draw(0.3, 0.6)),
            Hidden::Place => (size * draw(1.0, 3.0) * dry, draw(0.05, 0.4) * amplitude),
            Hidden::Ripple => (size * draw(0.01, 0.03) * moment * amplitude.min(1.0), draw(0.15, 0.4) * amplitude),
            Hidden::Wall => (size * draw(2.0, 8.0) * moment, draw(0.5, 0.8) * amplitude),
            Hidden::Asymmetry => (size * draw(0.5, 0.9) * dry, 0.0),
            Hidden::Tilt => (size * draw(0.02, 0.1), 0.0),
        };
        let rates = [50.0, 100.0, 200.0, 500.0, 1000.0];
        let rate_hz = rates[(draw(1.0, 6.0) as usize - 1).min(4)];
        let rate_noise = (draw(1.0, 3.0) > 2.0).then(|| top_speed * draw(0.001, 0.02));
        // A resolver or a camera with noise, or an encoder with steps.
        let noise = draw(2e-5, 1e-3) * amplitude.clamp(0.3, 1.0);
        let has_steps = draw(1.0, 3.0) > 1.9;
        let step = if has_steps { std::f64::consts::TAU / (4.0 * draw(500.0, 5000.0)) } else { 1e-6 };
        let zero_rad = if draw(1.0, 3.0) > 1.8 { draw(0.01, 1.6) } else { 0.0 };
        let known = match (draw(1.0, 3.99) as usize, moment / 9.81) {
            (1, _) => vec![("inertia_kg_m2".to_owned(), inertia)],
            (2, arm) => vec![("mass_kg".to_owned(), 4.0 * arm), ("com_m".to_owned(), 0.25)],
            _ => Vec::new(),
        };
        let seconds = draw(15.0, 40.0);
        Self {
            seed,
            is_angular: true,
            inertia,
            moment,
            viscous,
            dry,
            hidden,
            size,
            more,
            zero_rad,
            start: [amplitude, 0.0],
            seconds,
            rate_hz,
            noise: if has_steps { 0.2 * step } else { noise },
            step,
            rate_noise,
            known,
        }
    }

    /// A cart that coasts down, up a slope and back, or to and fro on a spring.
    pub fn cart(seed: u64, hidden: Hidden, size: f64) -> Self {
        let mut like = Self::pendulum(seed, Hidden::Nothing, 0.0);
        let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(104_729) ^ 0xca47);
        let mut draw = |low: f64, high: f64| low * (high / low).powf(rng.random::<f64>());
        let inertia = draw(0.3, 3.0);
        let speed = draw(0.3, 1.2);
        let (viscous, dry) = (inertia * draw(0.03, 0.2), inertia * draw(0.03, 0.15));
        let way = 0.5 * speed * speed * inertia / dry;
        let (size, more) = match hidden {
            Hidden::Drag => (size * draw(0.5, 2.0) * dry / (speed * speed), 0.0),
            Hidden::Spring => (inertia * draw(3.0, 9.0_f64).powi(2), draw(0.01, 0.2)),
            Hidden::Stribeck => (size * draw(0.7, 1.5) * dry, draw(0.1, 0.3) * speed),
            Hidden::Place => (size * draw(1.0, 3.0) * dry, draw(0.1, 0.25) * way),
            Hidden::Ripple => (size * draw(0.2, 0.6) * dry, draw(0.05, 0.1) * way),
            Hidden::Tilt => (size * draw(0.02, 0.06), 0.0),
            Hidden::Viscous => (viscous, 0.0),
            Hidden::Coulomb => (dry, 0.0),
            _ => (0.0, 0.0),
        };
        if hidden == Hidden::Tilt {
            // It must come back.
            like.seconds = 2.5 * speed / (9.81 * size);
        } else {
            like.seconds = if hidden == Hidden::Spring { 15.0 } else { 1.3 * speed * inertia / dry };
        }
        like.noise = draw(1e-5, 2e-4);
        like.step = if draw(1.0, 3.0) > 2.0 { draw(2e-5, 4e-4) } else { 1e-7 };
        like.rate_noise = like.rate_noise.map(|_| speed * draw(0.001, 0.02));
        like.known = if draw(1.0, 3.0) > 2.0 { vec![("mass_kg".to_owned(), inertia)] } else { Vec::new() };
        Self {
            is_angular: false,
            inertia,
            moment: 0.0,
            viscous,
            dry,
            hidden,
            size,
            more,
            zero_rad: 0.0,
            start: [0.0, speed],
            ..like
        }
    }

    /// Friction that holds, in this place and time, at the slowest speed.
    fn dry_at(&self, [q, v]: [f64; 2], time_s: f64) -> f64 {
        let more = match self.hidden {
            Hidden::Stribeck => self.size / (1.0 + (v / self.more).powi(2)),
            Hidden::Change if time_s > self.more * self.seconds => self.size * self.dry,
            Hidden::Place => {
                let away = (q - self.more).abs() / (0.2 * self.start[0].abs().max(2.0 * self.more));
                if away < 1.0 { 0.5 * self.size * (1.0 + (std::f64::consts::PI * away).cos()) } else { 0.0 }
            }
            Hidden::Asymmetry => self.size * v.signum(),
            _ => 0.0,
        };
        self.dry + more
    }

    /// Force of everything but dry friction, N m or N.
    fn pull(&self, [q, v]: [f64; 2]) -> f64 {
        let hidden = match self.hidden {
            Hidden::Drag => self.size * v * v.abs(),
            Hidden::Spring => self.size * (q - if self.is_angular { 0.0 } else { self.more }),
            Hidden::Ripple => self.size * (std::f64::consts::TAU * q / self.more + 1.0).sin(),
            Hidden::Wall if q > self.more => (self.size * (q - self.more) + 0.0002 * self.size * v).max(0.0),
            Hidden::Tilt => self.inertia * 9.81 * self.size.sin(),
            _ => 0.0,
        };
        -(self.moment * q.sin() + self.viscous * v + hidden)
    }

    fn rate(&self, state: [f64; 2], side: f64, time_s: f64) -> [f64; 2] {
        let dry =
            if side == 0.0 { 0.0 } else { side * self.dry_at([state[0], side * state[1].abs().max(1e-12)], time_s) };
        [state[1], (self.pull(state) - dry) / self.inertia]
    }

    /// One step of the integrator; what turns round on the way stops there and is asked whether it sticks.
    fn step(&self, state: [f64; 2], time_s: f64) -> [f64; 2] {
        let h = 1.0 / STEPS_HZ;
        let next = self.part(state, time_s, h);
        if next[1] * state[1] >= 0.0 {
            return next;
        }
        let before_s = h * state[1].abs() / (state[1].abs() + next[1].abs());
        let turned = self.part(state, time_s, before_s);
        self.part([turned[0], 0.0], time_s + before_s, h - before_s)
    }

    /// A part of a step in which nothing turns round.
    fn part(&self, state: [f64; 2], time_s: f64, h: f64) -> [f64; 2] {
        let mut side = state[1].signum();
        if state[1] == 0.0 {
            let pull = self.pull(state);
            side = pull.signum();
            if pull.abs() <= self.dry_at([state[0], 1e-12 * side], time_s) {
                return state;
            }
        }
        let at = |k: [f64; 2], by: f64| [state[0] + by * k[0], state[1] + by * k[1]];
        let k1 = self.rate(state, side, time_s);
        let k2 = self.rate(at(k1, 0.5 * h), side, time_s);
        let k3 = self.rate(at(k2, 0.5 * h), side, time_s);
        let k4 = self.rate(at(k3, h), side, time_s);
        std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    }

    /// As it is recorded.
    pub fn recording(&self) -> Recording {
        let mut rng = StdRng::seed_from_u64(self.seed ^ 0x0b5e);
        let mut normal = || {
            let (a, b) = (rng.random::<f64>().max(1e-300), rng.random::<f64>());
            (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
        };
        let per_sample = (STEPS_HZ / self.rate_hz).round() as usize;
        let mut state = self.start;
        let (mut time_s, mut place, mut rate) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..(self.seconds * STEPS_HZ) as usize {
            let now_s = k as f64 / STEPS_HZ;
            if k % per_sample == 0 {
                time_s.push(now_s);
                let measured = state[0] + self.zero_rad + self.noise * normal();
                place.push((measured / self.step).round() * self.step);
                rate.push(state[1] + self.rate_noise.unwrap_or(0.0) * normal());
            }
            state = self.step(state, now_s);
        }
        let names =
            if self.is_angular { [("q_rad", "rad"), ("dq_rad_s", "rad/s")] } else { [("q_m", "m"), ("dq_m_s", "m/s")] };
        let channel =
            |(name, unit): (&str, &str), values| Channel { name: name.to_owned(), unit: unit.to_owned(), values };
        let mut channels = vec![channel(names[0], place)];
        if self.rate_noise.is_some() {
            channels.push(channel(names[1], rate));
        }
        let known = self.known.iter().cloned().collect();
        Recording {
            name: format!("free {}", self.seed),
            time_s: Some(time_s),
            channels,
            meta: Meta { known, task: Some(Task::Mechanism), ..Meta::default() },
            ..Recording::default()
        }
    }
}
