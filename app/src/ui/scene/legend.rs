//! Legend of the marks in the picture, with their values: a strip below it.

use super::layers::SceneLayers;
use super::markers::{self, Marked, error_of};
use super::overlay::follows_fingers;
use super::path_extent::force_scale;
use crate::text::format::{number, significant};
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::prepared::Prepared;
use crate::ui::kit::icons;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme::{palette, role, space};
use crate::ui::scene::similarity::Likeness;
use crate::ui::session::Session;
use egui::{Align, Color32, FontId, Label, Layout, Rect, RichText, Sense, Stroke, Ui, UiBuilder, vec2};
use estimator::estimate::{Constraint, ConstraintKind, Phase, StrokePhase};
use render::ColorRole;

/// Height of a line and font size, points; space of a mark with and without its gap, and the gap between entries.
const LINE: f32 = 17.0;
const WORDS: f32 = 11.5;
const SIGN: f32 = 14.0;
const MARK: f32 = 20.0;
const APART: f32 = space::L;

/// Symbol of a legend entry.
#[derive(Clone, Copy, PartialEq)]
enum Mark {
    Line,
    Dashes,
    Arrow,
    Ring,
    /// No symbol in the picture: text only.
    Words,
}

struct Row {
    mark: Mark,
    color: ColorRole,
    text: String,
    /// Texts at other times: the widest sets the width, so that nothing moves with the cursor.
    else_says: Vec<String>,
}

impl Row {
    fn new(mark: Mark, color: ColorRole, text: impl Into<String>) -> Self {
        Self { mark, color, text: text.into(), else_says: Vec::new() }
    }

    fn width(&self, ui: &Ui) -> f32 {
        let wide = |text: &String| {
            ui.painter().layout_no_wrap(text.clone(), FontId::proportional(WORDS), Color32::PLACEHOLDER).size().x
        };
        MARK + self.else_says.iter().chain([&self.text]).map(wide).fold(0.0, f32::max).ceil() + 1.0
    }
}

/// Legend, laid out for a strip below the picture: it never covers the scene.
pub struct Legend {
    /// Entries of each line with their widths, points.
    lines: Vec<Vec<(f32, Row)>>,
}

impl Legend {
    /// Lays the entries out in as many lines as necessary for a strip `width` points wide.
    pub fn new(ui: &Ui, width: f32, session: &Session, prepared: &Prepared, likeness: Option<&Likeness>) -> Self {
        let room = width - 2.0 * space::M;
        let (mut lines, mut taken) = (Vec::<Vec<(f32, Row)>>::new(), f32::INFINITY);
        for row in rows(session, prepared, likeness) {
            let wide = row.width(ui).min(room);
            if taken + APART + wide > room {
                lines.push(Vec::new());
                taken = -APART;
            }
            taken += APART + wide;
            if let Some(line) = lines.last_mut() {
                line.push((wide, row));
            }
        }
        Self { lines }
    }

    /// Height of its strip, points; 0 without an entry.
    pub fn height(&self) -> f32 {
        if self.lines.is_empty() { 0.0 } else { LINE * self.lines.len() as f32 + 2.0 * space::XS }
    }

    /// Draws it.
    pub fn show(self, ui: &mut Ui, strip: Rect) {
        let p = palette(ui);
        let mut corner = strip.min + vec2(space::M, space::XS);
        for line in self.lines {
            for (wide, row) in line {
                let entry = UiBuilder::new().max_rect(Rect::from_min_size(corner, vec2(wide, LINE)));
                let mut ui = ui.new_child(entry.layout(Layout::left_to_right(Align::Center)));
                ui.spacing_mut().item_spacing = vec2(MARK - SIGN, 0.0);
                let color = role(ui.visuals().dark_mode, row.color);
                draw_mark(&mut ui, row.mark, color);
                ui.add(Label::new(RichText::new(row.text).size(WORDS).color(p.text)).truncate());
                corner.x += wide + APART;
            }
            corner = strip.min + vec2(space::M, corner.y + LINE - strip.min.y);
        }
    }
}

