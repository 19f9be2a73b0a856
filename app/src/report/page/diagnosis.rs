//! Deficits of the simulation: causes with their evidence and gain, alternatives, the next experiment.

use crate::report::chart::cloud;
use crate::report::collect::Content;
use crate::report::page::parts::failed;
use crate::text::diagnosis_words::{
    compared_unit, gain_unit, headline, listed, residual_unit, said_in_words, shown_unit, small, state_in_words,
    symbol, title,
};
use crate::text::format;
use crate::text::sentence::sentence;
use estimator::diagnose::{Cause, CauseParameter, Findings, RolloutOf};
use estimator::words::amount;
use haptics::law::{self, Kind};
use maud::{Markup, html};

/// Digits of an exponent.
const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// The section.
pub fn diagnosis(content: &Content) -> Markup {
    html! {
        section class="card" {
            h3 { "What the model gets wrong" }
            @match &content.diagnosis {
                Ok(diagnosis) => {
                    (answer(content, diagnosis))
                    @if let Some(of_world) = &content.of_world { (calibrated(of_world)) }
                }
                Err(why) => (failed("There is no diagnosis", why)),
            }
        }
    }
}

fn answer(content: &Content, diagnosis: &Findings) -> Markup {
    let found = !diagnosis.causes.is_empty();
    html! {
        p class="verdict" { (headline(diagnosis)) }
        p class="muted" { "Compared with the plain model of the task: " (words(&diagnosis.baseline.model)) "." }
        (levels(diagnosis))
        (by_state(diagnosis))
        @for (rank, cause) in diagnosis.causes.iter().enumerate() { (card(rank + 1, cause, diagnosis)) }
        @for settled in &diagnosis.settled {
            p { "Settled by " (settled.by) ": " (title(&settled.kept)) ", not " (title(&settled.excluded)) ". " (sentence(&settled.why)) }
        }
        @if let Some(next) = &diagnosis.next_experiment {
            div class="cause" {
                h4 { "Record next" }
                p { (sentence(&next.motion)) }
                @let names: Vec<String> = next.separates.iter().map(|id| title(id)).collect();
                p class="muted small" { "Tells " (listed(&names)) " apart with a probability of " (percent(next.expected_power)) "." }
            }
        }
        @if !diagnosis.warnings.is_empty() {
            ul class="small" { @for warning in &diagnosis.warnings { li class="warning" { (sentence(warning)) } } }
        }
        @for drawn in &content.drawn {
            @if let Some(curves) = &drawn.residuals {
                @if content.recordings.len() > 1 { h4 { (drawn.prepared.recording.name) } }
                (cloud::residuals(curves, found))
            }
        }
    }
}

/// Findings with everything fitted in the model.
fn calibrated(diagnosis: &Findings) -> Markup {
    html! {
        div class="cause" {
            h4 { "The same question to the calibrated world" }
            p { (super::log::of_world(diagnosis)) }
            (levels(diagnosis))
            @for cause in &diagnosis.causes {
                p class="small" { b { (title(&cause.id)) } " (" (percent(cause.posterior)) ")"
                    @for (k, p) in cause.parameters.iter().enumerate() { (if k == 0 { ": " } else { ", " }) (value(p)) } "." }
            }
        }
    }
}

/// Parameter with its standard error and unit.
fn value(p: &CauseParameter) -> String {
    if let Some(said) = said_in_words(p) {
        return said;
    }
    format!("{} = {} {}", symbol(&p.name), with_power(p.value, p.std_error), shown_unit(&p.unit)).trim_end().to_owned()
}

/// `value ± error`; very large and very small ones with a power of ten.
fn with_power(value: f64, error: f64) -> String {
    let size = value.abs().max(error);
    let power = if size.is_finite() && size > 0.0 { size.log10().floor() as i32 } else { 0 };
    let joined = |value: f64, error: f64| match format::with_error(value, Some(error)) {
        (value, Some(error)) => format!("{value} ± {error}"),
        (value, None) => value,
    };
    if (-3..5).contains(&power) {
        return joined(value, error);
    }
    let scale = 10_f64.powi(power);
    let superscript = |c: char| if c == '-' { '⁻' } else { SUPERSCRIPTS[c as usize - '0' as usize] };
    let digits: String = power.to_string().chars().map(superscript).collect();
    format!("({})·10{}", joined(value / scale, error / scale), digits)
}

/// Label of a base model such as `weight+load-friction`.
fn words(model: &str) -> String {
    let parts: Vec<String> = model.split('+').map(|id| title(id).replace('-', " ")).collect();
    if parts.iter().all(|p| p.trim().is_empty()) { "no model".to_owned() } else { listed(&parts) }
}

fn percent(share: f64) -> String {
    match share {
        s if s >= 0.995 => "over 99 %".to_owned(),
        s if s < 0.005 => "under 1 %".to_owned(),
        s => format!("{} %", format::number(100.0 * s, 0)),
    }
}

