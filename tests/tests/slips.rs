//! The grasp slips on the crank's handle: it is said when and by how much, and centre and radius survive it.

use estimator::identify::crank;
use haptics::device::Skill;
use haptics::recording::Recording;
use haptics::servo::recorder::SensorModel;
use rayon::prelude::*;
use tests::generate::{crank_world, perform};

/// The tips move on the handle by this, m, as a recording would show it.
const SLIP_M: [f64; 2] = [0.6e-3, -0.8e-3];

/// Both tips jump in the middle of the turning and stay there.
fn slipped(mut recording: Recording) -> (Recording, f64) {
    let n = recording.len();
    let at = n * 11 / 20;
    for channel in &mut recording.channels {
        let shift = match channel.name.as_str() {
            "x1_m" | "x2_m" => SLIP_M[0],
            "y1_m" | "y2_m" => SLIP_M[1],
            _ => continue,
        };
        for (i, value) in channel.values.iter_mut().enumerate().skip(at) {
            // Within 20 samples.
            *value += shift * ((i - at) as f64 / 20.0).min(1.0);
        }
    }
    let time = recording.time_s.as_ref().map_or(0.0, |t| t[at]);
    (recording, time)
}

#[test]
fn a_slip_on_the_handle_is_found_and_the_circle_survives_it() {
    let results: Vec<_> = (0..30_u64)
        .into_par_iter()
        .map(|seed| {
            let (world, truth) = crank_world(seed);
            let performance = perform(&world, seed, Skill::default(), 5, &SensorModel::TYPICAL);
            let radius = truth[&("crank".to_owned(), "radius_m".to_owned())];
            let (plain, _) = crank::fit(&performance.recording, None).expect("the crank was turned");
            let (recording, time) = slipped(performance.recording);
            let (fit, _) = crank::fit(&recording, None).expect("the crank was turned");
            let found =
                fit.parameter("crank", "radius_m").and_then(|p| Some((p.value?, p.std_error?))).expect("a radius");
            let slips = fit.constraints[0].slips.clone();
            let warned = fit.warnings.iter().any(|w| w.contains("slipped"));
            (seed, plain.constraints[0].slips.len(), slips, time, (found.0 - radius) / radius, warned)
        })
        .collect();
    let false_slips = results.iter().filter(|r| r.1 > 0).count();
    let mut seen = 0;
    for (seed, _, slips, time, error, warned) in &results {
        let near = |s: &&estimator::estimate::Slip| {
            let size = (s.displacement_m[0] - SLIP_M[0]).hypot(s.displacement_m[1] - SLIP_M[1]);
            s.time_s.is_some_and(|t| t > time - 0.15)
                && s.not_before_s.is_some_and(|t| t < time + 0.15)
                && size < 0.3e-3
        };
        let right = slips.iter().filter(near).count() == 1;
        seen += usize::from(right && *warned);
        if !right || error.abs() > 0.01 {
            println!("seed {seed}: slip at {time:.2} s, radius off by {:.2} %, found {slips:?}", 100.0 * error);
        }
    }
    let survived = results.iter().filter(|r| r.4.abs() < 0.01).count();
    println!("{seen} of 30 slips found, {false_slips} false, {survived} radii within 1 %");
    assert!(seen >= 27 && survived >= 28, "{seen} {survived}");
    assert!(false_slips <= 1, "{false_slips}");
}
