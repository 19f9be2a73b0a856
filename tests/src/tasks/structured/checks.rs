//! The generator itself: it repeats, its structures have their size, and its recordings are numbers.

use super::family::{Family, Group};
use super::sets::{Counts, Job, structured};
use blind::Set;
use estimator::diagnose::Options;
use haptics::recording::Recording;
use rayon::prelude::*;

fn job(group: Group, family: Family, form: u32, ratio: f64, seed: u64) -> Job {
    Job { group, family, form, carry_effect: None, needle_effect: None, ratios: vec![ratio], seed }
}

fn values(recording: &Recording) -> impl Iterator<Item = f64> {
    recording.channels.iter().flat_map(|channel| channel.values.iter().copied())
}

fn known(options: &Options) -> String {
    serde_json::to_string(&options.world).expect("a world")
}

#[test]
fn a_seed_repeats_a_case_and_all_of_it_are_numbers() {
    let groups = [Group::Blocks, Group::Needles];
    let all: Vec<(Group, Family)> =
        groups.into_iter().flat_map(|g| g.families().iter().map(move |f| (g, *f))).collect();
    all.par_iter().enumerate().for_each(|(k, (group, family))| {
        let job = job(*group, *family, k as u32 % Family::FORMS, 2.0, 40 + k as u64);
        let (one, two) = (job.make(), job.make());
        let (a, b) = (&one.case.recordings[0], &two.case.recordings[0]);
        assert!(values(a).all(f64::is_finite), "{family:?}");
        assert!(a.len() > 1000, "{family:?}: {} rows", a.len());
        let same = values(a).zip(values(b)).all(|(x, y)| x.to_bits() == y.to_bits());
        assert!(same && one.scaled == two.scaled && known(&one.case.options) == known(&two.case.options), "{family:?}");
        let differs = values(a).zip(values(&one.clean.recordings[0])).filter(|(x, y)| x != y).count();
        assert!(differs > 100, "{family:?}: {differs} values go with the structure");
        let [ratio] = one.scaled.ratios[..] else { panic!("{family:?}: one ratio") };
        assert!(one.scaled.is_missed || (ratio / 2.0 - 1.0).abs() <= 0.1, "{family:?}: {ratio}");
    });
}

/// A tone is in all rows, free and held, and so are the differences of two recordings with the same noise.
#[test]
fn a_tone_has_the_stated_size_in_the_recording_itself() {
    for (group, channels) in [(Group::Blocks, ["fy1_N", "fy2_N"]), (Group::Needles, ["fy_N", "fy_N"])] {
        let made = job(group, Family::Hum, 0, 4.0, 11).make();
        let power: Vec<f64> = channels
            .iter()
            .map(|name| {
                let [with, without] =
                    [&made.case, &made.clean].map(|case| case.recordings[0].channel(name).expect("a force"));
                let squares = with.iter().zip(without).map(|(a, b)| (a - b).powi(2));
                squares.sum::<f64>() / with.len() as f64
            })
            .collect();
        let noise_n = if group == Group::Blocks { made.noise_n / 2_f64.sqrt() } else { made.noise_n };
        let ratio = (0.5 * power.iter().sum::<f64>()).sqrt() / noise_n;
        // The ratio is that of the channel that shows it best, and the amplitude wanders.
        assert!((2.0..4.6).contains(&ratio), "{group:?}: {ratio}");
    }
}

#[test]
fn a_battery_has_every_family_at_every_size_alone_and_beside_an_effect_that_it_does_not_look_like() {
    let jobs = structured(Counts::USUAL, 7);
    assert_eq!(jobs.len(), 2 * 12 * 9);
    for job in &jobs {
        let tolerated = job.family.tolerated(job.group);
        assert!(job.hidden().is_none_or(|id| !tolerated.contains(&id)), "{job:?}");
        assert_eq!(job.ratios.len(), if job.set() == Set::Beside { 2 } else { 1 });
    }
    let alone = |ratio: f64| jobs.iter().filter(|j| j.set() == Set::Structured && j.ratios[0] == ratio).count();
    assert_eq!([1.0, 2.0, 4.0].map(alone), [48; 3]);
}
