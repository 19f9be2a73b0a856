//! Needles by both methods against the labels of the simulated sheet: rates, noise, operators.

use super::generator::{log, perform};
use super::{FIRST_SEED, METHODS, SKILLS, in_parallel};
use estimator::segment::agreement::Score;
use estimator::segment::{SystemState, segment_by};
use haptics::device::Skill;
use haptics::recording::{Labels, Task};
use haptics::world::presets;
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};

const CONDITIONS: [(f64, f64); 5] = [(20.0, 1.0), (100.0, 1.0), (1000.0, 1.0), (1000.0, 5.0), (4000.0, 3.0)];

/// Labels from when the needle first leaves the sheet, on which it stands by itself when it is gripped: what that is called is a
/// matter of words.
fn without_standing(labels: &Labels) -> Labels {
    let inside = |label: &str| matches!(label, "insertion" | "extraction");
    let entered = labels.iter().position(inside).unwrap_or(0);
    let left = labels.iter().skip(entered).position(|label| label == "free-motion").unwrap_or(0);
    labels.iter().enumerate().map(|(i, label)| if i < entered + left { "" } else { label }).collect()
}

/// A sheet of random stiffness and strength.
fn scores(seed: u64) -> Vec<[Score; 2]> {
    let mut rng = StdRng::seed_from_u64(seed ^ 0x004e_ed1e);
    let mut world = presets::needle();
    if let Some(membrane) = &mut world.membrane {
        membrane.law.stiffness_n_m *= rng.random_range(0.7..1.4);
        membrane.law.puncture_n *= rng.random_range(0.7..1.3);
    }
    let skill = Skill::from_name(SKILLS[seed as usize % SKILLS.len()]).expect("a level");
    let ticks = perform(&world, skill, &[], seed);
    CONDITIONS
        .iter()
        .map(|(rate_hz, noise)| {
            let mut recording = log(&world, &ticks, *rate_hz, *noise, seed);
            recording.meta.task = Some(Task::Needle);
            recording.labels = recording.labels.as_ref().map(without_standing);
            METHODS.map(|method| {
                let found = segment_by(method, &recording, None, None).expect("segments");
                let punctured = found.states.iter().filter(|i| i.state == SystemState::Penetration).count();
                assert!(punctured > 0, "seed {seed}, {rate_hz} Hz, noise x{noise}: {:?}", found.states);
                found.score.expect("a generated recording has labels")
            })
        })
        .collect()
}

#[test]
fn needles_at_every_rate_and_noise() {
    const SEEDS: u64 = 8;
    let all = in_parallel(SEEDS, |number| scores(FIRST_SEED + 500 + number));
    let mut poor = Vec::new();
    println!("needle\n  rate Hz  noise  method     accuracy  boundary F1  boundary error");
    for (at, (rate_hz, noise)) in CONDITIONS.into_iter().enumerate() {
        for (method, by) in METHODS.into_iter().enumerate() {
            let mean =
                |of: &dyn Fn(&Score) -> f64| all.iter().map(|seed| of(&seed[at][method])).sum::<f64>() / SEEDS as f64;
            let (accuracy, f1) = (mean(&|s| s.accuracy), mean(&|s| s.boundary_f1));
            let error_ms = 1e3 * mean(&|s| s.boundary_error_s.unwrap_or(0.0));
            println!("  {rate_hz:>7}  x{noise:<4}  {:<9}  {accuracy:.4}    {f1:.3}        {error_ms:.0} ms", by.name());
            let least = if noise == 1.0 { 0.97 } else { 0.9 };
            if f1 < least {
                poor.push(format!("{rate_hz} Hz, noise x{noise}, {by:?}: boundary F1 {f1}"));
            }
        }
    }
    assert!(poor.is_empty(), "{poor:?}");
}
