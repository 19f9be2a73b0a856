//! Diagnosis of a thrown body. Its falls, impacts and slides are compared with a simulation with the right lengths,
//! lossless impacts and no sliding friction, or with the floor of `--world`.

pub(crate) mod flight;
pub(crate) mod impact;
pub(crate) mod sliding;

use crate::diagnose::answer::build::{Evidence, answer};
use crate::diagnose::answer::cause::Found;
use crate::diagnose::answer::part::Part;
use crate::diagnose::contract::{Alternative, Baseline, Cause, CauseParameter, Final, NextExperiment, NotExcited};
use crate::diagnose::findings::{Figures, Findings};
use crate::diagnose::free_run::windows::AT_AN_INSTANT;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{channel_fault, coulomb_friction, length_scale, load_friction, velocity_loss};
use crate::diagnose::options::Options;
use crate::diagnose::recording::sample_faults;
use estimation::identify::tossed::pose::Track;
use estimation::identify::tossed::slide::unknown_of_foot;
use estimation::identify::tossed::{Tossed, tossed};
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
    let sliding = sliding::sliding(seen, floor.map_or(0.0, |f| f.loss.map_or(f.friction, |l| l.mu)))?;
    let half_width_m = meta.known.get("half_width_m").copied();
    let scaled = flight::scale(seen, meta.gravity());
    let recorded = if scaled.is_some() { seen.fall.down_m_s2 / meta.gravity() } else { 1.0 };
    let blow = match half_width_m {
        // Only for bodies whose positions are recorded.
        Some(half) => impact::blow(seen, half * recorded, floor.and_then(|f| f.loss).map_or(1.0, |l| l.e))?,
        None => None,
    };
    let mut beside = Evidence {
        model: "free-fall+impact without loss+sliding without friction".to_owned(),
        causes: recordings.first().map(|r| sample_faults::faults(r).causes).unwrap_or_default(),
        ..Evidence::default()
    };
    if floor.is_some() {
        "free-fall+floor of the world".clone_into(&mut beside.model);
    }
    if let Some((cause, alternative)) = scaled {
        beside.causes.push(cause);
        beside.alternatives.push(alternative);
    }
    let mut unseen =
        |id: &str, why: &str| beside.not_excited.push(NotExcited { id: id.to_owned(), why: why.to_owned() });
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
    let mean = mean_friction(seen);
    let slides = |_: usize, c: &Candidate, found: Vec<CauseParameter>| sliding::states(c, found, mean);
    let pushed = blow.as_ref().map_or(0.0, |(_, _, pushed)| *pushed);
    let loses = |_: usize, c: &Candidate, found: Vec<CauseParameter>| impact::states(c, &found, pushed);
    let (slide_shows, blow_shows) = (|f: &Found<'_>| sliding::shows(f), |f: &Found<'_>| impact::shows(f));
    let step_s = seen.tracks.first().map_or(0.0, Track::step_s);
    let run = sliding.as_ref().map(|(compared, _)| sliding::Slides { compared, step_s });
    let mut parts: Vec<Part<'_>> = Vec::new();
    parts.extend(run.as_ref().map(|run| run.compared.part(&slide_shows, &slides, &|_| None).running(run)));
    parts.extend(blow.as_ref().map(|(b, _, _)| b.part(&blow_shows, &loses, &|_| None).still(AT_AN_INSTANT)));
    let figures = of_falls(seen, meta.gravity(), &beside.causes);
    let mut found = answer(&parts, Evidence { figures, next: &next, ..beside });
    if options.atlas {
        let channels = &mut found.atlas.channels;
        channels.extend(sliding.as_ref().map(|(s, view)| s.atlas(view, sliding::best_seen)));
        channels.extend(blow.as_ref().map(|(b, view, _)| b.atlas(view, impact::best_seen)));
    }
    Ok(found)
}

/// Figures of the falls, for throws without anything else to compare.
fn of_falls(seen: &Tossed, gravity_m_s2: f64, causes: &[Cause]) -> Figures {
    let [before_m, after_m, own_m] = flight::left_m(seen, gravity_m_s2);
    let is_named = causes.iter().any(|c| c.id == length_scale::ID);
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
    let n = seen.slides.len() as f64;
    let values: Vec<f64> = seen.slides.iter().map(|s| s.friction(seen.fall.down_m_s2)).collect();
    let mean = values.iter().sum::<f64>() / n.max(1.0);
    let scatter = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    (scatter / (n - 1.0).max(1.0) / n.max(1.0)).sqrt().hypot(mean * unknown_of_foot(&seen.slides))
}

fn next(open: &[Alternative]) -> Option<NextExperiment> {
    let first = open.first()?;
    let motion = if first.id == channel_fault::ID {
        "drop the body beside a scale of known length, or film a clock: a wrong clock leaves lengths at rest as they are"
    } else {
        "let the body slide flat from several speeds, and load it with a known weight"
    };
    let separates = vec![first.instead_of.clone(), first.id.clone()];
    Some(NextExperiment { motion: motion.to_owned(), separates, expected_power: 0.9, experiment: None })
}
