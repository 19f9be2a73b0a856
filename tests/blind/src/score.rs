//! Opens the truth beside an answer. Nothing but this looks into both.

use super::case::{Case, Truth};
use super::draw::{Bench, Spec};
use super::effect::{Effect, Shows};
use super::follow::{Followed, follow};
use super::interval::{Share, quantile};
use super::plan::Log;
use super::sets::{Job, Set};
use estimator::diagnose::{Findings, Options, Verdict};
use haptics::recording::{Recording, Task};
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// One case with its answer.
#[derive(Clone, Debug)]
pub struct Row {
    /// Which question.
    pub set: Set,
    /// What was moved.
    pub bench: Bench,
    /// How.
    pub log: Log,
    /// Samples a second.
    pub rate_hz: f64,
    /// Length, s.
    pub seconds: f64,
    /// Repeats the case.
    pub seed: u64,
    /// What was hidden, and in which form.
    pub hidden: Vec<(Effect, u32)>,
    /// Effect over noise that was asked for.
    pub ratio: f64,
    /// Sizes over the noise that came out, of each that is hidden.
    pub ratios: Vec<f64>,
    /// The recording cannot show the effect in that size.
    pub missed: bool,
    /// Noise of the force along the motion, N.
    pub noise_n: f64,
    /// Causes that nobody can tell from a hidden one here.
    pub equals: Vec<&'static str>,
    /// Mean square of the effect, N²; not a number for effects without a force.
    pub effect_n2: f64,
    /// What the answer takes off the unexplained force as a share of what the oracle takes; see [`Row::gain_of_oracle`].
    pub share_of_oracle: f64,
    /// The answer, or the sentence of the error.
    pub answer: Result<Findings, String>,
    /// Stated noise floor over the noise where the structured model error of this case is left out; not a number elsewhere.
    pub clean_floor: f64,
    /// How long the answer took, s.
    pub took_s: f64,
    /// What came of the experiment that the answer asks for.
    pub followed: Option<Followed>,
}

/// Whoever looks for what is hidden.
pub type Engine<'a> = dyn Fn(&[Recording], &Options) -> Result<Findings, String> + Sync + 'a;

/// What a case may tell beside its recordings.
pub fn options(case: &Case) -> Options {
    let task = if case.bench.is_crank() { Task::Crank } else { Task::Mechanism };
    Options { task: Some(task), baseline: case.baseline.map(str::to_owned), ..Options::default() }
}

/// Makes and asks every case, on all cores; answers keep the order of the jobs.
pub fn ask(jobs: &[Job], engine: &Engine<'_>) -> Vec<Row> {
    jobs.par_iter()
        .with_max_len(1)
        .map(|job| {
            let (case, truth, object) = job.make_with_object();
            let start = Instant::now();
            let answer = catch_unwind(AssertUnwindSafe(|| engine(&case.recordings, &options(&case))))
                .unwrap_or_else(|_| Err("it panicked".to_owned()));
            let took_s = start.elapsed().as_secs_f64();
            // Nothing is asked twice where names are counted only.
            let once = matches!(job.set, Set::Structured | Set::Beside);
            let followed = answer
                .as_ref()
                .ok()
                .filter(|_| !once)
                .and_then(|answer| follow(&object, &case.recordings, answer, &options(&case), engine, job.seed));
            let clean_floor = if job.set == Set::Structured { clean_floor(job, engine) } else { f64::NAN };
            Row { clean_floor, followed, ..Row::new(job, &case, &truth, answer, took_s) }
        })
        .collect()
}

/// Noise floor over the noise that is stated for the same object and hand without structured model error.
fn clean_floor(job: &Job, engine: &Engine<'_>) -> f64 {
    let clean = Job { spec: Spec { structure: None, ..job.spec.clone() }, ..job.clone() };
    let (case, truth) = clean.make();
    let answer = catch_unwind(AssertUnwindSafe(|| engine(&case.recordings, &options(&case))));
    answer.ok().and_then(Result::ok).map_or(f64::NAN, |a| a.noise_floor_n / truth.noise_n)
}

