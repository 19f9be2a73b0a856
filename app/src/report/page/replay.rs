//! Measured vs. simulated: the measured motion through the calibrated world.

use crate::report::chart::{bad, frame, signals};
use crate::report::collect::{Content, Drawn};
use crate::report::page::parts::failed;
use crate::text::diagnosis_words::listed;
use crate::text::format;
use estimator::diagnose::{Findings, Verdict};
use estimator::signal::noise::white_noise;
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

/// Common reason why none of the recordings could be simulated.
fn nowhere(content: &Content) -> Option<&str> {
    let mut reasons = content.drawn.iter().map(|d| d.simulation.as_ref().err());
    let first = reasons.next()??;
    reasons.all(|r| r.is_some()).then_some(first.as_str())
}

/// Residual of a channel's simulation and the part due to noise, in the channel's unit, RMS.
struct Left<'a> {
    name: &'a str,
    rms: f64,
    measured: Option<f64>,
    /// White noise of the sensor, and of the simulated force.
    noise: Option<(f64, f64)>,
}

impl Left<'_> {
    fn share(&self) -> Option<f64> {
        self.measured.filter(|m| *m > 0.0).map(|measured| self.rms / measured)
    }

    /// True if noise alone explains the residual.
    fn is_noise(&self) -> bool {
        self.noise.is_some_and(|(sensor, own)| self.rms < NOISE_ALONE * sensor.hypot(own))
    }
}

/// Maximum ratio of residual to expected noise for noise alone: only the white part of the noise is known.
const NOISE_ALONE: f64 = 1.3;
/// Share of a channel's residual that a reader would notice.
const NOTICED: f64 = 0.05;

fn left<'a>(drawn: &Drawn, simulation: &'a Simulation) -> Vec<Left<'a>> {
    let of = |(name, left): &'a (String, f64)| {
        let measured = drawn.prepared.recording.channel(name);
        let simulated = simulation.predicted.iter().find(|c| c.name == *name);
        let noise = measured.zip(simulated).map(|(m, s)| {
            // Without contact the simulated force is zero, without any noise.
            let felt: Vec<f64> = s.values.iter().copied().filter(|v| *v != 0.0).collect();
            (white_noise(m), white_noise(&felt))
        });
        Left { name, rms: *left, measured: measured.map(size), noise }
    };
    simulation.residual_rms.iter().map(of).collect()
}

/// Explanation why a world without a significant residual leaves a share of single channels here; `None` if it does
/// not.
pub fn beside_the_diagnosis(content: &Content, diagnosis: &Findings) -> Option<String> {
    if diagnosis.verdict != Verdict::None {
        return None;
    }
    let simulated = content.drawn.iter().filter_map(|d| Some((d, d.simulation.as_ref().ok()?)));
    let all: Vec<Left<'_>> = simulated.flat_map(|(d, s)| left(d, s)).collect();
    let worst = all.iter().max_by(|a, b| a.share().unwrap_or(0.0).total_cmp(&b.share().unwrap_or(0.0)))?;
    let share = worst.share().filter(|s| *s > NOTICED)?;
    let why = if worst.is_noise() {
        "this is noise of the sensor and of the simulated force itself, into which that of the measured positions comes through the stiff pads"
    } else {
        "that is asked of every channel, the diagnosis asks for what laws determine"
    };
    Some(format!("Its replay leaves {} % of {}: {why}.", format::significant(100.0 * share, 2), worst.name))
}

/// Table of the channels' residual shares and noise.
fn table(all: &[Left<'_>], simulation: &Simulation) -> Markup {
    html! {
        table {
            thead { tr {
                th { "Channel" } th class="number" { "Measured, RMS" } th class="number" { "Left over, RMS" } th class="number" { "Share" }
                th class="number" { "Noise measured" } th class="number" { "Noise simulated" }
            } }
            tbody { @for channel in all {
                @let (unit, factor) = unit_of(simulation, channel.name);
                @let shown = |rms: f64| format!("{} {unit}", format::significant(rms * factor, 3));
                @let dash = || "–".to_owned();
                tr {
                    td class="mono" { (channel.name) }
                    td class="number" { (channel.measured.map_or_else(dash, shown)) }
                    td class="number" { (shown(channel.rms)) }
                    td class="number" { (channel.share().map_or_else(dash, |s| format!("{} %", format::significant(100.0 * s, 2)))) }
                    td class="number" { (channel.noise.map_or_else(dash, |n| shown(n.0))) }
                    td class="number" { (channel.noise.map_or_else(dash, |n| shown(n.1))) }
                }
            } }
        }
        p class="muted small" {
            "Noise: its white part, RMS. The simulated force has some of its own, because the noise of the measured motion goes into it; "
            "what is left holds both."
            @let noisy: Vec<String> = all.iter().filter(|c| c.is_noise()).map(|c| c.name.to_owned()).collect();
            @if !noisy.is_empty() { " In " (listed(&noisy)) " nothing more than that is left." }
        }
    }
}

fn replay(drawn: &Drawn, simulation: &Simulation) -> Markup {
    let rms = |name: &str| simulation.residual_rms.iter().find(|(n, _)| n == name).map(|(_, v)| *v);
    let holes = bad::holes(&drawn.prepared);
    html! {
        @if !simulation.residual_rms.is_empty() { (table(&left(drawn, simulation), simulation)) }
        @if !holes.is_empty() {
            p class="muted small" { "Nothing is simulated in the " @if holes.len() == 1 { "gap" } @else { (holes.len()) " gaps" }
                ": what was held goes on where the fingers are found again." }
        }
        div class="keys small" { (frame::key("measured", "measured; below: measured less simulated")) (frame::key("simulated", "simulated")) }
        // A single channel has the whole width.
        @let alone = simulation.predicted.len() == 1;
        div class=[(!alone).then_some("pair")] {
            @for channel in &simulation.predicted {
                @let width = if alone { frame::WIDE } else { 0.5 * frame::WIDE };
                (signals::against_virtual(&drawn.prepared, channel, &simulation.time_s, rms(&channel.name), width))
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
