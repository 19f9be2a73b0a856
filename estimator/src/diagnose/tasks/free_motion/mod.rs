//! Free motion, without a force channel. No external force acts, so the forces of the laws and of the inertia sum to
//! zero.
//!
//! The rows are those of a mechanism with zero force and a known inertia: the laws must equal −I a. The acceleration
//! has the most noise, so it is the target. The data determine only ratios to the inertia. Values known from the
//! sidecar or the world set the scale, as in a fit (`identify/mechanism/free.rs`). All values are proportional to the
//! inertia.
//!
//! Texts of a free motion: units, warnings, causes not excited, next experiment.

mod energy;
mod half_swings;
pub(crate) mod rows;
mod unit_per_inertia;

use super::baseline_models::{known_laws, named};
use super::coordinate_answer::explain;
use super::one_coordinate;
use crate::diagnose::answer::build::Evidence;
use crate::diagnose::answer::named::Named;
use crate::diagnose::contract;
use crate::diagnose::contract::NotExcited;
use crate::diagnose::data::coordinate::Along;
use crate::diagnose::data::covariates;
use crate::diagnose::data::limits::{HALF, SIGNIFICANT};
use crate::diagnose::data::regression_data::{Model, Row, Track, join};
use crate::diagnose::findings::Findings;
use crate::diagnose::hypotheses::all::with_both_ways;
use crate::diagnose::hypotheses::{force_bias, force_gain};
use crate::diagnose::options::{Options, nothing};
use crate::diagnose::recording::{rate_signs, sample_faults};
use crate::diagnose::selection::comparison::ChannelFit;
use estimation::identify::mechanism;
use estimation::identify::mechanism::{Stated, raw};
use estimation::regression::linear::least_squares;
use foundation::estimate::EstimateError;
use haptics::law::{Coordinate, CoulombFriction, EccentricMass, Effect, Inertia, Law, Role, ViscousFriction};
use haptics::recording::Recording;
use haptics::world::MechanismPath;
pub(super) use rows::track;
use unit_per_inertia::per_inertia;

/// True if no recording has a force along its coordinate. `paths`: of tools whose coordinate is measured along one.
///
/// # Errors
/// Recordings of both kinds, or without coordinate or clock: in a sentence.
pub(crate) fn is_free(recordings: &[Recording], paths: &[Option<MechanismPath>]) -> Result<bool, EstimateError> {
    let mut driven = Vec::new();
    for (recording, path) in recordings.iter().zip(paths) {
        driven.push(raw(recording, path.as_ref())?.force.is_some());
    }
    if driven.iter().any(|d| *d) && driven.iter().any(|d| !d) {
        let text = "some recordings have a force column and others do not; diagnose the driven and the free ones apart, \
                    and give the others as --validate";
        return Err(EstimateError::Other(text.to_owned()));
    }
    Ok(driven.iter().all(|d| !d))
}

/// The answer of one object's free motions. `paths`: as in [`is_free`].
pub(crate) fn diagnose(
    recordings: &[Recording],
    paths: &[Option<MechanismPath>],
    options: &Options,
) -> Result<Findings, EstimateError> {
    let Read { mut track, faults, bad } = read(recordings, paths)?;
    let first = &recordings[0];
    let mut model = model(&track, first, options)?;
    options.progress.tell(0.4)?;
    let mut scale = scale_of(&mut track, first, &mut model, options);
    let fixed = fixed(&track);
    let mut study = one_coordinate::study(&mut track, &model, &fixed)?;
    options.progress.tell(0.6)?;
    if let Scale::ByRatio(stated) = scale {
        // Estimated together with the causes found: a hidden spring would look like gravity.
        match inertia_by(stated, &model, &study) {
            Some((inertia, relative_error)) => {
                set(&mut track, inertia, relative_error);
                keep_known(&mut track, first, &mut model, Some(stated));
                let fixed = self::fixed(&track);
                study = one_coordinate::study(&mut track, &model, &fixed)?;
            }
            None => scale = Scale::Hidden,
        }
    }
    options.progress.tell(0.8)?;
    let evidence = Evidence {
        model: model_name(&model),
        causes: faults,
        warnings: sentence(&track, scale).into_iter().collect(),
        atlas: options.atlas,
        ..Evidence::default()
    };
    let energy = energy::energy(recordings, paths, (&model, &track), &bad)?;
    let parts = energy.iter().map(energy::Energy::part).collect();
    let mut draft = explain(&track, &model, &study, parts, evidence);
    put_right(&mut draft.named, &track);
    Ok(Findings { along: Some(Along::of(track.coordinate, recordings, paths)), ..draft.finish(None) })
}