impl Row {
    /// Brings a truth and an answer together.
    pub fn new(job: &Job, case: &Case, truth: &Truth, answer: Result<Findings, String>, took_s: f64) -> Self {
        let force = truth.hidden.len() == 1 && truth.hidden[0].effect.shows() == Shows::Force;
        Self {
            set: job.set,
            bench: case.bench,
            log: case.log,
            rate_hz: case.rate_hz,
            seconds: job.spec.seconds,
            seed: job.seed,
            hidden: truth.hidden.iter().map(|h| (h.effect, h.form)).collect(),
            ratio: job.spec.ratio,
            ratios: truth.ratio.clone(),
            missed: truth.missed(),
            noise_n: truth.noise_n,
            equals: truth.equals.clone(),
            share_of_oracle: if force {
                answer.as_ref().map_or(f64::NAN, |a| share_of_oracle(a, truth))
            } else {
                f64::NAN
            },
            effect_n2: if force { truth.effect_rms[0].powi(2) } else { f64::NAN },
            answer,
            clean_floor: f64::NAN,
            took_s,
            followed: None,
        }
    }

    /// The ids of what was hidden.
    pub fn ids(&self) -> Vec<&'static str> {
        self.hidden.iter().map(|(effect, _)| effect.id()).collect()
    }

    /// The causes that were named, strongest first (terms without a name are none).
    pub fn named(&self) -> Vec<&str> {
        let Ok(answer) = &self.answer else { return Vec::new() };
        answer.causes.iter().map(|c| c.id.as_str()).filter(|id| !id.starts_with("other:")).collect()
    }

    /// True when a known cause was named.
    pub fn alarmed(&self) -> bool {
        !self.named().is_empty()
    }

    /// True when the answer says that something is there which no law explains.
    pub fn flagged(&self) -> bool {
        self.answer
            .as_ref()
            .is_ok_and(|a| a.verdict == Verdict::Unexplained || a.causes.iter().any(|c| c.id.starts_with("other:")))
    }

    /// The first cause is the hidden one, and nothing else will do.
    pub fn first_right(&self) -> bool {
        self.named().first().is_some_and(|first| self.ids().contains(first))
    }

    /// The first cause is the hidden one, or one that nobody could tell from it here.
    pub fn first_right_or_equal(&self) -> bool {
        self.named().first().is_some_and(|first| self.ids().contains(first) || self.equals.contains(first))
    }

    /// What the answer says the first cause could be: itself and what could stand in its place.
    pub fn ambiguity_set(&self) -> Vec<&str> {
        self.answer.as_ref().map_or_else(|_| Vec::new(), stated_set)
    }

    /// The hidden cause is among what the answer says it could be.
    pub fn set_right(&self) -> bool {
        let set = self.ambiguity_set();
        self.ids().iter().any(|id| set.contains(id))
    }

    /// Named, and not hidden.
    pub fn spurious(&self) -> usize {
        let ids = self.ids();
        self.named().iter().filter(|id| !ids.contains(id)).count()
    }

    /// Named, not hidden, and not exactly equal to what is.
    pub fn spurious_beside_equals(&self) -> usize {
        let ids = self.ids();
        self.named().iter().filter(|id| !ids.contains(id) && !self.equals.contains(id)).count()
    }

    /// Everything that was hidden was named, or as many exact equals in its place.
    pub fn all_right_or_equal(&self) -> bool {
        let (named, ids) = (self.named(), self.ids());
        let missing = ids.iter().filter(|id| !named.contains(id)).count();
        missing <= named.iter().filter(|id| !ids.contains(id) && self.equals.contains(id)).count()
    }

    /// Everything that was hidden was named.
    pub fn all_right(&self) -> bool {
        let named = self.named();
        self.ids().iter().all(|id| named.contains(id))
    }

    /// What the extension takes off the unexplained force on locked rows, as a share of what the oracle takes off there, who knows the
    /// hidden effect's force at every instant: 1 is the oracle's. Says nothing for effects without a force.
    pub fn gain_of_oracle(&self) -> f64 {
        let Ok(answer) = &self.answer else { return 0.0 };
        if !self.effect_n2.is_finite() {
            return f64::NAN;
        }
        if answer.causes.is_empty() {
            return 0.0;
        }
        if !answer.course.instants.is_empty() {
            return self.share_of_oracle;
        }
        (answer.baseline.heldout_rms_n.powi(2) - answer.end.heldout_rms_n.powi(2)) / self.effect_n2
    }

    /// What the answer itself says that its first cause explains of the explainable, by its own idea of the noise; where that is the
    /// hidden one.
    pub fn gain_claimed(&self) -> f64 {
        match &self.answer {
            Ok(answer) if self.first_right_or_equal() => {
                answer.causes.first().map_or(f64::NAN, |c| c.gain.share_of_explainable)
            }
            _ => f64::NAN,
        }
    }

    /// Every cause that was given a probability, and whether it was the hidden one.
    pub fn beliefs(&self) -> Vec<(f64, bool)> {
        let Ok(answer) = &self.answer else { return Vec::new() };
        let ids = self.ids();
        let causes = answer.causes.iter().map(|c| (c.posterior, ids.contains(&c.id.as_str())));
        let others = answer.alternatives.iter().map(|a| (a.posterior, ids.contains(&a.id.as_str())));
        causes.chain(others).collect()
    }

    /// How the answer reads in one or a few words.
    pub fn said(&self) -> String {
        match &self.answer {
            Err(error) => format!("error: {error}"),
            Ok(_) if self.alarmed() => self.named().join(" + "),
            Ok(_) if self.flagged() => "unexplained".to_owned(),
            Ok(_) => "none".to_owned(),
        }
    }
}

