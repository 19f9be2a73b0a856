//! The force that the motion needs: what the model leaves of it, and which causes explain that.

use super::blur::{TOGETHER, blur, blurred};
use super::candidate::Candidate;
use super::columns::Columns;
use super::compare::whitening as whitening_of;
use super::dictionary::Dictionary;
use super::friction::{dry_level, friction_is_sound, is_resisting, shares_of, total};
use super::gain::{confirmed, gain};
use super::generic::generic;
use super::geometry::{Study, residual};
use super::grid::Grid;
use super::hung;
use super::means::column;
use super::searched::firsts;
use super::select::{Chosen, Selection};
use super::starts::to_refine;
use super::stuck::{self, Load};
use super::system::{Held, Rows, System};
use super::track::{Place, Row, Track};
use super::white::Noise;
use crate::estimate::EstimateError;
use crate::identify::linear::{least_squares, least_squares_values};
use haptics::Vec2;
use haptics::law::{CoulombFriction, Effect, ForceDrift, Law, Memory, Stribeck, ViscousFriction};
use std::collections::HashMap;

/// Most rounds in which searched values and the sensor's faults are settled.
const REFINEMENTS: usize = 2;
/// … and of a free motion, whose noise is less where it swings.
const REFINEMENTS_OF_FREE: usize = 5;

/// What a model misses is alike within about such times, s: as long as a hand takes for a turn and for a stroke.
pub const PIECES_S: [f64; 3] = [0.25, 0.5, 1.0];

/// The model to start from: laws with their non-linear values.
pub type Model = Vec<Effect>;

/// Compares all causes on a track. `fixed`: laws of which everything is known. `threshold`: least score of a cause.
pub fn study(track: &mut Track, model: &Model, fixed: &Model, threshold: f64) -> Result<Study, EstimateError> {
    blur(track);
    let loads = loads(track, model, fixed)?;
    // Without a force nothing tells a standstill under load from one without.
    if track.freely.is_none() {
        stuck::add(track, &loads);
    }
    let has_dry = model.iter().any(|e| e.law().is_dry());
    let coarse = Grid::coarse(track);
    let mut known = Known { columns: Columns::default(), generic: generic(track), is_sharp: false, noise: None };
    let mut made = compare(track, (model, fixed), &known, threshold, [&coarse, &Grid::default()], None)?;
    let is_free = track.freely.is_some();
    for round in 0..if is_free { REFINEMENTS_OF_FREE } else { REFINEMENTS } {
        // One cause alone is as near after the first as it needs be; beside others, what it misses may pass for one of them. The long means of a
        // free motion show so much more of a place that one alone is not near enough either.
        let searched = |c: &Chosen| !made.candidates[c.candidate].searched.is_empty();
        let enough = if is_free { round > 0 && !made.chosen.iter().any(searched) } else { made.chosen.len() <= round };
        if made.chosen.is_empty() || enough {
            break;
        }
        let step = if is_free { 0.5_f64.powf(round as f64) } else { 1.0 / (1 + round) as f64 };
        let fine = Grid::around(&to_refine(&made, threshold, has_dry), track, step);
        known.noise = match (known.noise, calmer(track, &made)) {
            (Some(before), Some(now)) if (now / before).ln().abs() < SAME_NOISE => Some(before),
            (before, now) => now.or(before),
        };
        // The load on the friction is what the sensor told, rid of what is now known of the sensor.
        if correct_load(track, &made) {
            known.columns.forget_loads();
            known.generic = generic(track);
        }
        made = compare(track, (model, fixed), &known, threshold, [&coarse, &fine], Some(made))?;
    }
    // How wide the direction of a mechanism is blurred is a guess. Where it is too wide, the friction of everything slow comes out too small,
    // which passes for friction that rises there, or for a bend that no law has.
    let rises = |study: &Study| study.chosen.iter().any(|c| study.candidates[c.candidate].id == Stribeck.id());
    let bends = |study: &Study| {
        let Study { system, candidates, .. } = study;
        let selection = Selection::new(system, candidates, threshold);
        selection.unexplained(&study.picks()).is_some_and(|(_, score)| score > threshold)
    };
    let (rose, bent) = (rises(&made), !track.planar && bends(&made));
    if !track.planar && (rose || bent) {
        known.is_sharp = true;
        let found: Vec<&Candidate> = made.chosen.iter().map(|c| &made.candidates[c.candidate]).collect();
        let fine = Grid::around(&found, track, 1.0);
        let sharp = compare(track, (model, fixed), &known, threshold, [&coarse, &fine], None)?;
        if rose && !rises(&sharp) || bent && !bends(&sharp) {
            made = sharp;
        }
    }
    let stretch: Vec<usize> = track.rows.iter().map(|r| r.stretch).collect();
    leave_out_what_harms(&mut made, &stretch, threshold, &|_, _| true);
    Ok(made)
}

