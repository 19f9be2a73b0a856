//! Force along one coordinate: its residual, and the causes that explain it.

use crate::diagnose::data::direction::{STICKING_ROWS_TOGETHER, blur, blurred};
use crate::diagnose::data::limits::REFINEMENTS;
use crate::diagnose::data::plain_fit::PlainFit;
use crate::diagnose::data::regression_data::{Model, Place, Row, Track};
use crate::diagnose::data::row_means::column;
use crate::diagnose::data::stick_phases::Load;
use crate::diagnose::data::{known_weight, stick_phases};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::covariate::covariates;
use crate::diagnose::hypotheses::dictionary::Dictionary;
use crate::diagnose::hypotheses::grid::Grid;
use crate::diagnose::hypotheses::regressor_cache::Columns;
use crate::diagnose::hypotheses::{
    backlash, coulomb_friction, force_bias, force_cross_axis, force_drift, force_gain, force_step, hysteresis,
    quadratic_drag, time_delay, viscous_friction,
};
use crate::diagnose::model_error::of_coordinate::discrepancies;
use crate::diagnose::model_error::smooth::Discrepancy;
use crate::diagnose::selection::channel::{Channel, leave_out_what_is_unsure};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::dry_friction::{dry_level, friction_is_sound, is_resisting, shares_of, total};
use crate::diagnose::selection::layout::Noise;
use crate::diagnose::selection::layout::{Blocks, Held, Layout};
use crate::diagnose::selection::refinement::{Refinement, refined};
use crate::diagnose::selection::restarts::to_refine;
use crate::diagnose::selection::rules::Rules;
use crate::diagnose::selection::stepwise::SelectedTerm;
use estimation::regression::linear::least_squares_values;
use foundation::estimate::EstimateError;
use haptics::Vec2;
use haptics::law::{CoulombFriction, Effect, ForceDrift, Law, Stribeck, ViscousFriction};

/// The same for a free motion, whose noise becomes smaller if it swings.
/// Choice: no case of the ablation reads it.
const REFINEMENTS_OF_FREE: usize = 5;

/// Compares all causes on a track. `fixed`: laws that are completely known.
pub fn study(track: &mut Track, model: &Model, fixed: &Model) -> Result<ChannelFit, EstimateError> {
    blur(track);
    let loads = loads(track, model, fixed)?;
    // Without a force, a stick phase under load cannot be distinguished from one without.
    if track.freely.is_none() {
        stick_phases::add(track, &loads);
    }
    let is_free = track.freely.is_some();
    let coarse = Grid::coarse(track);
    let (fine, columns) = (Grid::default(), Columns::default());
    let mut search = Search { track, model, fixed, coarse, fine, columns, errors: None, is_sharp: false, noise: None };
    let mut made = refined(&mut search, if is_free { REFINEMENTS_OF_FREE } else { REFINEMENTS })?;
    // The blur of a mechanism's direction is an assumption. If it is too wide, the friction of all slow motion is
    // estimated too small, which looks like friction that rises there.
    let rises = |study: &ChannelFit| study.has(Stribeck.id());
    if !search.track.planar && rises(&made) {
        search.is_sharp = true;
        let found: Vec<&Candidate> = made.chosen.iter().map(|c| &made.candidates[c.candidate]).collect();
        search.fine = Grid::around(&found, search.track, 1.0);
        let sharp = search.compare(None)?;
        if !rises(&sharp) {
            made = sharp;
        }
    }
    leave_out_what_is_unsure(&mut made);
    if !made.errors.is_empty() {
        let predicted: Vec<f64> = made.target.iter().zip(made.residual(&[])).map(|(y, r)| y - r).collect();
        made.errors = discrepancies(track, &made.layout.time_s, &predicted);
    }
    Ok(made)
}

/// A comparison on a track, with what is common to all rounds.
struct Search<'a> {
    track: &'a mut Track,
    /// Laws that are fitted, and those of which everything is known.
    model: &'a Model,
    fixed: &'a Model,
    coarse: Grid,
    /// Values around those found.
    fine: Grid,
    columns: Columns,
    /// Structured errors of the first round, or of the last one in which the load changed.
    errors: Option<Vec<Discrepancy>>,
    /// True if the width of the direction's blur is reduced.
    is_sharp: bool,
    /// Noise of the rows along the motion, N or N m. Without a measured noise, it is the residual of a plain fit.
    noise: Option<f64>,
}