/// What an answer says its first cause could be: itself and what could stand in its place.
pub fn stated_set(answer: &Findings) -> Vec<&str> {
    let first = answer.causes.iter().map(|c| c.id.as_str()).find(|id| !id.starts_with("other:"));
    let mut set: Vec<&str> = first.into_iter().collect();
    for other in &answer.alternatives {
        let stands_there = other.instead_of.is_empty() || Some(other.instead_of.as_str()) == first;
        if stands_there && !set.contains(&other.id.as_str()) {
            set.push(&other.id);
        }
    }
    set
}

/// Rows that the answer itself trusts less than this are left out: there the sign of friction is a guess for everybody.
const TRUSTED: f64 = 0.5;
/// An oracle that gains less than this share of the noise's power on the locked rows says nothing.
const LEAST_GAIN: f64 = 0.02;

/// Powers taken off the locked rows: by the answer's extension, and by taking off the hidden effect itself.
fn share_of_oracle(answer: &Findings, truth: &Truth) -> f64 {
    let locked = answer.course.instants.iter().filter(|i| i.is_locked && i.recording == 0 && i.weight >= TRUSTED);
    let (mut found, mut oracle, mut noise) = (0.0, 0.0, 0.0);
    for instant in locked {
        let Some(effect_n) = at(&truth.effect, instant.time_s) else { continue };
        let (before, after) = (instant.left_before, instant.left_after);
        found += before * before - after * after;
        oracle += before * before - (before - effect_n).powi(2);
        noise += truth.noise_n * truth.noise_n;
    }
    if oracle > LEAST_GAIN * noise { found / oracle } else { f64::NAN }
}

/// A force between its samples; nothing where there are none near.
fn at(effect: &[(f64, f64)], time_s: f64) -> Option<f64> {
    /// Samples farther apart have a gap between them, s.
    const GAP_S: f64 = 0.06;
    let next = effect.partition_point(|(t, _)| *t < time_s);
    let ((t0, f0), (t1, f1)) = (*effect.get(next.checked_sub(1)?)?, *effect.get(next)?);
    (t1 - t0 < GAP_S).then(|| f0 + (f1 - f0) * (time_s - t0) / (t1 - t0).max(1e-12))
}

/// The figures that a battery is judged by.
#[derive(Clone, Debug)]
pub struct Figures {
    /// Right cause first in main cases that show it, effect over noise 0.5 and more.
    pub first_from_half: Share,
    /// … where an exact equal counts as right.
    pub first_or_equal_from_half: Share,
    /// … in all main cases.
    pub first_all: Share,
    /// … where an exact equal counts as right.
    pub first_or_equal: Share,
    /// Truth in the ambiguity set, of the cases in which something was named.
    pub in_set: Share,
    /// Mean size of that set.
    pub set_size: f64,
    /// Alarms in nulls at 100 Hz and more …
    pub false_alarms: Share,
    /// … and at 20 Hz.
    pub false_alarms_20_hz: Share,
    /// Nulls that are said to hold something unexplained.
    pub null_flags: Share,
    /// Named causes that were hidden, or equal to what was, of all that were named in nulls and main cases.
    pub precision: Share,
    /// Nameless effects that were given a name without a flag …
    pub nameless_named: Share,
    /// … and that were flagged, effect over noise 1 and more.
    pub nameless_flagged: Share,
    /// Both causes of a pair.
    pub both: Share,
    /// … where an exact equal counts as right.
    pub both_or_equal: Share,
    /// Causes too many, a pair, …
    pub spurious: f64,
    /// … exact equals not counted.
    pub spurious_beside_equals: f64,
    /// Median and 10th percentile of the gain as a share of the oracle's, effect over noise 0.5 and more.
    pub gain: [f64; 2],
    /// The same as the answers state it, where they are right.
    pub gain_claimed: [f64; 2],
    /// Cases that ended in an error.
    pub errors: Share,
}

