//! A carried block as a body of its own: the measured net force of the fingers moves its mass, gravity and cables pull
//! at it.

use super::cable::pull_n;
use super::rows::{Place, Row, Rows};
use super::signals::Seen;
use crate::diagnose::contract::RolloutOf;
use crate::diagnose::free_run::channel::{Fit, Forward, consecutive};
use crate::diagnose::free_run::integrate::{Moment, Side, run};
use crate::diagnose::free_run::windows::{Errors, NO_LAW};
use crate::diagnose::hypotheses::{added_constraint, inertia, viscous_friction};
use haptics::Vec2;
use haptics::law::{Effect, Inertia, Memories, Motion, ViscousFriction};
use haptics::world::{Cable, World};

/// Free-run simulation of carried blocks as separate bodies.
pub struct Airborne<'a> {
    pub rows: Rows<'a>,
    gravity_m_s2: f64,
    /// Weights that are known, N, by block.
    known_n: Vec<Option<f64>>,
    /// Cables of the world with their blocks. Each has one regressor in the model, after those of the weights.
    ties: Vec<(usize, Cable)>,
}

impl<'a> Airborne<'a> {
    pub fn of(rows: Rows<'a>, world: Option<&World>, known_n: Vec<Option<f64>>) -> Self {
        let tied = world.iter().flat_map(|w| &w.blocks).enumerate().filter_map(|(k, block)| {
            // Its damping is no part of the model.
            let cable = Cable { damping_n_s_m: 0.0, ..*block.cable.as_ref()? };
            Some((k + 1, cable))
        });
        let gravity = |one: &Seen<'_>| one.blocks.recording.meta.gravity();
        let gravity_m_s2 = rows.seen.iter().map(gravity).fold(1e-9, f64::max);
        Self { gravity_m_s2, known_n, ties: tied.collect(), rows }
    }

    /// Number of estimated weights: their regressors come first in the model.
    fn open(&self) -> usize {
        self.known_n.iter().filter(|k| k.is_none()).count()
    }

    /// Weight of a block as known or as fitted, N.
    fn weight_n(&self, number: usize, values: &[f64]) -> f64 {
        let open_before = self.known_n[..number - 1].iter().filter(|k| k.is_none()).count();
        self.known_n[number - 1].unwrap_or_else(|| values.get(open_before).copied().unwrap_or(0.0))
    }

    /// The world's cable at a block, with fitted stiffness.
    fn of_world(&self, number: usize, values: &[f64]) -> Option<Cable> {
        let (k, (_, tie)) = self.ties.iter().enumerate().find(|(_, (own, _))| *own == number)?;
        Some(Cable { stiffness_n_m: tie.stiffness_n_m * values.get(self.open() + k).copied().unwrap_or(1.0), ..*tie })
    }
}

impl Forward for Airborne<'_> {
    fn of(&self) -> (RolloutOf, &str) {
        (RolloutOf::Position, "m")
    }

    fn windows(&self) -> Vec<Vec<usize>> {
        let Rows { all, stretch, .. } = &self.rows;
        let carried: Vec<usize> = (0..all.len()).filter(|i| all[*i].number() > 0).collect();
        // Rows of one segment are of one recording, block and axis.
        consecutive(&carried, &|i| all[i].time_s, self.rows.period_s(), &|a, b| stretch[a] == stretch[b])
    }

    fn errors(&self, fit: &Fit<'_>, window: &[usize]) -> Result<Errors, String> {
        let (study, values) = (fit.study, fit.values);
        let Place::Carried { number, axis } = self.rows.all[window[0]].place else { return Ok((0.0, 0.0)) };
        let weight_n = self.weight_n(number, values);
        let up = if axis == 1 { 1.0 } else { 0.0 };
        // A block's swinging in the pads, if it is in the model, is no motion of the grip.
        let swings = self.open() + self.ties.len() + number - 1;
        let swing_n = |i: usize| study.baseline.get(swings).map_or(0.0, |column| values[swings] * column[i]);
        let force_n = |i: usize| self.rows.force_n(&self.rows.all[i]);
        let mut drive: Vec<f64> = window.iter().map(|i| force_n(*i) - up * weight_n - swing_n(*i)).collect();
        let (mut mass_kg, mut drag) = (weight_n / self.gravity_m_s2, 0.0);
        let mut ties: Vec<Cable> = self.of_world(number, values).into_iter().collect();
        for (candidate, own) in fit.causes() {
            let at = |name: &str| candidate.value(name).unwrap_or(0.0);
            match candidate.id {
                // One mass for all blocks, or each its own.
                inertia::ID => mass_kg += own.get(number - 1).filter(|_| own.len() > 1).unwrap_or(&own[0]),
                viscous_friction::ID => drag += own[0],
                added_constraint::ID if self.rows.touched(&candidate.regressors[0]) != number => {}
                added_constraint::ID => ties.push(Cable {
                    stiffness_n_m: own[0],
                    damping_n_s_m: own.get(1).copied().unwrap_or(0.0).max(0.0),
                    anchor_m: Vec2::new(at("anchor x"), at("anchor y")),
                    length_m: at("length"),
                }),
                // Effects that do not depend on the motion, and faults of the sensors.
                _ => candidate.regressors.iter().zip(own).for_each(|(column, value)| {
                    drive.iter_mut().zip(window).for_each(|(drive, i)| *drive -= value * column[*i]);
                }),
            }
        }
        if mass_kg <= 0.0 {
            return Err(NO_LAW.to_owned());
        }
        let effects = [Effect::new(&Inertia, &[mass_kg]), Effect::new(&ViscousFriction, &[drag])];
        let across = 1 - axis;
        let moment = |(i, drive): (&usize, &f64)| {
            let Row { i, time_s, recording, .. } = self.rows.all[*i];
            let Seen { place, velocity, .. } = &self.rows.seen[recording];
            let motion = Motion { time_s, position: place[axis][i], velocity: velocity[axis][i], ..Motion::default() };
            Moment { motion, drive: *drive, beside: [place[across][i], velocity[across][i]] }
        };
        let moments: Vec<Moment> = window.iter().zip(&drive).map(moment).collect();
        let acts = &mut |motion: &Motion, [place, velocity]: [f64; 2]| {
            let both =
                |along: f64, across: f64| if axis == 0 { Vec2::new(along, across) } else { Vec2::new(across, along) };
            let (place_m, velocity_m_s) = (both(motion.position, place), both(motion.velocity, velocity));
            ties.iter().map(|tie| pull_n(tie, place_m, velocity_m_s, axis)).sum::<f64>()
        };
        Ok(run(&moments, Side { effects: &effects, memory: Memories::default(), acts, driven: true }))
    }
}
