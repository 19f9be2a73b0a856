//! Diagnosis of a thrown body. Its falls, impacts and slides are compared with a simulation with the right lengths,
//! lossless impacts and no sliding friction, or with the floor of `--world`.

pub(crate) mod air;
pub(crate) mod flight;
pub(crate) mod impact;
pub(crate) mod sliding;

use crate::diagnose::answer::build::{Evidence, answer};
use crate::diagnose::answer::part::Part;
use crate::diagnose::contract::{Alternative, Baseline, Cause, Final, NextExperiment, NotExcited};
use crate::diagnose::data::row_means::mean_and_error;
use crate::diagnose::findings::{Figures, Findings};
use crate::diagnose::free_run::FreeRun;
use crate::diagnose::free_run::windows::AT_AN_INSTANT;
use crate::diagnose::hypotheses::{channel_fault, coulomb_friction, length_scale, load_friction, velocity_loss};
use crate::diagnose::options::Options;
use crate::diagnose::recording::sample_faults;
use estimation::identify::tossed::slide::unknown_of_foot;
use estimation::identify::tossed::{Tossed, tossed, trajectory};
use foundation::estimate::EstimateError;
use haptics::recording::Recording;

/// Diagnoses recordings of one thrown body; `None` for other recordings.
pub fn impact(recordings: &[Recording], options: &Options) -> Option<Result<Findings, EstimateError>> {
    let seen = tossed(recordings)?;
    Some(diagnosed(recordings, options, &seen))
}

fn diagnosed(recordings: &[Recording], options: &Options, seen: &Tossed) -> Result<Findings, EstimateError> {
    let meta = &recordings[0].meta;
    let floor = options.world.as_ref().and_then(|w| w.floor.as_ref());
    let sliding =
        sliding::sliding(seen, floor.map_or(0.0, |f| f.loss.map_or(f.friction, |l| l.mu)), mean_friction(seen))?;
    let half_width_m = meta.known.get("half_width_m").copied();
    let air = trajectory::air(&seen.tracks, meta.gravity());
    let bent = air.as_ref().filter(|air| air.bends());
    let is_compared = air.is_some();
    let scaled = if bent.is_some() { None } else { flight::scale(seen, meta.gravity()) };
    let recorded = if scaled.is_some() { seen.fall.down_m_s2 / meta.gravity() } else { 1.0 };
    let blow = match half_width_m {
        // Only for bodies whose positions are recorded.
        Some(half) => impact::blow(seen, half * recorded, floor.and_then(|f| f.loss).map_or(1.0, |l| l.e))?,
        None => None,
    };
    let mut beside = Evidence {
        model: "free-fall+impact without loss+sliding without friction".to_owned(),
        causes: sample_faults::causes(recordings.get(..1).unwrap_or_default()).collect(),
        ..Evidence::default()
    };
    if floor.is_some() {
        "free-fall+floor of the world".clone_into(&mut beside.model);
    }
    beside.causes.extend(bent.into_iter().flat_map(air::causes));
    beside.warnings.extend(bent.and_then(air::spin));
    if let Some((mut cause, alternative)) = scaled {
        let drags = air.as_ref().and_then(air::instead_of_scale);
        cause.posterior *= 1.0 - drags.as_ref().map_or(0.0, |drag| drag.posterior);
        beside.causes.push(cause);
        beside.alternatives.extend(std::iter::once(alternative).chain(drags));
    }
    let mut unseen = |id: &str, why: &str| beside.not_excited.push(NotExcited::new(id, why));
    if half_width_m.is_some() && blow.is_none() {
        unseen(velocity_loss::ID, "too few impacts on one corner, with free flight before and after, were seen");
    }
    if half_width_m.is_none() {
        unseen(velocity_loss::ID, "the places of the corners are not known; state half_width_m in the sidecar");
    }
    if sliding.is_none() {
        unseen(load_friction::ID, "the body does not slide flat for long enough; throw it flatter");
    }
    unseen(
        coulomb_friction::ID,
        "the body slides under its own weight only: friction in proportion to the load and a constant one are the same",
    );
    let slides = sliding.as_ref().map(|slides| Part::of(&slides.compared, slides).running(FreeRun::Channel(slides)));
    let blows = blow.as_ref().map(|blows| Part::of(&blows.compared, blows).running(FreeRun::None(AT_AN_INSTANT)));
    let parts: Vec<Part<'_>> = slides.into_iter().chain(blows).collect();
    let figures = of_falls(seen, meta.gravity(), (&beside.causes, bent.map(|air| air.best.rms_m)));
    Ok(answer(&parts, Evidence { figures, is_compared, next: &next, atlas: options.atlas, ..beside }))
}

/// Figures of the falls, for throws without anything else to compare.
fn of_falls(seen: &Tossed, gravity_m_s2: f64, (causes, bent_m): (&[Cause], Option<f64>)) -> Figures {
    let [before_m, after_m, own_m] = flight::left_m(seen, gravity_m_s2);
    let [after_m, own_m] = [after_m, own_m].map(|own_m| bent_m.unwrap_or(own_m));
    let is_named = bent_m.is_some() || causes.iter().any(|c| c.id == length_scale::ID);
    let Figures { baseline, end, .. } = Figures::of_nothing();
    Figures {
        baseline: Baseline {
            rms_n: before_m,
            heldout_rms_n: before_m,
            of: Some("height of the flights".to_owned()),
            unit: Some("m".to_owned()),
            ..baseline
        },
        end: Final { heldout_rms_n: if is_named { after_m } else { before_m }, ..end },
        noise_floor: own_m,
    }
}

/// Powers 0 … of a number, one row an entry.
fn powers(rows: usize, size: usize, of: impl Fn(usize) -> f64) -> nalgebra::DMatrix<f64> {
    let mut matrix = nalgebra::DMatrix::from_element(rows, size, 1.0);
    for (i, j) in (1..size).flat_map(|j| (0..rows).map(move |i| (i, j))) {
        matrix[(i, j)] = matrix[(i, j - 1)] * of(i);
    }
    matrix
}

/// Standard error of the friction by the scatter of single slides (a table is not alike everywhere) and by what is not
/// known of the foot.
fn mean_friction(seen: &Tossed) -> f64 {
    let values: Vec<f64> = seen.slides.iter().map(|s| s.friction(seen.fall.down_m_s2)).collect();
    let (mean, scatter) = mean_and_error(&values);
    scatter.hypot(mean * unknown_of_foot(&seen.slides))
}

fn next(open: &[Alternative]) -> Option<NextExperiment> {
    let first = open.first()?;
    let motion = if first.id == channel_fault::ID {
        "drop the body beside a scale of known length, or film a clock: a wrong clock leaves lengths at rest as they are"
    } else {
        "let the body slide flat from several speeds, and load it with a known weight"
    };
    Some(NextExperiment::in_words(motion, vec![first.instead_of.clone(), first.id.clone()], 0.9))
}
