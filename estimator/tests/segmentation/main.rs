//! Both methods of segmentation against the labels of simulated recordings: rates from 20 Hz to 4 kHz, four operators, sensors up
//! to five times as noisy as typical ones. The methods were tuned on seeds 0 to 29; these they never saw.

mod generator;
mod needles;
mod scores;
mod tasks;

use estimator::segment::{Method, SystemState, segment_by};
use generator::{crank, log, perform, stacking};
use haptics::device::{Mistake, Skill};
use haptics::servo::TickRecord;
use haptics::world::World;
use scores::Scores;
use std::collections::BTreeMap;

const FIRST_SEED: u64 = 15_000;
const METHODS: [Method; 2] = [Method::Threshold, Method::Hmm];
const RATES_HZ: [f64; 4] = [20.0, 100.0, 1000.0, 4000.0];
const NOISES: [f64; 3] = [1.0, 3.0, 5.0];
const SKILLS: [&str; 4] = ["steady", "novice", "advanced", "expert"];
/// How much worse than the rules the model may be: a quarter of a sample a boundary at 20 Hz. On the tuning seeds it was better in
/// every condition but one: 0.0024 less of the samples at 20 Hz when a block was dropped.
const MARGIN: f64 = 0.005;

/// A condition (rate, noise) and the figures of both methods in it.
type Table = BTreeMap<(usize, usize), [Scores; 2]>;

/// A world and what was done in it. The simulated fingers pass through each other when a hard pinch slips off (novices do that
/// often); no hand does, and the sign of the grip has no meaning then: such a draw is drawn again.
fn fair_performance(skill: Skill, mistakes: &[Mistake], seed: u64) -> (World, Vec<TickRecord>, u64) {
    const MOST_DRAWS: u64 = 20;
    for seed in (0..MOST_DRAWS).map(|draw| seed + 1000 * draw) {
        let world = stacking(seed);
        let ticks = perform(&world, skill, mistakes, seed);
        if ticks.iter().all(|t| t.input.tip_in_world[0].x <= t.input.tip_in_world[1].x) {
            return (world, ticks, seed);
        }
        println!("seed {seed}: the fingers went through each other; drawn again");
    }
    panic!("no fair performance in {MOST_DRAWS} draws from seed {seed}");
}

/// Runs `work` for every number on two threads and returns the answers.
fn in_parallel<T: Send>(count: u64, work: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let half = |first: u64| (first..count).step_by(2).map(&work).collect::<Vec<T>>();
    std::thread::scope(|scope| {
        let other = scope.spawn(|| half(1));
        let mut all = half(0);
        all.extend(other.join().expect("the other half"));
        all
    })
}

fn add_all(table: &mut Table, world: &World, ticks: &[TickRecord], seed: u64, as_one: fn(SystemState) -> SystemState) {
    for (rate, rate_hz) in RATES_HZ.iter().enumerate() {
        // The highest rate takes the longest and differs the least by noise.
        for (noise, times) in NOISES.iter().enumerate().filter(|(_, times)| *rate_hz < 4000.0 || **times == 3.0) {
            let recording = log(world, ticks, *rate_hz, *times, seed);
            let both = table.entry((rate, noise)).or_default();
            for (scores, method) in both.iter_mut().zip(METHODS) {
                let found = segment_by(method, &recording, None, None).expect("segments");
                scores.add(&recording, &found, as_one);
                scores.in_order += usize::from(found.sequence() == "132313231");
            }
        }
    }
}

fn joined(tables: Vec<Table>) -> Table {
    let mut total = Table::new();
    for (key, scores) in tables.into_iter().flatten() {
        let both = total.entry(key).or_default();
        both.iter_mut().zip(&scores).for_each(|(a, b)| a.join(b));
    }
    total
}

fn print(title: &str, table: &Table) {
    println!("{title}\n  rate Hz  noise  method     accuracy  boundary median, 95 %    F1     expected order");
    for ((rate, noise), both) in table {
        for (scores, method) in both.iter().zip(METHODS) {
            println!(
                "  {:>7}  x{:<4}  {:<9}  {:.4}    {:>6.1} ms {:>6.1} ms      {:.3}  {} of {}",
                RATES_HZ[*rate],
                NOISES[*noise],
                method.name(),
                scores.accuracy(),
                1e3 * scores.boundary_s(0.5),
                1e3 * scores.boundary_s(0.95),
                scores.f1(),
                scores.in_order,
                scores.recordings
            );
        }
    }
}