/// Recordings of free motions, as read.
struct Read {
    /// The rows of all of them.
    track: Track,
    /// Faults of their samples.
    faults: Vec<contract::Cause>,
    /// Flags of samples that no sensor measured, recording by recording.
    bad: Vec<Vec<bool>>,
}

fn read(recordings: &[Recording], paths: &[Option<MechanismPath>]) -> Result<Read, EstimateError> {
    let (mut tracks, mut faults, mut bad) = (Vec::new(), Vec::new(), Vec::new());
    for (recording, path) in recordings.iter().zip(paths) {
        let found = sample_faults::faults(recording);
        let (recording, mirrored_rate) = rate_signs::with_rates_of_motion(recording);
        let mut rows = track(recording.as_ref(), &found.bad, path.as_ref())?;
        rows.extra = vec![covariates::of(recording.as_ref())];
        faults.extend(mirrored_rate.map(sample_faults::against_motion));
        faults.extend(found.causes);
        tracks.push(rows);
        bad.push(found.bad);
    }
    Ok(Read { track: join(tracks).ok_or_else(nothing)?, faults, bad })
}

/// The laws of the base model, without the inertia.
fn model(track: &Track, first: &Recording, options: &Options) -> Result<Model, EstimateError> {
    let mut model: Model = match (&options.world, options.baseline.as_deref()) {
        (Some(world), _) => world.mechanism.as_ref().map(|m| m.effects.clone()).unwrap_or_default(),
        (None, name) => {
            let mut laws = gravity(track, first);
            laws.extend(named(name.unwrap_or("mass+viscous+coulomb"))?);
            laws
        }
    };
    model.retain(|e| e.role() != Role::Inertia);
    Ok(model)
}

/// Gravity of any phase for an angle that swings: its zero need not be the hanging position.
pub(crate) fn gravity(track: &Track, first: &Recording) -> Model {
    let is_known = mechanism::stated(&first.meta, track.coordinate).iter().any(|s| matches!(s, Stated::Gravity(_)));
    if track.coordinate == Coordinate::Linear || !(is_known || swings(track)) {
        return Model::new();
    }
    [[1.0, 0.0], [0.0, 1.0]].map(|values| Effect::new(&EccentricMass, &values)).to_vec()
}

/// True if the motion swings back and forth under gravity.
fn swings(track: &Track) -> bool {
    let along = |of: &dyn Fn(&Row) -> f64| -> Vec<f64> { track.along().map(|i| of(&track.rows[i])).collect() };
    let acceleration = along(&|r| r.motion.acceleration);
    let mean = |of: &dyn Fn(f64) -> f64| along(&|r| track.mean(r, &|m| of(m.position)));
    let columns = [mean(&f64::sin), mean(&f64::cos), vec![1.0; acceleration.len()]];
    let power = acceleration.iter().map(|a| a * a).sum::<f64>() / acceleration.len().max(1) as f64;
    let explains =
        least_squares(&columns, &acceleration, None).is_ok_and(|fit| fit.rms * fit.rms < (1.0 - HALF) * power);
    explains && !track.goes_one_way()
}

/// Source of the inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scale {
    /// The world or the sidecar states it.
    Stated,
    /// A known parameter whose ratio to the inertia is significant.
    ByRatio(Stated),
    /// A known parameter whose ratio to the inertia is not significant, or that is no part of the model.
    Hidden,
    /// Nothing is known.
    Nothing,
}

