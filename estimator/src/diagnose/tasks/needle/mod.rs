//! Diagnosis of a needle in a sheet: the sheet before the puncture, the shaft in its hole, and the sensors without
//! touch.
//!
//! Without a world the sheet is a linear spring and the hole holds nothing, as in the thesis's simulation; with one
//! they are its laws.

pub(crate) mod experiment;
pub(crate) mod held_needle;
pub(crate) mod hole;
pub(crate) mod interpolation;
pub(crate) mod rows;
pub(crate) mod sheet;
pub(crate) mod simulated_channels;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod time_delay;

use crate::diagnose::answer::build::{Evidence, answer};
use crate::diagnose::answer::cause::Found;
use crate::diagnose::answer::part::Part;
use crate::diagnose::contract::{Alternative, Cause, CauseParameter, Gain, NextExperiment, NotExcited, parameter};
use crate::diagnose::findings::{DelayFindings, Findings};
use crate::diagnose::free_run::windows::AT_AN_INSTANT;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{coulomb_friction, force_bias, friction_change, viscous_friction};
use crate::diagnose::options;
use crate::diagnose::options::Options;
use crate::diagnose::recording::sample_faults;
use crate::diagnose::selection::comparison::Compared;
use crate::diagnose::selection::held_out_gain::chi_square_tail;
use crate::diagnose::selection::rules::Rules;
use foundation::estimate::EstimateError;
use haptics::law::Kind;
use haptics::recording::Recording;
use rows::{Needle, Puncture};

/// Scatter of puncture forces (χ² less its degrees of freedom) from which they are not of one sheet.
const UNEVEN: f64 = 25.0;
/// Relative scatter of the puncture forces of one sheet.
const PUNCTURE_SHARE: f64 = 0.03;

/// Diagnoses recordings of one needle and one sheet, all together.
pub fn needle(recordings: &[Recording], options: &Options, faults: &[Cause]) -> Result<Findings, EstimateError> {
    let (seen, names, left_out) = joined(recordings)?;
    let law = options.world.as_ref().and_then(|w| w.membrane.as_ref()).map(|m| &m.law);
    let rules = Rules::of_channel(seen.period_s);
    let sheet::Sheet { compared: sheet, view, pressed } = sheet::sheet(&seen, law, rules)?;
    let shaft = hole::shaft(&seen, law, rules)?;
    let mut beside = Evidence {
        model: format!(
            "{}+{}",
            if law.is_some() { "sheet of the world" } else { "linear sheet" },
            shaft.as_ref().map_or("no hole", |s| s.model)
        ),
        causes: faults.iter().cloned().chain(recordings.iter().flat_map(|r| sample_faults::faults(r).causes)).collect(),
        warnings: left_out,
        ..Evidence::default()
    };
    beside.causes.extend(punctures(&seen, &names, &|p| sheet::level_n(&sheet.study, p)));
    if shaft.is_none() {
        let why = "the needle hardly moved in a hole; push it through and draw it out";
        let ids = [coulomb_friction::ID, friction_change::ID, viscous_friction::ID];
        beside.not_excited.extend(ids.map(|id| NotExcited { id: id.to_owned(), why: why.to_owned() }));
    }
    if !seen.two_fingered {
        let why = "a single tool is held all the time: a bias of its force passes for its weight";
        beside.not_excited.push(NotExcited { id: force_bias::ID.to_owned(), why: why.to_owned() });
    }
    let plain = |_: usize, _: &Candidate, found: Vec<CauseParameter>| found;
    let (on_sheet, on_shaft) = (|f: &Found<'_>| sheet::shows(f), |f: &Found<'_>| hole::shows(f));
    let mut parts: Vec<Part<'_>> = vec![sheet.part(&on_sheet, &plain, &sheet::usual).running(&pressed)];
    if let Some(hole::Shaft { compared, sliding, .. }) = &shaft {
        parts.push(compared.part(&on_shaft, &plain, &hole::usual).running(sliding));
    }
    let asked =
        |open: &[Alternative]| experiment::propose(open, (&seen, law), (&sheet, shaft.as_ref())).or_else(|| next(open));
    let mut found = answer(&parts, Evidence { next: &asked, ..beside });
    if options.atlas {
        let of_shaft = |s: &hole::Shaft| s.compared.atlas(&s.view, sheet::best_seen);
        found.atlas.channels.push(sheet.atlas(&view, sheet::best_seen));
        found.atlas.channels.extend(shaft.as_ref().map(of_shaft));
    }
    if let Some((late, on_sheet)) = seen.late.zip(parts.first()) {
        found.delay = DelayFindings::of_scan(late, on_sheet.figures());
    }
    found.hypotheses =
        simulated_channels::hypotheses((&sheet, shaft.as_ref()), (seen.holds, seen.two_fingered), law.is_some());
    Ok(found)
}