/// The model is not worse than the rules, in any condition.
fn demand_no_loss(table: &Table) {
    for ((rate, noise), [rules, hmm]) in table {
        let at = format!("{} Hz, noise x{}", RATES_HZ[*rate], NOISES[*noise]);
        assert!(hmm.accuracy() >= rules.accuracy() - MARGIN, "{at}: {} and {}", hmm.accuracy(), rules.accuracy());
        assert!(hmm.f1() >= rules.f1() - 2.0 * MARGIN, "{at}: F1 {} and {}", hmm.f1(), rules.f1());
        let (a, b) = (hmm.boundary_s(0.95), rules.boundary_s(0.95));
        assert!(a <= b + 0.005 + 1.0 / RATES_HZ[*rate], "{at}: boundaries {a} s and {b} s");
    }
}

#[test]
fn blocks_at_every_rate_noise_and_skill() {
    const SEEDS: u64 = 16;
    let tables = in_parallel(SEEDS, |number| {
        let skill = Skill::from_name(SKILLS[(number / 2 % 4) as usize]).expect("a level");
        let (world, ticks, seed) = fair_performance(skill, &[], FIRST_SEED + number);
        let mut table = Table::new();
        add_all(&mut table, &world, &ticks, seed, |state| state);
        table
    });
    let table = joined(tables);
    print("two blocks", &table);
    demand_no_loss(&table);
    for ((_, noise), both) in &table {
        for scores in both {
            let least = if NOISES[*noise] == 1.0 { 0.97 } else { 0.9 };
            assert!(scores.f1() >= least, "F1 {} at noise x{}", scores.f1(), NOISES[*noise]);
        }
    }
}

#[test]
fn blocks_that_are_dropped_and_fetched_again() {
    const SEEDS: u64 = 6;
    let tables = in_parallel(SEEDS, |number| {
        let mistake = [Mistake::EarlyRelease, Mistake::WeakPinch][(number / 2 % 2) as usize];
        let (world, ticks, seed) = fair_performance(Skill::expert(), &[mistake], FIRST_SEED + 100 + number);
        let mut table = Table::new();
        add_all(&mut table, &world, &ticks, seed, |state| state);
        table
    });
    let table = joined(tables);
    print("two blocks, one of them dropped", &table);
    demand_no_loss(&table);
    assert!(table.values().flatten().all(|s| s.f1() > 0.9));
}

#[test]
fn cranks_at_every_rate_and_noise() {
    const SEEDS: u64 = 4;
    // The labels only say whether the handle is held.
    let held = |state| if state == SystemState::Holding { SystemState::Turning } else { state };
    let tables = in_parallel(SEEDS, |number| {
        let seed = FIRST_SEED + 200 + number;
        let world = crank(seed);
        let skill = Skill::from_name(SKILLS[number as usize % 4]).expect("a level");
        let mut table = Table::new();
        add_all(&mut table, &world, &perform(&world, skill, &[], seed), seed, held);
        table
    });
    let table = joined(tables);
    print("crank", &table);
    demand_no_loss(&table);
}

#[test]
fn every_sample_has_a_probability_and_intervals_carry_its_mean() {
    let world = stacking(FIRST_SEED + 300);
    let ticks = perform(&world, Skill::default(), &[], FIRST_SEED + 300);
    let recording = log(&world, &ticks, 100.0, 1.0, FIRST_SEED + 300);
    let found = segment_by(Method::Hmm, &recording, None, None).expect("segments");
    assert_eq!(found.method, "hmm");
    let posterior = found.posterior.as_ref().expect("the model knows");
    assert_eq!(posterior.values.len(), recording.len() * posterior.states.len());
    for row in posterior.values.chunks_exact(posterior.states.len()) {
        assert!((row.iter().sum::<f32>() - 1.0).abs() < 1e-5, "{row:?}");
    }
    assert!(found.states.windows(2).all(|w| w[0].end == w[1].first && w[0].t1 == w[1].t0));
    for interval in &found.states {
        let samples = interval.first..interval.end;
        let mean = samples.clone().map(|i| posterior.at(i, interval.state)).sum::<f64>() / samples.len() as f64;
        assert!((mean - interval.probability).abs() < 1e-9, "{interval:?}");
    }
    // Nothing slid, and no crank was turned: such states are not invented.
    assert!(!posterior.states.contains(&SystemState::Turning));
    assert!(segment_by(Method::Threshold, &recording, None, None).expect("segments").posterior.is_none());
}
