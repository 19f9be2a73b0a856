//! Several recordings of one crank in one regression: what none of them shows alone, all of them show together.

use estimator::pipeline::{Options, analyse};
use haptics::device::Skill;
use haptics::recording::{Channel, Recording};
use haptics::servo::recorder::SensorModel;
use rayon::prelude::*;
use tests::generate::{crank_world, perform, stacking_world};

/// The first share of a recording, and the rest.
fn halves(recording: &Recording) -> [Recording; 2] {
    let n = recording.len();
    let part = |name: &str, from: usize, to: usize| Recording {
        name: name.to_owned(),
        time_s: recording.time_s.as_ref().map(|t| t[from..to].to_vec()),
        channels: recording
            .channels
            .iter()
            .map(|c| Channel { values: c.values[from..to].to_vec(), ..c.clone() })
            .collect(),
        labels: None,
        ..recording.clone()
    };
    [part("first half", 0, n / 2), part("second half", n / 2, n)]
}

#[test]
fn halves_fitted_together_say_what_the_whole_says() {
    let names = ["weight_N", "friction_mu", "viscous_N_s_m", "coulomb_N", "inertia_kg_m2"];
    let results: Vec<(usize, usize, usize, usize)> = (31_000..31_040_u64)
        .into_par_iter()
        .map(|seed| {
            let (world, truth) = crank_world(seed);
            let whole = perform(&world, seed, Skill::default(), 5, &SensorModel::TYPICAL).recording;
            let parts = halves(&whole);
            let together = analyse(&parts, &Options::default()).expect("both halves turn").fit;
            let alone = analyse(&parts[..1], &Options::default()).expect("the first half turns").fit;
            let (mut shown, mut held, mut narrower, mut first) = (0, 0, 0, 0);
            for name in names {
                let true_value = truth[&("crank".to_owned(), name.to_owned())];
                let Some(found) = together.parameter("crank", name) else { continue };
                let single = alone.parameter("crank", name).and_then(|p| p.std_error);
                first += usize::from(single.is_some());
                if let (Some(value), Some(error)) = (found.value, found.std_error) {
                    shown += 1;
                    held += usize::from((value - true_value).abs() <= 1.96 * error);
                    narrower += usize::from(single.is_none_or(|e| error < e));
                }
            }
            (shown, held, narrower, first)
        })
        .collect();
    let sum = |pick: fn(&(usize, usize, usize, usize)) -> usize| results.iter().map(pick).sum::<usize>();
    let (shown, held, narrower, first) = (sum(|r| r.0), sum(|r| r.1), sum(|r| r.2), sum(|r| r.3));
    println!(
        "of 200 parameters: together {shown} shown, {held} held, {narrower} narrower than the first half's {first}"
    );
    assert!(shown >= 196 && held * 100 >= 90 * shown, "{shown} shown, {held} held");
    assert!(narrower * 100 >= 95 * shown, "{narrower} of {shown} narrower");
}

/// Two recordings of the same blocks: the zero of the sensors is another one in each, weights, widths, heights and pads are the same.
#[test]
fn blocks_of_two_recordings_share_weights_widths_heights_and_pads() {
    let names = [
        ("block-1", "weight_N"),
        ("block-2", "weight_N"),
        ("block-1", "width_m"),
        ("block-2", "width_m"),
        ("block-1", "height_m"),
        ("block-2", "height_m"),
        ("pad", "shear_stiffness_N_m"),
    ];
    let results: Vec<(usize, usize, usize)> = (34_000..34_016_u64)
        .into_par_iter()
        .map(|seed| {
            let (world, truth) = stacking_world(seed);
            // Another hand, another bias.
            let both = [seed, seed + 5_000].map(|s| {
                let mut one = perform(&world, s, Skill::default(), 5, &SensorModel::TYPICAL).recording;
                one.name = format!("blocks {s}");
                one
            });
            let together = analyse(&both, &Options::default()).expect("both carry blocks").fit;
            let alone =
                both.each_ref().map(|r| analyse(std::slice::from_ref(r), &Options::default()).expect("carried").fit);
            let (mut shown, mut held, mut narrower) = (0, 0, 0);
            for (object, name) in names.into_iter().chain([("pad", "stiffness_N_m")]) {
                let true_value = truth[&(object.to_owned(), name.to_owned())];
                let found = together.parameter(object, name).expect("listed");
                assert!(found.how.contains("2 recordings in one regression"), "seed {seed}: {found:?}");
                let (Some(value), Some(error)) = (found.value, found.std_error) else { continue };
                let single = alone.each_ref().map(|f| f.parameter(object, name).and_then(|p| p.std_error));
                shown += 1;
                held += usize::from((value - true_value).abs() <= 1.96 * error);
                narrower += usize::from(single.iter().flatten().all(|e| error < 1.02 * e));
                assert!(found.bootstrap_error.is_some_and(|b| b > 0.3 * error && b < 3.0 * error), "{found:?}");
            }
            (shown, held, narrower)
        })
        .collect();
    let sum = |pick: fn(&(usize, usize, usize)) -> usize| results.iter().map(pick).sum::<usize>();
    let (shown, held, narrower) = (sum(|r| r.0), sum(|r| r.1), sum(|r| r.2));
    println!("of 128 parameters: {shown} shown, {held} held, {narrower} narrower than in either recording alone");
    assert!(shown == 128 && held >= 114, "{shown} shown, {held} held");
    assert!(narrower * 100 >= 85 * shown, "{narrower} of {shown} narrower");
}
