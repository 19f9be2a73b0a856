//! Reliability diagram as a picture in SVG: how often names are right, over their stated posterior.

use crate::report::style::hex;
use crate::ui::kit::theme::{Palette, curve};
use blind::certain::Reliability;
use render::ColorRole;
use std::fmt::Write as _;

/// Size of the chart and its margins, in units of the picture.
const SIDE: f64 = 300.0;
const LEFT: f64 = 62.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 56.0;
const RIGHT: f64 = 30.0;

/// Share of right names over the mean stated posterior of each bin, with exact 95 % intervals. Calibrated names lie on
/// the diagonal.
pub(super) fn svg(bins: &[Reliability]) -> String {
    // On a light background of its own, in plain colours: programs without CSS variables would draw those black.
    let paper = Palette::of(false);
    let (width, height) = (LEFT + SIDE + RIGHT, TOP + SIDE + BOTTOM);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"12\">\n<style>\
         text{{fill:{}}}.n{{fill:{}}}.g{{stroke:{}}}</style>\n\
         <rect width=\"{width}\" height=\"{height}\" rx=\"8\" fill=\"{}\"/>\n<g transform=\"translate({LEFT} {TOP})\">\n\
         <text y=\"-16\" font-weight=\"bold\">right names over their posterior</text>\n",
        hex(paper.text),
        hex(paper.secondary),
        hex(paper.border),
        hex(paper.card)
    );
    for tick in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let (right, down) = (tick * SIDE, (1.0 - tick) * SIDE);
        let _ = writeln!(
            text,
            "<path class=\"g\" d=\"M0 {down}H{SIDE}M{right} 0V{SIDE}\"/><text class=\"n\" x=\"-8\" y=\"{}\" text-anchor=\"end\">{tick}</text>\
             <text class=\"n\" x=\"{right}\" y=\"{}\" text-anchor=\"middle\">{tick}</text>",
            down + 4.0,
            SIDE + 18.0
        );
    }
    let color = hex(curve(false, ColorRole::Block(0), true));
    let _ = writeln!(text, "<path class=\"g\" stroke-width=\"2\" stroke-dasharray=\"5 3\" d=\"M0 {SIDE}L{SIDE} 0\"/>");
    let named = bins.iter().filter(|bin| bin.fair.of > 0);
    for bin in named {
        let [low, high] = bin.fair.interval(0.95).map(|share| (1.0 - share) * SIDE);
        let (right, down) = (bin.stated * SIDE, (1.0 - bin.fair.value()) * SIDE);
        let _ = writeln!(
            text,
            "<path fill=\"none\" stroke-width=\"2\" stroke=\"{color}\" d=\"M{right:.1} {low:.1}V{high:.1}\"/>\
             <circle cx=\"{right:.1}\" cy=\"{down:.1}\" r=\"4\" fill=\"{color}\"/>\
             <text class=\"n\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            right - 7.0,
            down + 4.0,
            bin.fair.of
        );
    }
    let _ = writeln!(
        text,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">stated posterior (number of names beside each point)</text>",
        0.5 * SIDE,
        SIDE + 42.0
    );
    text + "</g>\n</svg>\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use blind::Share;

    #[test]
    fn a_calibrated_bin_lies_on_the_diagonal_and_an_empty_one_is_not_drawn() {
        let bin = |stated: f64, hits: usize, of: usize| {
            let share = Share { hits, of };
            Reliability { bin: [0.0, 1.0], stated, right: share, fair: share }
        };
        let text = svg(&[bin(0.75, 3, 4), bin(f64::NAN, 0, 0)]);
        assert!(text.contains("cx=\"225.0\" cy=\"75.0\"") && text.matches("<circle").count() == 1, "{text}");
        assert!(!text.contains("NaN") && text.ends_with("</svg>\n"), "{text}");
    }
}
