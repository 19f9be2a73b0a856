//! Answers beside truths.

use super::family::{Family, Group};
use super::sets::Job;
use crate::tasks::Case;
use blind::{Counted, Set};
use estimator::diagnose::{Findings, Options};
use haptics::recording::Recording;
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// One case with its answer.
#[derive(Clone, Debug)]
pub struct Row {
    /// Carried blocks or needles.
    pub group: Group,
    /// Family of the structure.
    pub family: Family,
    /// Its form.
    pub form: u32,
    /// Alone, or beside an effect.
    pub set: Set,
    /// Id of that effect.
    pub hidden: Option<&'static str>,
    /// Repeats the case.
    pub seed: u64,
    /// Sizes over the noise that came out: of the structure, then of the effect.
    pub ratios: Vec<f64>,
    /// A size could not be had.
    pub is_missed: bool,
    /// Noise of a reading, N.
    pub noise_n: f64,
    /// Stated noise floor over the noise where the structure is left out.
    pub clean_floor: f64,
    /// Ids of causes that were named where the structure is left out, strongest first.
    pub clean_names: Vec<String>,
    /// The answer, or the sentence of the error.
    pub answer: Result<Findings, String>,
    /// Length of the recording, s.
    pub seconds: f64,
    /// Time to make the case, and to answer it once, s.
    pub took_s: [f64; 2],
}

/// Whoever looks for what is hidden.
pub type Engine<'a> = dyn Fn(&[Recording], &Options) -> Result<Findings, String> + Sync + 'a;

/// Makes and asks every case, on all cores; answers keep the order of the jobs.
pub fn ask(jobs: &[Job], engine: &Engine<'_>) -> Vec<Row> {
    jobs.par_iter().with_max_len(1).map(|job| row(job, engine)).collect()
}

fn row(job: &Job, engine: &Engine<'_>) -> Row {
    let asked = |case: &Case| {
        catch_unwind(AssertUnwindSafe(|| engine(&case.recordings, &case.options)))
            .unwrap_or_else(|_| Err("it panicked".to_owned()))
    };
    let start = Instant::now();
    let made = job.make();
    let made_s = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let answer = asked(&made.case);
    let answered_s = start.elapsed().as_secs_f64();
    let clean = asked(&made.clean).ok();
    let named = |id: &String| !besides(job.family).contains(&id.as_str());
    let names = |found: &Findings| found.causes.iter().map(|cause| cause.id.clone()).filter(named).collect();
    let times = made.case.recordings[0].time_s.as_deref().unwrap_or_default();
    Row {
        group: job.group,
        family: job.family,
        form: job.form,
        set: job.set(),
        hidden: job.hidden(),
        seed: job.seed,
        ratios: made.scaled.ratios,
        is_missed: made.scaled.is_missed,
        noise_n: made.noise_n,
        clean_floor: clean.as_ref().map_or(f64::NAN, |found| floor_n(found) / made.noise_n),
        clean_names: clean.as_ref().map_or_else(Vec::new, names),
        answer,
        seconds: times.last().copied().unwrap_or(0.0),
        took_s: [made_s, answered_s],
    }
}

/// Stated noise floor, N; not a number where the answer is about places.
fn floor_n(found: &Findings) -> f64 {
    if found.baseline.unit.as_deref() == Some("m") { f64::NAN } else { found.noise_floor_n }
}

/// Friction that a structure multiplies is there, and the plain model has none.
fn besides(family: Family) -> &'static [&'static str] {
    if family.needs_friction() { &["coulomb-friction"] } else { &[] }
}

impl Counted for Row {
    fn group(&self) -> &str {
        self.group.name()
    }

    fn family(&self) -> &str {
        self.family.name()
    }

    fn set(&self) -> Set {
        self.set
    }

    fn is_missed(&self) -> bool {
        self.is_missed
    }

    fn answer(&self) -> Result<&Findings, &str> {
        self.answer.as_ref().map_err(String::as_str)
    }

    fn right_ids(&self) -> Vec<&str> {
        self.hidden.into_iter().collect()
    }

    fn tolerated_ids(&self) -> &[&str] {
        self.family.tolerated(self.group)
    }

    fn ids_besides(&self) -> &[&str] {
        besides(self.family)
    }

    fn noise_n(&self) -> f64 {
        self.noise_n
    }

    fn floor_over_noise(&self) -> f64 {
        self.answer.as_ref().map_or(f64::NAN, |found| floor_n(found) / self.noise_n)
    }

    fn clean_floor(&self) -> f64 {
        self.clean_floor
    }
}

/// A case in one line: group, family, form, seconds, seed, sizes over the noise, hidden, verdict, names with posterior.
pub fn line(row: &Row) -> String {
    let ratios: Vec<String> = row.ratios.iter().map(|x| format!("{x:.2}")).collect();
    let clean =
        if row.clean_names.is_empty() { String::new() } else { format!("|clean: {}", row.clean_names.join(", ")) };
    let case =
        format!("{}|{}|form {}|{:.0} s|{}", row.group.name(), row.family.name(), row.form, row.seconds, row.seed);
    let hidden = row.hidden.unwrap_or("");
    let floor = format!("floor {:.2} of {:.2}", row.floor_over_noise(), row.clean_floor);
    format!("{case}|{}|{hidden}|{floor}|{}{clean}", ratios.join(","), row.told())
}