/// Sets the inertia if it is stated; otherwise returns the known parameter that determines it.
fn scale_of(track: &mut Track, first: &Recording, model: &mut Model, options: &Options) -> Scale {
    let laws = options.world.as_ref().and_then(|w| w.mechanism.as_ref()).map(|m| m.effects.as_slice());
    let of_world: f64 = laws.into_iter().flatten().filter(|e| e.role() == Role::Inertia).map(|e| e.values[0]).sum();
    let stated = mechanism::stated(&first.meta, track.coordinate);
    let of_sidecar = stated.iter().find_map(|s| if let Stated::Inertia(value) = s { Some(*value) } else { None });
    if let Some(inertia) = Some(of_world).into_iter().chain(of_sidecar).find(|inertia| *inertia > 0.0) {
        set(track, inertia, 0.0);
        keep_known(track, first, model, None);
        return Scale::Stated;
    }
    let in_model = |law: &dyn Law| model.iter().any(|e| e.law().id() == law.id());
    let shows = |s: &&Stated| in_model(law_of(**s));
    match (stated.iter().find(shows), stated.is_empty()) {
        (Some(by), _) => Scale::ByRatio(*by),
        (None, false) => Scale::Hidden,
        (None, true) => Scale::Nothing,
    }
}

fn law_of(stated: Stated) -> &'static dyn Law {
    match stated {
        Stated::Inertia(_) => &Inertia,
        Stated::Gravity(_) => &EccentricMass,
        Stated::Viscous(_) => &ViscousFriction,
        Stated::Coulomb(_) => &CoulombFriction,
    }
}

fn set(track: &mut Track, inertia: f64, relative_error: f64) {
    let Some(free) = &mut track.freely else { return };
    track.force_noise *= inertia / free.inertia;
    (free.inertia, free.relative_error, free.is_known) = (inertia, relative_error, true);
}

/// Takes friction that the sidecar states out of the fitted laws, unless it determined the inertia.
fn keep_known(track: &mut Track, first: &Recording, model: &mut Model, gave: Option<Stated>) {
    let had = model.clone();
    let known = known_laws(first, track.coordinate, model);
    let spared = gave.map(|by| law_of(by).id());
    let is_spared = |e: &&Effect| Some(e.law().id()) == spared;
    model.extend(had.iter().filter(is_spared).filter(|e| known.iter().any(|k| k.law().id() == e.law().id())));
    let Some(free) = &mut track.freely else { return };
    let mut kept = known.iter().filter(|e| !is_spared(e)).copied();
    free.known = [kept.next(), kept.next(), None];
}

/// Known forces: that of the inertia, and friction that the sidecar states.
fn fixed(track: &Track) -> Model {
    let Some(free) = track.freely else { return Model::new() };
    std::iter::once(Effect::new(&Inertia, &[free.inertia])).chain(free.known.into_iter().flatten()).collect()
}

/// Inertia from a known parameter and its value per unit of inertia, with its relative standard error.
fn inertia_by(stated: Stated, model: &Model, study: &ChannelFit) -> Option<(f64, f64)> {
    let (Stated::Inertia(known) | Stated::Gravity(known) | Stated::Viscous(known) | Stated::Coulomb(known)) = stated;
    let solved = study.solved.as_ref()?;
    let variance = solved.variance(study.system.rows);
    let of: Vec<usize> = (0..model.len()).filter(|k| model[*k].law().id() == law_of(stated).id()).collect();
    let ratio = of.iter().map(|k| solved.values[*k].powi(2)).sum::<f64>().sqrt();
    let pairs = of.iter().flat_map(|a| of.iter().map(move |b| (*a, *b)));
    let spread: f64 = pairs.map(|(a, b)| solved.values[a] * solved.values[b] * solved.inverse[(a, b)]).sum();
    let error = (variance * spread.max(0.0)).sqrt() / ratio.max(1e-300);
    (ratio > SIGNIFICANT * error).then(|| (known / ratio, error / ratio))
}

/// Causes that a motion without a force sensor never shows.
const HIDDEN: [&str; 2] = [force_gain::ID, force_bias::ID];

