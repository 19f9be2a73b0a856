//! Offsets of signals made by a generator of its own: sums of waves, pulses, and noise.

use super::*;
use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};
use std::f64::consts::TAU;

/// A motion: sum of waves (amplitude, frequency in Hz, phase).
struct Motion(Vec<[f64; 3]>);

impl Motion {
    fn new(random: &mut StdRng) -> Self {
        let wave = |_| {
            [
                random.random_range(0.2..1.0),
                random.random_range(0.2_f64.ln()..4_f64.ln()).exp(),
                random.random_range(0.0..TAU),
            ]
        };
        Self((0..12).map(wave).collect())
    }

    fn at(&self, t: f64) -> f64 {
        self.0.iter().map(|[a, f, p]| a * (TAU * f * t + p).sin()).sum()
    }
}

/// Two draws of a normal variable are not needed at once: Box & Muller 1958.
fn normal(random: &mut StdRng) -> f64 {
    let radius = (-2.0 * random.random_range(f64::MIN_POSITIVE..1.0_f64).ln()).sqrt();
    radius * (TAU * random.random_range(0.0..1.0_f64)).cos()
}

/// A device: its rate, its start and length in true time, the reading of its clock, and of its sensor.
struct Device {
    rate_hz: f64,
    from_s: f64,
    length_s: f64,
    /// Reading of the clock at true time zero, and its seconds a true second.
    clock: (f64, f64),
    gain: f64,
    noise: f64,
    quantum: f64,
}

impl Device {
    fn record(&self, signal: impl Fn(f64) -> f64, random: &mut StdRng) -> (Vec<f64>, Vec<f64>) {
        let count = (self.length_s * self.rate_hz) as usize;
        let sample = |k: usize| {
            let t = self.from_s + k as f64 / self.rate_hz;
            let value = self.gain * signal(t) + self.noise * normal(random);
            let read = if self.quantum > 0.0 { (value / self.quantum).round() * self.quantum } else { value };
            (self.clock.0 + self.clock.1 * t, read)
        };
        (0..count).map(sample).unzip()
    }
}

const OWN: Device =
    Device { rate_hz: 100.0, from_s: 0.0, length_s: 30.0, clock: (0.0, 1.0), gain: 1.0, noise: 0.05, quantum: 0.0 };

fn signal(of: &(Vec<f64>, Vec<f64>)) -> Signal<'_> {
    Signal { time_s: &of.0, values: &of.1 }
}

/// The offset that holds at the middle that an answer states: the log's reading less the other's.
fn true_offset(own: &Device, other: &Device, middle_s: f64) -> f64 {
    let t = (middle_s - other.clock.0) / other.clock.1;
    own.clock.0 + own.clock.1 * t - middle_s
}

/// Standardized error and share of covered intervals over seeds.
fn coverage(name: &str, seeds: u64, other: impl Fn(&mut StdRng) -> Device) -> (f64, f64) {
    let (mut covered, mut squares, mut widths) = (0, 0.0, 0.0);
    for seed in 0..seeds {
        let random = &mut StdRng::seed_from_u64(seed);
        let (motion, other) = (Motion::new(random), other(random));
        let own = OWN.record(|t| motion.at(t), random);
        let theirs = other.record(|t| motion.at(t), random);
        let found = estimate(signal(&own), signal(&theirs)).unwrap_or_else(|why| panic!("{name} {seed}: {why:?}"));
        let error = found.offset_s - true_offset(&OWN, &other, found.middle_s);
        covered += u64::from(error.abs() <= found.half_width_s);
        squares += (error / found.standard_error_s).powi(2);
        widths += found.half_width_s;
    }
    let (share, spread) = (covered as f64 / seeds as f64, (squares / seeds as f64).sqrt());
    eprintln!("{name}: covered {share:.3}, spread {spread:.2}, half width {:.2e} s", widths / seeds as f64);
    (share, spread)
}

/// A device that is drawn for each seed.
type Drawn<'a> = dyn Fn(&mut StdRng) -> Device + 'a;

/// Seeds of a coverage.
const SEEDS: u64 = 100;

