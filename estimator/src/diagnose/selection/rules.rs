//! Limits that decide which causes an answer names, side by side for the two kinds of channels.

use crate::diagnose::data::limits::{AMBIGUOUS, SLOW_ROW_S};

/// Least evidence of a cause, 2 ln(likelihood): keeps false alarms below 1 in 200.
/// Choice: halved, 6 of 87 answers change (2 to wrong, 1 to right); doubled, 1 of 90 answers change.
pub(crate) const THRESHOLD: f64 = 20.0;
/// The same for slow rows, whose noise averages out less, and for few observations.
/// Choice: halved, 1 of 90 answers change (1 to wrong); doubled, 3 of 90 answers change (3 to right).
pub(crate) const THRESHOLD_SLOW: f64 = 25.0;
/// Largest ratio of the final residual to a force noise that was measured in free rows, under a correct model along
/// one coordinate. That residual also contains noise of the motion.
/// Choice: halved, 1 of 43 answers change; doubled, 0 of 43 answers change.
pub(crate) const MUCH: f64 = 1.6;
/// The same ratio for a noise that was estimated from fast changes.
/// Choice: halved, 0 of 62 answers change; doubled, 1 of 62 answers change.
pub(crate) const MUCH_UNSEEN: f64 = 4.0;
/// Largest ratio of residuals, after over before, of an explanation that is as good.
/// Choice: halved, 4 of 48 answers change; doubled, 0 of 48 answers change.
pub(crate) const AS_GOOD: f64 = 1.1;
/// Number of causes, strongest first, that are tried as the first of a pair and whose products are computed ahead.
/// Choice: halved or doubled, none of 90 answers changes.
pub(crate) const LIKELY_CAUSES: usize = 6;
/// Probability of an alternative below which it is excluded.
/// Derived: 1/(1 + e³) = 0.047, an evidence margin of 6 in 2 ln(likelihood).
pub const OPEN: f64 = 0.047;

/// The limits in force for one channel. Evidence is 2 ln(likelihood ratio) less the price of the parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Least evidence of a named cause.
    pub threshold: f64,
    /// True if the model has dry friction. Causes that bend or lift it require it.
    pub has_dry_friction: bool,
    /// True if motion is lost at a reversal in one way only: hysteresis and backlash then exclude each other.
    pub one_loss: bool,
    /// Evidence margin within which rival causes are ambiguous.
    pub ambiguous: f64,
    /// Ridge on the candidates in the fit whose residual determines the whitening, relative to the power of a regressor.
    /// For causes it is scaled by their part beyond the model. With a common ridge, the fit would attribute nearly
    /// collinear causes to the model and leave the difference in the residual.
    pub ridge: f64,
    /// Share of an empirical curve's evidence below which another cause over the same variable may be its misfit.
    pub remainder: f64,
    /// Multiple of the threshold from which a joint effect is beyond doubt.
    pub sure: f64,
    /// True if the held-out rows may be too few to test a cause. An untested cause must then be steady; along a
    /// coordinate, every cause is tested and must be steady.
    pub is_sparse: bool,
    /// Multiple of the threshold below which a cause must be confirmed on the locked blocks.
    pub confirmed: f64,
    /// Least evidence on the locked blocks. A true cause keeps about a third of its evidence there, while one found by
    /// a search in noise becomes negative.
    pub shown: f64,
    /// Least ratio of a cause's squared effect to its jackknife variance.
    pub steady: f64,
    /// Ratio of held-out residuals from which a cause is harmful. A true but poorly estimated small cause may increase
    /// the residual slightly.
    pub harms: f64,
    /// Largest ratio of final residual to noise under a correct model; `None` if it is not known.
    pub much: Option<f64>,
    /// The final residual is not white if noise would have this p-value or less.
    pub surely_not_white: f64,
    /// Evidence of a cause of usual size below which the motion does not excite it, because it would not be named.
    pub visible: f64,
    /// Probability of an alternative above which its question is open.
    pub open: f64,
    /// Evidence that a discrepancy must add, ln(likelihood): that of 1 in 1000.
    pub discrepancy: f64,
    /// Prior odds against a cause, ln: one of twenty.
    pub unlikely: f64,
    /// ln(Bayes factor) from which a cause may be certain. Choice, by recordings with structure and without: doubled, 10
    /// of 520 without a cause get a certain one (13), and 264 of 311 causes without structure are certain (293).
    pub certain: f64,
    /// Share of its own and the discrepancies' power from which a cause may be certain. Choice, by the same recordings:
    /// halved, 17 of 520; at 0.9, 99 of 260 causes beside structure are certain (237).
    pub certain_share: f64,
}

impl Rules {
    /// Channel whose rows may be few, or dealt out between fitted and held-out ones.
    pub fn of_channel(period_s: f64) -> Self {
        Self {
            threshold: if period_s > SLOW_ROW_S { THRESHOLD_SLOW } else { THRESHOLD },
            has_dry_friction: true,
            one_loss: false,
            ambiguous: AMBIGUOUS,
            ridge: 1e-2,
            remainder: 0.12,
            sure: 10.0,
            is_sparse: true,
            confirmed: 2.5,
            shown: 1.0,
            steady: 15.0,
            harms: 1.05,
            much: None,
            surely_not_white: 1e-12,
            visible: THRESHOLD_SLOW,
            open: OPEN,
            discrepancy: 7.0,
            unlikely: 3.0,
            certain: 6.0,
            certain_share: 0.6,
        }
    }

    /// Channel of observations without a period: blows, or places of a path without a clock.
    pub fn of_observations() -> Self {
        Self { threshold: THRESHOLD, ..Self::of_channel(f64::INFINITY) }
    }

    /// Force along one coordinate, in blocks of a long motion.
    pub fn of_coordinate(period_s: f64) -> Self {
        Self {
            one_loss: true,
            is_sparse: false,
            visible: THRESHOLD,
            // An evidence margin of 6.
            open: 1.0 / (1.0 + 3.0_f64.exp()),
            ..Self::of_channel(period_s)
        }
    }

    /// Path of a handle: a circle, without friction.
    pub fn of_path(period_s: f64) -> Self {
        Self { one_loss: false, ridge: 0.0, much: Some(MUCH), ..Self::of_coordinate(period_s) }
    }

    /// The same rules for a model with or without dry friction.
    pub fn with_friction(self, has_dry_friction: bool) -> Self {
        Self { has_dry_friction, ..self }
    }

    /// The same rules with the noise measured in free rows, or estimated from fast changes.
    pub fn with_noise(self, is_measured: bool) -> Self {
        Self { much: Some(if is_measured { MUCH } else { MUCH_UNSEEN }), ..self }
    }
}
