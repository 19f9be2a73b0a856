//! Answers beside truths.

use super::{Case, Truth};
use blind::Share;
use estimator::diagnose::{Cause, Findings, Verdict, diagnose};
use std::fmt::Write;

/// One case, asked.
pub struct Row {
    /// Which kind.
    pub kind: &'static str,
    /// Repeats it.
    pub seed: u64,
    /// What is true.
    pub truth: Truth,
    /// The answer, or the sentence of the error.
    pub answer: Result<Findings, String>,
}

/// Makes a case and asks the program.
pub fn ask(kind: &'static str, seed: u64, (case, truth): (Case, Truth)) -> Row {
    let answer = diagnose(&case.recordings, &case.options).map_err(|e| e.to_string());
    Row { kind, seed, truth, answer }
}

impl Row {
    /// Ids that were named, without those that may be there in any case; the strongest first.
    pub fn named(&self) -> Vec<&str> {
        let Ok(answer) = &self.answer else { return Vec::new() };
        let ids = answer.causes.iter().map(|c| c.id.as_str());
        ids.filter(|id| !self.truth.besides.contains(id) || self.truth.hidden.contains(id)).collect()
    }

    /// Everything hidden is named, or what nobody could tell from it, and comes out as it must.
    pub fn right(&self) -> bool {
        self.is_named() && self.misses().is_empty()
    }

    /// What does not come out as it must: name, truth, answer.
    fn misses(&self) -> Vec<(&'static str, f64, Option<f64>)> {
        let Ok(answer) = &self.answer else { return Vec::new() };
        let of = |name: &str| {
            let hidden = answer.causes.iter().filter(|c| self.truth.hidden.contains(&c.id.as_str()));
            hidden.flat_map(|c| &c.parameters).find(|p| p.name == name).map(|p| p.value)
        };
        let near = self.truth.near.iter().map(|(name, truth, within)| (*name, *truth, of(name), *within));
        near.filter(|(_, truth, found, within)| found.is_none_or(|f| (f - truth).abs() > *within))
            .map(|(name, truth, found, _)| (name, truth, found))
            .collect()
    }

    /// Everything hidden is named, or what nobody could tell from it.
    fn is_named(&self) -> bool {
        let named = self.named();
        let one = |id: &&str| named.contains(id) || self.truth.equals.iter().any(|e| named.contains(e));
        self.truth.hidden.iter().all(one)
    }

    /// Everything hidden is named or listed.
    pub fn in_set(&self) -> bool {
        let Ok(answer) = &self.answer else { return false };
        let listed = |id: &&&str| answer.alternatives.iter().any(|a| a.id == **id);
        let named = self.named();
        self.truth.hidden.iter().all(|id| named.contains(id) || listed(&id))
    }

    /// Named although it is not there.
    pub fn spurious(&self) -> usize {
        let known = |id: &&&str| self.truth.hidden.contains(*id) || self.truth.equals.contains(*id);
        self.named().iter().filter(|id| !known(id)).count()
    }

    /// The verdict is what it should be: nothing, a cause, or open where nobody can tell.
    pub fn verdict_fits(&self) -> bool {
        let Ok(answer) = &self.answer else { return false };
        match (self.truth.hidden.is_empty() && self.truth.besides.is_empty(), self.truth.equals.is_empty()) {
            (true, _) => answer.verdict == Verdict::None,
            (false, true) => answer.verdict != Verdict::Unexplained,
            // A trace in the little that was free may settle it all the same.
            (false, false) => answer.verdict == Verdict::Ambiguous || self.named() == self.truth.hidden,
        }
    }

    /// The true parameter against the found one: relative error and distance in standard errors.
    pub fn off(&self) -> Option<(f64, f64)> {
        let (name, truth) = self.truth.value?;
        let causes = &self.answer.as_ref().ok()?.causes;
        let of = causes.iter().filter(|c| self.truth.hidden.contains(&c.id.as_str()));
        let found = of.flat_map(|c| &c.parameters).find(|p| p.name == name)?;
        Some((found.value / truth - 1.0, (found.value - truth) / found.std_error))
    }

    /// One line for people.
    pub fn line(&self) -> String {
        let answer = match &self.answer {
            Ok(a) => format!(
                "{:?} {:?} or {:?}",
                a.verdict,
                a.causes.iter().map(said).collect::<Vec<_>>(),
                a.alternatives.iter().map(|c| c.id.as_str()).collect::<Vec<_>>()
            ),
            Err(sentence) => sentence.clone(),
        };
        let off = self.off().map_or(String::new(), |(r, s)| format!(" off {:+.1} % = {s:+.1} errors", 100.0 * r));
        let misses = if self.is_named() { self.misses() } else { Vec::new() };
        let misses = if misses.is_empty() { String::new() } else { format!(" not {misses:?}") };
        format!("{} seed {}: hidden {:?}: {answer}{off}{misses}", self.kind, self.seed, self.truth.hidden)
    }
}

/// A cause with what it comes out at, for people.
fn said(cause: &Cause) -> String {
    let parameters: Vec<String> = cause.parameters.iter().map(|p| format!("{} {:.3e}", p.name, p.value)).collect();
    format!("{} {}", cause.id, parameters.join(" "))
}

/// A table: kind, right, in the set, spurious, verdict.
pub fn table(rows: &[Row]) -> String {
    let mut kinds: Vec<&str> = rows.iter().map(|r| r.kind).collect();
    kinds.dedup();
    let mut text = String::new();
    for kind in kinds {
        let of: Vec<&Row> = rows.iter().filter(|r| r.kind == kind).collect();
        let share = |hit: &dyn Fn(&&Row) -> bool| Share::count(of.iter().copied(), |r| hit(&r));
        let spurious: usize = of.iter().map(|r| r.spurious()).sum();
        let mut errors: Vec<f64> = of.iter().filter_map(|r| Some(r.off()?.0.abs())).collect();
        errors.sort_by(f64::total_cmp);
        let held = of.iter().filter_map(|r| r.off()).filter(|(_, s)| s.abs() < 1.96).count();
        let _ = writeln!(
            text,
            "{kind:22} right {} | in set {} | verdict {} | spurious {spurious} | median error {:.1} %, in interval {held}/{}",
            share(&|r| r.right()),
            share(&|r| r.in_set()),
            share(&|r| r.verdict_fits()),
            100.0 * errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN),
            errors.len()
        );
    }
    text
}
