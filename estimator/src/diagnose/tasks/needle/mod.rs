//! Diagnosis of a needle in a sheet: the sheet before the puncture, the shaft in its hole, and the sensors without
//! touch.
//!
//! Without a world the sheet is a linear spring and the hole holds nothing, as in the thesis's simulation; with one
//! they are its laws.

pub(crate) mod experiment;
pub(crate) mod forces;
pub(crate) mod held_needle;
pub(crate) mod hole;
pub(crate) mod interpolation;
pub(crate) mod rows;
pub(crate) mod sheet;
#[cfg(test)]
pub(crate) mod tests;

use crate::diagnose::answer::build::{Evidence, draft};
use crate::diagnose::answer::part::Part;
use crate::diagnose::answer::put_back::PutBack;
use crate::diagnose::contract::{Alternative, Cause, Gain, NextExperiment, NotExcited, parameter};
use crate::diagnose::extension::hypothetical_worlds::{Act, Simulated};
use crate::diagnose::findings::{DelayFindings, Findings};
use crate::diagnose::free_run::FreeRun;
use crate::diagnose::free_run::windows::AT_AN_INSTANT;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::sensor_fault::{SensorFault, Step};
use crate::diagnose::hypotheses::{
    coulomb_friction, force_bias, friction_change, hysteresis, stiffness_hardening, viscous_friction,
};
use crate::diagnose::model_error::twin::{Twin, is_upright};
use crate::diagnose::options;
use crate::diagnose::options::Options;
use crate::diagnose::recording::sample_faults;
use crate::diagnose::selection::comparison::Compared;
use crate::diagnose::selection::held_out_gain::chi_square_tail;
use crate::diagnose::selection::rules::{Rules, THRESHOLD_SLOW};
use foundation::estimate::EstimateError;
use foundation::words::amount;
use haptics::Vec2;
use haptics::law::Kind;
use haptics::recording::Recording;
use rows::{Needle, Puncture};

/// Relative scatter of the puncture forces of one sheet.
/// Choice: halved, 0 of 15 answers change; doubled, 1 of 15 answers change (1 to wrong).
const PUNCTURE_SHARE: f64 = 0.03;