/// Adapts texts that were written for a driven motion.
pub fn put_right(found: &mut Named, track: &Track) {
    let Some(free) = track.freely else { return };
    let angular = track.coordinate == Coordinate::Angular;
    for parameter in found.causes.iter_mut().flat_map(|c| &mut c.parameters) {
        if parameter.unit.starts_with('N') {
            parameter.std_error = parameter.std_error.hypot(parameter.value * free.relative_error);
            if !free.is_known {
                parameter.unit = per_inertia(&parameter.unit);
            }
        }
    }
    for hidden in &mut found.not_excited {
        hidden.why = format!(
            "this free motion hides it behind the model's own terms; {}",
            if angular { "release it from farther away, or from both sides" } else { "let it go faster, or both ways" }
        );
    }
    let why = "the recording has no force column, so there is no force sensor whose gain or bias could show";
    found.not_excited.extend(HIDDEN.map(|id| NotExcited::new(id, why)));
    if track.goes_one_way() {
        let why = "it goes one way only and slows down, which is then the same as friction, or as friction that changes with speed; let it \
                   go the other way, too";
        found.not_excited.extend(with_both_ways().map(|id| NotExcited::new(id, why)));
    }
}

/// The terms of the model, each once, the inertia first.
pub fn model_name(model: &Model) -> String {
    let mut names = vec!["inertia"];
    for effect in model {
        if !names.contains(&effect.law().id()) {
            names.push(effect.law().id());
        }
    }
    names.join("+")
}

/// Sentence on the source of the scale of all values; `None` for a driven motion.
pub fn sentence(track: &Track, scale: Scale) -> Option<String> {
    let free = track.freely?;
    let angular = track.coordinate == Coordinate::Angular;
    let (what, unit) = if angular { ("moment of inertia", "kg m²") } else { ("mass", "kg") };
    let name = if angular { "inertia_kg_m2, or mass_kg and com_m of a pendulum" } else { "mass_kg" };
    let inertia = free.inertia;
    Some(match scale {
        Scale::Stated => {
            format!(
                "there is no force column: the motion is taken to be free, with the stated {what} of {inertia:.4} {unit}"
            )
        }
        Scale::ByRatio(by) => format!(
            "there is no force column: the motion is taken to be free, and the known {} gives a {what} of {inertia:.4} {unit} ± {:.2} % \
             beside what was found",
            known(by),
            100.0 * free.relative_error
        ),
        Scale::Hidden => format!(
            "there is no force column, and what the sidecar knows does not show in this motion: all values are per unit of {what} (1 {unit}); \
             state {name} under \"known\" in the sidecar"
        ),
        Scale::Nothing => format!(
            "there is no force column and nothing is known: all values are per unit of {what} (1 {unit}); state {name} under \"known\" in the \
             sidecar"
        ),
    })
}

fn known(by: Stated) -> &'static str {
    match by {
        Stated::Inertia(_) => "inertia",
        Stated::Gravity(_) => "gravity moment",
        Stated::Viscous(_) => "viscous friction",
        Stated::Coulomb(_) => "Coulomb friction",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypotheses::all::can_show;
    use haptics::law::{EccentricMass, Effect, Law, ViscousFriction, entries};

    #[test]
    fn units_are_per_unit_of_inertia() {
        let laws = entries().filter(|e| can_show(e.id, true));
        for spec in laws.flat_map(|e| e.parameters) {
            for unit in [spec.unit, spec.unit_angular] {
                assert!(!per_inertia(unit).starts_with('N'), "{unit} of {}", spec.name);
            }
        }
    }

    #[test]
    fn a_model_names_each_term_once() {
        let laws: [&'static dyn Law; 3] = [&EccentricMass, &EccentricMass, &ViscousFriction];
        let model: Model = laws.map(|law| Effect::new(law, &[1.0])).to_vec();
        assert_eq!(model_name(&model), "inertia+eccentric-mass+viscous-friction");
        assert_eq!(model_name(&Model::new()), "inertia");
    }
}
