//! What an answer about a block asks for is done by a hand of our own, and settles the question.
//!
//! `TOUCHSTONE_SEED=20400 cargo test -p tests --test diagnose_experiments` repeats a day, `TOUCHSTONE_TASK_CASES=30` asks more.

use blind::Share;
use estimator::diagnose::{Experiment, Findings, diagnose};
use haptics::recording::Recording;
use rayon::prelude::*;
use std::time::{SystemTime, UNIX_EPOCH};
use tests::tasks::{Case, Truth, blocks, slide};

fn told(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

fn seed() -> u64 {
    let today = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs() / 86_400);
    told("TOUCHSTONE_SEED").unwrap_or_else(today)
}

type Make = fn(u64) -> (Case, Truth);
type Perform = fn(u64, &Experiment) -> Option<Recording>;

/// What is hidden, how it is done again as asked, and what must not be open any more.
const KINDS: [(&str, Make, Perform, &str); 3] = [
    (
        "leak, cut off",
        |s| blocks::make(blocks::Kind::LeakCut, s),
        |s, asked| blocks::as_asked(blocks::Kind::LeakCut, s, asked, s ^ 0x77),
        "force-drift",
    ),
    (
        "drift, cut off",
        |s| blocks::make(blocks::Kind::DriftCut, s),
        |s, asked| blocks::as_asked(blocks::Kind::DriftCut, s, asked, s ^ 0x77),
        "mass-change",
    ),
    (
        "slide: tilt, cut off",
        |s| slide::make(slide::Kind::TiltCut, s),
        |s, asked| slide::as_asked(slide::Kind::TiltCut, s, asked, s ^ 0x77),
        "force-bias",
    ),
];

/// A question that was asked, and what came of it.
struct Asked {
    kind: &'static str,
    power: f64,
    settled: bool,
}

fn open(answer: &Findings, id: &str) -> bool {
    answer.causes.iter().any(|c| c.id == id) || answer.alternatives.iter().any(|a| a.id == id)
}

fn ask(kind: &'static str, make: Make, perform: Perform, wrong: &str, seed: u64) -> Option<Asked> {
    let (case, truth) = make(seed);
    let alone = diagnose(&case.recordings, &case.options).expect("it can be diagnosed");
    let next = alone.next_experiment.as_ref().filter(|_| open(&alone, wrong))?;
    let asked = next.experiment.as_ref()?;
    let again = perform(seed, asked).expect("the hand knows the motion");
    let both = [case.recordings[0].clone(), again];
    let answer = diagnose(&both, &case.options).expect("both can be diagnosed");
    let named = truth.hidden.iter().all(|id| answer.causes.iter().any(|c| c.id == *id));
    let settled = named && !open(&answer, wrong);
    if !settled {
        println!("{kind} seed {seed}: {asked:?} left {:?} or {:?}", ids(&answer), answer.alternatives);
    }
    Some(Asked { kind, power: next.expected_power, settled })
}

fn ids(answer: &Findings) -> Vec<&str> {
    answer.causes.iter().map(|c| c.id.as_str()).collect()
}

#[test]
fn what_is_asked_for_settles_the_question() {
    let (seed, cases) = (seed(), told("TOUCHSTONE_TASK_CASES").unwrap_or(4));
    println!("TOUCHSTONE_SEED={seed} repeats it");
    let jobs: Vec<_> = KINDS
        .into_iter()
        .flat_map(|kind| (0..cases).map(move |k| (kind, seed.wrapping_mul(733).wrapping_add(k))))
        .collect();
    let asked: Vec<Asked> = jobs
        .par_iter()
        .with_max_len(1)
        .filter_map(|&((kind, make, perform, wrong), seed)| ask(kind, make, perform, wrong, seed))
        .collect();
    for (kind, ..) in KINDS {
        let of: Vec<&Asked> = asked.iter().filter(|a| a.kind == kind).collect();
        let power = of.iter().map(|a| a.power).sum::<f64>() / of.len().max(1) as f64;
        println!("{kind:22} settled {} of {cases} cases, expected {power:.2}", Share::count(of, |a| a.settled));
    }
    assert!(!asked.is_empty(), "nothing was open in any case");
    assert!(asked.iter().all(|a| (0.0..1.0).contains(&a.power)));
    let share = Share::count(asked.iter(), |a| a.settled);
    assert!(share.at_most(1e-4) >= 0.9, "settled {share}; TOUCHSTONE_SEED={seed} repeats it");
}