/// The channels of other recordings of the same needle and sheet.
pub fn channels(recordings: &[Recording], options: &Options) -> Result<Vec<Compared>, EstimateError> {
    let (seen, ..) = joined(recordings)?;
    let law = options.world.as_ref().and_then(|w| w.membrane.as_ref()).map(|m| &m.law);
    let rules = Rules::of_channel(seen.period_s);
    let mut found = vec![sheet::sheet(&seen, law, rules)?.compared];
    found.extend(hole::shaft(&seen, law, rules)?.map(|s| s.compared));
    Ok(found)
}

/// All recordings joined, the names of those used, and a sentence for each that is not.
fn joined(recordings: &[Recording]) -> Result<(Needle, Vec<&str>, Vec<String>), EstimateError> {
    let (mut whole, mut names, mut left_out): (Option<Needle>, Vec<&str>, Vec<String>) = (None, Vec::new(), Vec::new());
    let mut first_error = None;
    for recording in recordings {
        let seen = match rows::needle(recording) {
            Ok(seen) => seen,
            Err(error) => {
                left_out.push(format!("{} takes no part: {error}", recording.name));
                first_error.get_or_insert(error);
                continue;
            }
        };
        names.push(&recording.name);
        match &mut whole {
            Some(whole) => whole.then(seen),
            None => whole = Some(seen),
        }
    }
    match whole {
        Some(whole) => Ok((whole, names, left_out)),
        None => Err(first_error.unwrap_or_else(options::nothing)),
    }
}

/// Puncture forces that differ between insertions, for which the catalogue has no law. `names`: of the recordings;
/// `level_n`: sensor reading at a puncture without the sheet, N.
fn punctures(seen: &Needle, names: &[&str], level_n: &dyn Fn(&Puncture) -> f64) -> Option<Cause> {
    let n = seen.punctures.len() as f64;
    let all: Vec<Puncture> =
        seen.punctures.iter().map(|p| Puncture { force_n: p.force_n - level_n(p), ..*p }).collect();
    let mean = all.iter().map(|p| p.force_n).sum::<f64>() / n;
    let error = |p: &Puncture| (PUNCTURE_SHARE * mean).hypot(p.error_n);
    let scatter: f64 = all.iter().map(|p| ((p.force_n - mean) / error(p)).powi(2)).sum();
    if n < 2.0 || scatter < UNEVEN {
        return None;
    }
    let (first, last) = (all.first()?, all.last()?);
    let told = |p: &Puncture| {
        let within = names.get(p.recording).filter(|_| names.len() > 1).map_or(String::new(), |n| format!(" of {n}"));
        format!("{:.2} N at {:.1} s{within}", p.force_n, p.time_s)
    };
    Some(Cause {
        id: "other:puncture force over time".to_owned(),
        kind: Kind::Plant,
        parameters: vec![
            parameter("from", first.force_n, error(first), "N"),
            parameter("to", last.force_n, error(last), "N"),
        ],
        p_value: chi_square_tail(scatter, n - 1.0),
        posterior: 1.0,
        gain: Gain {
            no_share: Some("each puncture is one observation: none was held out".to_owned()),
            no_rollout: Some(AT_AN_INSTANT.to_owned()),
            ..Gain::default()
        },
        evidence: format!(
            "the sheet was pierced at {} and at {}; one sheet has one puncture force",
            told(first),
            told(last)
        ),
    })
}

fn next(open: &[Alternative]) -> Option<NextExperiment> {
    let first = open.first()?;
    let mut separates = vec![first.instead_of.clone()];
    separates.extend(open.iter().filter(|a| a.instead_of == first.instead_of).map(|a| a.id.clone()));
    Some(NextExperiment {
        motion: "push in slowly and fast, draw back before the sheet gives way, push through at another place, move to and fro in the \
                 hole, and end with the needle outside"
            .to_owned(),
        separates,
        expected_power: 0.8,
        experiment: None,
    })
}
