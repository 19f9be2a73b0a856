//! Free-run simulation of a needle: a hand holds it on its measured path, and the sheet or the hole acts on it.

use super::hole::{RIM_SHARE, rim};
use super::rows::{Needle, Phase, Row};
use super::sheet::{Law, first_push_n, own_n};
use crate::diagnose::contract::RolloutOf;
use crate::diagnose::data::regression_data::Track;
use crate::diagnose::extension::model::without_friction;
use crate::diagnose::free_run::channel::{Forward, consecutive};
use crate::diagnose::free_run::integrate::{Moment, Side, remembered, run};
use crate::diagnose::free_run::windows::NO_LAW;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::coulomb_friction;
use crate::diagnose::selection::comparison::ChannelFit;
use haptics::law::object::{MembraneHistory, MembraneLaw};
use haptics::law::{Effect, Inertia, Kind, Memories, Motion};

/// Parts common to both simulations: the world's law, and the indices of the model's regressors.
struct Model {
    law: Option<MembraneLaw>,
    period_s: f64,
    /// Number of regressors for the held weight, and true if the needle's mass is a regressor.
    holds: usize,
    two_fingered: bool,
}

impl Model {
    fn new(needle: &Needle, law: Option<&MembraneLaw>) -> Self {
        let (holds, two_fingered) = (needle.holds, needle.two_fingered);
        Self { law: law.copied(), period_s: needle.period_s, holds, two_fingered }
    }

    /// A negative mass is noise of a zero one.
    fn inertia(&self, mass: usize, values: &[f64]) -> Vec<Effect> {
        let kg = if self.two_fingered { values[mass].max(0.0) } else { 0.0 };
        vec![Effect::new(&Inertia, &[kg])]
    }
}

/// Measured force less the contribution of these regressors in a row, N.
fn drive(study: &ChannelFit, row: usize, columns: &[(&[f64], f64)]) -> f64 {
    study.y[row] - columns.iter().map(|(column, value)| value * column[row]).sum::<f64>()
}

/// Regressors of candidates with their coefficients.
fn faults<'a>(of: impl Iterator<Item = (&'a Candidate, &'a [f64])>) -> impl Iterator<Item = (&'a [f64], f64)> {
    of.flat_map(|(candidate, own)| candidate.columns.iter().map(|c| c.as_slice()).zip(own.iter().copied()))
}

fn motion(row: &Row) -> Motion {
    Motion { time_s: row.time_s, position: row.depth_m, velocity: row.rate_m_s, ..Motion::default() }
}

/// Simulation of a needle outside of a sheet, and on one that is not pierced yet.
pub struct Pressed {
    model: Model,
    stiffness_n_m: f64,
    /// Rows in the order of the comparison.
    rows: Vec<Row>,
}

impl Pressed {
    pub fn new(needle: &Needle, law: Option<&MembraneLaw>, rows: Vec<Row>) -> Self {
        Self { model: Model::new(needle, law), stiffness_n_m: needle.stiffness_n_m, rows }
    }

    /// Deepest indentation of the sheet so far at the place of a row, m.
    fn deepest_m(&self, at: &Row) -> f64 {
        let here = |r: &&Row| r.recording == at.recording && r.push == at.push && r.time_s <= at.time_s;
        let touched = |r: &&Row| matches!(r.phase, Phase::Loading | Phase::Unloading);
        self.rows.iter().filter(here).filter(touched).map(|r| r.deepest_m).fold(0.0, f64::max)
    }
}

impl Forward for Pressed {
    fn of(&self) -> (RolloutOf, &str) {
        (RolloutOf::Force, "N")
    }

    fn windows(&self) -> Vec<Vec<usize>> {
        // The comparison deals its rows into separate segments.
        let mut order: Vec<usize> = (0..self.rows.len()).collect();
        order.sort_by(|a, b| self.rows[*a].time_s.total_cmp(&self.rows[*b].time_s));
        let of = |i: usize| {
            let Row { recording, hold, push, phase, .. } = self.rows[i];
            (recording, hold, push, phase == Phase::Empty)
        };
        consecutive(&order, &|i| self.rows[i].time_s, self.model.period_s, &|a, b| of(a) == of(b))
    }

    fn errors(
        &self,
        study: &ChannelFit,
        window: &[usize],
        picks: &[usize],
        values: &[f64],
    ) -> Result<(f64, f64), String> {
        let Model { law, holds, .. } = &self.model;
        let law = law.as_ref();
        let elastic = |x: f64| first_push_n(self.stiffness_n_m, law, x);
        let laws: Vec<(Law, f64)> =
            study.with_values(picks, values).filter_map(|(c, own)| Some((Law::of(c)?, own[0]))).collect();
        let of_motion = [Some(*holds), self.model.two_fingered.then_some(holds + 1)];
        let constant = study.base.iter().enumerate().filter(|(k, _)| !of_motion.contains(&Some(*k)));
        let mut beside: Vec<(&[f64], f64)> = constant.map(|(k, column)| (column.as_slice(), values[k])).collect();
        beside.extend(faults(study.with_values(picks, values).filter(|(c, _)| Law::of(c).is_none())));
        let moment =
            |i: &usize| Moment { motion: motion(&self.rows[*i]), drive: drive(study, *i, &beside), beside: [0.0; 2] };
        let moments: Vec<Moment> = window.iter().map(moment).collect();
        let first = self.rows[window[0]];
        // Empty fingers touch no sheet and carry only their own mass.
        let is_held = first.phase != Phase::Empty;
        let mut deepest_m = self.deepest_m(&first);
        let acts = &mut |motion: &Motion, _: [f64; 2]| {
            if !is_held {
                return 0.0;
            }
            let (depth_m, rate_m_s) = (motion.position, motion.velocity);
            let phase = if depth_m >= deepest_m { Phase::Loading } else { Phase::Unloading };
            deepest_m = deepest_m.max(depth_m);
            let row = Row { depth_m, rate_m_s, phase, deepest_m, ..first };
            let more = laws.iter().map(|(law, value)| value * law.unit_n(&row, &elastic)).sum::<f64>();
            values[*holds] * own_n(law, &row) + more
        };
        let effects = if is_held { self.model.inertia(holds + 1, values) } else { Vec::new() };
        Ok(run(&moments, Side { effects: &effects, memory: Memories::default(), acts, driven: false }))
    }
}

