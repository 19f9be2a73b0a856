//! The catalogue of physical laws: one law a file, written once.
//!
//! A law adds a term to the force that is needed to move a coordinate `s` (or angle) against it. The same object is
//! integrated by the servo ([`crate::world`]), summed by the replay, put into a fit as regressor columns by the estimator and
//! proposed by the diagnosis. Ids are those of `spec/causes.md`.
//!
//! Adding a law: one file here, one line in [`CATALOGUE`], one one-effect test in its file, one recovery test in `tests/`.

mod coulomb_friction;
mod eccentric_mass;
mod force_bias;
mod friction_asymmetry;
mod inertia;
mod load_friction;
mod quadratic_drag;
mod return_spring;
mod viscous_friction;
mod weight;

pub use coulomb_friction::CoulombFriction;
pub use eccentric_mass::EccentricMass;
pub use force_bias::ForceBias;
pub use friction_asymmetry::FrictionAsymmetry;
pub use inertia::Inertia;
pub use load_friction::LoadFriction;
pub use quadratic_drag::QuadraticDrag;
pub use return_spring::ReturnSpring;
pub use viscous_friction::ViscousFriction;
pub use weight::Weight;

use serde::{Deserialize, Serialize};

/// Most parameters that a single law has.
pub const MAX_PARAMETERS: usize = 4;

/// Whether a law changes the world or corrects the recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Part of what the trainee feels.
    Plant,
    /// A fault of the measurement; the world stays as it is.
    Instrument,
}

/// Whether the coordinate is a length or an angle: decides the units of a law's parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Coordinate {
    /// Path length s in m, force in N.
    Linear,
    /// Angle θ in rad, torque in N m.
    Angular,
}

/// Name, unit and range of one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterSpec {
    /// Symbol without its unit, e.g. `c`.
    pub name: &'static str,
    /// Unit when the coordinate is a length.
    pub unit: &'static str,
    /// Unit when the coordinate is an angle.
    pub unit_angular: &'static str,
    /// Physically meaningful range.
    pub bounds: (f64, f64),
}

/// The state of one coordinate at one instant, as every law sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Time since the start, s.
    pub time_s: f64,
    /// Coordinate, m or rad.
    pub position: f64,
    /// Its rate, m/s or rad/s.
    pub velocity: f64,
    /// Its second derivative, m/s² or rad/s².
    pub acceleration: f64,
    /// Direction of motion in −1 … 1. The caller decides how a noisy sign is smoothed; the servo passes the direction of
    /// the impending slip.
    pub direction: f64,
    /// Normal (constraint) force, N.
    pub normal_force_n: f64,
    /// Component of the upward unit vector along +coordinate (cos θ for a crank measured from the horizontal).
    pub up_along: f64,
}

/// A physical law in one coordinate. The sign convention is that of a *drive*: the term is the force a tool must exert
/// along +coordinate to make the motion happen.
pub trait Law: Sync {
    /// Stable id (`spec/causes.md`, or a base term such as `weight`).
    fn id(&self) -> &'static str;
    /// Plant or instrument.
    fn kind(&self) -> Kind;
    /// A short name for people.
    fn title(&self) -> &'static str;
    /// The parameters, in the order of the regressor's columns.
    fn parameters(&self) -> &'static [ParameterSpec];
    /// True when the term is dry friction: proportional to [`Motion::direction`] and able to hold the coordinate at rest.
    fn is_dry(&self) -> bool {
        false
    }
    /// Regressor row: `columns[i]` = d(force)/d(parameter i). Laws here are linear in their parameters.
    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]);
    /// The law's force, N or N m.
    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        let mut columns = [0.0; MAX_PARAMETERS];
        self.regressor(motion, &mut columns);
        columns.iter().zip(parameters).map(|(c, p)| c * p).sum()
    }
}

/// Every law, in the order it is shown.
pub static CATALOGUE: [&dyn Law; 10] = [
    &Weight,
    &Inertia,
    &CoulombFriction,
    &LoadFriction,
    &ViscousFriction,
    &FrictionAsymmetry,
    &QuadraticDrag,
    &EccentricMass,
    &ReturnSpring,
    &ForceBias,
];

