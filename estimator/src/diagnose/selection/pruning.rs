use super::comparison::Study;
use super::held_out_gain::{confirmed, gain};
use super::profile_likelihood::firsts;
use std::collections::HashMap;

/// Correlation times of a model error, s: typical durations of a hand's reversal and stroke.
pub const PIECES_S: [f64; 3] = [0.25, 0.5, 1.0];
/// Ratio of held-out residuals from which a cause is harmful. A true but poorly estimated small cause may increase the
/// residual slightly.
pub(crate) const HARMS: f64 = 1.05;
/// Multiple of the threshold below which a cause must be confirmed on the locked blocks.
pub const CONFIRMED: f64 = 2.5;
/// Least evidence on the locked blocks, 2 ln(likelihood). A true cause keeps about a third of its evidence there, while
/// one found by a search in noise becomes negative.
pub const SHOWN: f64 = 1.0;

/// Removes unsound causes: those that certainly increase the held-out error, those that are unsteady over blocks of
/// the recording, and weak ones that fail on the `tested` held-out rows. `stretch`: segment of each row; `threshold`:
/// least evidence of a cause.
pub fn leave_out_what_harms(
    study: &mut Study,
    stretch: &[usize],
    threshold: f64,
    tested: &dyn Fn(&Study, usize) -> bool,
) {
    let sure = CONFIRMED * threshold;
    loop {
        let unsure = |k: &usize| {
            harms(study, *k)
                || !is_steady(study, *k)
                || study.chosen[*k].score < sure && tested(study, *k) && confirmed(study, *k, stretch) < SHOWN
        };
        let Some(k) = (0..study.chosen.len()).rev().find(unsure) else { return };
        study.chosen.remove(k);
        study.solved = study.system.solve(&study.picks());
    }
}

/// Least ratio of a cause's squared effect to its jackknife variance.
pub(crate) const STEADY: f64 = 15.0;

/// True if a jackknife over blocks of the recording confirms the effect of the k-th chosen cause. The test is only
/// made at the end: before that, the residual of a missing cause disturbs the blocks.
pub fn is_steady(study: &Study, k: usize) -> bool {
    let Some(solved) = &study.solved else { return true };
    let picks = study.picks();
    let first = firsts(study, &picks)[k];
    let own = first..first + study.candidates[picks[k]].columns.len();
    study.system.steadiness(solved, &own) > STEADY
}

/// True if the k-th chosen cause certainly increases the error on held-out rows.
pub fn harms(study: &Study, k: usize) -> bool {
    let gain = gain(study, k, 0.0);
    gain.heldout_rms_after > HARMS * gain.heldout_rms_before && gain.interval[1] < 0.0
}

/// Jackknife block of this length for each row, numbered without the empty ones.
pub(crate) fn pieces(time_s: &[f64], piece_s: f64) -> Vec<usize> {
    let mut numbers: HashMap<i64, usize> = HashMap::new();
    let mut number = |time_s: &f64| {
        let next = numbers.len();
        *numbers.entry((time_s / piece_s).floor() as i64).or_insert(next)
    };
    time_s.iter().map(&mut number).collect()
}
