//! The input of a transmission on its own: a hand holds it on its measured way, and its friction and the measured load
//! act against it. (Its inertia is a small part of the force: a measured force that drove it would be followed in all
//! its errors.)

use super::rows::{Row, Seen};
use crate::diagnose::contract::RolloutOf;
use crate::diagnose::data::limits::SHORTEST_S;
use crate::diagnose::free_run::channel::{Fit, Forward, consecutive};
use crate::diagnose::free_run::integrate::{Side, over, remembered};
use crate::diagnose::free_run::windows::{Errors, NO_LAW};
use crate::diagnose::hypotheses::{
    coulomb_friction, hysteresis, load_friction, quadratic_drag, return_spring, viscous_friction,
};
use haptics::law::{
    CoulombFriction, Effect, Hysteresis, Inertia, LoadFriction, Motion, QuadraticDrag, ReturnSpring, ViscousFriction,
};

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
    /// `unit`: of the force; `inertia`: index of the acceleration among the model's regressors.
    pub fn new((rows, stretch): (&[Row], &[usize]), unit: &'static str, inertia: usize, seen: &Seen) -> Self {
        let (low, high) = seen.ends();
        Self { rows: rows.to_vec(), stretch: stretch.to_vec(), unit, inertia, middle: 0.5 * (low + high) }
    }

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
                    let way = candidate.searched.first().map_or(0.0, |s| s.value).max(1e-12);
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
        let of_model = fit.columns().take(fit.study.base.len()).enumerate().filter(|(k, _)| *k != self.inertia);
        let beside: Vec<(&[f64], f64)> = of_model.map(|(_, column)| column).collect();
        let row = |i: usize| (self.motion(i), fit.less(i, &beside));
        let first = window[0];
        let began = (0..first).rev().find(|i| self.rows[*i].recording != self.rows[first].recording);
        let past: Vec<Motion> = (began.map_or(0, |i| i + 1)..=first).map(|i| self.motion(i)).collect();
        let memory = remembered(&effects, &past);
        Ok(over(window, &row, Side { effects: &effects, memory, acts: &mut |_, _| 0.0, driven: false }))
    }
}