fn draw_mark(ui: &mut Ui, mark: Mark, color: Color32) {
    let (rect, _) = ui.allocate_exact_size(vec2(SIGN, LINE), Sense::hover());
    let (painter, stroke) = (ui.painter(), Stroke::new(1.8, color));
    let ends = [rect.left_center(), rect.right_center()];
    match mark {
        Mark::Line => {
            painter.line_segment(ends, stroke);
        }
        Mark::Dashes => painter.extend(egui::Shape::dashed_line(&ends, stroke, 4.0, 2.5)),
        Mark::Arrow => painter.arrow(ends[0], ends[1] - ends[0], stroke),
        Mark::Ring => {
            painter.circle_stroke(rect.center(), 4.5, Stroke::new(1.4, color));
            painter.circle_filled(rect.center(), 1.6, color);
        }
        Mark::Words => Icon::Told.paint(painter, rect.center(), icons::SMALL, palette(ui).secondary),
    }
}

fn rows(session: &Session, prepared: &Prepared, likeness: Option<&Likeness>) -> Vec<Row> {
    let layers = session.layers;
    let mut rows = Vec::new();
    if layers.path {
        rows.extend(paths(&session.calibration, prepared));
    }
    if layers.forces_on_path {
        rows.push(Row::new(Mark::Arrow, ColorRole::Measured, format!("Force of the hand, {}", scale(prepared))));
    }
    if layers.unexplained {
        let text = format!("Force that weight and friction do not explain, {}", scale(prepared));
        rows.push(Row::new(Mark::Arrow, ColorRole::Constraint, text));
    }
    if layers.constraints {
        for marked in markers::of(&session.document, &session.calibration, prepared) {
            rows.extend(of_constraint(&marked, session.document.cursor_s));
        }
    }
    if layers.contacts
        && prepared.tips.is_some()
        && session.calibration.replay(session.document.current).is_some_and(|r| r.film.is_some())
    {
        rows.push(Row::new(Mark::Ring, ColorRole::Measured, "Contact of the replay, by its force"));
    }
    rows.extend(of_replay(layers, likeness));
    rows
}

fn paths(calibration: &Calibration, prepared: &Prepared) -> Vec<Row> {
    if follows_fingers(calibration, prepared) {
        let row = |finger, text| Row::new(Mark::Line, ColorRole::Finger(finger), text);
        return vec![row(0, "Path of the left finger"), row(1, "Path of the right finger")];
    }
    let text = if prepared.tool.is_some() { "Path of the tool" } else { "Path of the hand" };
    vec![Row::new(Mark::Line, ColorRole::Measured, text)]
}

/// Scale of the vectors along the path, as text.
fn scale(prepared: &Prepared) -> String {
    format!("1 N is {} mm", significant(f64::from(force_scale(prepared)) * 1e3, 2))
}

fn of_replay(layers: SceneLayers, likeness: Option<&Likeness>) -> Vec<Row> {
    if !layers.replay {
        return Vec::new();
    }
    let none = || {
        vec![Row::new(
            Mark::Words,
            ColorRole::Simulated,
            "No replay: the fit made no world that these fingers can touch",
        )]
    };
    let Some(like) = likeness else { return none() };
    let mut rows = Vec::new();
    if let Some(force) = like.force_n {
        let [force, of] = [force, like.of_force_n].map(|n| significant(n, 2));
        let text = format!("Virtual force: {force} N off, of {of} N (RMS)");
        rows.push(Row::new(Mark::Arrow, ColorRole::Simulated, text));
    }
    if let Some(place) = like.place_m {
        let [place, way] = [place, like.of_way_m].map(|m| significant(m * 1e3, 2));
        let text = format!("Virtual object: {place} mm off, on a way of {way} mm (RMS)");
        rows.push(Row::new(Mark::Ring, ColorRole::Simulated, text));
    }
    if rows.is_empty() { none() } else { rows }
}