impl Figures {
    /// Counts.
    pub fn of(rows: &[Row]) -> Self {
        let set = |set: Set| rows.iter().filter(move |r| r.set == set);
        let single = || set(Set::Single).filter(|r| !r.missed);
        let named: Vec<&Row> = single().filter(|r| r.alarmed()).collect();
        let strong = || single().filter(|r| r.ratio >= 0.5);
        let counted: Vec<(&Row, &str)> =
            set(Set::Null).chain(single()).flat_map(|r| r.named().into_iter().map(move |id| (r, id))).collect();
        let gains: Vec<f64> = strong().map(Row::gain_of_oracle).collect();
        let claimed: Vec<f64> = strong().map(Row::gain_claimed).collect();
        let pairs: Vec<&Row> = set(Set::Pair).filter(|r| !r.missed).collect();
        let mean = |of: &dyn Fn(&Row) -> usize| pairs.iter().map(|r| of(r) as f64).sum::<f64>() / pairs.len() as f64;
        Self {
            first_from_half: Share::count(strong(), Row::first_right),
            first_or_equal_from_half: Share::count(strong(), Row::first_right_or_equal),
            first_all: Share::count(single(), Row::first_right),
            first_or_equal: Share::count(single(), Row::first_right_or_equal),
            in_set: Share::count(named.iter(), |r| r.set_right()),
            set_size: named.iter().map(|r| r.ambiguity_set().len() as f64).sum::<f64>() / named.len() as f64,
            false_alarms: Share::count(set(Set::Null).filter(|r| r.rate_hz >= 100.0), Row::alarmed),
            false_alarms_20_hz: Share::count(set(Set::Null).filter(|r| r.rate_hz < 100.0), Row::alarmed),
            null_flags: Share::count(set(Set::Null), Row::flagged),
            precision: Share::count(counted, |(r, id)| r.ids().contains(&id) || r.equals.contains(&id)),
            nameless_named: Share::count(set(Set::Nameless), |r| r.alarmed() && !r.flagged()),
            nameless_flagged: Share::count(set(Set::Nameless).filter(|r| r.ratio >= 1.0), Row::flagged),
            both: Share::count(pairs.iter(), |r| r.all_right()),
            both_or_equal: Share::count(pairs.iter(), |r| r.all_right_or_equal()),
            spurious: mean(&|r| r.spurious()),
            spurious_beside_equals: mean(&|r| r.spurious_beside_equals()),
            gain: [0.5, 0.1].map(|part| quantile(&gains, part)),
            gain_claimed: [0.5, 0.1].map(|part| quantile(&claimed, part)),
            errors: Share::count(rows, |r| r.answer.is_err()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estimator::diagnose::diagnose;

    #[test]
    fn a_force_is_read_between_its_samples_and_not_in_gaps() {
        let effect = [(0.0, 1.0), (0.01, 3.0), (0.5, 7.0)];
        assert_eq!(at(&effect, 0.0025), Some(1.5));
        assert_eq!((at(&effect, 0.2), at(&effect, -1.0), at(&effect, 9.0)), (None, None, None));
    }

    #[test]
    fn who_takes_nothing_off_gains_nothing_and_the_truth_itself_gains_all() {
        let job =
            Job { set: Set::Single, spec: Spec::hiding(vec![(Effect::Eccentric, 0)], 2.0, Bench::OneFinger), seed: 3 };
        let (case, truth) = job.make();
        let mut answer = diagnose(&case.recordings, &options(&case)).expect("it can be diagnosed");
        for instant in &mut answer.course.instants {
            instant.left_after = instant.left_before;
        }
        assert_eq!(share_of_oracle(&answer, &truth), 0.0);
        for instant in &mut answer.course.instants {
            instant.left_after -= at(&truth.effect, instant.time_s).unwrap_or(0.0);
        }
        assert!((share_of_oracle(&answer, &truth) - 1.0).abs() < 1e-9);
    }
}
