//! Free-run simulation of a needle: a hand holds it on its measured path, and the sheet or the hole acts on it.

use super::forces::{Law, RIM_SHARE, first_push_n, own_n, rim};
use super::rows::{Needle, Phase, Row};
use crate::diagnose::data::regression_data::Track;
use crate::diagnose::extension::model::without_friction;
use crate::diagnose::free_run::channel::{Fit, Forward, consecutive};
use crate::diagnose::free_run::integrate::{Side, over, remembered};
use crate::diagnose::free_run::windows::{Errors, NO_LAW};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::coulomb_friction;
use haptics::law::object::{MembraneHistory, MembraneLaw};
use haptics::law::{Effect, Inertia, Kind, Memories, Motion};

/// Inertia of a needle whose mass is the regressor of this number, if it is one. A negative mass is noise of a zero one.
fn inertia(needle: &Needle, mass: usize, values: &[f64]) -> Vec<Effect> {
    let kg = if needle.two_fingered { values[mass].max(0.0) } else { 0.0 };
    vec![Effect::new(&Inertia, &[kg])]
}

/// Regressors of candidates with their coefficients.
fn faults<'a>(of: impl Iterator<Item = (&'a Candidate, &'a [f64])>) -> impl Iterator<Item = (&'a [f64], f64)> {
    of.flat_map(|(candidate, own)| candidate.regressors.iter().map(|c| c.as_slice()).zip(own.iter().copied()))
}

/// Simulation of a needle outside of a sheet, and on one that is not pierced yet.
pub struct Pressed<'a> {
    pub needle: &'a Needle,
    /// The sheet of the world.
    pub law: Option<&'a MembraneLaw>,
    /// Rows in the order of the comparison.
    pub rows: Vec<Row>,
}

impl Pressed<'_> {
    /// Deepest indentation of the sheet so far at the place of a row, m.
    fn deepest_m(&self, at: &Row) -> f64 {
        let here = |r: &&Row| r.recording == at.recording && r.push == at.push && r.time_s <= at.time_s;
        let touched = |r: &&Row| matches!(r.phase, Phase::Loading | Phase::Unloading);
        self.rows.iter().filter(here).filter(touched).map(|r| r.deepest_m).fold(0.0, f64::max)
    }
}

impl Forward for Pressed<'_> {
    fn windows(&self) -> Vec<Vec<usize>> {
        // The comparison deals its rows into separate segments.
        let mut order: Vec<usize> = (0..self.rows.len()).collect();
        order.sort_by(|a, b| self.rows[*a].time_s.total_cmp(&self.rows[*b].time_s));
        let of = |i: usize| {
            let Row { recording, hold, push, phase, .. } = self.rows[i];
            (recording, hold, push, phase == Phase::Empty)
        };
        consecutive(&order, &|i| self.rows[i].time_s, self.needle.period_s, &|a, b| of(a) == of(b))
    }

    fn errors(&self, fit: &Fit<'_>, window: &[usize]) -> Result<Errors, String> {
        let Self { needle, law, .. } = *self;
        let holds = needle.holds;
        let elastic = |x: f64| first_push_n(needle.stiffness_n_m, law, x);
        let give = law.map_or(0.0, |l| l.give);
        let laws: Vec<(Law, f64)> = fit.causes().filter_map(|(c, own)| Some((Law::of(c)?, own[0]))).collect();
        let of_motion = [Some(holds), needle.two_fingered.then_some(holds + 1)];
        let of_model = fit.columns().take(fit.study.baseline.len()).enumerate();
        let constant = of_model.filter(|(k, _)| !of_motion.contains(&Some(*k))).map(|(_, column)| column);
        let of_faults = faults(fit.causes().filter(|(c, _)| Law::of(c).is_none()));
        let beside: Vec<(&[f64], f64)> = constant.chain(of_faults).collect();
        let row = |i: usize| {
            let Row { time_s, depth_m: position, rate_m_s: velocity, .. } = self.rows[i];
            (Motion { time_s, position, velocity, ..Motion::default() }, fit.less(i, &beside))
        };
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
            let more = laws.iter().map(|(law, value)| value * law.unit_n(&row, &elastic, give)).sum::<f64>();
            fit.values[holds] * own_n(law, &row) + more
        };
        let effects = if is_held { inertia(needle, holds + 1, fit.values) } else { Vec::new() };
        Ok(over(window, &row, Side { effects: &effects, memory: Memories::default(), acts, driven: false }))
    }
}

