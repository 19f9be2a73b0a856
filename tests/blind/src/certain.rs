//! Certain names in the presence of structured model error: how many there are, and how many are wrong.

use super::counted::{Counted, Name};
use super::interval::{Share, quantile};
use super::score::Row;
use super::sets::Set;
use estimator::diagnose::Verdict;
use std::fmt::Write as _;

/// Edges of the bins of stated posteriors.
const BINS: [f64; 6] = [0.0, 0.2, 0.5, 0.8, 0.95, 1.0 + 1e-9];

/// Counts of cases with structured model error and nothing else.
#[derive(Clone, Debug)]
pub struct Alone {
    /// A wrong name is certain.
    pub false_certain: Share,
    /// A wrong name is certain that does not describe the structure.
    pub fair: Share,
    /// The verdict is `ambiguous`.
    pub ambiguous: Share,
    /// The verdict is `unexplained`.
    pub unexplained: Share,
    /// Stated noise floor over its clean value, median.
    pub floor: f64,
    /// Stated noise floor over the noise of a reading, median: with the structure, and without it.
    pub floor_over_noise: [f64; 2],
}

impl Alone {
    /// Counts.
    pub fn of<R: Counted>(rows: &[&R]) -> Self {
        let rows = || rows.iter().filter(|r| r.set() == Set::Structured && !r.is_missed());
        let median = |of: &dyn Fn(&R) -> f64| quantile(&rows().map(|r| of(r)).collect::<Vec<f64>>(), 0.5);
        Self {
            false_certain: Share::count(rows(), |r| r.false_certain()[0] > 0),
            fair: Share::count(rows(), |r| r.false_certain()[1] > 0),
            ambiguous: Share::count(rows(), |r| r.has_verdict(Verdict::Ambiguous)),
            unexplained: Share::count(rows(), |r| r.has_verdict(Verdict::Unexplained)),
            floor: median(&|r| r.floor_over_noise() / r.clean_floor()),
            floor_over_noise: [median(&|r| r.floor_over_noise()), median(&|r| r.clean_floor())],
        }
    }
}

/// Counts of cases with one effect beside structured model error.
#[derive(Clone, Debug)]
pub struct Beside {
    /// The first name is right and certain.
    pub right: Share,
    /// The same, or the effect is among what is said to be possible.
    pub in_set: Share,
    /// Certain wrong names a case, and without those that describe the structure.
    pub false_certain: [f64; 2],
}

impl Beside {
    /// Counts.
    pub fn of<R: Counted>(rows: &[&R]) -> Self {
        let rows = || rows.iter().filter(|r| r.set() == Set::Beside && !r.is_missed());
        let mean = |k: usize| rows().map(|r| r.false_certain()[k] as f64).sum::<f64>() / rows().count() as f64;
        Self {
            right: Share::count(rows(), |r| r.right_for_certain()),
            in_set: Share::count(rows(), |r| r.right_or_in_set()),
            false_certain: [mean(0), mean(1)],
        }
    }
}

/// Tables for a person to read.
pub fn report<R: Counted>(rows: &[R]) -> String {
    let family = |r: &R| r.family().to_owned();
    let group = |r: &R| r.group().to_owned();
    let missed = Share::count(rows, R::is_missed);
    let errors = Share::count(rows, |r| r.answer().is_err());
    let parts = [
        alone(&grouped(rows, &group)),
        alone(&grouped(rows, &family)),
        beside(&grouped(rows, &group)),
        beside(&grouped(rows, &family)),
        frequent(rows),
        calibration(rows),
        format!("not counted, because their size could not be had: {missed}\nerrors: {errors}\n"),
    ];
    parts.join("\n")
}

/// Rows by a name, in the order in which the names come first; all of them at the end.
fn grouped<'a, R>(rows: &'a [R], name: &dyn Fn(&R) -> String) -> Vec<(String, Vec<&'a R>)> {
    let mut groups: Vec<(String, Vec<&R>)> = Vec::new();
    for row in rows {
        let name = name(row);
        match groups.iter_mut().find(|(group, _)| *group == name) {
            Some((_, of)) => of.push(row),
            None => groups.push((name, vec![row])),
        }
    }
    groups.push(("all".to_owned(), rows.iter().collect()));
    groups
}

