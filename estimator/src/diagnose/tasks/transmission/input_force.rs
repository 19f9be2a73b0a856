//! Force at the input of a transmission against its motion and the load.
//!
//! Dry friction of an input beside a load that reverses with the motion, as dry friction does.
//!
//! The input of a transmission on its own: a hand holds it on its measured way, and its friction and the measured load
//! act against it. (Its inertia is a small part of the force: a measured force that drove it would be followed in all
//! its errors.)

use super::filtered_columns::Fine;
use super::grid::{Tried, closer};
use super::rows::{Columns, Row, Seen, constants, stretches_of};
use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::contract::{Alternative, CauseParameter, RolloutOf};
use crate::diagnose::data::limits::{HALF, SHORTEST_S};
use crate::diagnose::free_run::channel::{Fit, Forward, consecutive};
use crate::diagnose::free_run::integrate::{Side, over, remembered};
use crate::diagnose::free_run::windows::{Errors, NO_LAW};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{
    coulomb_friction, force_gain, hysteresis, load_friction, quadratic_drag, return_spring, viscous_friction,
};
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{ChannelFit, Compared};
use crate::diagnose::selection::layout::Use;
use crate::diagnose::selection::normal_equations::solve;
use crate::diagnose::tasks::transmission::{channel, compared, shows, view};
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use haptics::law::{
    CoulombFriction, Effect, Hysteresis, Inertia, Kind, LoadFriction, Motion, QuadraticDrag, ReturnSpring,
    ViscousFriction,
};

/// Share of the usual speed below which the direction of friction is uncertain, as it is in rows over a reversal.
/// Choice: no case of the ablation reads it.
const SLOW_SPEED_SHARE: f64 = 0.1;
/// Direction of motion from which its sign is certain, of 1.
/// Choice: no case of the ablation reads it.
const SURE_POSTERIOR: f64 = 0.99;

/// Rows with a certain direction of friction.
fn sure(seen: &Seen, usual: f64) -> Vec<usize> {
    let direction: Vec<f64> = seen.fine.iter().flat_map(Fine::direction).collect();
    let is_sure =
        |(row, direction): (&Row, &f64)| direction.abs() > SURE_POSTERIOR && row.rate.abs() > SLOW_SPEED_SHARE * usual;
    seen.kept(&seen.rows.iter().zip(&direction).map(is_sure).collect::<Vec<bool>>())
}

/// The comparison with its free-run model.
pub struct Force {
    pub compared: Compared,
    /// Separability of friction and load.
    pub told: Option<Confounding>,
    pub input: Input,
}

/// The input force against its motion and the load, and the separability of friction from that load.
pub fn force(seen: &Seen, names: &'static Columns) -> Result<Option<Force>, EstimateError> {
    if seen.rows.iter().any(|r| r.force.is_none()) {
        return Ok(None);
    }
    let mut speeds: Vec<f64> = seen.rows.iter().map(|r| r.rate.abs()).collect();
    speeds.sort_by(f64::total_cmp);
    let usual = speeds.get(speeds.len() * 9 / 10).copied().unwrap_or(1.0).max(f64::MIN_POSITIVE);
    let kept = sure(seen, usual);
    let rows = seen.at(&kept);
    let stretch = stretches_of(&rows);
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let mut base = constants(&rows);
    let is_loaded = rows.iter().all(|r| r.load.is_some());
    let load = base.len();
    if is_loaded {
        base.push(of(&|r| r.load.unwrap_or(0.0)));
    }
    let inertia = base.len();
    base.push(of(&|r| r.acceleration));
    let direction = seen.column(&kept, &Fine::direction);
    let (low, high) = seen.ends();
    let middle = 0.5 * (low + high);
    let mut plain = vec![
        Candidate::one(coulomb_friction::ID, Kind::Plant, "Fc", names.force_unit, direction.clone()).positive(),
        Candidate::one(viscous_friction::ID, Kind::Plant, "c", "", of(&|r| r.rate)).positive(),
        Candidate::one(return_spring::ID, Kind::Plant, "k", "", of(&|r| r.input - middle)),
        Candidate::one(quadratic_drag::ID, Kind::Plant, "k", "", of(&|r| r.rate * r.rate.abs())).positive(),
    ];
    if is_loaded {
        let column = rows.iter().zip(&direction).map(|(r, d)| r.load.map_or(0.0, f64::abs) * d).collect();
        plain.push(Candidate::one(load_friction::ID, Kind::Plant, "mu", "1", column).positive());
    }
    let view = view(&rows, names);
    let channel = channel(of(&|r| r.force.unwrap_or(0.0)), base, &rows, &view);
    let once = |tried: &[Tried]| {
        let bend = |way: &f64| {
            let bent = seen.column(&kept, &|f| f.bent(*way)).iter().zip(&direction).map(|(z, d)| z - d).collect();
            let cause = Candidate::one(hysteresis::ID, Kind::Plant, "Fc", names.force_unit, bent).positive();
            cause.at("way", *way, names.unit)
        };
        let candidates = tried[0].values().iter().map(bend).chain(plain.iter().cloned()).collect();
        Channel { candidates, ..channel.clone() }.fit()
    };
    let study = closer(&mut [Tried::new(hysteresis::ID, high - low)], &once)?;
    let told = if is_loaded { Confounding::of(&study, load, &direction, &rows) } else { None };
    let floor = white_noise(&seen.rows.iter().map(|r| r.force.unwrap_or(0.0)).collect::<Vec<_>>());
    let compared = compared(study, view, ("force at the input", names.force_unit), floor);
    let input = Input { rows, stretch, unit: names.force_unit, inertia, middle };
    Ok(Some(Force { compared, told, input }))
}