/// A needle in its hole.
pub struct Sliding {
    model: Model,
    rows: Vec<Row>,
    track: Track,
    /// Dry friction to which shares refer, N.
    dry_n: f64,
}

impl Sliding {
    pub fn new(needle: &Needle, law: Option<&MembraneLaw>, (rows, track): (&[Row], Track), dry_n: f64) -> Self {
        Self { model: Model::new(needle, law), rows: rows.to_vec(), track, dry_n }
    }

    /// Rows of the same hole up to the first of a window.
    fn past(&self, first: usize) -> std::ops::RangeInclusive<usize> {
        let of = |i: usize| (self.rows[i].recording, self.rows[i].push);
        let began = (0..first).rev().find(|i| of(*i) != of(first));
        began.map_or(0, |i| i + 1)..=first
    }
}

impl Forward for Sliding {
    fn of(&self) -> (RolloutOf, &str) {
        (RolloutOf::Force, "N")
    }

    fn windows(&self) -> Vec<Vec<usize>> {
        let all: Vec<usize> = (0..self.rows.len()).collect();
        let of = |i: usize| (self.rows[i].stretch, self.rows[i].push);
        consecutive(&all, &|i| self.rows[i].time_s, self.model.period_s, &|a, b| of(a) == of(b))
    }

    fn errors(
        &self,
        study: &ChannelFit,
        window: &[usize],
        picks: &[usize],
        values: &[f64],
    ) -> Result<(f64, f64), String> {
        let no_law = || NO_LAW.to_owned();
        let mass = self.model.holds;
        let mut plant: Vec<(&Candidate, &[f64])> =
            study.with_values(picks, values).filter(|(c, _)| c.kind == Kind::Plant).collect();
        // Friction that bends before it slides is subtracted from the dry friction, which must come first.
        plant.sort_by_key(|(c, _)| c.id != coulomb_friction::ID);
        // A hole that differs from one insertion to the next is no change in time.
        if plant.iter().any(|(c, _)| c.searched.iter().any(|s| s.name == "from insertion")) {
            return Err(no_law());
        }
        let (candidates, own): (Vec<&Candidate>, Vec<&[f64]>) = plant.into_iter().unzip();
        let effects = self.model.inertia(mass, values);
        let effects =
            without_friction(&self.track, effects, self.dry_n, &candidates, &own.concat()).ok_or_else(no_law)?;
        let mut beside: Vec<(&[f64], f64)> =
            study.base[..self.model.holds].iter().map(Vec::as_slice).zip(values.iter().copied()).collect();
        beside.extend(faults(study.with_values(picks, values).filter(|(c, _)| c.kind == Kind::Instrument)));
        let moment = |i: &usize| Moment {
            motion: self.track.rows[*i].motion,
            drive: drive(study, *i, &beside),
            beside: [0.0; 2],
        };
        let moments: Vec<Moment> = window.iter().map(moment).collect();
        let past = self.past(window[0]);
        let before: Vec<Motion> = past.clone().map(|i| self.track.rows[i].motion).collect();
        // A world's hole: as stiff as the sheet, and slightly stiffer, as in the regressors.
        let first = mass + usize::from(self.model.two_fingered);
        let of_world = self.model.law.map(|law| {
            let stiffer = MembraneLaw { stiffness_n_m: (1.0 + RIM_SHARE) * law.stiffness_n_m, ..law };
            [rim(&law), rim(&stiffer)]
        });
        let mut histories = [MembraneHistory::default(); 2];
        let mut held = |motion: &Motion| -> [f64; 2] {
            let Some(laws) = &of_world else { return [0.0; 2] };
            [0, 1].map(|k| laws[k].force_n(motion.position.max(1e-6), motion.velocity, &mut histories[k]))
        };
        for motion in &before {
            held(motion);
        }
        let worlds = self.model.law.map(|_| [values[first], values[first + 1], values[first + 2]]);
        let acts = &mut |motion: &Motion, _: [f64; 2]| {
            let Some([stiffer, factor, drag]) = worlds else { return 0.0 };
            let [own, other] = held(motion);
            stiffer * (other - own) + factor * own + drag * motion.velocity
        };
        Ok(run(&moments, Side { effects: &effects, memory: remembered(&effects, &before), acts, driven: false }))
    }
}
