//! Rows that stand in another order than their times: the newest first, or neighbours exchanged.

use super::clock::usual_step;

/// Farthest that exchanged rows go back, in usual steps. A run that starts again goes back farther.
/// Choice: not varied.
const FARTHEST_BACK: f64 = 10.0;
/// Steps between rows in the right order, as shares of the usual one. A clock that was set back makes smaller ones, and runs that
/// were recorded apart make larger ones.
/// Choice: not varied.
const STEPS: std::ops::Range<f64> = 0.6..1.5;

/// The way in which rows stand out of the order of their times, if only one order is possible.
pub fn fault(time: &[f64]) -> Option<String> {
    let steps_back = time.windows(2).filter(|w| w[1] < w[0]).count();
    let mut sorted = time.to_vec();
    sorted.sort_by(f64::total_cmp);
    let usual = usual_step(&sorted)?;
    let newest_first = steps_back + 1 == time.len();
    let is_near = newest_first || time.windows(2).all(|w| w[0] - w[1] <= FARTHEST_BACK * usual);
    let steps = || sorted.windows(2).map(|w| (w[1] - w[0]) / usual);
    let is_even = || steps().all(|step| STEPS.contains(&step));
    if steps_back == 0 || steps().any(|step| step < STEPS.start) || !(is_near || is_even()) {
        return None;
    }
    Some(if newest_first {
        "the newest row stands first".to_owned()
    } else {
        format!("{steps_back} row(s) stand behind later ones")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_order_without_doubt_is_told() {
        let right: Vec<f64> = (0..40).map(f64::from).collect();
        let mut exchanged = right.clone();
        exchanged.swap(5, 6);
        exchanged.swap(20, 23);
        let reversed: Vec<f64> = right.iter().rev().copied().collect();
        let shuffled: Vec<f64> = (0..40).map(|k| f64::from(k * 7 % 40)).collect();
        assert!([exchanged, reversed, shuffled].iter().all(|time| fault(time).is_some()));
        let again: Vec<f64> = right.iter().chain(&right).copied().collect();
        let set_back: Vec<f64> = right.iter().map(|t| if *t < 20.0 { *t } else { t - 3.5 }).collect();
        assert!([right, again, set_back].iter().all(|time| fault(time).is_none()));
    }
}
