//! Real against virtual: the measured motion through the calibrated world.

use super::failed;
use crate::report::chart;
use crate::report::collect::{Content, Drawn};
use crate::ui::format;
use estimator::simulate::Simulation;
use maud::{Markup, html};

/// The section.
pub fn against_virtual(content: &Content) -> Markup {
    html! {
        section class="card" {
            h3 { "Real against virtual" }
            p class="muted" {
                "The measured motion, put through the world that was calibrated from it: what force would have been felt there, and what was measured."
            }
            @if let Some(why) = nowhere(content) { (failed("Nothing was simulated", why)) }
            @else {
                @for drawn in &content.drawn {
                    @if content.recordings.len() > 1 { h4 { (drawn.prepared.recording.name) } }
                    @match &drawn.simulation {
                        Ok(simulation) => (replay(drawn, simulation)),
                        Err(why) => (failed("Nothing was simulated", why)),
                    }
                }
            }
        }
    }
}

/// Why none of the recordings could be simulated: said once.
fn nowhere(content: &Content) -> Option<&str> {
    let mut reasons = content.drawn.iter().map(|d| d.simulation.as_ref().err());
    let first = reasons.next()??;
    reasons.all(|r| r.is_some()).then_some(first.as_str())
}

fn replay(drawn: &Drawn, simulation: &Simulation) -> Markup {
    let rms = |name: &str| simulation.residual_rms.iter().find(|(n, _)| n == name).map(|(_, v)| *v);
    let measured = |name: &str| drawn.prepared.recording.channel(name);
    html! {
        @if !simulation.residual_rms.is_empty() {
            table {
                thead { tr { th { "Channel" } th class="number" { "Measured, RMS" } th class="number" { "Left over, RMS" } th class="number" { "Share" } } }
                tbody { @for (name, left) in &simulation.residual_rms {
                    @let (unit, factor) = unit_of(simulation, name);
                    @let whole = measured(name).map(size);
                    tr {
                        td class="mono" { (name) }
                        td class="number" { (whole.map_or("–".to_owned(), |w| format!("{} {unit}", format::significant(w * factor, 3)))) }
                        td class="number" { (format::significant(left * factor, 3)) " " (unit) }
                        td class="number" { (whole.filter(|w| *w > 0.0).map_or("–".to_owned(), |w| format!("{} %", format::significant(100.0 * left / w, 2)))) }
                    }
                } }
            }
        }
        div class="keys small" { (chart::key("measured", "measured; below: measured less simulated")) (chart::key("simulated", "simulated")) }
        // One channel has the whole width.
        @let alone = simulation.predicted.len() == 1;
        div class=[(!alone).then_some("pair")] {
            @for channel in &simulation.predicted {
                @let width = if alone { chart::WIDE } else { 0.5 * chart::WIDE };
                (chart::against_virtual(&drawn.prepared, channel, &simulation.time_s, rms(&channel.name), width))
            }
        }
    }
}

fn unit_of<'a>(simulation: &'a Simulation, name: &str) -> (&'a str, f64) {
    let channel = simulation.predicted.iter().find(|c| c.name == name);
    format::channel_unit(channel.map_or("", |c| c.unit.as_str()))
}

fn size(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
