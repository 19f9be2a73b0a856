//! Stamps of a converter that sends its samples in bursts: even at the sensor, stamped when a packet came in.

use haptics::recording::{REPAIRS, Recording, Span, Warning};

/// A step shorter than this share of the mean one lies within a burst.
const WITHIN: f64 = 0.25;
/// Share of steps within bursts, and of bursts with the usual size.
const MOST: f64 = 0.5;
const ALIKE: f64 = 0.8;
/// Fewer bursts show no rhythm.
const LEAST_BURSTS: usize = 16;
/// Largest distance of a stamp from the even time, in intervals between bursts.
const FARTHEST: f64 = 1.5;

/// Kind of the warning about them.
pub const BURSTS: &str = REPAIRS[1];

/// Spreads the samples of even bursts over the time between them.
pub fn spread(recording: &mut Recording) -> Option<Warning> {
    let (even, text) = even(recording.time_s.as_deref()?)?;
    let spans = vec![Span { first: 0, end: even.len() }];
    recording.time_s = Some(even);
    Some(Warning { kind: BURSTS.to_owned(), column: Some("t_s".to_owned()), spans, text, ..Warning::default() })
}

/// Times of samples whose stamps come in even bursts, spread over the time between them, and a sentence about it.
pub fn even(time: &[f64]) -> Option<(Vec<f64>, String)> {
    let count = time.len();
    let mean_s = (time.last()? - time.first()?) / (count.checked_sub(1)? as f64);
    let within = time.windows(2).filter(|w| w[1] - w[0] < WITHIN * mean_s).count();
    if (within as f64) < MOST * count as f64 {
        return None;
    }
    let starts: Vec<usize> =
        std::iter::once(0).chain((1..count).filter(|&i| time[i] - time[i - 1] >= WITHIN * mean_s)).collect();
    let mut sizes: Vec<usize> = starts.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if sizes.len() < LEAST_BURSTS {
        return None;
    }
    let middle = sizes.len() / 2;
    let size = *sizes.select_nth_unstable(middle).1;
    let alike = sizes.iter().filter(|other| **other == size).count();
    let (first, last) = (starts[0], *starts.last()?);
    let period_s = (time[last] - time[first]) / (last - first) as f64;
    let even: Vec<f64> = (0..count).map(|i| time[0] + period_s * i as f64).collect();
    // Only the first sample of a burst has a stamp that means something.
    let is_even = starts.iter().all(|&i| (time[i] - even[i]).abs() <= FARTHEST * period_s * size as f64);
    if size < 2 || (alike as f64) < ALIKE * sizes.len() as f64 || !is_even || period_s <= 0.0 {
        return None;
    }
    let text = format!(
        "the stamps come in bursts of {size} samples: the times are spread evenly, at the mean rate of {:.4} Hz; state \"rate_hz\" if it is another",
        1.0 / period_s
    );
    Some((even, text))
}