/// The law with this id.
pub fn law(id: &str) -> Option<&'static dyn Law> {
    CATALOGUE.iter().copied().find(|law| law.id() == id)
}

/// A law with its parameter values: what a world file stores and the servo runs.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(try_from = "EffectFile", into = "EffectFile")]
pub struct Effect {
    law: &'static dyn Law,
    /// Values, in the order of [`Law::parameters`]; unused places are zero.
    pub values: [f64; MAX_PARAMETERS],
    /// Switched off effects stay in the file and add nothing.
    pub enabled: bool,
}

impl Effect {
    /// A law with the given parameter values (missing ones are zero).
    pub fn new(law: &'static dyn Law, values: &[f64]) -> Self {
        let mut padded = [0.0; MAX_PARAMETERS];
        for (to, from) in padded.iter_mut().zip(values) {
            *to = *from;
        }
        Self { law, values: padded, enabled: true }
    }

    /// The law itself.
    pub fn law(&self) -> &'static dyn Law {
        self.law
    }

    /// Force of this effect, N or N m; zero when switched off.
    pub fn force(&self, motion: &Motion) -> f64 {
        if self.enabled { self.law.force(motion, &self.values) } else { 0.0 }
    }
}

impl std::fmt::Debug for Effect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{:?}", self.law.id(), &self.values[..self.law.parameters().len()])
    }
}

impl PartialEq for Effect {
    fn eq(&self, other: &Self) -> bool {
        self.law.id() == other.law.id() && self.values == other.values && self.enabled == other.enabled
    }
}

/// An effect as it stands in a world file.
#[derive(Clone, Serialize, Deserialize)]
struct EffectFile {
    id: String,
    parameters: std::collections::BTreeMap<String, f64>,
    #[serde(default = "yes")]
    enabled: bool,
}

fn yes() -> bool {
    true
}

impl From<Effect> for EffectFile {
    fn from(effect: Effect) -> Self {
        let specs = effect.law.parameters().iter();
        Self {
            id: effect.law.id().to_owned(),
            parameters: specs.zip(effect.values).map(|(s, v)| (s.name.to_owned(), v)).collect(),
            enabled: effect.enabled,
        }
    }
}

impl TryFrom<EffectFile> for Effect {
    type Error = String;

    fn try_from(file: EffectFile) -> Result<Self, String> {
        let law = law(&file.id).ok_or_else(|| format!("there is no law called `{}`", file.id))?;
        let mut effect = Self { law, values: [0.0; MAX_PARAMETERS], enabled: file.enabled };
        for (name, value) in file.parameters {
            let index = law
                .parameters()
                .iter()
                .position(|spec| spec.name == name)
                .ok_or_else(|| format!("the law `{}` has no parameter `{name}`", file.id))?;
            if !value.is_finite() {
                return Err(format!("parameter `{name}` of `{}` is not a finite number", file.id));
            }
            effect.values[index] = value;
        }
        Ok(effect)
    }
}

/// The forces of a list of effects on one coordinate, split the way an integrator needs them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resistance {
    /// Everything that acts whether or not the coordinate moves, N or N m.
    pub smooth: f64,
    /// Dry friction level, N or N m, ≥ 0: opposes motion and holds at rest.
    pub dry: f64,
    /// Inertia that belongs to the coordinate itself, kg or kg m².
    pub inertia: f64,
}

/// Sums `effects` for a coordinate that moves, or is about to move, towards `motion.direction`.
///
/// Called by the servo at every tick: no allocation.
pub fn resistance(effects: &[Effect], motion: &Motion) -> Resistance {
    let mut sum = Resistance::default();
    for effect in effects.iter().filter(|e| e.enabled) {
        if effect.law.id() == Inertia.id() {
            sum.inertia += effect.values[0];
        } else if effect.law.is_dry() {
            // The term is along the direction of motion; its level is what opposes it.
            sum.dry += effect.law.force(motion, &effect.values) * motion.direction;
        } else {
            sum.smooth += effect.law.force(motion, &effect.values);
        }
    }
    sum.dry = sum.dry.max(0.0);
    sum
}

