//! Spikes of single samples are no bias, no drift and no catch: an answer is as without them.

use blind::{Chance, Counts, Set, battery};
use estimator::diagnose::{Findings, Options, diagnose};
use haptics::recording::Recording;
use rayon::prelude::*;

/// A seed on which nothing was chosen.
const SEED: u64 = 7_540_001;
/// Samples between two spikes in the mean, and size of a spike over the noise.
const APART: usize = 200;
const SIZE: f64 = 40.0;

/// Adds spikes of one sign to the channels of the force.
fn spoil(recording: &mut Recording, size: f64, chance: &mut Chance) {
    for channel in recording.channels.iter_mut().filter(|c| c.name.starts_with('f') || c.name.starts_with("tau")) {
        let mut at = chance.whole(2, APART as u32) as usize;
        while at + 1 < channel.values.len() {
            channel.values[at] += size;
            at += chance.whole(APART as u32 / 2, 3 * APART as u32 / 2) as usize;
        }
    }
}

fn certain(answer: &Findings) -> Vec<String> {
    let own = answer.certain().into_iter().filter(|c| !c.id.starts_with("other:"));
    let mut names: Vec<String> = own.map(|c| c.id.clone()).collect();
    names.sort();
    names
}

#[test]
fn spikes_change_no_name() {
    let jobs = battery(Counts::FAST, SEED);
    let jobs: Vec<_> = jobs.into_iter().filter(|job| matches!(job.set, Set::Null | Set::Single)).step_by(3).collect();
    let each: Vec<(Vec<String>, Vec<String>, bool)> = jobs
        .par_iter()
        .map(|job| {
            let (case, truth) = job.make();
            let options = Options { baseline: case.baseline.map(str::to_owned), ..Options::default() };
            let clean = diagnose(&case.recordings, &options).expect("an answer");
            let mut spoilt = case.recordings.clone();
            let mut chance = Chance::new(job.seed, 23);
            for recording in &mut spoilt {
                spoil(recording, SIZE * truth.noise_n, &mut chance);
            }
            let answer = diagnose(&spoilt, &options).expect("an answer");
            let said = answer.warnings.iter().any(|w| w.contains("spike"));
            (certain(&clean), certain(&answer), said)
        })
        .collect();
    let other: Vec<_> = each.iter().filter(|(clean, spoilt, _)| clean != spoilt).collect();
    println!("{} of {} differ: {other:?}", other.len(), each.len());
    assert!(each.len() >= 20 && 10 * other.len() <= each.len(), "{} of {}: {other:?}", other.len(), each.len());
    let said = each.iter().filter(|(.., said)| *said).count();
    assert!(10 * said >= 9 * each.len(), "{said} of {} answers speak of spikes", each.len());
}