/// A needle in its hole.
pub struct Sliding<'a> {
    pub needle: &'a Needle,
    /// The hole of the world.
    pub law: Option<&'a MembraneLaw>,
    pub rows: Vec<Row>,
    pub track: Track,
    /// Dry friction to which shares refer, N.
    pub dry_n: f64,
}

impl Sliding<'_> {
    /// Rows of the same hole up to the first of a window.
    fn past(&self, first: usize) -> std::ops::RangeInclusive<usize> {
        let of = |i: usize| (self.rows[i].recording, self.rows[i].push);
        let began = (0..first).rev().find(|i| of(*i) != of(first));
        began.map_or(0, |i| i + 1)..=first
    }
}

impl Forward for Sliding<'_> {
    fn windows(&self) -> Vec<Vec<usize>> {
        let all: Vec<usize> = (0..self.rows.len()).collect();
        let of = |i: usize| (self.rows[i].stretch, self.rows[i].push);
        consecutive(&all, &|i| self.rows[i].time_s, self.needle.period_s, &|a, b| of(a) == of(b))
    }

    fn errors(&self, fit: &Fit<'_>, window: &[usize]) -> Result<Errors, String> {
        let no_law = || NO_LAW.to_owned();
        let (mass, values) = (self.needle.holds, fit.values);
        let mut plant: Vec<(&Candidate, &[f64])> = fit.causes().filter(|(c, _)| c.kind == Kind::Plant).collect();
        // Friction that bends before it slides is subtracted from the dry friction, which must come first.
        plant.sort_by_key(|(c, _)| c.id != coulomb_friction::ID);
        // A hole that differs from one insertion to the next is no change in time.
        if plant.iter().any(|(c, _)| c.searched.iter().any(|s| s.name == "from insertion")) {
            return Err(no_law());
        }
        let (candidates, own): (Vec<&Candidate>, Vec<&[f64]>) = plant.into_iter().unzip();
        let effects = inertia(self.needle, mass, values);
        let effects =
            without_friction(&self.track, effects, self.dry_n, &candidates, &own.concat()).ok_or_else(no_law)?;
        let of_faults = faults(fit.causes().filter(|(c, _)| c.kind == Kind::Instrument));
        let beside: Vec<(&[f64], f64)> = fit.columns().take(mass).chain(of_faults).collect();
        let row = |i: usize| (self.track.rows[i].motion, fit.less(i, &beside));
        let past = self.past(window[0]);
        let before: Vec<Motion> = past.clone().map(|i| self.track.rows[i].motion).collect();
        // A world's hole: as stiff as the sheet, and slightly stiffer, as in the regressors.
        let first = mass + usize::from(self.needle.two_fingered);
        let of_world = self.law.map(|law| {
            let stiffer = MembraneLaw { stiffness_n_m: (1.0 + RIM_SHARE) * law.stiffness_n_m, ..*law };
            [rim(law), rim(&stiffer)]
        });
        let mut histories = [MembraneHistory::default(); 2];
        let mut held = |motion: &Motion| -> [f64; 2] {
            let Some(laws) = &of_world else { return [0.0; 2] };
            [0, 1].map(|k| laws[k].force_n(motion.position.max(f64::MIN_POSITIVE), motion.velocity, &mut histories[k]))
        };
        for motion in &before {
            held(motion);
        }
        let worlds = self.law.map(|_| [values[first], values[first + 1], values[first + 2]]);
        let acts = &mut |motion: &Motion, _: [f64; 2]| {
            let Some([stiffer, factor, drag]) = worlds else { return 0.0 };
            let [own, other] = held(motion);
            stiffer * (other - own) + factor * own + drag * motion.velocity
        };
        let memory = remembered(&effects, &before);
        Ok(over(window, &row, Side { effects: &effects, memory, acts, driven: false }))
    }
}
