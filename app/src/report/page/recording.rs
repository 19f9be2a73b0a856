//! Content of the recordings, data-quality problems, and states over time.

use crate::report::chart::{bad, band, signals};
use crate::report::collect::{Content, Drawn};
use crate::report::page::parts::fact;
use crate::text::format;
use crate::text::sentence::sentence;
use crate::text::states::state_of_task;
use estimator::segment::{Interval, Segmentation};
use haptics::recording::Recording;
use maud::{Markup, html};

/// Maximum number of printed warnings and channels; the rest is counted.
const MOST_ROWS: usize = 40;
/// Maximum number of printed recordings and intervals, which are less informative.
const FEW_ROWS: usize = 16;

/// Total duration of all recordings, as text.
pub fn length(content: &Content) -> String {
    let total: Option<f64> = content.recordings.iter().map(Recording::duration_s).sum();
    total.map_or_else(|| "no clock".to_owned(), |s| format!("{} s", format::significant(s, 3)))
}

/// Facts, warnings and channels.
pub fn facts(content: &Content) -> Markup {
    let samples: usize = content.recordings.iter().map(Recording::len).sum();
    let warnings = content.warnings();
    html! {
        section class="card" {
            h3 { "What was recorded" }
            dl {
                @if content.recordings.len() > 1 { (fact("Recordings", &content.recordings.len().to_string())) }
                (fact("Length", &length(content)))
                (fact("Rate", &rate(&content.recordings)))
                (fact("Samples", &format::grouped(samples)))
                (fact("Task", content.analysis.as_ref().map_or("not known", |a| a.task.name())))
            }
            @if warnings.is_empty() {
                p class="muted" { "No gaps, no stuck or copied channels, no samples at a sensor's limit were found." }
            } @else {
                h4 { "Quality of the data" }
                ul {
                    @for text in warnings.iter().take(MOST_ROWS) { li class="warning" { (sentence(text)) } }
                }
                (rest(warnings.len(), MOST_ROWS))
            }
            @for note in content.notes() { p class="muted small" { (sentence(note)) } }
            @if content.recordings.len() > 1 { (recordings(&content.recordings)) }
            @if let Some(first) = content.recordings.first() { (channels(first)) }
        }
    }
}

fn rate(recordings: &[Recording]) -> String {
    let rates: Vec<f64> = recordings.iter().filter_map(Recording::rate_hz).collect();
    if rates.is_empty() {
        return "no clock".to_owned();
    }
    let (low, high) = rates.iter().fold((f64::MAX, 0.0_f64), |(low, high), r| (low.min(*r), high.max(*r)));
    let text = |hz: f64| {
        let digits = format::significant(hz, 4);
        // Trailing zeros after the decimal point carry no information.
        if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.').to_owned() } else { digits }
    };
    if high - low < 1e-3 * high { format!("{} Hz", text(high)) } else { format!("{} … {} Hz", text(low), text(high)) }
}

fn rest(all: usize, shown: usize) -> Markup {
    html! { @if all > shown { p class="muted small" { "… and " (all - shown) " more." } } }
}

fn recordings(all: &[Recording]) -> Markup {
    html! {
        h4 { "Recordings in the file" }
        table {
            thead { tr { th { "Name" } th class="number" { "Samples" } th class="number" { "Length, s" } } }
            tbody { @for recording in all.iter().take(FEW_ROWS) {
                tr {
                    td { (recording.name) }
                    td class="number" { (format::grouped(recording.len())) }
                    td class="number" { (recording.duration_s().map_or("–".to_owned(), |s| format::number(s, 2))) }
                }
            } }
        }
        (rest(all.len(), FEW_ROWS))
    }
}

fn channels(recording: &Recording) -> Markup {
    html! {
        h4 { "Channels" @if recording.trial.is_some() { " of the first recording" } }
        div class="channels" {
            @for channel in recording.channels.iter().take(MOST_ROWS) {
                @let (unit, factor) = format::channel_unit(&channel.unit);
                @let (low, high) = channel.values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
                div {
                    span class="mono" { (channel.name) }
                    span class="muted" { (format::significant(low * factor, 3)) " … " (format::significant(high * factor, 3)) " " (unit) }
                }
            }
        }
        (rest(recording.channels.len(), MOST_ROWS))
    }
}

/// States over time with the measured curves under them.
pub fn course(content: &Content) -> Markup {
    let all = content.recordings.len();
    html! {
        section class="card" {
            h3 { "What happened when" }
            @for drawn in &content.drawn {
                @if all > 1 { h4 { (drawn.prepared.recording.name) } }
                @match &drawn.segmentation {
                    Some(segmentation) => (states(segmentation, drawn)),
                    None if drawn.prepared.clockless() => p class="muted" { "No states: they are told from velocities, and this log has no clock." },
                    None => p class="muted" { "No states were told in this recording." },
                }
                (signals::signals(drawn))
                @if let Some(segmentation) = &drawn.segmentation { (intervals(segmentation)) }
            }
            @if all > content.drawn.len() {
                p class="muted" { (content.drawn.len()) " of " (all) " recordings are drawn; all of them take part in the results." }
            }
        }
    }
}

fn states(segmentation: &Segmentation, drawn: &Drawn) -> Markup {
    let holes = bad::holes(&drawn.prepared);
    html! {
        figure {
            figcaption { b { "States and subtasks" } (band::legend(segmentation, &holes)) }
            (band::band(segmentation, drawn.prepared.span(), &holes))
        }
    }
}

/// The intervals that belong to the task's subtasks.
fn intervals(segmentation: &Segmentation) -> Markup {
    let told: Vec<&Interval> = segmentation.states.iter().filter(|i| i.subtask.is_some()).collect();
    html! {
        @if !told.is_empty() {
            table {
                thead { tr {
                    th { "Subtask" } th { "State" } th class="number" { "From, s" } th class="number" { "To, s" } th class="number" { "Agreement" }
                } }
                tbody { @for interval in told.iter().take(FEW_ROWS) {
                    tr {
                        td { (interval.subtask.as_deref().unwrap_or_default()) }
                        td { (state_of_task(segmentation, interval.state)) }
                        td class="number" { (format::number(interval.t0, 2)) }
                        td class="number" { (format::number(interval.t1, 2)) }
                        td class="number" { (format::number(100.0 * interval.probability, 0)) " %" }
                    }
                } }
            }
            (rest(told.len(), FEW_ROWS))
            p class="muted small" {
                @if segmentation.posterior.is_some() { "Agreement: mean probability of the state over its time." }
                @else { "Agreement: share of the samples that show the state by themselves." }
            }
        }
        @for warning in &segmentation.warnings { p class="small" { (sentence(warning)) } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(step_s: f64) -> Recording {
        Recording { time_s: Some((0..9).map(|i| f64::from(i) * step_s).collect()), ..Recording::default() }
    }

    #[test]
    fn rates_keep_their_digits_and_no_more() {
        assert_eq!(rate(&[sampled(1e-3)]), "1000 Hz");
        assert_eq!(rate(&[sampled(0.05)]), "20 Hz");
        assert_eq!(rate(&[sampled(1.0 / 147.93)]), "147.9 Hz");
        assert_eq!(rate(&[sampled(0.01), sampled(0.02)]), "50 … 100 Hz");
        assert_eq!(rate(&[Recording::default()]), "no clock");
    }
}