/// Total drive force for a motion that is given, N or N m: what the replay predicts.
pub fn drive_force(effects: &[Effect], motion: &Motion) -> f64 {
    effects.iter().map(|effect| effect.force(motion)).sum()
}

/// Advances one coordinate by `dt_s` under `drive` (N or N m): semi-implicit Euler with dry friction solved exactly, so that
/// a coordinate at rest stays at rest until the drive exceeds the friction level.
///
/// Returns the new (position, velocity). `extra_inertia` is mass that other bodies add, kg or kg m²; the total must be > 0.
pub fn step_coordinate(effects: &[Effect], motion: &Motion, drive: f64, extra_inertia: f64, dt_s: f64) -> (f64, f64) {
    // First without dry friction: which way does it want to go?
    let mut probe = Motion { direction: motion.velocity.signum(), ..*motion };
    let smooth = resistance(effects, &probe);
    let inertia = (smooth.inertia + extra_inertia).max(1e-9);
    let free = motion.velocity + (drive - smooth.smooth) / inertia * dt_s;
    probe.direction = free.signum();
    let brake = resistance(effects, &probe).dry / inertia * dt_s;
    let velocity = if free.abs() <= brake { 0.0 } else { free - brake * free.signum() };
    (motion.position + velocity * dt_s, velocity)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_unique_and_bounds_are_ordered() {
        for (i, a) in CATALOGUE.iter().enumerate() {
            assert!(a.parameters().len() <= MAX_PARAMETERS);
            assert!(CATALOGUE[i + 1..].iter().all(|b| b.id() != a.id()));
            assert!(a.parameters().iter().all(|p| p.bounds.0 < p.bounds.1));
        }
    }

    #[test]
    fn an_effect_survives_its_file_and_a_wrong_one_is_named() {
        let effect = Effect::new(&CoulombFriction, &[0.25]);
        let text = serde_json::to_string(&effect).expect("an effect serialises");
        assert_eq!(text, r#"{"id":"coulomb-friction","parameters":{"Fc":0.25},"enabled":true}"#);
        assert_eq!(serde_json::from_str::<Effect>(&text).expect("reads back"), effect);
        let wrong = serde_json::from_str::<Effect>(r#"{"id":"coulomb-friction","parameters":{"mu":1}}"#);
        assert!(wrong.expect_err("unknown parameter").to_string().contains("no parameter `mu`"));
    }

    #[test]
    fn dry_friction_holds_at_rest_and_stops_without_reversal() {
        let effects = [Effect::new(&Inertia, &[2.0]), Effect::new(&CoulombFriction, &[1.0])];
        let rest = Motion::default();
        assert_eq!(step_coordinate(&effects, &rest, 0.99, 0.0, 1e-3), (0.0, 0.0));
        let (_, v) = step_coordinate(&effects, &rest, -1.5, 0.0, 1e-3);
        assert!((v + 0.5 / 2.0 * 1e-3).abs() < 1e-15, "only the excess over Fc accelerates: {v}");
        let slow = Motion { velocity: 1e-5, ..rest };
        assert_eq!(step_coordinate(&effects, &slow, 0.0, 0.0, 1e-3).1, 0.0);
    }

    #[test]
    fn coulomb_spin_down_takes_m_v_over_fc() {
        // 2 kg at 0.5 m/s against 1 N stops after exactly 1 s and 0.25 m.
        let effects = [Effect::new(&Inertia, &[2.0]), Effect::new(&CoulombFriction, &[1.0])];
        let mut motion = Motion { velocity: 0.5, ..Motion::default() };
        let mut ticks = 0;
        while motion.velocity != 0.0 {
            (motion.position, motion.velocity) = step_coordinate(&effects, &motion, 0.0, 0.0, 1e-4);
            ticks += 1;
        }
        assert!((f64::from(ticks) * 1e-4 - 1.0).abs() < 2e-4);
        // Semi-implicit Euler is first order: error below v dt.
        assert!((motion.position - 0.25).abs() < 0.5 * 1e-4);
    }
}
