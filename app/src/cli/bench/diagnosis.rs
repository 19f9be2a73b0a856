//! `touchstone bench diagnosis`: duration of a diagnosis for a minute at 1 kHz, with and without a hidden effect.

use super::frames::performance;
use super::table::{Figure, Said, Wanted};
use super::whole::{best_s, long};
use crate::cli::{Output, progress};
use blind::{Bench, Effect, Job, Set, Spec};
use clap::Args;
use estimator::diagnose::{Options, diagnose};
use haptics::recording::Recording;
use haptics::world::presets;

const RATE_HZ: f64 = 1000.0;
const SECONDS: f64 = 60.0;
/// Time limit of a diagnosis on one core, ms.
const MOST_MS: f64 = 500.0;

/// Arguments of `bench diagnosis`.
#[derive(Args, Clone, Copy, Default)]
pub struct DiagnosisBench {
    /// Two recordings, each asked once
    #[arg(long)]
    pub(super) quick: bool,
    /// Draws the objects, hands and instruments
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
}

/// Object, and its hidden effects.
type Case = (Bench, &'static [Effect]);

/// Null cases and effects of all three places: in the force, in the path, and where the diagnosis runs twice (late
/// forces).
const CASES: [Case; 12] = [
    (Bench::OneFinger, &[]),
    (Bench::Linear, &[Effect::Hysteresis]),
    (Bench::TwoFingers, &[]),
    (Bench::OneFinger, &[Effect::Ripple]),
    (Bench::OneFinger, &[Effect::Hysteresis]),
    (Bench::TwoFingers, &[Effect::Stribeck]),
    (Bench::OneFinger, &[Effect::Pad]),
    (Bench::OneFinger, &[Effect::Delay]),
    (Bench::OneFinger, &[Effect::Spring, Effect::Asymmetry]),
    (Bench::Linear, &[]),
    (Bench::Angular, &[]),
    (Bench::Angular, &[Effect::Ripple]),
];

fn job((bench, effects): Case, seed: u64) -> Job {
    let effects: Vec<(Effect, u32)> = effects.iter().map(|e| (*e, e.forms_on(bench.is_crank()).start)).collect();
    let (set, ratio) = match effects.len() {
        0 => (Set::Null, 0.0),
        1 => (Set::Single, 1.0),
        _ => (Set::Pair, 1.0),
    };
    let spec = Spec { rate_hz: RATE_HZ, seconds: SECONDS, ..Spec::hiding(effects, ratio, bench) };
    Job { set, spec, seed }
}

fn name_of((bench, effects): Case) -> String {
    let what = match bench {
        Bench::OneFinger => "crank",
        Bench::TwoFingers => "crank by two fingers",
        Bench::Linear => "slide",
        Bench::Angular => "hinge",
    };
    let hidden: Vec<&str> = effects.iter().map(|e| e.id()).collect();
    if hidden.is_empty() { format!("{what}, nothing hidden") } else { format!("{what}, {}", hidden.join(" + ")) }
}

impl DiagnosisBench {
    pub(super) fn run(self) -> anyhow::Result<Output> {
        let figures = progress::during("measuring diagnoses", |share| self.figures(|done| share.tell(done)))?;
        let said = Said::of(self.quick, figures);
        Ok(Output { text: said.in_words(), json: serde_json::to_value(&said)? })
    }

    /// One row per case; a diagnosis runs on the calling thread.
    pub(super) fn figures(self, told: impl Fn(f64)) -> anyhow::Result<Vec<Figure>> {
        let rounds = if self.quick { 1 } else { 3 };
        let cases = if self.quick { &CASES[..2] } else { &CASES[..] };
        let mut figures = Vec::new();
        for (k, case) in cases.iter().enumerate() {
            let (made, _) = job(*case, self.seed.wrapping_add(k as u64)).make();
            let options = blind::score::options(&made);
            figures.push(figure(&name_of(*case), &made.recordings, &options, rounds)?);
            told((k + 1) as f64 / (cases.len() + 1) as f64);
        }
        if !self.quick {
            // The battery has no blocks: the scripted operator stacks them repeatedly.
            let stacked = [long(&performance("stack", &presets::stacking()), (RATE_HZ * SECONDS) as usize)];
            figures.push(figure("blocks, nothing hidden", &stacked, &Options::default(), rounds)?);
        }
        Ok(figures)
    }
}

fn figure(what: &str, asked: &[Recording], options: &Options, rounds: usize) -> anyhow::Result<Figure> {
    let took = best_s(rounds, || Ok(diagnose(asked, options)?))?;
    let name = format!("diagnosis of 60 s at 1 kHz: {what}");
    Ok(Figure::new(name, 1e3 * took, "ms").wanted(Wanted::AtMost(MOST_MS)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_is_a_minute_with_what_its_name_says() {
        for case in CASES {
            let Job { spec, .. } = job(case, 1);
            assert!(spec.rate_hz * spec.seconds >= 60_000.0);
            assert!(case.1.iter().all(|e| name_of(case).contains(e.id())), "{}", name_of(case));
            let mechanism = matches!(case.0, Bench::Linear | Bench::Angular);
            let fits = |e: &Effect| if mechanism { e.on_mechanism(case.0 == Bench::Angular) } else { e.on_crank() };
            assert!(case.1.iter().all(fits), "the generator knows it there: {}", name_of(case));
        }
    }

    #[test]
    fn a_quick_run_has_a_crank_and_a_mechanism_with_their_bound() {
        let output = DiagnosisBench { quick: true, seed: 1 }.run().expect("it runs");
        for part in ["60 s at 1 kHz: crank, nothing hidden", "slide, hysteresis", "≤ 500"] {
            assert!(output.text.contains(part), "{part}: {}", output.text);
        }
        assert_eq!(output.json["figures"].as_array().map(Vec::len), Some(2));
    }
}