impl Told for Force {
    fn shows(&self, found: &Found<'_>) -> String {
        shows(found)
    }

    fn states(&self, _: usize, candidate: &Candidate, mut found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        if let (Some(confounding), true) = (&self.told, candidate.id == coulomb_friction::ID) {
            for p in &mut found {
                p.std_error = p.std_error.hypot(confounding.error(p.value));
            }
        }
        found
    }
}

/// Noise of the load due to the shape of its reversal, per unit of its slope over the direction.
/// Choice: no case of the ablation reads it.
const SHAPE: f64 = 0.03;

/// Separability of a load from dry friction.
pub struct Confounding {
    /// Share of the load's own part (beyond the other regressors) that may be noise or another shape of the reversal, 0
    /// to 1.
    noise: f64,
    /// Load per unit of direction, N or N m.
    slope: f64,
    /// Coefficient of the load in the comparison, in units of force per unit of load.
    weight: f64,
}

impl Confounding {
    /// Separability in a comparison whose base model has the load as regressor `load`. `direction`: the regressor of
    /// dry friction, a value per row.
    pub fn of(study: &ChannelFit, load: usize, direction: &[f64], rows: &[Row]) -> Option<Self> {
        let used: Vec<usize> = (0..rows.len())
            .filter(|i| study.layout.weight[*i] > 0.0 && !matches!(study.system.uses[*i], Use::Locked(_)))
            .collect();
        let others = study.baseline.iter().enumerate().filter(|(k, _)| *k != load).map(|(_, column)| column.as_slice());
        let columns: Vec<&[f64]> = others.chain([direction, study.baseline[load].as_slice()]).collect();
        let gram = nalgebra::DMatrix::from_fn(columns.len(), columns.len(), |a, b| {
            used.iter().map(|i| columns[a][*i] * columns[b][*i]).sum::<f64>()
        });
        let beside: Vec<usize> = (0..columns.len() - 1).collect();
        let solved = solve(&gram, &beside, columns.len() - 1)?;
        let loads: Vec<f64> = rows.iter().map(|r| r.load.unwrap_or(0.0)).collect();
        let own = (solved.rss / used.len().max(1) as f64).max(f64::MIN_POSITIVE);
        let weight = *study.solved.as_ref()?.values.get(load)?;
        let slope = *solved.values.last()?;
        let noise = ((white_noise(&loads).powi(2) + (SHAPE * slope).powi(2)) / own).min(1.0);
        Some(Self { noise, slope, weight })
    }

    /// True if load and dry friction are equivalent in this recording.
    pub fn is_one(&self) -> bool {
        self.noise > HALF
    }

    /// Error of this dry friction due to the load, N or N m. Noise of a regressor biases its coefficient towards zero,
    /// and dry friction takes over the missing part. If the two are equivalent, all that reverses with the direction
    /// may belong to either.
    pub fn error(&self, friction: f64) -> f64 {
        let shared = self.weight * self.slope;
        if self.is_one() { (friction + shared).abs() } else { (shared * self.noise / (1.0 - self.noise)).abs() }
    }