/// What the causes leave must be less than this share of what the model leaves for the rows' weights to be asked for again.
const CALMER: f64 = 0.7;
/// Noises that differ by less than this factor's logarithm are one.
const SAME_NOISE: f64 = 0.2;

/// The noise of the rows along the motion as what was found leaves it, where nothing else tells it and it is much less than the model leaves: what is hidden
/// passes for noise at first, beside which a direction that is a guess weighs nothing.
fn calmer(track: &Track, made: &Study) -> Option<f64> {
    if track.noise_is_measured {
        return None;
    }
    let left = |picks: &[usize]| -> Option<f64> {
        let solved = made.system.solve(picks)?;
        let left = residual(&made.y, &made.base, &made.candidates, picks, &solved);
        let (sum, rows) = track.along().fold((0.0, 0.0), |(sum, rows), i| {
            let weight = made.weight[i].powi(2);
            (sum + weight * left[i].powi(2), rows + weight)
        });
        Some((sum / f64::max(rows, 1e-12)).sqrt())
    };
    let (model, found) = (left(&[])?, left(&made.picks())?);
    (found < CALMER * model).then_some(found)
}

/// By so much a cause must enlarge what is left to be harmful: a small one that is true, but known badly, may do a little.
const HARMS: f64 = 1.05;

/// A cause that scores less than this many times what is asked for must show on the locked blocks, too …
pub const CONFIRMED: f64 = 2.5;
/// … by more than this in 2 ln(likelihood): what is true is worth a third of its score there, what was searched for among noise as much less
/// than nothing.
pub const SHOWN: f64 = 1.0;

/// A cause that makes more of an error for certain where it was not fitted is none, whatever it explains elsewhere; nor is one that is known
/// badly where every piece may be wrong in its own way, or one that scores little and shows nothing there, where it is `tested`.
/// `stretch`: of each row. `threshold`: least score of a cause.
pub fn leave_out_what_harms(
    study: &mut Study,
    stretch: &[usize],
    threshold: f64,
    tested: &dyn Fn(&Study, usize) -> bool,
) {
    let sure = CONFIRMED * threshold;
    loop {
        let unsure = |k: &usize| {
            harms(study, *k)
                || !is_steady(study, *k)
                || study.chosen[*k].score < sure && tested(study, *k) && confirmed(study, *k, stretch) < SHOWN
        };
        let Some(k) = (0..study.chosen.len()).rev().find(unsure) else { return };
        study.chosen.remove(k);
        study.solved = study.system.solve(&study.picks());
    }
}

/// So much is asked of the square of what a cause explains over its error by a jackknife.
const STEADY: f64 = 15.0;

/// Whether what the k-th of the chosen causes explains is known as well as is asked for by a jackknife over pieces of the recording, too. That is
/// asked in the end alone: as long as another cause is missing, what that one leaves is in the pieces.
pub fn is_steady(study: &Study, k: usize) -> bool {
    let Some(solved) = &study.solved else { return true };
    let picks = study.picks();
    let first = firsts(study, &picks)[k];
    let own = first..first + study.candidates[picks[k]].columns.len();
    study.system.steadiness(solved, &own) > STEADY
}

/// Whether the k-th of the chosen causes makes more of an error for certain where it was not fitted.
pub fn harms(study: &Study, k: usize) -> bool {
    let gain = gain(study, k, 0.0);
    gain.heldout_rms_after > HARMS * gain.heldout_rms_before && gain.interval[1] < 0.0
}

