//! What varies from case to case beside the effect: object, person, motion, instruments.

use super::arm::Arm;
use super::chance::Chance;
use super::effect::Effect;
use super::hand::Habits;
use super::measure::Known;
use super::plan::{Log, Plan};
use super::plant::{Hidden, Hung, Plant};
use super::sensor::Sensor;
use super::simulate::Setup;
use super::structure;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Nominal link length, m.
pub const LINK_M: f64 = 0.08;

/// What is turned or moved, and by how many fingers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bench {
    /// A crank, one finger in joint form.
    OneFinger,
    /// A crank, two fingers in joint form.
    TwoFingers,
    /// A mechanism that slides.
    Linear,
    /// A mechanism that turns.
    Angular,
}

impl Bench {
    /// True for both cranks.
    pub fn is_crank(self) -> bool {
        matches!(self, Self::OneFinger | Self::TwoFingers)
    }

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::OneFinger => "crank",
            Self::TwoFingers => "crank-2",
            Self::Linear => "linear",
            Self::Angular => "angular",
        }
    }

    /// A usual speed along the path.
    pub fn usual_speed(self) -> f64 {
        match self {
            Self::OneFinger | Self::TwoFingers => 0.08,
            Self::Linear => 0.2,
            Self::Angular => 2.0,
        }
    }
}

/// What is asked of a case.
#[derive(Clone, Debug)]
pub struct Spec {
    /// What is hidden, and in which form.
    pub effects: Vec<(Effect, u32)>,
    /// Effect over noise, each.
    pub ratio: f64,
    /// Structured model error beside it.
    pub structure: Option<Structure>,
    /// What it is hidden in.
    pub bench: Bench,
    /// How the hand moves.
    pub log: Log,
    /// Samples a second.
    pub rate_hz: f64,
    /// Length, s.
    pub seconds: f64,
}

impl Spec {
    /// These effects alone in a quarter of a minute of mixed motion at 100 Hz.
    pub fn hiding(effects: Vec<(Effect, u32)>, ratio: f64, bench: Bench) -> Self {
        Self { effects, ratio, structure: None, bench, log: Log::Mixed, rate_hz: 100.0, seconds: 15.0 }
    }
}

/// A structured force that no law of the catalogue describes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Structure {
    /// Family: one of [`Effect::STRUCTURES`].
    pub effect: Effect,
    /// Its form.
    pub form: u32,
    /// Structure over noise.
    pub ratio: f64,
}

impl Spec {
    /// Sizes over the noise that are asked for: the effects', then the structure's.
    pub fn wanted_ratios(&self) -> Vec<f64> {
        self.effects.iter().map(|_| self.ratio).chain(self.structure.map(|s| s.ratio)).collect()
    }
}

/// The terms that the model of a mechanism starts from.
pub fn known(spec: &Spec) -> Known {
    let has = |effect: Effect| spec.effects.iter().any(|(e, _)| *e == effect);
    if spec.bench.is_crank() {
        if has(Effect::Gain) { Known::CrankOfKnownWeight } else { Known::Crank }
    } else if has(Effect::Viscous) {
        Known::Mass
    } else if has(Effect::Coulomb) {
        Known::MassViscous
    } else {
        Known::MassViscousDry
    }
}

/// The finger: where it stands varies a little.
pub fn arm(chance: &mut Chance) -> Arm {
    Arm { base_m: [chance.between(-0.01, 0.01), chance.between(-0.004, 0.004)], link_m: [LINK_M; 2] }
}

fn plant(spec: &Spec, chance: &mut Chance) -> Plant {
    let mut plant = match spec.bench {
        Bench::OneFinger | Bench::TwoFingers => Plant {
            radius_m: chance.between(0.016, 0.026),
            weight_n: chance.between(0.12, 0.4),
            load_friction: chance.between(0.05, 0.18),
            dry_n: 0.0,
            viscous: chance.between(0.4, 2.0),
            inertia_kg: 3e-5,
            hung: Hung::default(),
        },
        Bench::Linear => Plant {
            radius_m: chance.between(0.03, 0.08),
            weight_n: 0.0,
            load_friction: 0.0,
            dry_n: chance.between(0.5, 2.0),
            viscous: chance.between(2.0, 9.0),
            inertia_kg: chance.between(0.5, 3.0),
            hung: Hung::default(),
        },
        Bench::Angular => Plant {
            radius_m: 1.0,
            weight_n: 0.0,
            load_friction: 0.0,
            dry_n: chance.between(0.05, 0.2),
            viscous: chance.between(0.02, 0.08),
            inertia_kg: chance.between(0.02, 0.08),
            hung: Hung::default(),
        },
    };
    match known(spec) {
        Known::Mass => (plant.viscous, plant.dry_n) = (0.0, 0.0),
        Known::MassViscous => plant.dry_n = 0.0,
        _ => {}
    }
    plant
}