fn alone<R: Counted>(groups: &[(String, Vec<&R>)]) -> String {
    let mut text = format!(
        "structure alone: {:<4} {:<30} {:<30} {:<30} {:<30} noise floor over clean (over noise, clean)\n",
        "", "false certain", "fair", "ambiguous", "unexplained"
    );
    for (group, rows) in groups {
        let a = Alone::of(rows);
        let [with, clean] = a.floor_over_noise;
        let shares =
            [a.false_certain, a.fair, a.ambiguous, a.unexplained].map(|s| format!("{s:<30}", s = s.to_string()));
        let _ = writeln!(text, "  {group:<19} {} {:.2} ({:.2}, {clean:.2})", shares.join(" "), a.floor, with);
    }
    text
}

fn beside<R: Counted>(groups: &[(String, Vec<&R>)]) -> String {
    let mut text = format!(
        "beside an effect:{:<4} {:<30} {:<30} false certain a case, fair\n",
        "", "right by one certain name", "or in the stated set"
    );
    for (group, rows) in groups {
        let b = Beside::of(rows);
        let (right, set) = (b.right.to_string(), b.in_set.to_string());
        let [all, fair] = b.false_certain;
        let _ = writeln!(text, "  {group:<19} {right:<30} {set:<30} {all:.2} {fair:.2}");
    }
    text
}

/// Wrong certain names, most frequent first.
fn frequent<R: Counted>(rows: &[R]) -> String {
    let mut counts: Vec<(&str, usize)> = Vec::new();
    for name in rows.iter().flat_map(R::names).filter(|n| n.is_certain && !n.is_right && !n.is_tolerated) {
        match counts.iter_mut().find(|(id, _)| *id == name.id) {
            Some((_, count)) => *count += 1,
            None => counts.push((name.id, 1)),
        }
    }
    counts.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(b.0)));
    let words: Vec<String> = counts.iter().map(|(id, count)| format!("{id} {count}")).collect();
    format!("wrong certain names (fair): {}\n", words.join(", "))
}

/// Names whose stated posterior lies in one bin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reliability {
    /// Ends of the bin.
    pub bin: [f64; 2],
    /// Mean of the stated posteriors; not a number without names.
    pub stated: f64,
    /// Names that are right.
    pub right: Share,
    /// The same without names that describe the structure.
    pub fair: Share,
}

/// Stated posteriors of names in bins, and how many of the names are right.
pub fn reliability<R: Counted>(rows: &[R]) -> Vec<Reliability> {
    let counted = rows.iter().filter(|r| matches!(r.set(), Set::Structured | Set::Beside) && !r.is_missed());
    let names: Vec<Name<'_>> = counted.flat_map(R::names).collect();
    let bin = |edge: &[f64]| {
        let there = || names.iter().filter(|n| n.posterior >= edge[0] && n.posterior < edge[1]);
        Reliability {
            bin: [edge[0], edge[1].min(1.0)],
            stated: there().map(|n| n.posterior).sum::<f64>() / there().count() as f64,
            right: Share::count(there(), |n| n.is_right),
            fair: Share::count(there().filter(|n| !n.is_tolerated), |n| n.is_right),
        }
    };
    BINS.windows(2).map(bin).collect()
}

fn calibration<R: Counted>(rows: &[R]) -> String {
    let mut text = String::from("posterior of a name → how often it is right, fair\n");
    for Reliability { bin: [from, to], right, fair, .. } in reliability(rows) {
        let _ = writeln!(text, "  {from:.2}–{to:.2}  {:<30} {fair}", right.to_string());
    }
    text
}

/// A case in one line: family, bench, log, rate, seconds, seed, sizes over the noise, hidden, verdict, names with posterior.
pub fn line(r: &Row) -> String {
    let hidden: Vec<String> = r.hidden.iter().map(|(e, form)| format!("{} ({})", e.id(), e.form(*form))).collect();
    let ratios: Vec<String> = r.ratios.iter().map(|x| format!("{x:.2}")).collect();
    let family = r.structure().map_or("", super::effect::Effect::id);
    let object = format!("{}|{}|{} Hz|{:.0} s", r.bench.name(), r.log.name(), r.rate_hz, r.seconds);
    let floor = format!("floor {:.2} of {:.2}", r.floor_over_noise(), r.clean_floor());
    format!("{family}|{object}|{}|{}|{}|{floor}|{}", r.seed, ratios.join(","), hidden.join(" + "), r.told())
}