/// The force across the motion without the faults of the sensor that were found; whether that changes anything.
fn correct_load(track: &mut Track, study: &Study) -> bool {
    let Some(solved) = study.solved.as_ref().filter(|_| track.planar) else { return false };
    let mut faults: Vec<(&Candidate, Vec<f64>)> = Vec::new();
    let mut at = study.base.len();
    for chosen in &study.chosen {
        let candidate = &study.candidates[chosen.candidate];
        let end = at + candidate.columns.len();
        faults.push((candidate, solved.values[at..end].to_vec()));
        at = end;
    }
    let bearing = track.bearing;
    let mut changes = false;
    for row in track.rows.iter_mut().filter(|r| r.place == Place::Along) {
        let outward = Vec2::new(row.along.y, -row.along.x);
        let mut force = row.force;
        for (candidate, values) in &faults {
            let tau = candidate.searched.first().map_or(0.0, |s| s.value);
            let size = |law: &'static dyn Law| Effect::new(law, &[1.0, tau]).force(&row.motion);
            force -= match (candidate.id, candidate.linear[0].0) {
                ("force-bias", _) => Vec2::new(values[0], values[1]),
                ("force-drift", _) => Vec2::new(values[0], values[1]) * size(&ForceDrift),
                ("force-cross-axis", "kappa_xy") => Vec2::new(values[0] * row.force.y, 0.0),
                ("force-cross-axis", "kappa_turned") => Vec2::new(-row.force.y, row.force.x) * values[0],
                ("force-cross-axis", _) => Vec2::new(0.0, values[0] * row.force.x),
                ("force-gain", _) => row.force * (values[0] / (1.0 + values[0]).max(0.1)),
                ("time-delay", _) => row.force_rate * -values[0],
                _ => Vec2::zeros(),
            };
        }
        let load_n = force.dot(&outward) + bearing.load_n(row);
        changes |= load_n.to_bits() != row.motion.normal_force_n.to_bits();
        row.motion.normal_force_n = load_n;
    }
    changes
}

/// What every round is made of.
struct Known {
    columns: Columns,
    generic: Vec<Candidate>,
    /// How wide the direction is blurred is open, too.
    is_sharp: bool,
    /// The noise of the rows along the motion, N or N m; what a plain fit leaves where nothing better is known.
    noise: Option<f64>,
}

/// One round: laws that are fitted, and those of which everything is known. `before`: the round before, whose whitening stays (the same
/// things together left the same).
fn compare(
    track: &Track,
    (model, fixed): (&Model, &Model),
    made: &Known,
    threshold: f64,
    [coarse, fine]: [&Grid; 2],
    before: Option<Study>,
) -> Result<Study, EstimateError> {
    let Asked { mut base, known, y } = asked(track, model, fixed);
    let Look { mut predicted, mut resisting, weight, slides: mut dry } =
        first_look(track, model, (&base, &y), made.noise)?;
    // What the model's laws came out at beside what was found.
    let laws = before.as_ref().and_then(|b| Some(&b.solved.as_ref()?.values[..b.base.len()]));
    if let Some(laws) = laws.filter(|laws| friction_is_sound(model, laws)) {
        (predicted, resisting) = (total(y.len(), model, &base, laws, false), total(y.len(), model, &base, laws, true));
        dry = (0..y.len()).map(|i| dry_level(track, model, laws, i)).collect();
    }
    let taken: Vec<&str> = model.iter().chain(fixed).map(|e| e.law().id()).collect();
    let dictionary = |grid| {
        let without = &taken;
        let (predicted, resisting, dry) = (&predicted, &resisting, &dry);
        let columns = &made.columns;
        Dictionary { track, predicted, resisting, dry, fixed: &known, without, grid, columns }
    };
    let mut candidates = dictionary(coarse).candidates();
    candidates.extend(dictionary(fine).searched());
    let losses = candidates.iter().filter(|c| ["hysteresis", "backlash"].contains(&c.id));
    let losses: Vec<&[f64]> = losses.map(|c| c.columns[0].as_slice()).collect();
    base.extend(stuck::creep(track, &y, &losses));
    base.extend(made.is_sharp.then(|| blurred(track, &dry)));
    candidates.extend(made.generic.iter().cloned());
    let stretch: Vec<usize> = track.rows.iter().map(|r| r.stretch).collect();
    let held = |row: &Row| match row.place {
        Place::Along => Held::Fully,
        Place::Stuck { .. } => Held::ByFolds,
        Place::FreeX | Place::FreeY => Held::Never,
    };
    let testable: Vec<Held> = track.rows.iter().map(held).collect();
    // One recording after the other.
    let time_s: Vec<f64> =
        track.rows.iter().map(|r| r.recording as f64 * (track.span_s + 1.0) + r.motion.time_s).collect();
    let rows = Rows {
        y: &y,
        stretch: &stretch,
        testable: &testable,
        time_s: &time_s,
        weight: &weight,
        period_s: track.period_s,
        noise: if track.freely.is_some() { Noise::OfDifferences } else { Noise::Any },
        may_stand: true,
    };
    let has_dry = model.iter().any(|e| e.law().is_dry());
    let place = |found: &Candidate| candidates.iter().position(|c| c.id == found.id && c.is_near(&found.searched));
    let found = before.iter().flat_map(|b| b.chosen.iter().map(|c| &b.candidates[c.candidate]));
    let start: Vec<usize> = found.filter_map(place).collect();
    let mut system = match before {
        // Rows of other weights leave another noise.
        Some(before) if before.weight == weight => System::after(before, &base, &candidates, &rows),
        _ => System::new(&base, &candidates, &rows, whitening_of(&base, &candidates, &rows, threshold)?),
    };
    system.resisting = (0..model.len()).filter(|k| is_resisting(&model[*k])).collect();
    system.pieces = PIECES_S.map(|piece_s| pieces(&time_s, piece_s)).to_vec();
    let chosen = Selection::new(&system, &candidates, threshold).of(has_dry, true).run(&start);
    let picks: Vec<usize> = chosen.iter().map(|c| c.candidate).collect();
    let solved = system.solve(&picks);
    let shares_of = solved.as_ref().map_or([1.0, 0.0], |s| shares_of(track, model, &dry, s, system.rows));
    Ok(Study { candidates, chosen, system, solved, y, base, weight, shares_of })
}