fn habits(spec: &Spec, plant: &Plant, chance: &mut Chance) -> Habits {
    // A lever of some decimetres turns what the hand does into angles.
    let (stiffness, damping, wander, tremor) = match spec.bench {
        Bench::OneFinger | Bench::TwoFingers => (chance.between(150.0, 400.0), chance.between(2.5, 7.0), 1.0, 1.0),
        Bench::Linear => {
            let k = chance.between(250.0, 700.0);
            (k, chance.between(1.0, 1.6) * (k * plant.inertia_kg).sqrt(), 4.0, 2.0)
        }
        Bench::Angular => {
            let k = chance.between(4.0, 12.0);
            (k, chance.between(1.0, 1.6) * (k * plant.inertia_kg).sqrt(), 30.0, 8.0)
        }
    };
    let one_way = spec.log == Log::PullOnly;
    Habits {
        stiffness,
        damping,
        pull_m: if one_way { chance.sign() * chance.between(6.0, 9.0) } else { chance.between(-1.0, 1.0) }
            * 1e-3
            * 250.0
            / stiffness,
        pull_spread_m: if one_way { chance.between(0.6, 1.2) } else { chance.between(4.0, 8.0) } * 1e-3 * 250.0
            / stiffness,
        wander_m: wander * chance.between(0.5e-3, 1.5e-3),
        tremor_m: tremor * chance.of_order(3e-5, 1.2e-4),
        tremor_hz: chance.between(8.0, 12.0),
        correction: chance.between(0.4, 0.9),
        reaction_ms: chance.whole(140, 220) as usize,
    }
}

/// Instruments of the usual quality.
pub fn sensor(spec: &Spec, chance: &mut Chance) -> Sensor {
    let swing_hz = if chance.happens(0.25) { chance.between(6.0, 20.0) } else { 0.0 };
    let memory_s = chance.of_order(0.004, 0.02);
    let (noise_n, angle_noise, rate_noise) = match spec.bench {
        Bench::OneFinger | Bench::TwoFingers => {
            (chance.of_order(0.008, 0.025), chance.of_order(6e-5, 2.5e-4), chance.of_order(0.004, 0.02))
        }
        Bench::Linear => (chance.of_order(0.03, 0.1), chance.of_order(4e-6, 2e-5), chance.of_order(5e-4, 3e-3)),
        Bench::Angular => (chance.of_order(0.004, 0.015), chance.of_order(5e-5, 3e-4), chance.of_order(5e-3, 3e-2)),
    };
    Sensor {
        noise_n,
        memory_s,
        swing_hz,
        step_n: noise_n * chance.between(0.1, 0.5),
        angle_noise,
        angle_step: angle_noise * chance.between(0.3, 1.5),
        rate_noise,
    }
}

/// Everything but the sizes of what is hidden, which start as a guess.
pub fn setup(spec: &Spec, sensor: &Sensor, arm: &Arm, seed: u64) -> Setup {
    let mut chance = Chance::new(seed, 1);
    let plant = plant(spec, &mut chance);
    let habits = habits(spec, &plant, &mut chance);
    let center_m = spec
        .bench
        .is_crank()
        .then(|| [arm.base_m[0] + chance.between(0.012, 0.03) + 1e-9, arm.base_m[1] + chance.between(0.096, 0.108)]);
    let before = chance.between(1.1, 1.6);
    let after = if chance.happens(0.85) { chance.between(1.0, 1.4) } else { 0.0 };
    let short = spec.seconds < 6.0;
    let hold_s = if short { [1.0, spec.seconds] } else { [before, spec.seconds - after] };
    let plan = if spec.bench.is_crank() {
        Plan::turning(spec.log, hold_s[0] + 0.4, hold_s[1], &mut chance)
    } else {
        Plan::stroking(spec.log, 2.5, hold_s[0] + 0.4, hold_s[1], &mut chance)
    };
    let mut away = || {
        let (sin, cos) = chance.between(-0.4, 2.6).sin_cos();
        let far = chance.between(0.008, 0.018);
        [far * cos, far * sin]
    };
    let away_m = [away(), away()];
    let mut hidden: Vec<Hidden> =
        spec.effects.iter().map(|&(effect, form)| guess(spec, &plant, sensor, effect, form, &mut chance)).collect();
    if let Some(structure) = &spec.structure {
        hidden.push(structure::guess(spec, &plant, sensor, structure, &mut Chance::new(seed, 13)));
    }
    // A crank hangs where its weight pulls it; a mechanism stands somewhere.
    let start_angle = if center_m.is_some() { -FRAC_PI_2 } else { 0.0 };
    let filter_hz = (0.4 * spec.rate_hz).max(150.0);
    Setup {
        plant,
        center_m,
        start_angle,
        away_m,
        hidden,
        habits,
        plan,
        seconds: spec.seconds,
        effects_s: spec.seconds,
        hold_s,
        rate_hz: spec.rate_hz,
        filter_hz,
        seed,
    }
}

