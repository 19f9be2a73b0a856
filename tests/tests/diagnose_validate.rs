//! What was found in one recording, put on another one of the same object: what is left there must go down, and stay where nothing was.
//!
//! `TOUCHSTONE_SEED=20400 cargo test -p tests --test diagnose_validate` repeats a day.

use estimator::diagnose::{Findings, Options, Validation, diagnose, validate};
use haptics::recording::Recording;
use rayon::prelude::*;
use std::time::{SystemTime, UNIX_EPOCH};
use tests::tasks::{Case, Truth, barrel, blocks, needle, slide, switch};

type Twice = (Case, Truth, Recording);

fn seed() -> u64 {
    let today = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs() / 86_400);
    std::env::var("TOUCHSTONE_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or_else(today)
}

fn cases() -> u64 {
    std::env::var("TOUCHSTONE_TASK_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(3)
}

/// Findings of the first recording and its validation on the second.
fn measured((case, _, again): &Twice) -> (Findings, Validation) {
    let found = diagnose(&case.recordings, &case.options).expect("it can be diagnosed");
    let options: &Options = &case.options;
    let mut on = validate(std::slice::from_ref(again), options, &found).expect("it can be measured");
    (found, on.remove(0))
}

/// A name and how a case is made.
type Kind = (&'static str, fn(u64) -> Twice);

const HIDDEN: [Kind; 12] = [
    ("blocks: pads", |s| blocks::twice(blocks::Kind::Pads, s)),
    ("blocks: bias", |s| blocks::twice(blocks::Kind::Bias, s)),
    ("blocks: gain", |s| blocks::twice(blocks::Kind::Gain, s)),
    ("barrel: wall", |s| barrel::twice(barrel::Kind::Wall, s)),
    ("barrel: drift", |s| barrel::twice(barrel::Kind::Drift, s)),
    ("needle: hardening", |s| needle::twice(needle::Kind::Hardening, s)),
    ("needle: shaft", |s| needle::twice(needle::Kind::Shaft, s)),
    ("switch: viscous", |s| switch::twice(switch::Kind::Viscous, s)),
    ("switch: friction (world)", |s| switch::twice(switch::Kind::Coulomb, s)),
    ("slide: viscous", |s| slide::twice(slide::Kind::Viscous, s)),
    ("slide: wet", |s| slide::twice(slide::Kind::Wet, s)),
    ("slide: bias", |s| slide::twice(slide::Kind::Bias, s)),
];

/// One case: its name, and what came of it.
struct Held {
    name: &'static str,
    /// What was hidden has been named.
    named: bool,
    /// Share of the power left that goes on the other recording, and its 95 % interval.
    share: f64,
    interval: [f64; 2],
}

impl Held {
    fn of((name, make): Kind, seed: u64) -> Self {
        let made = make(seed);
        let (found, on) = measured(&made);
        let named = made.1.hidden.iter().all(|id| found.causes.iter().any(|c| c.id == *id));
        let held = Self { name, named, share: on.share, interval: on.interval };
        if !held.is_better() {
            println!("{name} seed {seed}: named {named}, {on:?}");
        }
        held
    }

    /// What was hidden is named, and taking it in leaves less of another recording, beyond chance.
    fn is_better(&self) -> bool {
        self.named && self.interval[0] > 0.0
    }

    /// What was taken in leaves more of another recording, beyond chance.
    fn is_worse(&self) -> bool {
        self.interval[1] < 0.0
    }
}

/// Of 1080 cases (thirty days' seeds) 21 were not better beyond chance, so that more than four of 36 come once in a thousand days; one was
/// worse. How much goes depends on how large the effect is beside the noise, so that it is asked of the middle of all alone.
#[test]
fn what_is_found_holds_in_another_recording() {
    let seed = seed();
    println!("TOUCHSTONE_SEED={seed} repeats it");
    let jobs: Vec<(Kind, u64)> = HIDDEN
        .into_iter()
        .flat_map(|kind| (0..cases()).map(move |k| (kind, seed.wrapping_mul(577).wrapping_add(k))))
        .collect();
    let held: Vec<Held> = jobs.par_iter().with_max_len(1).map(|&(kind, seed)| Held::of(kind, seed)).collect();
    for (name, _) in HIDDEN {
        let of: Vec<&Held> = held.iter().filter(|h| h.name == name).collect();
        println!("{name:26} median share of what is left that goes {:.2}", median(of.iter().map(|h| h.share)));
        assert!(of.iter().any(|h| h.is_better()), "{name}: nothing that was found holds");
    }
    let count = |is: fn(&Held) -> bool| held.iter().filter(|h| is(h)).count();
    assert!(count(Held::is_better) * 9 >= held.len() * 8, "{} of {} hold", count(Held::is_better), held.len());
    assert!(count(Held::is_worse) * 36 <= held.len(), "{} of {} are worse", count(Held::is_worse), held.len());
    assert!(median(held.iter().map(|h| h.share)) > 0.7);
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn where_nothing_was_found_nothing_changes() {
    for k in 0..2 {
        let seed = seed().wrapping_mul(577).wrapping_add(k);
        for made in [blocks::twice(blocks::Kind::Nothing, seed), switch::twice(switch::Kind::Nothing, seed)] {
            let (found, on) = measured(&made);
            if found.causes.is_empty() {
                assert!((on.rms_after - on.rms_before).abs() < 1e-9 && on.of.is_none(), "{on:?}");
            }
        }
    }
}