/// Which piece of this length each row is in, counted without those that no row is in.
fn pieces(time_s: &[f64], piece_s: f64) -> Vec<usize> {
    let mut numbers: HashMap<i64, usize> = HashMap::new();
    let mut number = |time_s: &f64| {
        let next = numbers.len();
        *numbers.entry((time_s / piece_s).floor() as i64).or_insert(next)
    };
    time_s.iter().map(&mut number).collect()
}

/// What the model with Coulomb friction leaves of the force, root mean square, and whether its friction resists.
pub fn plain_rms(track: &mut Track, model: &Model) -> Result<(f64, bool), EstimateError> {
    blur(track);
    blurred_rms(track, model)
}

/// The same of rows whose directions are blurred already.
pub fn blurred_rms(track: &Track, model: &Model) -> Result<(f64, bool), EstimateError> {
    let mut columns: Vec<Vec<f64>> = model.iter().map(|effect| column(track, effect)).collect();
    columns.push(column(track, &Effect::new(&CoulombFriction, &[1.0])));
    let along: Vec<f64> =
        track.rows.iter().map(|r| if r.place == Place::Along { r.motion.direction.powi(4) } else { 0.0 }).collect();
    let y: Vec<f64> = track.rows.iter().map(|r| r.y).collect();
    let fit = least_squares_values(&columns, &y, Some(&along))?;
    let resisting: f64 = (0..y.len())
        .map(|i| {
            let parts =
                model.iter().enumerate().filter(|(_, e)| is_resisting(e)).map(|(k, _)| fit.values[k] * columns[k][i]);
            let coulomb = fit.values[model.len()] * columns[model.len()][i];
            (parts.sum::<f64>() + coulomb) * track.rows[i].motion.direction
        })
        .sum();
    Ok((fit.rms, resisting > 0.0))
}

/// So many standard errors below zero every one of mass, damping and dry friction must be for a force with the wrong sign.
const SURELY_NEGATIVE: f64 = 6.0;

