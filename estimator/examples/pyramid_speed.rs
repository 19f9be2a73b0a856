//! Builds a pyramid over ten million samples and asks it for plots: `cargo run --release -p estimator --example pyramid_speed`.

use estimator::log::pyramid::Pyramid;
use std::time::Instant;

const SAMPLES: usize = 10_000_000;
const PIXELS: usize = 2000;

fn main() {
    let time: Vec<f64> = (0..SAMPLES).map(|i| i as f64 * 1e-3).collect();
    let values: Vec<f64> = time.iter().map(|t| t.sin() + 0.1 * (1e4 * t).sin()).collect();
    let start = Instant::now();
    let pyramid = Pyramid::of(&values);
    let build = start.elapsed();
    println!(
        "built in {:.1} ms, {:.1} MB beside {:.1} MB of samples",
        build.as_secs_f64() * 1e3,
        pyramid.bytes() as f64 / 1e6,
        8.0 * SAMPLES as f64 / 1e6
    );
    for span in [1.0, 0.1, 0.01, 0.001, 0.0001] {
        let length = span * SAMPLES as f64 * 1e-3;
        let mut times: Vec<f64> = (0..101)
            .map(|k| {
                let from = f64::from(k) * (1e4 - length) / 100.0;
                let start = Instant::now();
                let found = pyramid.query(&time, &values, from, from + length, PIXELS);
                assert!(found.len() <= PIXELS);
                start.elapsed().as_secs_f64() * 1e6
            })
            .collect();
        times.sort_unstable_by(f64::total_cmp);
        println!("{length:>8} s on {PIXELS} pixels: median {:.0} µs, worst {:.0} µs", times[50], times[100]);
    }
}
