//! Rows that stand in another order than their times: the newest first, or neighbours exchanged.

use super::clock::usual_step;

/// Farthest that exchanged rows go back, in usual steps. A run that starts again goes back farther.
/// Choice: not varied.
const FARTHEST_BACK: f64 = 10.0;
/// Least step between rows in the right order, as a share of the usual one: a clock that was set back makes smaller ones.
/// Choice: not varied.
const LEAST_STEP: f64 = 0.6;

/// The way in which rows stand out of the order of their times, if only one order is possible.
pub fn fault(time: &[f64]) -> Option<String> {
    let steps_back = time.windows(2).filter(|w| w[1] < w[0]).count();
    let mut sorted = time.to_vec();
    sorted.sort_by(f64::total_cmp);
    let usual = usual_step(&sorted)?;
    let newest_first = steps_back + 1 == time.len();
    let is_near = newest_first || time.windows(2).all(|w| w[0] - w[1] <= FARTHEST_BACK * usual);
    if steps_back == 0 || !is_near || sorted.windows(2).any(|w| w[1] - w[0] < LEAST_STEP * usual) {
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
        assert!(fault(&exchanged).is_some() && fault(&reversed).is_some());
        let again: Vec<f64> = right.iter().chain(&right).copied().collect();
        let set_back: Vec<f64> = right.iter().map(|t| if *t < 20.0 { *t } else { t - 3.5 }).collect();
        assert!([right, again, set_back].iter().all(|time| fault(time).is_none()));
    }
}