/// Ratio of residuals (extended over base model) below which the weights of the rows are computed again.
/// Choice: halved, 1 of 3 answers change; doubled, 0 of 3 answers change.
const CALMER: f64 = 0.7;
/// Difference of log noise below which two noise levels count as equal.
/// Choice: halved or doubled, none of 1 answers changes.
const SAME_NOISE: f64 = 0.2;

/// Residual RMS of the extended model along the motion, as the noise of the rows. `None` if the noise was measured, or
/// is not much less than the base model's residual. Hidden causes count as noise at first, and beside such noise an
/// uncertain direction hardly reduces a row's weight.
fn calmer(track: &Track, made: &ChannelFit) -> Option<f64> {
    if track.noise_is_measured {
        return None;
    }
    let rms = |picks: &[usize]| -> Option<f64> {
        let solved = made.system.solve(picks)?;
        let residual = made.residual_of(picks, &solved);
        let (sum, rows) = track.along().fold((0.0, 0.0), |(sum, rows), i| {
            let weight = made.layout.weight[i].powi(2);
            (sum + weight * residual[i].powi(2), rows + weight)
        });
        Some((sum / f64::max(rows, 1e-12)).sqrt())
    };
    let (model, found) = (rms(&[])?, rms(&made.picks())?);
    (found < CALMER * model).then_some(found)
}

/// Removes the sensor faults found from the force across the motion; true if the load changed.
fn correct_load(track: &mut Track, study: &ChannelFit) -> bool {
    if !track.planar {
        return false;
    }
    let faults = study.found();
    let bearing = track.bearing;
    let mut changes = false;
    for row in track.rows.iter_mut().filter(|r| r.place == Place::Along) {
        let outward = Vec2::new(row.along.y, -row.along.x);
        let mut force = row.force;
        for (candidate, values) in &faults {
            let tau = candidate.searched.first().map_or(0.0, |s| s.value);
            let size = |law: &'static dyn Law| Effect::new(law, &[1.0, tau]).force(&row.motion);
            force -= match (candidate.id, candidate.linear[0].0) {
                (force_bias::ID, _) => Vec2::new(values[0], values[1]),
                (force_drift::ID, _) => Vec2::new(values[0], values[1]) * size(&ForceDrift),
                (force_step::ID, _) => force_step::vector_at(candidate, values, row.motion.time_s),
                (force_cross_axis::ID, "kappa_xy") => Vec2::new(values[0] * row.force.y, 0.0),
                (force_cross_axis::ID, "kappa_turned") => Vec2::new(-row.force.y, row.force.x) * values[0],
                (force_cross_axis::ID, _) => Vec2::new(0.0, values[0] * row.force.x),
                (force_gain::ID, _) => row.force * (values[0] / (1.0 + values[0]).max(0.1)),
                (time_delay::ID, _) => row.force_rate * -values[0],
                _ => Vec2::zeros(),
            };
        }
        let load_n = force.dot(&outward) + bearing.load_n(row);
        changes |= load_n.to_bits() != row.motion.normal_force_n.to_bits();
        row.motion.normal_force_n = load_n;
    }
    changes
}

