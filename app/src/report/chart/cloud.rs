//! Force residuals of the base and the extended model: over time, and against each candidate variable.

use crate::report::chart::frame::{Frame, WIDE, key};
use crate::ui::plots::residual_plot::BAND_SIGMAS;
use crate::ui::plots::residuals::{Cloud, Residuals, Suspect};
use egui_plot::PlotPoint;
use maud::{Markup, html};
use std::fmt::Write as _;

/// Maximum number of points of a cloud.
const MOST_DOTS: usize = 1200;

/// All curves of a diagnosis of one recording. `found` is true if a cause was diagnosed, so that there is an extended
/// model.
pub fn residuals(curves: &Residuals, found: bool) -> Markup {
    html! {
        figure {
            figcaption {
                b { "Force along the motion, " (curves.unit) }
                span class="keys" {
                    (key("measured", "measured"))
                    (key("simulated", "model"))
                    @if found { (key("good", "with what was found")) }
                    (key("faint", "noise"))
                }
            }
            (force(curves, found))
        }
        div class="pair" {
            @for cloud in &curves.clouds {
                figure {
                    figcaption {
                        b { "Left over, " (curves.unit) }
                        span class="muted" { "against " (cloud.title.to_lowercase()) @if !cloud.unit.is_empty() { ", " (cloud.unit) } }
                    }
                    (against(curves, cloud, found))
                }
            }
        }
        p class="muted small" {
            "Dots: what the model leaves of single rows. Lines: means over small ranges"
            @if found { ", before and with what was found" }
            "; dashed: backwards. The grey band holds two standard deviations of the noise."
        }
    }
}

fn force(curves: &Residuals, found: bool) -> Markup {
    let frame = Frame { size: (WIDE, 190.0), x: curves.span_s, y: curves.force, x_unit: Some(" s") };
    let edge = BAND_SIGMAS * curves.noise;
    let around = if found { &curves.extended } else { &curves.modelled };
    let inside = html! {
        @for stretch in around.iter().filter(|s| s.len() > 1) {
            @let up = frame.line(stretch.iter().map(|p| (p.x, p.y + edge)));
            @let down = frame.line(stretch.iter().rev().map(|p| (p.x, p.y - edge)));
            path class="noise" d=(format!("{up}{}Z", down.replacen('M', "L", 1))) {}
        }
        (lines(&frame, &curves.modelled, "line broad", "simulated"))
        @if found { (lines(&frame, &curves.extended, "line", "good")) }
        (lines(&frame, &curves.measured, "line thin", "measured"))
    };
    frame.draw("Measured and modelled force over time", &inside)
}

fn against(curves: &Residuals, cloud: &Cloud, found: bool) -> Markup {
    let unit = if cloud.suspect == Suspect::Time { " s" } else { "" };
    let y = (-curves.largest, curves.largest);
    let frame = Frame { size: (0.5 * WIDE, 150.0), x: cloud.range, y, x_unit: Some(unit) };
    let (width, _) = frame.inner();
    let (top, bottom) = (frame.down(BAND_SIGMAS * curves.noise), frame.down(-BAND_SIGMAS * curves.noise));
    let step = cloud.before.len().div_ceil(MOST_DOTS).max(1);
    let mut dots = String::new();
    for point in cloud.before.iter().step_by(step).filter(|p| p.x.is_finite() && p.y.abs() <= curves.largest) {
        let _ = write!(dots, "M{:.1} {:.1}h0", frame.right(point.x), frame.down(point.y));
    }
    let inside = html! {
        rect class="noise" x="0" width=(width) y=(crate::report::chart::frame::short(top)) height=(crate::report::chart::frame::short(bottom - top)) {}
        path class="dots" style="stroke:var(--simulated)" d=(dots) {}
        @for (trend, dash) in cloud.trend_before.iter().zip(["line broad", "line broad dashed"]) {
            (lines(&frame, trend, dash, "simulated"))
        }
        @if found {
            @for (trend, dash) in cloud.trend_after.iter().zip(["line", "line dashed"]) { (lines(&frame, trend, dash, "good")) }
        }
    };
    frame.draw(&format!("Force left over against {}", cloud.title.to_lowercase()), &inside)
}

fn lines(frame: &Frame, stretches: &[Vec<PlotPoint>], class: &str, color: &str) -> Markup {
    let data: String = stretches.iter().map(|s| frame.line(s.iter().map(|p| (p.x, p.y)))).collect();
    html! { path class=(class) style=(format!("stroke:var(--{color})")) d=(data) {} }
}