#[test]
fn nine_of_ten_intervals_and_more_cover_the_offset() {
    let usual = |random: &mut StdRng| Device {
        rate_hz: 1000.0,
        from_s: random.random_range(-3.0..3.0),
        length_s: 30.0,
        clock: (random.random_range(-20.0..20.0), 1.0),
        gain: -3.7,
        noise: 0.3,
        quantum: 0.0,
    };
    let cases: [(&str, &Drawn<'_>); 4] = [
        ("1 kHz", &usual),
        ("1 kHz, 80 ppm, quanta", &|r| Device { clock: (7.3, 1.0 + 80e-6), quantum: 0.1, ..usual(r) }),
        ("100 Hz", &|r| Device { rate_hz: 100.0, ..usual(r) }),
        ("40 Hz, more noise", &|r| Device { rate_hz: 40.0, noise: 1.0, ..usual(r) }),
    ];
    for (name, other) in cases {
        let (share, spread) = coverage(name, SEEDS, other);
        assert!((0.90..=0.99).contains(&share), "{name}: {share} are covered, the spread is {spread}");
    }
}

#[test]
fn the_ratio_of_the_clocks_is_found_and_left_out_where_there_is_none() {
    let random = &mut StdRng::seed_from_u64(5);
    let motion = Motion::new(random);
    for (skew, has_ratio) in [(80e-6, true), (0.0, false)] {
        let long = Device { length_s: 300.0, ..OWN };
        let other = Device { rate_hz: 1000.0, clock: (2.5, 1.0 + skew), gain: 0.2, noise: 0.02, ..long };
        let (own, theirs) = (long.record(|t| motion.at(t), random), other.record(|t| motion.at(t), random));
        let found = estimate(signal(&own), signal(&theirs)).expect("an offset");
        assert_eq!(found.skew.is_some(), has_ratio, "{found:?}");
        if let Some((ratio, error)) = found.skew {
            assert!((ratio + skew).abs() < 4.0 * error && error < 5e-6, "{found:?}");
        }
        assert!((found.offset_s - true_offset(&long, &other, found.middle_s)).abs() < 4.0 * found.standard_error_s);
    }
}

/// Pulses at uneven times.
fn pulses(times: &[f64]) -> impl Fn(f64) -> f64 {
    let times = times.to_vec();
    move |t| f64::from(u8::from(times.iter().any(|start| (*start..*start + 0.4).contains(&t))))
}

#[test]
fn edges_are_known_to_their_samples() {
    let other = Device { rate_hz: 1000.0, from_s: -2.0, clock: (13.0, 1.0), gain: -5.0, noise: 0.02, ..OWN };
    let own = Device { noise: 0.0, ..OWN };
    for (seed, times) in [(1, vec![4.0]), (2, vec![3.1, 9.4, 22.7]), (3, vec![25.0])] {
        let random = &mut StdRng::seed_from_u64(seed);
        let (a, b) = (own.record(pulses(&times), random), other.record(pulses(&times), random));
        let found = estimate(signal(&a), signal(&b)).expect("an offset");
        assert!((found.offset_s + 13.0).abs() <= found.half_width_s, "{found:?}");
        assert!((0.0055..0.007).contains(&found.half_width_s), "{found:?}");
    }
    // A single step.
    let random = &mut StdRng::seed_from_u64(4);
    let step = |t: f64| f64::from(u8::from(t > 11.0));
    let (a, b) = (own.record(step, random), other.record(step, random));
    let found = estimate(signal(&a), signal(&b)).expect("an offset");
    assert!((found.offset_s + 13.0).abs() <= found.half_width_s, "{found:?}");
}

#[test]
fn pulses_over_ten_minutes_show_the_ratio_of_the_clocks() {
    let random = &mut StdRng::seed_from_u64(9);
    let mut times = vec![2.0];
    while times[times.len() - 1] < 590.0 {
        times.push(times[times.len() - 1] + random.random_range(8.0..40.0));
    }
    let own = Device { length_s: 600.0, noise: 0.0, rate_hz: 500.0, ..OWN };
    let other = Device { clock: (-4.0, 1.0 + 80e-6), noise: 0.01, rate_hz: 1000.0, ..own };
    let (a, b) = (own.record(pulses(&times), random), other.record(pulses(&times), random));
    let found = estimate(signal(&a), signal(&b)).expect("an offset");
    let (ratio, error) = found.skew.expect("a ratio");
    assert!((ratio + 80e-6).abs() < 4.0 * error, "{found:?}");
    assert!((found.offset_s - true_offset(&own, &other, found.middle_s)).abs() <= found.half_width_s, "{found:?}");
}

#[test]
fn a_periodic_signal_is_ambiguous() {
    for (noise, seed) in [(0.0, 1), (0.05, 2), (0.3, 3)] {
        let random = &mut StdRng::seed_from_u64(seed);
        let own = Device { noise, ..OWN };
        let other = Device { rate_hz: 1000.0, clock: (3.0, 1.0), ..own };
        let sine = |t: f64| (TAU * 1.3 * t).sin();
        let (a, b) = (own.record(sine, random), other.record(sine, random));
        let refused = estimate(signal(&a), signal(&b)).expect_err("a sine repeats itself");
        let Refusal::Ambiguous { offset_s, rival_s } = refused else { panic!("{refused:?}") };
        assert!((offset_s - rival_s).abs() > 0.2, "{refused:?}");
        let train = |t: f64| f64::from(u8::from(t.rem_euclid(0.7) < 0.2));
        let (a, b) = (own.record(train, random), other.record(train, random));
        assert!(matches!(estimate(signal(&a), signal(&b)), Err(Refusal::Ambiguous { .. })), "a train of pulses");
    }
}

#[test]
fn unrelated_signals_are_refused() {
    let mut joined = [0; 3];
    for seed in 0..SEEDS {
        let random = &mut StdRng::seed_from_u64(1000 + seed);
        let other = Device { rate_hz: 200.0, length_s: 20.0, ..OWN };
        let (motion, another) = (Motion::new(random), Motion::new(random));
        let (a, b) = (OWN.record(|t| motion.at(t), random), other.record(|t| another.at(t), random));
        joined[0] += i32::from(estimate(signal(&a), signal(&b)).is_ok());
        let (a, b) = (OWN.record(|_| 0.0, random), other.record(|_| 0.0, random));
        joined[1] += i32::from(estimate(signal(&a), signal(&b)).is_ok());
        // Motions of few strokes.
        let slow = |motion: Motion| move |t: f64| motion.at(0.08 * t);
        let (a, b) = (OWN.record(slow(motion), random), other.record(slow(another), random));
        joined[2] += i32::from(estimate(signal(&a), signal(&b)).is_ok());
    }
    eprintln!("of {SEEDS} pairs, joined: motions {}, noise {}, slow motions {}", joined[0], joined[1], joined[2]);
    assert!(joined[0] == 0 && joined[1] == 0, "{joined:?}");
    assert!(joined[2] as u64 <= SEEDS / 20, "{joined:?}");
}

#[test]
fn a_signal_that_does_not_vary_or_is_short_is_refused() {
    let random = &mut StdRng::seed_from_u64(7);
    let still = Device { noise: 0.0, ..OWN }.record(|_| 2.0, random);
    let motion = Motion::new(random);
    let own = OWN.record(|t| motion.at(t), random);
    assert_eq!(estimate(signal(&own), signal(&still)), Err(Refusal::Flat));
    let short = Device { length_s: 0.3, ..OWN }.record(|t| motion.at(t), random);
    assert_eq!(estimate(signal(&own), signal(&short)), Err(Refusal::Flat));
}

#[test]
fn a_gap_in_one_recording_does_no_harm() {
    let random = &mut StdRng::seed_from_u64(8);
    let motion = Motion::new(random);
    let own = OWN.record(|t| motion.at(t), random);
    let other = Device { rate_hz: 250.0, clock: (1.0, 1.0), noise: 0.02, ..OWN };
    let (time, values) = other.record(|t| motion.at(t), random);
    let kept = |t: f64| !(9.0..14.0).contains(&t);
    let theirs: (Vec<f64>, Vec<f64>) = time.into_iter().zip(values).filter(|(t, _)| kept(*t)).unzip();
    let found = estimate(signal(&own), signal(&theirs)).expect("an offset");
    assert!((found.offset_s + 1.0).abs() < 4.0 * found.standard_error_s, "{found:?}");
}
