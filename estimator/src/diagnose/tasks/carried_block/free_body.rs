//! A carried block as a body of its own: the measured net force of the fingers moves its mass, gravity and cables pull
//! at it.

use super::cable::pull_n;
use super::rows::{Place, Rows};
use crate::diagnose::contract::RolloutOf;
use crate::diagnose::free_run::channel::{Forward, consecutive};
use crate::diagnose::free_run::integrate::{Moment, Side, run};
use crate::diagnose::free_run::windows::NO_LAW;
use crate::diagnose::hypotheses::{added_constraint, inertia, viscous_friction};
use crate::diagnose::selection::comparison::ChannelFit;
use haptics::Vec2;
use haptics::law::{Effect, Inertia, Memories, Motion, ViscousFriction};
use haptics::world::{Cable, World};

/// Data of a row for the free-run simulation.
#[derive(Clone, Copy)]
struct Row {
    recording: usize,
    stretch: usize,
    time_s: f64,
    /// Block and axis; no block where nothing is held.
    number: usize,
    axis: usize,
    place_m: Vec2,
    velocity_m_s: Vec2,
    force_n: f64,
}

/// Free-run simulation of carried blocks as separate bodies.
pub struct Airborne {
    rows: Vec<Row>,
    period_s: f64,
    gravity_m_s2: f64,
    /// Weights that are known, N, by block.
    known_n: Vec<Option<f64>>,
    /// Cables of the world with their blocks. Each has one regressor in the model, after those of the weights.
    ties: Vec<(usize, Cable)>,
}

impl Airborne {
    pub fn of(rows: &Rows<'_>, stretch: &[usize], world: Option<&World>, known_n: &[Option<f64>]) -> Self {
        let row = |(row, stretch): (&super::rows::Row, &usize)| {
            let seen = &rows.seen[row.recording];
            let both = |of: &[Vec<f64>; 2]| Vec2::new(of[0][row.i], of[1][row.i]);
            let (number, axis) = match row.place {
                Place::Carried { number, axis } => (number, axis),
                Place::Free { axis, .. } => (0, axis),
            };
            Row {
                recording: row.recording,
                stretch: *stretch,
                time_s: row.time_s,
                number,
                axis,
                place_m: both(&seen.place),
                velocity_m_s: both(&seen.velocity),
                force_n: rows.force_n(row),
            }
        };
        let tied = world.iter().flat_map(|w| &w.blocks).enumerate().filter_map(|(k, block)| {
            // Its damping is no part of the model.
            let cable = Cable { damping_n_s_m: 0.0, ..*block.cable.as_ref()? };
            Some((k + 1, cable))
        });
        let gravity = |one: &super::signals::Seen<'_>| one.blocks.recording.meta.gravity();
        Self {
            rows: rows.all.iter().zip(stretch).map(row).collect(),
            period_s: rows.seen.iter().map(|s| s.period_s).fold(0.0, f64::max),
            gravity_m_s2: rows.seen.iter().map(gravity).fold(1e-9, f64::max),
            known_n: known_n.to_vec(),
            ties: tied.collect(),
        }
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

    /// Number of the block on which a regressor acts.
    fn tied(&self, column: &[f64]) -> usize {
        column.iter().position(|v| *v != 0.0).map_or(0, |i| self.rows[i].number)
    }
}

impl Forward for Airborne {
    fn of(&self) -> (RolloutOf, &str) {
        (RolloutOf::Position, "m")
    }

    fn windows(&self) -> Vec<Vec<usize>> {
        let carried: Vec<usize> = (0..self.rows.len()).filter(|i| self.rows[*i].number > 0).collect();
        let of = |i: usize| (self.rows[i].recording, self.rows[i].stretch, self.rows[i].number, self.rows[i].axis);
        consecutive(&carried, &|i| self.rows[i].time_s, self.period_s, &|a, b| of(a) == of(b))
    }

    fn errors(
        &self,
        study: &ChannelFit,
        window: &[usize],
        picks: &[usize],
        values: &[f64],
    ) -> Result<(f64, f64), String> {
        let Row { number, axis, .. } = self.rows[window[0]];
        let weight_n = self.weight_n(number, values);
        let up = if axis == 1 { 1.0 } else { 0.0 };
        // A block's swinging in the pads, if it is in the model, is no motion of the grip.
        let swings = self.open() + self.ties.len() + number - 1;
        let swing_n = |i: usize| study.base.get(swings).map_or(0.0, |column| values[swings] * column[i]);
        let mut drive: Vec<f64> = window.iter().map(|i| self.rows[*i].force_n - up * weight_n - swing_n(*i)).collect();
        let (mut mass_kg, mut drag) = (weight_n / self.gravity_m_s2, 0.0);
        let mut ties: Vec<Cable> = self.of_world(number, values).into_iter().collect();
        for (candidate, own) in study.with_values(picks, values) {
            let at = |name: &str| candidate.searched.iter().find(|s| s.name == name).map_or(0.0, |s| s.value);
            match candidate.id {
                // One mass for all blocks, or each its own.
                inertia::ID => mass_kg += own.get(number - 1).filter(|_| own.len() > 1).unwrap_or(&own[0]),
                viscous_friction::ID => drag += own[0],
                added_constraint::ID if self.tied(&candidate.columns[0]) != number => {}
                added_constraint::ID => ties.push(Cable {
                    stiffness_n_m: own[0],
                    damping_n_s_m: own.get(1).copied().unwrap_or(0.0).max(0.0),
                    anchor_m: Vec2::new(at("anchor x"), at("anchor y")),
                    length_m: at("length"),
                }),
                // Effects that do not depend on the motion, and faults of the sensors.
                _ => candidate.columns.iter().zip(own).for_each(|(column, value)| {
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
            let Row { time_s, place_m, velocity_m_s, .. } = self.rows[*i];
            let motion = Motion { time_s, position: place_m[axis], velocity: velocity_m_s[axis], ..Motion::default() };
            Moment { motion, drive: *drive, beside: [place_m[across], velocity_m_s[across]] }
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