fn of_constraint(marked: &Marked<'_>, cursor_s: f64) -> Vec<Row> {
    let constraint = marked.constraint;
    let row = |mark, text: String| vec![Row::new(mark, ColorRole::Constraint, text)];
    let mm = |m: f64| significant(m * 1e3, 2);
    match constraint.kind {
        ConstraintKind::Revolute => revolute(marked),
        ConstraintKind::Prismatic => row(
            Mark::Line,
            format!("Line found; the path stays within {} mm", mm(constraint.residual_m.unwrap_or(0.0))),
        ),
        ConstraintKind::Spline => constraint.guide.as_ref().map_or_else(Vec::new, |guide| {
            let (points, rms) = (guide.points_m.len(), mm(guide.rms_m));
            row(Mark::Dashes, format!("Curve found: {points} control points, path within {rms} mm"))
        }),
        ConstraintKind::Unilateral => constraint.surface.as_ref().map_or_else(Vec::new, |touched| {
            let rubs = touched.friction.map_or(String::new(), |mu| format!(", friction {}", significant(mu, 2)));
            row(Mark::Line, format!("Surface found, ± {} mm{rubs}", mm(touched.offset_std_error_m)))
        }),
        ConstraintKind::Membrane => {
            let text = phase_at(&constraint.phases, cursor_s).map(in_words).unwrap_or_default();
            let else_says = constraint.phases.iter().map(in_words).collect();
            vec![Row { else_says, ..Row::new(Mark::Words, ColorRole::Constraint, text) }]
        }
        ConstraintKind::Undecided if constraint.existence.is_some() => {
            row(Mark::Words, "Constraint: cannot be decided from this recording".to_owned())
        }
        ConstraintKind::Screw => row(Mark::Words, "Screw found: turning and sliding go together".to_owned()),
        ConstraintKind::Free | ConstraintKind::Undecided => Vec::new(),
    }
}

fn revolute(marked: &Marked<'_>) -> Vec<Row> {
    let Constraint { radius_m: Some(radius_m), .. } = marked.constraint else { return Vec::new() };
    let error = error_of(marked.constraint, "radius_m");
    let plus_minus = if error > 0.0 { format!(" ± {}", significant(error * 1e3, 1)) } else { String::new() };
    let circle = format!("Circle found, radius {}{plus_minus} mm", significant(radius_m * 1e3, 4));
    let mut rows = vec![Row::new(Mark::Dashes, ColorRole::Constraint, circle)];
    let center = error_of(marked.constraint, "center_m");
    if center > 0.0 {
        let drawn =
            if marked.magnified > 1.0 { format!(", {} ×", number(marked.magnified, 0)) } else { String::new() };
        let text = format!("Its centre ± {} mm (95 % ellipse{drawn})", significant(center * 1e3, 1));
        rows.push(Row::new(Mark::Ring, ColorRole::Constraint, text));
    }
    rows
}

fn phase_at(phases: &[StrokePhase], cursor_s: f64) -> Option<&StrokePhase> {
    phases.iter().find(|phase| (phase.t0..phase.t1).contains(&cursor_s))
}

/// Action of the membrane at this moment, as text (thesis, figure 5.14).
fn in_words(phase: &StrokePhase) -> String {
    let name = match phase.phase {
        Phase::Free => "Needle outside of the sheet",
        Phase::Insertion => "The needle presses the sheet in",
        Phase::Penetration => "The needle goes in",
        Phase::Extraction => "The needle comes out",
    };
    let depth = format!("{} mm deep at most", significant(phase.deepest_m.max(0.0) * 1e3, 2));
    match phase.stiffness_n_m {
        Some(stiffness) => format!("{name}: {} N/m, {depth}", significant(stiffness, 2)),
        None => name.to_owned(),
    }
}