impl Refinement for Search<'_> {
    /// The whitening of the round before stays: the same things together leave the same residual.
    fn compare(&mut self, before: Option<ChannelFit>) -> Result<ChannelFit, EstimateError> {
        let (track, model) = (&*self.track, self.model);
        let Asked { mut base, known, y } = asked(track, model, self.fixed);
        let Look { mut predicted, mut resisting, weight, slides: mut dry } =
            first_look(track, model, (&base, &y), self.noise)?;
        // Coefficients of the model's laws, estimated together with the causes of the last round.
        let laws = before.as_ref().and_then(|b| Some(&b.solved.as_ref()?.values[..b.baseline.len()]));
        if let Some(laws) = laws.filter(|laws| friction_is_sound(model, laws)) {
            (predicted, resisting) =
                (total(y.len(), model, &base, laws, false), total(y.len(), model, &base, laws, true));
            dry = (0..y.len()).map(|i| dry_level(track, model, laws, i)).collect();
        }
        let taken: Vec<&str> = model.iter().chain(self.fixed).map(|e| e.law().id()).collect();
        let dictionary = |grid| {
            let (predicted, resisting, dry) = (&predicted, &resisting, &dry);
            Dictionary {
                track,
                predicted,
                resisting,
                dry,
                fixed: &known,
                without: &taken,
                grid,
                columns: &self.columns,
            }
        };
        let mut candidates = dictionary(&self.coarse).candidates();
        candidates.extend(dictionary(&self.fine).searched());
        let losses = candidates.iter().filter(|c| [hysteresis::ID, backlash::ID].contains(&c.id));
        let losses: Vec<&[f64]> = losses.map(|c| c.regressors[0].as_slice()).collect();
        base.extend(stick_phases::creep(track, &y, &losses));
        base.extend(self.is_sharp.then(|| blurred(track, &dry)));
        candidates.extend(covariates(track));
        // One decay takes time and amplitude away together: causes over time or place are not told from those of speed.
        if track.freely.is_some_and(|free| free.is_energy) {
            candidates.retain(|c| [coulomb_friction::ID, viscous_friction::ID, quadratic_drag::ID].contains(&c.id));
        }
        let rules = Rules::of_coordinate(track.period_s)
            .with_friction(model.iter().any(|e| e.law().is_dry()))
            .with_noise(track.noise_is_measured);
        let resisting = (0..model.len()).filter(|k| is_resisting(&model[*k])).collect();
        let layout = layout(track, weight);
        // A free motion has too few rows for structured errors. Pads that bend before a block slides look like several.
        let make = || {
            if track.freely.is_some() || taken.contains(&hysteresis::ID) {
                Vec::new()
            } else {
                discrepancies(track, &layout.time_s, &predicted)
            }
        };
        let errors = self.errors.get_or_insert_with(make).clone();
        let mut study =
            Channel { target: y, baseline: base, resisting, candidates, errors, layout, rules }.select(before)?;
        study.shares_of = shares_of(track, model, &dry, &study);
        Ok(study)
    }

    /// One cause alone is as near after the first round as it needs be; beside others, what it misses may pass for one
    /// of them. The long means of a free motion show so much more of a place that one alone is not near enough either.
    fn close_in(&mut self, made: &ChannelFit, round: usize) -> bool {
        let is_free = self.track.freely.is_some();
        let searched = |c: &SelectedTerm| !made.candidates[c.candidate].searched.is_empty();
        let enough = if is_free { round > 0 && !made.chosen.iter().any(searched) } else { made.chosen.len() <= round };
        if made.chosen.is_empty() || enough {
            return false;
        }
        let step = if is_free { 0.5_f64.powf(round as f64) } else { 1.0 / (1 + round) as f64 };
        self.fine = Grid::around(&to_refine(made), self.track, step);
        self.noise = match (self.noise, calmer(self.track, made)) {
            (Some(before), Some(now)) if (now / before).ln().abs() < SAME_NOISE => Some(before),
            (before, now) => now.or(before),
        };
        // Load on the friction: the sensor's reading, corrected for its faults found so far.
        if correct_load(self.track, made) {
            self.columns.forget_loads();
            self.errors = None;
        }
        true
    }
}

/// The rows of a track, with these weights.
fn layout(track: &Track, weight: Vec<f64>) -> Layout {
    let held = |row: &Row| match row.place {
        Place::Along => Held::Fully,
        Place::Stuck { .. } => Held::ByFolds,
        Place::FreeX | Place::FreeY => Held::Never,
    };
    Layout {
        segment: track.rows.iter().map(|r| r.segment).collect(),
        held: track.rows.iter().map(held).collect(),
        // One recording after the other.
        time_s: track.rows.iter().map(|r| r.recording as f64 * (track.span_s + 1.0) + r.motion.time_s).collect(),
        weight,
        period_s: track.period_s,
        noise: if track.freely.is_some_and(|free| !free.is_energy) { Noise::OfDifferences } else { Noise::Any },
        may_stand: true,
        blocks: Blocks::OfTime,
    }
}

/// Residual RMS of the model with Coulomb friction, and true if its friction opposes motion.
pub fn plain_rms(track: &mut Track, model: &Model) -> Result<(f64, bool), EstimateError> {
    blur(track);
    blurred_rms(track, model)
}

/// The same for rows whose directions are already blurred.
pub fn blurred_rms(track: &Track, model: &Model) -> Result<(f64, bool), EstimateError> {
    let plain = PlainFit::of(track, &Model::new());
    let mut columns = plain.laws(model);
    columns.extend(plain.laws(&[Effect::new(&CoulombFriction, &[1.0])]));
    let fit = plain.fit(&columns)?;
    let resisting: f64 = (0..track.rows.len())
        .map(|i| {
            let parts =
                model.iter().enumerate().filter(|(_, e)| is_resisting(e)).map(|(k, _)| fit.values[k] * columns[k][i]);
            let coulomb = fit.values[model.len()] * columns[model.len()][i];
            (parts.sum::<f64>() + coulomb) * track.rows[i].motion.direction
        })
        .sum();
    Ok((fit.rms, resisting > 0.0))
}