    /// Alternative explanation of that friction by the load.
    pub fn alternative(&self) -> Option<Alternative> {
        self.is_one().then(|| Alternative {
            id: force_gain::ID.to_owned(),
            instead_of: coulomb_friction::ID.to_owned(),
            posterior: 0.5,
            why: WHY.to_owned(),
        })
    }
}

/// Why friction cannot be told from the load.
pub const WHY: &str = "the load at the output turns round with the motion, as dry friction does: with another gain of its sensor, or another \
     lever, it makes the same force; record runs under other loads";

/// Free-run simulation of a transmission's input.
pub struct Input {
    rows: Vec<Row>,
    stretch: Vec<usize>,
    unit: &'static str,
    /// Index of the acceleration among the model's regressors. Its coefficient is the inertia.
    inertia: usize,
    /// Middle of its travel, the position at which the regressor of a spring is zero.
    middle: f64,
}

impl Input {
    /// Law of a friction of this size, or of a cause that is a law by itself.
    fn law(&self, id: &str, value: f64) -> Option<Effect> {
        Some(match id {
            load_friction::ID => Effect::new(&LoadFriction, &[value]),
            viscous_friction::ID => Effect::new(&ViscousFriction, &[value]),
            quadratic_drag::ID => Effect::new(&QuadraticDrag, &[value]),
            return_spring::ID => Effect::new(&ReturnSpring, &[value, 0.0, 0.0, self.middle]),
            _ => return None,
        })
    }

    /// Laws of the causes; `None` if one has no law.
    fn effects(&self, fit: &Fit<'_>) -> Option<Vec<Effect>> {
        let (mut effects, mut dry) = (vec![Effect::new(&Inertia, &[fit.values[self.inertia].max(0.0)])], 0.0);
        for (candidate, own) in fit.causes() {
            match candidate.id {
                coulomb_friction::ID => dry += own[0],
                // Friction that bends before it slides is part of the dry friction, and is subtracted from it.
                hysteresis::ID => {
                    let way = candidate.searched.first().map_or(0.0, |s| s.value).max(f64::MIN_POSITIVE);
                    dry -= own[0];
                    effects.push(Effect::new(&Hysteresis, &[own[0], own[0] / way]));
                }
                id => effects.push(self.law(id, own[0])?),
            }
        }
        effects.push(Effect::new(&CoulombFriction, &[dry.max(0.0)]));
        Some(effects)
    }

    fn motion(&self, i: usize) -> Motion {
        let Row { time_s, input, rate, acceleration, load, .. } = self.rows[i];
        Motion {
            time_s,
            position: input,
            velocity: rate,
            acceleration,
            direction: rate.signum(),
            normal_force_n: load.unwrap_or(0.0),
            ..Motion::default()
        }
    }
}

impl Forward for Input {
    fn of(&self) -> (RolloutOf, &str) {
        (RolloutOf::Force, self.unit)
    }

    fn windows(&self) -> Vec<Vec<usize>> {
        let all: Vec<usize> = (0..self.rows.len()).collect();
        consecutive(&all, &|i| self.rows[i].time_s, SHORTEST_S, &|a, b| self.stretch[a] == self.stretch[b])
    }

    fn errors(&self, fit: &Fit<'_>, window: &[usize]) -> Result<Errors, String> {
        let effects = self.effects(fit).ok_or_else(|| NO_LAW.to_owned())?;
        // The sensors' zeros and the load drive it; they are no laws.
        let of_model = fit.columns().take(fit.study.baseline.len()).enumerate().filter(|(k, _)| *k != self.inertia);
        let beside: Vec<(&[f64], f64)> = of_model.map(|(_, column)| column).collect();
        let row = |i: usize| (self.motion(i), fit.less(i, &beside));
        let first = window[0];
        let began = (0..first).rev().find(|i| self.rows[*i].recording != self.rows[first].recording);
        let past: Vec<Motion> = (began.map_or(0, |i| i + 1)..=first).map(|i| self.motion(i)).collect();
        let memory = remembered(&effects, &past);
        Ok(over(window, &row, Side { effects: &effects, memory, acts: &mut |_, _| 0.0, driven: false }))
    }
}
