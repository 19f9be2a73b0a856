//! A leak told apart from sensor drift, on drawn recordings of each kind.

use crate::generator::{Fault, perform, until};
use crate::online::leak::Verdict;
use crate::online::{Settings, replay};
use haptics::recording::{Recording, Task};
use rayon::prelude::*;

/// Most confident wrong answers, as a share.
const WRONG: f64 = 0.02;

/// What is said of the first block beside the servo, and by the batch fit.
fn said(recording: &Recording) -> [Verdict; 2] {
    let online = replay(std::slice::from_ref(recording), Task::BlockStack, &Settings::default()).expect("fed");
    let leaks = online.report().leaks;
    let beside = leaks.iter().find(|(object, _)| object == "block-1").map_or(Verdict::Steady, |(_, a)| a.verdict);
    let fit =
        crate::identify::block::fit(recording, None).map(|(fit, _)| fit.parameter("block-1", "leak_kg_s").cloned());
    let batch = match fit {
        // A carry without an end is no carry to the batch fit: it says so and fits nothing.
        Err(_) => Verdict::CannotTell,
        Ok(None) => Verdict::Steady,
        Ok(Some(p)) if !p.identified => Verdict::CannotTell,
        Ok(Some(p)) if p.value.expect("identified").abs() > 3.0 * p.std_error.expect("identified") => Verdict::Leak,
        Ok(Some(_)) => Verdict::SensorDrift,
    };
    [beside, batch]
}

fn count(all: &[[Verdict; 2]], which: usize, verdict: Verdict) -> usize {
    all.iter().filter(|v| v[which] == verdict).count()
}

#[test]
fn a_leak_is_told_from_a_drift_or_said_not_to_be() {
    let first: u64 = std::env::var("TOUCHSTONE_SEED").ok().and_then(|s| s.parse().ok()).unwrap_or(43_000);
    // Sixty, as in docs/online.md, with TOUCHSTONE_ONLINE=60.
    let each = crate::each(10);
    let seeds = || (first..first + each).into_par_iter();
    let whole =
        |fault: fn(u64) -> Fault| -> Vec<[Verdict; 2]> { seeds().map(|s| said(&perform(s, &fault(s)).0)).collect() };
    let cut = |seed: u64| {
        let (recording, end_s) = perform(seed, &Fault::leak(seed));
        said(&until(&recording, end_s - 0.1))
    };
    let kinds = [
        ("leak", Verdict::Leak, whole(Fault::leak)),
        ("drift", Verdict::SensorDrift, whole(Fault::drift)),
        ("none", Verdict::Steady, whole(|_| Fault::default())),
        ("leak, not let go after", Verdict::CannotTell, seeds().map(cut).collect()),
    ];
    let verdicts = [Verdict::Steady, Verdict::Leak, Verdict::SensorDrift, Verdict::Both, Verdict::CannotTell];
    for (which, by) in ["beside the servo", "batch"].iter().enumerate() {
        println!("{by}: steady, leak, drift, both, cannot be told");
        for (name, truth, all) in &kinds {
            println!("  {name:<24} {:?}", verdicts.map(|v| count(all, which, v)));
            // Not to see a change, or not to know what it is, is no wrong answer.
            let wrong = verdicts[1..4].iter().filter(|v| *v != truth).map(|v| count(all, which, *v)).sum::<usize>();
            assert!(wrong as f64 <= (WRONG * each as f64).floor(), "{by}, {name}: {wrong} confident wrong answers");
        }
        let right = |kind: usize| count(&kinds[kind].2, which, kinds[kind].1);
        assert!(right(2) as f64 > 0.9 * each as f64, "{by}: steady {}", right(2));
        assert!(right(0) as f64 > 0.8 * each as f64, "{by}: leaks {}", right(0));
    }
}