/// Whether the laws of a model (all of them positive in anything that exists) come out with the wrong sign: none of them is positive for
/// certain, and the strongest is negative beyond doubt, as is the work that the friction takes.
pub fn drives(track: &Track, model: &Model) -> Result<bool, EstimateError> {
    let mut track = track.clone();
    blur(&mut track);
    let mut columns: Vec<Vec<f64>> = model.iter().map(|effect| column(&track, effect)).collect();
    // What stands in the way of mass: a spring, gravity, a constant pull.
    let beside: [&dyn Fn(&Row) -> f64; 4] =
        [&|_| 1.0, &|r| r.motion.position, &|r| r.angle_rad.sin(), &|r| r.angle_rad.cos()];
    let turns = track.coordinate == haptics::law::Coordinate::Angular;
    for of in &beside[..if turns { 4 } else { 2 }] {
        columns.push(track.rows.iter().map(|r| if r.place == Place::Along { of(r) } else { 0.0 }).collect());
    }
    let along: Vec<f64> =
        track.rows.iter().map(|r| if r.place == Place::Along { r.motion.direction.powi(4) } else { 0.0 }).collect();
    let y: Vec<f64> = track.rows.iter().map(|r| r.y).collect();
    let fit = least_squares(&columns, &y, Some(&along))?;
    let sizes: Vec<f64> = (0..model.len()).map(|k| fit.values[k] / fit.std_errors[k].max(1e-300)).collect();
    let friction: f64 = (0..y.len())
        .map(|i| {
            let resists = model.iter().enumerate().filter(|(_, e)| is_resisting(e));
            resists.map(|(k, _)| fit.values[k] * columns[k][i]).sum::<f64>() * track.rows[i].motion.direction
        })
        .sum();
    let [mass, others @ ..] = sizes.as_slice() else { return Ok(false) };
    // A force that only comes late drives, too, but needs no negative dry friction for that.
    let negative = |s: &f64| *s < -SURELY_NEGATIVE;
    Ok(friction < 0.0 && sizes.iter().all(|s| *s < SURELY_NEGATIVE) && (negative(mass) || others.iter().all(negative)))
}

/// What the laws need along every row, each law a mean over the row; what they remember starts anew at every stretch.
pub fn needed(track: &Track, effects: &[Effect]) -> Vec<f64> {
    let mut sum = vec![0.0; track.rows.len()];
    for effect in effects {
        let own = if effect.remembers() { remembered(track, effect) } else { column(track, effect) };
        sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
    }
    sum
}

/// The force of a law with a memory, row by row.
fn remembered(track: &Track, effect: &Effect) -> Vec<f64> {
    let rows = &track.rows;
    let mut memory = Memory::default();
    let mut force = |i: usize| {
        if track.follows(i) {
            let step_s = rows[i].motion.time_s - rows[i - 1].motion.time_s;
            effect.law().advance(&rows[i].motion, &effect.values, &mut memory, step_s);
        } else {
            memory = Memory::default();
        }
        effect.force_with(&rows[i].motion, &memory)
    };
    (0..rows.len()).map(&mut force).collect()
}

/// What a fit is asked for.
struct Asked {
    /// Columns of the model's laws, …
    base: Vec<Vec<f64>>,
    /// … and of the forces of which everything is known, a hung weight's among them.
    known: Vec<Vec<f64>>,
    /// The force that the known ones leave.
    y: Vec<f64>,
}

fn asked(track: &Track, model: &Model, fixed: &Model) -> Asked {
    let base = model.iter().map(|effect| column(track, effect)).collect();
    let known: Vec<Vec<f64>> = fixed.iter().map(|effect| column(track, effect)).chain(hung::column(track)).collect();
    let left = |(i, row): (usize, &Row)| row.y - known.iter().map(|k| k[i]).sum::<f64>();
    let y = track.rows.iter().enumerate().map(left).collect();
    Asked { base, known, y }
}

/// What a first plain fit tells of every row.
struct Look {
    /// What the model predicts, and the part of it that resists motion.
    predicted: Vec<f64>,
    resisting: Vec<f64>,
    /// How much the row can be trusted.
    weight: Vec<f64>,
    /// The dry friction if it slid.
    slides: Vec<f64>,
}

/// A first plain fit: what the model predicts, the resisting part of it, how much each row can be trusted where the direction is a
/// guess (effective variance, Orear 1982), and the dry friction of each row if it slid. `noise`: of a row, where it is known.
fn first_look(
    track: &Track,
    model: &Model,
    (base, y): (&[Vec<f64>], &[f64]),
    noise: Option<f64>,
) -> Result<Look, EstimateError> {
    let mut columns = base.to_vec();
    let together = if track.planar { TOGETHER } else { 1.0 };
    let has = |law: &dyn Law| model.iter().any(|e| e.law().id() == law.id());
    let has_dry = has(&CoulombFriction);
    // What resists without being in the model: with dry friction alone a viscous one would pass for it.
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
                // A sign that is anybody's guess leaves all of the friction open.
                let open = together * dry(&fit.values, i).powi(2) * row.open;
                (1.0 + open / (noise * noise)).powf(-0.5)
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

/// What the friction holds in each row along the motion, as far as a plain fit tells.
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