/// An effect in some shape, of about the wanted size.
fn guess(spec: &Spec, plant: &Plant, sensor: &Sensor, effect: Effect, form: u32, chance: &mut Chance) -> Hidden {
    let ratio = if spec.ratio > 0.0 { spec.ratio } else { 1.0 };
    let e = ratio * sensor.floor_n();
    let v = spec.bench.usual_speed() * if spec.log == Log::Slow { 0.2 } else { 1.0 };
    let crank = spec.bench.is_crank();
    let sign = chance.sign();
    let path = 6.0 * ratio * sensor.angle_floor() * LINK_M;
    let size = match effect {
        Effect::Asymmetry if form == 1 => sign * e / v,
        Effect::Asymmetry | Effect::CrossAxis => sign * e,
        Effect::Coulomb | Effect::SquareFriction | Effect::SquaredLoad | Effect::Shaking | Effect::Bias => e,
        Effect::Viscous | Effect::PositionViscous => e / v,
        Effect::Stribeck | Effect::Local => 2.5 * e,
        Effect::Drag if form == 0 => 2.0 * e / (v * v),
        Effect::Drag => 2.0 * e / v.powf(2.5),
        Effect::Inertia | Effect::Drift => 2.0 * e,
        Effect::Ripple => 1.4 * e,
        Effect::Eccentric => 1.4 * e * sign,
        Effect::Tilt => 1.4 * e * sign / plant.weight_n,
        Effect::Spring => e / 3.0,
        Effect::Backlash => 1e-3,
        Effect::Hysteresis => 0.01 * plant.radius_m,
        Effect::Leak => 4.0 * e / plant.weight_n,
        Effect::FrictionChange => 4.0 * e * if crank { 1.0 / plant.load_friction } else { 1.0 / plant.dry_n },
        Effect::Cable => 6.0 * e,
        Effect::Pad => path,
        Effect::Slip => 2.0 * path,
        Effect::Delay => 0.004,
        Effect::Gain => sign * e / plant.weight_n,
        Effect::Saturation => 0.3,
        Effect::JointOffset => sign * 20.0 * path,
        Effect::LengthScale => sign * 60.0 * path,
        // Structures have a guess of their own.
        Effect::AxisSign
        | Effect::ChannelFault
        | Effect::SensorWander
        | Effect::SensorCreep
        | Effect::AngleField
        | Effect::SpeedField
        | Effect::LoadField
        | Effect::StateField
        | Effect::FrictionOverAngle
        | Effect::FrictionWander
        | Effect::GraspCreep
        | Effect::Ringing
        | Effect::Hum
        | Effect::Steps => 1.0,
    };
    Hidden { effect, form, size, shape: shape(spec, effect, v, chance) }
}

fn shape(spec: &Spec, effect: Effect, usual_speed: f64, chance: &mut Chance) -> [f64; 3] {
    let crank = spec.bench.is_crank();
    match effect {
        Effect::Stribeck => [usual_speed * chance.of_order(0.15, 0.6), 0.0, 0.0],
        Effect::Ripple => {
            let most = if spec.rate_hz < 50.0 { 4 } else { 12 };
            [f64::from(chance.whole(2, most)), chance.between(0.0, TAU), 0.0]
        }
        Effect::Eccentric if !crank => [chance.between(0.0, TAU), 0.0, 0.0],
        Effect::Spring if crank => [chance.between(-3.0, 3.0), 4.0, 0.0],
        Effect::Spring => [chance.between(-0.6, 0.6), 1.2, 0.0],
        Effect::FrictionChange => [chance.between(0.35, 0.65), 0.0, 0.0],
        Effect::Local if crank => [chance.between(-3.1, 3.1), chance.between(0.3, 0.8), 0.0],
        Effect::Local => [chance.between(-1.4, 1.4), chance.between(0.25, 0.7), 0.0],
        Effect::Cable => [chance.between(-3.1, 3.1), chance.between(0.8, 1.3), 0.0],
        Effect::Slip => [chance.between(0.0, TAU), chance.between(0.35, 0.65), 0.0],
        Effect::Bias | Effect::Drift if crank => [chance.between(0.0, TAU), 0.0, 0.0],
        Effect::Drift => [if chance.happens(0.5) { 0.0 } else { std::f64::consts::PI }, 0.0, 0.0],
        Effect::ChannelFault => [chance.between(0.3, 0.6), chance.between(0.5, 1.5), 0.0],
        Effect::Shaking => [chance.between(7.0, 11.0), chance.between(0.0, TAU), 0.0],
        Effect::PositionViscous | Effect::SquareFriction => [chance.between(0.0, TAU), 0.0, 0.0],
        _ => [0.0; 3],
    }
}