/// Residual of the base and of the extended model, and the noise, as bars of one scale.
fn levels(diagnosis: &Findings) -> Markup {
    let unit = compared_unit(diagnosis);
    let (before, after, noise) =
        (diagnosis.baseline.heldout_rms_n, diagnosis.end.heldout_rms_n, diagnosis.noise_floor_n);
    let most = before.max(after).max(noise);
    let level = |name: &str, value: f64, color: &str| {
        let width = (100.0 * value / most.max(1e-300)).clamp(0.0, 100.0);
        html! {
            span { (name) }
            span class="bar" { span style=(format!("width:{width:.1}%;background:var(--{color})")) {} }
            span { (format::significant(value, 3)) " " (unit) }
        }
    };
    html! {
        // Diagnoses of tasks without a force along one coordinate use other units; their causes say so.
        @if before > 0.0 && !diagnosis.course.instants.is_empty() {
            div class="levels" {
                (level("Model", before, "simulated"))
                @if !diagnosis.causes.is_empty() { (level("With what was found", after, "good")) }
                (level("Noise", noise, "faint"))
            }
            p class="muted small" { "Force left over on data that chose and fitted nothing, root mean square." }
        }
    }
}

/// Residual in every channel and state.
fn by_state(diagnosis: &Findings) -> Markup {
    let all = &diagnosis.residuals;
    html! {
        @if all.len() > 1 {
            table {
                thead { tr {
                    th { "Left over" } th { "State" } th class="number" { "Model" }
                    @if !diagnosis.causes.is_empty() { th class="number" { "With what was found" } }
                    th class="number" { "Noise" }
                } }
                tbody { @for left in all {
                    @let (unit, factor) = residual_unit(&[left]);
                    @let shown = |rms: f64| format!("{} {unit}", format::significant(rms * factor, 3));
                    tr {
                        td { (format::capitalised(&left.channel)) }
                        td { (state_in_words(left.state)) }
                        td class="number" { (shown(left.rms_before)) }
                        @if !diagnosis.causes.is_empty() { td class="number" { (shown(left.rms_after)) } }
                        td class="number" { (left.noise_floor.map_or("–".to_owned(), shown)) }
                    }
                } }
            }
            p class="muted small" { "Root mean square over all rows of the state, each as far as it is trusted: the direction of what hardly moves is a guess." }
        }
    }
}

fn card(rank: usize, cause: &Cause, diagnosis: &Findings) -> Markup {
    // An unnamed residual term is not a cause: it has no probability and is in no world.
    let named = law::cause(&cause.id).is_some();
    let others: Vec<_> = diagnosis.alternatives.iter().filter(|a| a.instead_of == cause.id).collect();
    html! {
        div class="cause" data-cause=(cause.id) {
            h4 {
                span { (rank) ". " (title(&cause.id)) }
                @if named { span class="muted small" { "probability " (percent(cause.posterior)) } }
            }
            @if named {
                div class="meter" { span style=(format!("width:{:.1}%", 100.0 * cause.posterior.clamp(0.0, 1.0))) {} }
            }
            div class="chips" {
                span class="chip mono" { (cause.id) }
                @match cause.kind {
                    _ if !named => {}
                    Kind::Plant => span class="chip good" { "in the world" },
                    Kind::Instrument => span class="chip caution" { "in the measurement" },
                }
                @if let Some(entry) = law::cause(&cause.id) { span class="chip mono" { (entry.equation) } }
            }
            @if !cause.parameters.is_empty() {
                p class="values" { @for p in &cause.parameters { span { (value(p)) } } }
            }
            p { (sentence(&cause.evidence)) }
            (gain(cause, diagnosis))
            @for other in &others {
                p class="small" { "Or " b { (small(&title(&other.id))) } " (" (percent(other.posterior)) "): " (other.why.trim_end_matches('.')) "." }
            }
        }
    }
}

fn gain(cause: &Cause, diagnosis: &Findings) -> Markup {
    let gain = &cause.gain;
    let ((unit, factor), [low, high]) = (gain_unit(cause, diagnosis), gain.interval);
    let rms = |value: f64| format::significant(value, 2);
    let has_share = gain.heldout_rms_before > 0.0 && gain.no_share.is_none();
    html! {
        @if has_share {
            p class="muted small" {
                "Explains " (percent(gain.share_of_explainable)) " of what can be explained, on data that took no part (95 % interval "
                (format::number(100.0 * low, 0)) " … " (format::number(100.0 * high, 0)) " %)"
                @if !diagnosis.course.instants.is_empty() {
                    ": " (rms(factor * gain.heldout_rms_before)) " → " (rms(factor * gain.heldout_rms_after)) " " (unit) " RMS"
                }
                "."
            }
        }
        @if let Some(forward) = &gain.rollout {
            @let what = match forward.of { RolloutOf::Position => "position", RolloutOf::Force => "force" };
            p class="muted small" {
                "Run forward " (format::number(forward.window_s, 1)) " s, the " (what) " is off by " (amount(forward.rms_before, &forward.unit))
                " → " (amount(forward.rms_after, &forward.unit)) "."
            }
        } @else if let Some(why) = &gain.no_rollout {
            p class="muted small" { "Not run forward: " (why) "." }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_and_small_numbers_have_a_power_of_ten() {
        assert_eq!(with_power(1_422_827.0, 30_698.0), "(1.423 ± 0.031)·10⁶");
        assert_eq!(with_power(-2.5e-7, 1e-9), "(−2.500 ± 0.010)·10⁻⁷");
        assert_eq!(with_power(0.0545, 0.0013), "0.0545 ± 0.0013");
        assert_eq!(with_power(0.0, 0.0), "0");
    }
}
