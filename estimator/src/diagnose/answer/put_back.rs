//! Delay of the forces that was corrected before a comparison, as evidence for its answer.

use super::named::Named;
use crate::diagnose::contract::{Baseline, Cause, Gain, Standing, parameter};
use crate::diagnose::data::limits::HALF;
use crate::diagnose::findings::{DelayFindings, Figures, Findings};
use crate::diagnose::free_run::windows::PUT_BACK;
use crate::diagnose::hypotheses::time_delay::ID;
use crate::diagnose::selection::rules::Rules;
use haptics::law::Kind;

/// Shift of the forces before a comparison, and the answer without it.
pub struct PutBack<'a> {
    pub first: &'a Findings,
    /// Shift of the forces, s.
    pub back_s: f64,
    /// Usual time between two samples, s; 0 without a clock.
    pub period_s: f64,
}

impl PutBack<'_> {
    /// The whole delay: the shift, and the delay that remains beside it, s.
    pub fn late_s(&self, remaining: &DelayFindings) -> f64 {
        self.back_s + remaining.rest_s.map_or(0.0, |[more, _]| more)
    }

    /// A shift by this delay, s. Whole samples only: an interpolated force is a mean, with less noise than the others.
    pub fn whole(late_s: f64, period_s: f64) -> f64 {
        if period_s > 0.0 { (late_s / period_s).round() * period_s } else { late_s }
    }

    /// Names the delay instead of everything else that is said of one, and returns the figures of the whole answer.
    pub fn name(&self, named: &mut Named, delay: &mut DelayFindings, figures: Figures) -> Figures {
        let figures = delay.figures.clone().unwrap_or(figures);
        named.causes.retain(|c| c.id != ID);
        named.alternatives.retain(|a| a.instead_of != ID && a.id != ID);
        named.not_excited.retain(|n| n.id != ID);
        named.passed_over.retain(|p| p.id != ID);
        let place = self.first.causes.iter().position(|c| c.id == ID).unwrap_or(0);
        named.causes.insert(place.min(named.causes.len()), self.cause(delay, &figures));
        delay.corrected_s = Self::whole(self.late_s(delay), self.period_s);
        let model = self.first.baseline.model.clone();
        Figures { baseline: Baseline { model, ..self.first.figures_of_delay().baseline }, ..figures }
    }

    /// The delay as a cause, as the first answer named it, with the gain of the shift.
    fn cause(&self, remaining: &DelayFindings, figures: &Figures) -> Cause {
        let late_s = self.late_s(remaining);
        let before = self.first.causes.iter().find(|c| c.id == ID);
        let before_posterior = before.map(|c| c.posterior);
        let mut cause = before.map_or_else(|| unnamed_before(self.first, late_s), Cause::clone);
        if let Some(tau) = cause.parameters.first_mut() {
            tau.value = late_s;
            tau.std_error = remaining.rest_s.map_or(tau.std_error, |[_, error]| error);
        }
        let (before, after) = (cause.gain.heldout_rms_before, figures.end.heldout_rms_n);
        let power = (before * before - figures.noise_floor * figures.noise_floor).max(1e-3 * before * before);
        let share = ((before * before - after * after) / power).clamp(-1.0, 1.0);
        cause.gain.heldout_rms_after = after;
        cause.gain.share_of_explainable = share;
        cause.gain.interval = [cause.gain.interval[0].min(share), cause.gain.interval[1].max(share)];
        if cause.gain.rollout.is_none() {
            cause.gain.no_rollout = Some(PUT_BACK.to_owned());
        }
        cause.posterior = before_posterior.unwrap_or_else(|| self.probability(remaining));
        cause
    }

    /// Probability of a shift that only the scan found: by the evidence of the model after it against that of the model
    /// before it, in which structured errors can take its place. Along a coordinate it may also be a lag: presliding, or
    /// samples that were held.
    fn probability(&self, after: &DelayFindings) -> f64 {
        let most = if self.first.delay.figures.is_some() { 1.0 } else { HALF };
        let Some(([before, rows_before], [after, rows])) = self.first.delay.whole.zip(after.whole) else { return most };
        let rules = Rules::of_channel(self.period_s);
        let ln_bayes_factor = rows.min(rows_before) * (after / rows - before / rows_before) - rules.unlikely;
        let standing = Standing { ln_bayes_factor, share: f64::INFINITY, held_out_evidence: f64::INFINITY };
        most.min(standing.probability(&Gain { no_share: Some(String::new()), ..Gain::default() }, &rules))
    }
}

/// A delay that the first answer did not name, as a cause.
fn unnamed_before(first: &Findings, late_s: f64) -> Cause {
    let before = first.figures_of_delay();
    Cause {
        id: ID.to_owned(),
        kind: Kind::Instrument,
        parameters: vec![parameter("tau", late_s, 0.0, "s")],
        p_value: 0.0,
        posterior: 1.0,
        standing: None,
        gain: Gain { heldout_rms_before: before.end.heldout_rms_n, unit: before.baseline.unit, ..Gain::default() },
        evidence: format!(
            "the force fits the motion of {:.0} ms before: everything was asked again with the force put back to then",
            1e3 * late_s
        ),
    }
}
