//! What else holds a carried object: none that is not there, and the cable of a barrel with where it is tied.

use crate::generator::{Fault, perform};
use crate::online::{Settings, replay};
use estimator::online::Report;
use haptics::Vec2;
use haptics::recording::Task;
use haptics::servo::recorder::SensorModel;
use rayon::prelude::*;
use tests::handling::{barrel_world, handle};

/// Drawn after everything was tuned on seeds from 300 000 on.
fn seeds(few: u64) -> std::ops::Range<u64> {
    let first = std::env::var("TOUCHSTONE_SEED").ok().and_then(|s| s.parse().ok()).unwrap_or(61_000);
    first..first + crate::each(few)
}

fn report(seed: u64) -> (Report, Option<Vec2>) {
    let world = barrel_world(seed);
    let handling = handle(&world, seed, &[SensorModel::TYPICAL]);
    let online =
        replay(&handling.recordings[..1], Task::Barrel, &Settings::default()).expect("both fingers and a clock");
    // The fingers' middle is what the lines are drawn from.
    let anchor = |name: &str| handling.truth.get(&("cable".to_owned(), name.to_owned())).copied();
    (online.report(), anchor("anchor_x_m").zip(anchor("anchor_y_m")).map(|(x, y)| Vec2::new(x, y)))
}

#[test]
fn nothing_pulls_at_blocks_that_are_carried() {
    let accused: Vec<u64> = seeds(24)
        .into_par_iter()
        .filter(|seed| {
            let (recording, _) = perform(*seed, &Fault::default());
            let online =
                replay(&[recording], Task::BlockStack, &Settings::default()).expect("both fingers and a clock");
            !online.report().pulls.is_empty()
        })
        .collect();
    assert!(accused.is_empty(), "a pull was claimed where there is none: seeds {accused:?}");
}

#[test]
fn a_cable_is_found_and_told_where_it_is_tied() {
    let all: Vec<(u64, Report, Option<Vec2>)> = seeds(24)
        .into_par_iter()
        .map(|seed| {
            let (report, anchor) = report(seed);
            (seed, report, anchor)
        })
        .collect();
    let (mut tied, mut found, mut told, mut within, mut off_mm) = (0, 0, 0, 0, Vec::new());
    for (seed, report, anchor_m) in &all {
        let Some(truth) = anchor_m else {
            assert!(report.pulls.is_empty(), "seed {seed}: a free barrel is not held: {:?}", report.pulls);
            continue;
        };
        tied += 1;
        let Some(pull) = report.pulls.first() else { continue };
        found += 1;
        let Some(anchor) = pull.anchor else { continue };
        told += 1;
        let off = anchor.at_m - truth;
        let deviations = anchor.axes_m.iter().map(|a| (off.dot(a) / a.norm_squared()).powi(2)).sum::<f64>();
        // Nineteen of twenty of a χ² with two degrees of freedom.
        within += usize::from(deviations < 5.99);
        off_mm.push(1e3 * off.norm());
        println!(
            "{seed}: off {:.1} mm, axes {:.1} {:.1} mm, {deviations:.1}",
            1e3 * off.norm(),
            1e3 * anchor.axes_m[0].norm(),
            1e3 * anchor.axes_m[1].norm()
        );
    }
    off_mm.sort_by(f64::total_cmp);
    println!("tied {tied}, found {found}, told {told}, within {within}, off {off_mm:.1?} mm");
    assert!(found * 10 >= tied * 9, "{found} of {tied} cables found");
    assert!(told * 3 >= tied, "{told} of {tied} anchors told");
    assert!(within * 10 >= told * 8, "{within} of {told} anchors within their errors");
}