#[cfg(test)]
mod tests {
    use super::super::draw::{Bench, Spec, Structure};
    use super::super::effect::Effect;
    use super::super::plan::Log;
    use super::super::sets::Job;
    use super::*;
    use estimator::diagnose::{Diagnosis, Findings};

    /// An answer with names and their posteriors.
    fn said(verdict: &str, names: &[(&str, f64)], instead: &[&str]) -> Findings {
        let causes: Vec<_> = names
            .iter()
            .map(|(id, posterior)| {
                serde_json::json!({"id": id, "kind": "plant", "parameters": [], "p_value": 0.0, "posterior": posterior,
                    "gain": {"heldout_rms_before": 0.0, "heldout_rms_after": 0.0, "share_of_explainable": 0.0,
                        "interval": [0.0, 0.0]}, "evidence": ""})
            })
            .collect();
        let place = names.first().map_or("", |(id, _)| id);
        let alternatives: Vec<_> = instead
            .iter()
            .map(|id| serde_json::json!({"id": id, "instead_of": place, "posterior": 0.4, "why": ""}))
            .collect();
        let diagnosis: Diagnosis = serde_json::from_value(serde_json::json!({
            "verdict": verdict,
            "baseline": {"model": "", "rms_N": 0.0, "heldout_rms_N": 0.0, "whiteness_p": 0.0},
            "noise_floor_N": 0.5, "causes": causes, "alternatives": alternatives, "not_excited": [],
            "next_experiment": null, "final": {"heldout_rms_N": 0.0, "whiteness_p": 0.0}
        }))
        .expect("a diagnosis");
        diagnosis.into()
    }

    #[test]
    fn certain_names_are_counted_right_wrong_and_fairly() {
        let structure = Some(Structure { effect: Effect::AngleField, form: 0, ratio: 1.0 });
        let (bench, log, rate_hz, seconds) = (Bench::Linear, Log::Mixed, 100.0, 8.0);
        let alone = Spec { effects: Vec::new(), ratio: 0.0, structure, bench, log, rate_hz, seconds };
        let with = Spec { effects: vec![(Effect::Drag, 0)], ratio: 2.0, ..alone.clone() };
        let made = [(Set::Structured, alone), (Set::Beside, with)].map(|(set, spec)| {
            let job = Job { set, spec, seed: 3 };
            let (case, truth) = job.make();
            (job, case, truth)
        });
        let row = |k: usize, answer: Findings| {
            let (job, case, truth) = &made[k];
            Row { missed: false, noise_n: 0.25, clean_floor: 0.8, ..Row::new(job, case, truth, Ok(answer), 0.1) }
        };
        let rows = [
            row(0, said("causes", &[("position-ripple", 0.99), ("backlash", 0.9)], &[])),
            row(0, said("causes", &[("stribeck", 0.99), ("other:load", 0.99)], &[])),
            row(0, said("ambiguous", &[("stribeck", 0.99)], &["backlash"])),
            row(0, said("unexplained", &[], &[])),
            row(1, said("causes", &[("quadratic-drag", 0.99), ("position-ripple", 0.99), ("inertia", 0.96)], &[])),
            row(1, said("ambiguous", &[("stribeck", 0.6)], &["quadratic-drag"])),
        ];
        let all: Vec<&Row> = rows.iter().collect();
        let (alone, beside) = (Alone::of(&all), Beside::of(&all));
        assert_eq!((alone.false_certain.hits, alone.fair.hits, alone.fair.of), (2, 1, 4));
        assert_eq!((alone.ambiguous.hits, alone.unexplained.hits, alone.floor), (1, 1, 2.0 / 0.8));
        assert_eq!((beside.right.hits, beside.in_set.hits, beside.in_set.of), (1, 2, 2));
        assert_eq!(beside.false_certain, [1.0, 0.5]);
        let Reliability { right: all, fair, .. } = reliability(&rows)[4];
        assert_eq!((all, fair), (Share { hits: 1, of: 6 }, Share { hits: 1, of: 4 }));
        let text = report(&rows);
        assert!(text.contains("mechanisms") && text.contains("angle-field"), "{text}");
        assert!(line(&rows[4]).contains("quadratic-drag (right) 0.990"), "{}", line(&rows[4]));
    }
}
