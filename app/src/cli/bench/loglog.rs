//! Curves on logarithmic axes, as a picture in SVG: proportional growth rises at 45°.

use super::table::plain;
use crate::report::style::hex;
use crate::ui::kit::theme::{Palette, curve};
use render::ColorRole;
use std::fmt::Write as _;

/// Run time over a size.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    /// Name of the operation.
    pub name: &'static str,
    /// Object of the operation.
    pub of: &'static str,
    /// Size, and run time, s.
    pub points: Vec<(usize, f64)>,
}

/// Size of one chart, its axes' numbers and the legend, in units of the picture.
const SIDE: f64 = 300.0;
const LEFT: f64 = 62.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 44.0;
const LEGEND: f64 = 118.0;

impl Curve {
    /// Curve without points yet.
    pub fn new(name: &'static str, of: &'static str) -> Self {
        Self { name, of, points: Vec::new() }
    }

    /// Exponent of the growth of time with size, over the upper half of the points: overheads dominate the lower half.
    pub fn exponent(&self) -> f64 {
        let upper = &self.points[self.points.len() / 2..];
        let (Some(first), Some(last)) =
            (if upper.len() > 1 { upper.first() } else { self.points.first() }, upper.last())
        else {
            return f64::NAN;
        };
        (last.1 / first.1).ln() / (last.0 as f64 / first.0 as f64).ln()
    }
}

/// One chart for each kind of size, side by side.
pub(super) fn svg(curves: &[Curve]) -> String {
    let mut kinds: Vec<&str> = Vec::new();
    for curve in curves {
        if !kinds.contains(&curve.of) {
            kinds.push(curve.of);
        }
    }
    // On a light background of its own, in plain colours: programs without CSS variables would draw those black.
    let paper = Palette::of(false);
    let (width, height) = (kinds.len() as f64 * (LEFT + SIDE + LEGEND), TOP + SIDE + BOTTOM);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"12\">\n<style>\
         text{{fill:{}}}.n{{fill:{}}}.g{{stroke:{}}}.l{{fill:none;stroke-width:2}}</style>\n\
         <rect width=\"{width}\" height=\"{height}\" rx=\"8\" fill=\"{}\"/>\n",
        hex(paper.text),
        hex(paper.secondary),
        hex(paper.border),
        hex(paper.card)
    );
    for (k, kind) in kinds.iter().enumerate() {
        let shown: Vec<&Curve> = curves.iter().filter(|c| c.of == *kind && !c.points.is_empty()).collect();
        let _ = writeln!(text, "<g transform=\"translate({} {TOP})\">", LEFT + k as f64 * (LEFT + SIDE + LEGEND));
        chart(&mut text, kind, &shown);
        text.push_str("</g>\n");
    }
    text + "</svg>\n"
}

/// Range of decades that contains all values.
fn decades(values: impl Iterator<Item = f64> + Clone) -> (i32, i32) {
    let least = values.clone().fold(f64::INFINITY, f64::min).log10().floor() as i32;
    let most = values.fold(0.0, f64::max).log10().ceil() as i32;
    (least, most.max(least + 1))
}

fn chart(text: &mut String, kind: &str, curves: &[&Curve]) {
    let all = || curves.iter().flat_map(|c| c.points.iter());
    let (x, y) = (decades(all().map(|p| p.0 as f64)), decades(all().map(|p| p.1)));
    let place = |value: f64, (low, high): (i32, i32)| (value.log10() - f64::from(low)) / f64::from(high - low) * SIDE;
    let _ = writeln!(text, "<text y=\"-14\" font-weight=\"bold\">time over {kind}</text>");
    for power in y.0..=y.1 {
        let down = SIDE - place(10_f64.powi(power), y);
        let _ = writeln!(
            text,
            "<path class=\"g\" d=\"M0 {down:.1}H{SIDE}\"/><text class=\"n\" x=\"-6\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            down + 4.0,
            in_units(power)
        );
    }
    for power in x.0..=x.1 {
        let right = place(10_f64.powi(power), x);
        let number = if power < 4 {
            plain(10_f64.powi(power))
        } else {
            format!("10<tspan dy=\"-4\" font-size=\"9\">{power}</tspan>")
        };
        let _ = writeln!(
            text,
            "<path class=\"g\" d=\"M{right:.1} 0V{SIDE}\"/><text class=\"n\" x=\"{right:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{number}</text>",
            SIDE + 18.0
        );
    }
    let mut ends: Vec<(f64, usize)> = Vec::new();
    for (k, curve) in curves.iter().enumerate() {
        let points: Vec<(f64, f64)> =
            curve.points.iter().map(|p| (place(p.0 as f64, x), SIDE - place(p.1, y))).collect();
        let line: Vec<String> = points.iter().map(|(right, down)| format!("{right:.1} {down:.1}")).collect();
        let (color, dash) = (color(k), if k < COLORS { "" } else { " stroke-dasharray=\"5 3\"" });
        let _ = writeln!(text, "<path class=\"l\" stroke=\"{color}\"{dash} d=\"M{}\"/>", line.join("L"));
        for (right, down) in &points {
            let _ = writeln!(text, "<circle cx=\"{right:.1}\" cy=\"{down:.1}\" r=\"3\" fill=\"{color}\"/>");
        }
        ends.push((points.last().map_or(0.0, |p| p.1), k));
    }
    legend(text, curves, ends);
}

/// Number of curves distinguished by colour; further ones are dashed.
const COLORS: usize = 6;

/// Colour of a curve: the darker kind, for lines and dots on a light background.
fn color(k: usize) -> String {
    hex(curve(false, ColorRole::Block(k % COLORS), true))
}

/// Draws names beside the ends of their curves, without overlap.
fn legend(text: &mut String, curves: &[&Curve], mut ends: Vec<(f64, usize)>) {
    const LINE: f64 = 15.0;
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut free = f64::NEG_INFINITY;
    for (down, k) in ends {
        let at = down.max(free);
        free = at + LINE;
        let _ = writeln!(
            text,
            "<path class=\"l\" stroke=\"{}\"{} d=\"M{:.1} {at:.1}h13\"/><text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            color(k),
            if k < COLORS { "" } else { " stroke-dasharray=\"5 3\"" },
            SIDE + 9.0,
            SIDE + 26.0,
            at + 4.0,
            curves[k].name
        );
    }
}

/// A power of ten of a second, in its usual unit.
fn in_units(power: i32) -> String {
    let (unit, least) = match power {
        0.. => ("s", 0),
        -3..0 => ("ms", -3),
        -6..-3 => ("µs", -6),
        _ => ("ns", -9),
    };
    format!("{} {unit}", plain(10_f64.powi(power - least)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_law_is_found_and_drawn_with_its_units() {
        let points = [10, 100, 1_000].map(|n: usize| (n, 1e-6 * (n as f64).powi(2))).to_vec();
        let curve = Curve { name: "all pairs", of: "things", points };
        assert!((curve.exponent() - 2.0).abs() < 1e-9);
        let text = svg(&[curve, Curve { name: "nothing", of: "things", points: Vec::new() }]);
        assert!(!text.contains("var("), "plain colours: {text}");
        for part in ["all pairs", "time over things", "100 µs", "1 s", "</svg>"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(!text.contains("nothing") && !text.contains("NaN"), "{text}");
    }
}
