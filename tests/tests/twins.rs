//! Replays without any cause: they hold none of what the recording held, and few of them name a cause.

use blind::score::options;
use blind::{Counts, Set, Share, StructureCounts, battery, structured};
use estimator::diagnose::{Diagnosis, Options, diagnose, twins};
use haptics::recording::{Channel, Recording};
use rayon::prelude::*;
use tests::tasks::structured::sets as tasks;
use tests::tasks::switch;

/// Seeds on which nothing was chosen: for recordings with structure, for those with a cause, for blocks and needles, and for
/// switches.
const SEEDS: [u64; 4] = [7_430_001, 7_430_002, 7_430_003, 7_600_101];
const REPLAYS: u32 = 5;
/// Probability of a worse result by chance, beyond which the test fails.
const LUCK: f64 = 0.01;

fn replayed(recordings: &[Recording], options: Options) -> Result<Diagnosis, String> {
    let options = Options { twins: true, ..options };
    let mut found = diagnose(recordings, &options).map_err(|e| e.to_string())?;
    twins(recordings, &options, &mut found, REPLAYS).map_err(|e| e.to_string())?;
    Ok(found.diagnosis)
}

/// Replays with a certain cause.
fn named(answers: &[Diagnosis]) -> Share {
    let of = |answer: &Diagnosis| answer.twins.as_ref().map_or([0, 0], |t| [t.named, t.runs]);
    answers.iter().map(of).fold(Share::default(), |all, [hits, of]| Share { hits: all.hits + hits, of: all.of + of })
}

/// Replays leave a residual of the size that the recordings do.
fn leave_the_residual(answers: &[Diagnosis]) {
    let mut sizes: Vec<f64> = Vec::new();
    for answer in answers {
        let twins = answer.twins.as_ref().expect("replays");
        assert_eq!(twins.runs, REPLAYS as usize);
        let size = twins.heldout_rms_n / answer.baseline.heldout_rms_n;
        println!("{size:.2} {} {:?} {:?}", twins.named, twins.by_cause, answer.baseline.of);
        // Of a replay that answers about another channel there is no size.
        sizes.extend(Some(size).filter(|size| *size > 0.0));
    }
    sizes.sort_by(f64::total_cmp);
    let [least, middle, most] = [0, sizes.len() / 2, sizes.len() - 1].map(|k| sizes[k]);
    assert!(least > 0.4 && most < 2.0 && (0.7..1.3).contains(&middle), "{sizes:.2?} of the residual in replays");
}

#[test]
fn replays_of_structured_recordings_have_their_structure_and_few_certain_names() {
    let jobs = structured(StructureCounts { cranks: [1, 0], long_cranks: [0, 0], mechanisms: [1, 0] }, SEEDS[0]);
    let answers: Vec<Diagnosis> = jobs
        .par_iter()
        .filter(|job| job.set == Set::Structured)
        .filter_map(|job| {
            let (case, _) = job.make();
            replayed(&case.recordings, options(&case)).ok()
        })
        .collect();
    assert!(answers.len() >= 8, "{} could be replayed", answers.len());
    leave_the_residual(&answers);
    let named = named(&answers);
    assert!(named.at_least(LUCK) <= 0.05, "named in replays: {named}");
}

#[test]
fn a_cause_of_the_recording_is_not_in_its_replays() {
    let jobs = battery(Counts { nulls: 0, per_effect: 1, pairs: 0, per_nameless: 0, hard: 0 }, SEEDS[1]);
    let strong = jobs.par_iter().filter(|job| job.set == Set::Single && job.spec.ratio == 2.0);
    let answers: Vec<Diagnosis> = strong
        .filter_map(|job| {
            let (case, _) = job.make();
            replayed(&case.recordings, options(&case)).ok()
        })
        .collect();
    let held = answers.iter().filter(|answer| answer.certain().iter().any(|c| c.standing.is_some()));
    let (mut own, mut all) = (Share::default(), 0);
    for answer in held {
        let twins = answer.twins.as_ref().expect("replays");
        let certain: Vec<&str> = answer.certain().iter().map(|c| c.id.as_str()).collect();
        let again: usize = twins.by_cause.iter().filter(|n| certain.contains(&n.id.as_str())).map(|n| n.runs).sum();
        println!("{certain:?} {:?}", twins.by_cause);
        own = Share { hits: own.hits + again.min(twins.runs), of: own.of + twins.runs };
        all += 1;
    }
    assert!(all >= 8, "{all} recordings with a certain cause");
    assert!(own.at_least(LUCK) <= 0.05, "the cause again: {own}");
    let named = named(&answers);
    assert!(named.at_least(LUCK) <= 0.1, "named in replays: {named}");
}

#[test]
fn replays_of_blocks_and_needles_have_their_structure_and_few_certain_names() {
    let [blocks, needles] = [[[1, 0], [0, 0]], [[0, 0], [1, 0]]];
    for [blocks, needles] in [blocks, needles] {
        let jobs = tasks::structured(tasks::Counts { blocks, needles }, SEEDS[2]);
        let answers: Vec<Diagnosis> = jobs
            .par_iter()
            .filter_map(|job| {
                let case = job.make().case;
                replayed(&case.recordings, case.options).map_err(|e| println!("{e}")).ok()
            })
            .collect();
        assert!(answers.len() >= 8, "{} could be replayed", answers.len());
        leave_the_residual(&answers);
        let named = named(&answers);
        println!("named in replays: {named}");
        assert!(named.at_least(LUCK) <= 0.05, "named in replays: {named}");
    }
}

#[test]
fn replays_of_switches_have_few_certain_names() {
    let answers: Vec<Diagnosis> = (0..8_u64)
        .into_par_iter()
        .filter_map(|k| {
            let kind = if k < 4 { switch::Kind::Nothing } else { switch::Kind::Viscous };
            let (case, _) = switch::make(kind, SEEDS[3] + k);
            replayed(&case.recordings, case.options).map_err(|e| println!("{e}")).ok()
        })
        .collect();
    assert!(answers.len() == 8, "{} could be replayed", answers.len());
    leave_the_residual(&answers);
    let named = named(&answers);
    println!("named in replays: {named}");
    assert!(named.at_least(LUCK) <= 0.05, "named in replays: {named}");
}

#[test]
fn recordings_without_replays_say_why() {
    let time_s: Vec<f64> = (0..2000).map(|k| 0.005 * f64::from(k)).collect();
    let swing = time_s.iter().map(|t| (-0.1 * t).exp() * (3.0 * t).cos()).collect();
    let free = Recording {
        name: "pendulum".to_owned(),
        time_s: Some(time_s),
        channels: vec![Channel { name: "q_rad".to_owned(), unit: "rad".to_owned(), values: swing }],
        ..Recording::default()
    };
    let refused = replayed(&[free], Options::default()).expect_err("no force");
    assert!(refused.contains("motions without a force"), "{refused}");
}