/// Diagnoses recordings of one needle and one sheet, all together.
pub fn needle(
    recordings: &[Recording],
    options: &Options,
    faults: &[Cause],
    put_back: Option<&PutBack<'_>>,
) -> Result<Findings, EstimateError> {
    let (seen, names, left_out) = joined(recordings)?;
    let law = options.world.as_ref().and_then(|w| w.membrane.as_ref()).map(|m| &m.law);
    let rules = Rules::of_channel(seen.period_s);
    let sheet = sheet::sheet(&seen, law, rules)?;
    let shaft = hole::shaft(&seen, law, rules)?;
    let mut beside = Evidence {
        model: format!(
            "{}+{}",
            if law.is_some() { "sheet of the world" } else { "linear sheet" },
            shaft.as_ref().map_or("no hole", |s| s.model)
        ),
        causes: faults.iter().cloned().chain(sample_faults::causes(recordings)).collect(),
        warnings: left_out,
        atlas: options.atlas,
        ..Evidence::default()
    };
    beside.causes.extend(punctures(&seen, &names, &|p| sheet::level_n(&sheet.compared.study, p)));
    if shaft.is_none() {
        let why = "the needle hardly moved in a hole; push it through and draw it out";
        let ids = [coulomb_friction::ID, friction_change::ID, viscous_friction::ID];
        beside.not_excited.extend(ids.map(|id| NotExcited::new(id, why)));
    }
    if !seen.two_fingered {
        let why = "a single tool is held all the time: a bias of its force passes for its weight";
        beside.not_excited.push(NotExcited::new(force_bias::ID, why));
    }
    let (on_sheet, in_hole) = (InWorld::of_sheet(&seen, law.is_some()), InWorld::of_hole(&seen, law.is_some()));
    let mut parts =
        vec![Part::of(&sheet.compared, &sheet).running(FreeRun::Channel(&sheet.pressed)).in_world(&on_sheet)];
    if let Some(shaft) = &shaft {
        parts.push(Part::of(&shaft.compared, shaft).running(FreeRun::Channel(&shaft.sliding)).in_world(&in_hole));
    }
    let asked = |open: &[Alternative]| {
        experiment::propose(open, (&seen, law), (&sheet.compared, shaft.as_ref())).or_else(|| next(open))
    };
    if let Some((late, on_sheet)) = seen.late.zip(parts.first()) {
        beside.delay = DelayFindings::of_scan(late, on_sheet.figures());
    }
    let is_replayed = options.twins && names.len() == recordings.len() && is_upright(faults);
    let replayed = || {
        let sliding = shaft.as_ref().map(|s| (&s.compared.study, seen.placed(&s.sliding.rows)));
        let pressed = (&sheet.compared.study, seen.placed(&sheet.pressed.rows));
        Twin::of_channels(std::iter::once(pressed).chain(sliding))
    };
    let twin = is_replayed.then(replayed).flatten().map(Box::new);
    let mut draft = draft(&parts, Evidence { next: &asked, ..beside });
    draft.findings.twin = twin;
    Ok(draft.finish(put_back))
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
    if n < 2.0 || scatter < THRESHOLD_SLOW {
        return None;
    }
    let (first, last) = (all.first()?, all.last()?);
    let told = |p: &Puncture| {
        let within = names.get(p.recording).filter(|_| names.len() > 1).map_or(String::new(), |n| format!(" of {n}"));
        format!("{} at {:.1} s{within}", amount(p.force_n, "N"), p.time_s)
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
        standing: None,
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
    let motion = "push in slowly and fast, draw back before the sheet gives way, push through at another place, move to and fro in the \
                  hole, and end with the needle outside";
    NextExperiment::of_first(open, motion, 0.8)
}

/// Estimated model of a sheet or a hole: a world's with a factor, or the plain one.
pub struct InWorld {
    /// Name of its act.
    name: &'static str,
    /// Indices of the regressors in the base, and the names of their values.
    columns: Vec<(usize, &'static str)>,
    two_fingered: bool,
}

impl InWorld {
    /// `has_law`: the model is the sheet of a world.
    pub fn of_sheet(needle: &Needle, has_law: bool) -> Self {
        let columns = vec![(needle.holds, if has_law { "factor" } else { "k" })];
        Self { name: "sheet", columns, two_fingered: needle.two_fingered }
    }

    /// The same of a hole.
    pub fn of_hole(needle: &Needle, has_law: bool) -> Self {
        let first = needle.holds + usize::from(needle.two_fingered) + 1;
        let columns = if has_law { vec![(first, "factor"), (first + 1, "c")] } else { Vec::new() };
        Self { name: "hole", columns, two_fingered: needle.two_fingered }
    }
}

impl Simulated for InWorld {
    fn base(&self, values: &[f64]) -> Vec<Act> {
        let value =
            |(k, name): &(usize, &'static str)| parameter(name, values.get(*k).copied().unwrap_or(0.0), 0.0, "");
        vec![(self.name.to_owned(), self.columns.iter().map(value).collect())]
    }

    /// A world has no drag on a pressed sheet, and no change of friction in a hole.
    fn act(&self, candidate: &Candidate, values: &[f64]) -> Option<Act> {
        let named = |name: &str| candidate.linear.first().is_some_and(|(n, _)| *n == name);
        let known = match (self.name, candidate.id) {
            ("sheet", stiffness_hardening::ID) => named("k3"),
            ("sheet", hysteresis::ID) | ("hole", coulomb_friction::ID | viscous_friction::ID | hysteresis::ID) => true,
            _ => false,
        };
        known.then(|| (format!("{}: {}", self.name, candidate.id), candidate.parameters(values)))
    }

    /// Forces along the needle are downward pushes, of both fingers together.
    fn fault(&self, fault: &SensorFault) -> SensorFault {
        let share = if self.two_fingered { 0.5 } else { 1.0 };
        let down = |along: f64| {
            [Vec2::new(0.0, -share * along), Vec2::new(0.0, if self.two_fingered { -share * along } else { 0.0 })]
        };
        SensorFault {
            offset_n: down(fault.offset_along),
            drift_n_s: down(fault.drift_along_per_s),
            steps: fault.steps.map(|step| Step { force_n: down(step.along), along: 0.0, ..step }),
            offset_along: 0.0,
            drift_along_per_s: 0.0,
            ..*fault
        }
    }
}