/// Regressors and target of a fit.
struct Asked {
    /// Regressors of the model's laws.
    base: Vec<Vec<f64>>,
    /// Forces that are completely known, including a hung weight's.
    known: Vec<Vec<f64>>,
    /// The measured force less the known ones.
    y: Vec<f64>,
}

fn asked(track: &Track, model: &Model, fixed: &Model) -> Asked {
    let base = model.iter().map(|effect| column(track, effect)).collect();
    let known: Vec<Vec<f64>> =
        fixed.iter().map(|effect| column(track, effect)).chain(known_weight::column(track)).collect();
    let unknown = |(i, row): (usize, &Row)| row.target - known.iter().map(|k| k[i]).sum::<f64>();
    let y = track.rows.iter().enumerate().map(unknown).collect();
    Asked { base, known, y }
}

/// Result of a first plain fit for every row.
struct Look {
    /// Force predicted by the model, and the part of it that opposes motion.
    predicted: Vec<f64>,
    resisting: Vec<f64>,
    weight: Vec<f64>,
    /// The dry friction if it slid.
    slides: Vec<f64>,
}

/// A first plain fit: predicted force, its resisting part, weight of each row with an uncertain direction (effective
/// variance, Orear 1982), and dry friction of each row if it slid. `noise`: of a row, if known.
fn first_look(
    track: &Track,
    model: &Model,
    (base, y): (&[Vec<f64>], &[f64]),
    noise: Option<f64>,
) -> Result<Look, EstimateError> {
    let mut columns = base.to_vec();
    let together = if track.planar { STICKING_ROWS_TOGETHER } else { 1.0 };
    let has = |law: &dyn Law| model.iter().any(|e| e.law().id() == law.id());
    let has_dry = has(&CoulombFriction);
    // Resistance that the model lacks. With dry friction alone, viscous friction would be attributed to it.
    let missing: [(&'static dyn Law, bool); 2] =
        [(&CoulombFriction, has_dry), (&ViscousFriction, has_dry || has(&ViscousFriction))];
    for (law, _) in missing.iter().filter(|(_, there)| !there) {
        columns.push(column(track, &Effect::new(*law, &[1.0])));
    }
    let along: Vec<f64> = track.rows.iter().map(|r| f64::from(u8::from(r.place == Place::Along))).collect();
    let mut weight = along.clone();
    let mut fit = least_squares_values(&columns, y, Some(&weight))?;
    let dry = |values: &[f64], i: usize| -> f64 {
        dry_level(track, model, values, i) + if has_dry { 0.0 } else { values[base.len()].abs() }
    };
    for _ in 0..2 {
        let noise =
            if track.noise_is_measured { track.force_noise } else { noise.unwrap_or(fit.rms).max(track.force_noise) };
        weight = (0..y.len())
            .map(|i| {
                let row = &track.rows[i];
                if row.place != Place::Along {
                    return 1.0;
                }
                // If the sign is unknown, so is all of the friction.
                let open = together * dry(&fit.values, i).powi(2) * row.open;
                // Coarse steps may leave no residual.
                if open > 0.0 { (1.0 + open / (noise * noise)).powf(-0.5) } else { 1.0 }
            })
            .collect();
        let squares: Vec<f64> = weight.iter().zip(&along).map(|(w, a)| w * w * a).collect();
        fit = least_squares_values(&columns, y, Some(&squares))?;
    }
    let sum = |resists: bool| -> Vec<f64> {
        let mut sum = total(y.len(), model, base, &fit.values, resists);
        for (column, value) in columns.iter().zip(&fit.values).skip(base.len()) {
            sum.iter_mut().zip(column).for_each(|(s, c)| *s += value * c);
        }
        sum
    };
    let slides = (0..y.len()).map(|i| dry(&fit.values, i)).collect();
    Ok(Look { predicted: sum(false), resisting: sum(true), weight, slides })
}

/// Load on the friction in each row along the motion, as far as a plain fit determines it.
fn loads(track: &Track, model: &Model, fixed: &Model) -> Result<Vec<Option<Load>>, EstimateError> {
    let Asked { base, y, .. } = asked(track, model, fixed);
    let Look { predicted, resisting, slides, .. } = first_look(track, model, (&base, &y), None)?;
    let load = |i: usize| {
        let friction = slides[i];
        let held = y[i] - (predicted[i] - resisting[i]);
        (friction > 0.0).then(|| Load { share: held / friction, whole: y[i] / friction, friction })
    };
    Ok((0..y.len()).map(load).collect())
}
