//! The residual atlas: the residual against the variable of every candidate cause, with the part that this candidate
//! alone would explain.

use crate::text::diagnosis_words::{listed, title};
use crate::text::format::{self, capitalised};
use crate::text::sentence::sentence;
use crate::ui::diagnose::atlas_sheet::{Cell, Line, Scale, Sheet};
use crate::ui::diagnose::state::Diagnosing;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{Palette, palette, space};
use crate::ui::kit::widgets::compact;
use crate::ui::plots::axes::{decimals, marks};
use crate::ui::plots::residual_plot::{BAND_SIGMAS, inks};
use egui::{
    Align, Align2, Color32, FontId, Layout, Pos2, Rect, Response, RichText, ScrollArea, Sense, Shape, Stroke, Ui, pos2,
    vec2,
};
use estimator::diagnose::Findings;
use haptics::law;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const WAS_FOUND_IN_ANOTHER: &str = "was found in another way and has";
    pub const WERE_FOUND_IN_OTHER: &str = "were found in other ways and have";
    pub const ALL_SUSPECTS: &str = "All suspects";
    pub const NOT_NAMED: &str = "not named";
}

/// Minimum size of a cell, points, and the height of its text.
const CELL: [f32; 2] = [204.0, 132.0];
const WORDS: f32 = 18.0;
/// Space for numbers beside a large picture, points.
const NUMBERS: [f32; 2] = [52.0, 20.0];

/// Draws the grid, or one candidate enlarged.
pub fn show(ui: &mut Ui, diagnosing: &mut Diagnosing, sheet: &Sheet, diagnosis: &Findings) {
    let open = diagnosing.atlas_open.clone();
    match open.and_then(|key| sheet.find(&key)) {
        Some(cell) => large(ui, diagnosing, cell, diagnosis),
        None => grid(ui, diagnosing, sheet, diagnosis),
    }
}

fn grid(ui: &mut Ui, diagnosing: &mut Diagnosing, sheet: &Sheet, diagnosis: &Findings) {
    let gap = space::M;
    let mut clicked = None;
    ScrollArea::vertical().id_salt("atlas").auto_shrink(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing = vec2(gap, gap);
        let columns = (((ui.available_width() + gap) / (CELL[0] + gap)) as usize).max(1);
        let width = (ui.available_width() - gap * (columns as f32 - 1.0)) / columns as f32;
        for channel in sheet.cells.chunk_by(|a, b| a.scale.channel == b.scale.channel) {
            if let Some(Scale { channel, unit, .. }) =
                channel.first().map(|c| c.scale).filter(|s| !s.channel.is_empty())
            {
                compact(ui, |ui| {
                    ui.label(theme::strong(capitalised(channel)));
                    ui.label(theme::caption(ui, unit));
                });
            }
            for line in channel.chunks(columns) {
                ui.horizontal(|ui| {
                    for cell in line {
                        if small(ui, cell, vec2(width, CELL[1])).clicked() {
                            clicked = Some(cell.key());
                        }
                    }
                });
            }
        }
        if let Some(text) = without_picture(sheet, diagnosis) {
            ui.add(egui::Label::new(theme::caption(ui, text)).wrap());
        }
    });
    if clicked.is_some() {
        diagnosing.atlas_open = clicked;
    }
}

/// Causes detected outside of a channel: faults of samples, scales from a free fall.
fn without_picture(sheet: &Sheet, diagnosis: &Findings) -> Option<String> {
    let unseen =
        diagnosis.causes.iter().filter(|c| law::cause(&c.id).is_some() && sheet.cells.iter().all(|s| s.id != c.id));
    let names: Vec<String> = unseen.map(|c| title(&c.id)).collect();
    let what = if names.len() == 1 { words::WAS_FOUND_IN_ANOTHER } else { words::WERE_FOUND_IN_OTHER };
    (!names.is_empty()).then(|| format!("{} {what} no picture here; the evidence stands beside.", listed(&names)))
}

/// Draws one candidate of the grid.
fn small(ui: &mut Ui, cell: &Cell, size: egui::Vec2) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let words = cell.words();
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &words));
    if !ui.is_rect_visible(rect) {
        return response;
    }
    let p = palette(ui);
    let plot = Rect::from_min_max(rect.min + vec2(0.0, WORDS), rect.max - vec2(0.0, WORDS));
    picture(ui, plot, cell, false);
    let edge = if response.hovered() || response.has_focus() { p.accent } else { p.border };
    ui.painter().rect_stroke(plot, 4, Stroke::new(1.0, edge), egui::StrokeKind::Inside);
    let painter = ui.painter().with_clip_rect(rect);
    let score = format::number(cell.score, 0);
    let color = if cell.named { p.good } else { p.secondary };
    let right = painter.text(rect.right_top(), Align2::RIGHT_TOP, score, FontId::proportional(11.5), color);
    let name = painter.with_clip_rect(Rect::from_min_max(rect.min, pos2(right.left() - 6.0, rect.bottom())));
    name.text(rect.left_top(), Align2::LEFT_TOP, &cell.title, FontId::new(12.0, theme::semibold()), p.text);
    let small = FontId::proportional(11.0);
    let [low, high] = ends(cell);
    painter.text(rect.left_bottom(), Align2::LEFT_BOTTOM, low, small.clone(), p.faint);
    painter.text(rect.right_bottom(), Align2::RIGHT_BOTTOM, high, small.clone(), p.faint);
    let middle = format!("{}, {}", cell.variable, cell.unit);
    painter.text(rect.center_bottom(), Align2::CENTER_BOTTOM, middle, small, p.secondary);
    response.on_hover_text(format!(
        "{words}: what the model leaves (score {}). A click shows it large.",
        format::number(cell.score, 0)
    ))
}

/// Both ends of the variable's range, as numbers.
fn ends(cell: &Cell) -> [String; 2] {
    let digits = decimals(0.1 * (cell.range.1 - cell.range.0)).min(2);
    [cell.range.0, cell.range.1].map(|v| format::number(v, digits))
}

/// Draws noise band, zero line, binned means of the residual, and the part that the candidate explains.
fn picture(ui: &Ui, rect: Rect, cell: &Cell, points: bool) {
    let (p, inks) = (palette(ui), inks(ui));
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_filled(rect, 4, p.sunken);
    let at = |[x, y]: [f64; 2]| place(rect, cell.range, cell.scale.largest, x, y);
    let band = BAND_SIGMAS * cell.scale.noise;
    painter.rect_filled(Rect::from_two_pos(at([cell.range.0, band]), at([cell.range.1, -band])), 0, inks.noise);
    painter.hline(rect.x_range(), at([cell.range.0, 0.0]).y, Stroke::new(1.0, p.border));
    if points {
        for point in &cell.cloud {
            painter.circle_filled(at(*point), 1.2, inks.model.gamma_multiply(0.30));
        }
    }
    lines(&painter, &cell.left, &at, inks.model, if points { 2.0 } else { 1.5 });
    lines(&painter, &cell.taken, &at, suspect_ink(p, cell), if points { 3.0 } else { 2.0 });
}

/// Colour of a candidate; diagnosed causes are green everywhere.
fn suspect_ink(p: &Palette, cell: &Cell) -> Color32 {
    if cell.named { p.good } else { p.accent }
}

fn place(rect: Rect, (low, high): (f64, f64), largest: f64, x: f64, y: f64) -> Pos2 {
    let right = ((x - low) / (high - low)) as f32;
    let up = (0.5 + 0.5 * y / largest) as f32;
    pos2(rect.left() + right * rect.width(), rect.bottom() - up * rect.height())
}

/// Draws lines, forwards solid, backwards dashed.
fn lines(painter: &egui::Painter, lines: &[Line], at: &dyn Fn([f64; 2]) -> Pos2, color: Color32, width: f32) {
    let stroke = Stroke::new(width, color);
    for (k, line) in lines.iter().enumerate() {
        for part in line {
            let points: Vec<Pos2> = part.iter().map(|p| at(*p)).collect();
            if k == 0 {
                painter.add(Shape::line(points, stroke));
            } else {
                painter.extend(Shape::dashed_line(&points, stroke, 4.0, 3.0));
            }
        }
    }
}

/// Draws one candidate over the whole panel, with numbers and text.
fn large(ui: &mut Ui, diagnosing: &mut Diagnosing, cell: &Cell, diagnosis: &Findings) {
    let p = palette(ui);
    compact(ui, |ui| {
        if ui.add(egui::Button::new((Icon::Back, words::ALL_SUSPECTS)).small()).clicked()
            || ui.input(|i| i.key_pressed(egui::Key::Escape))
        {
            diagnosing.atlas_open = None;
        }
        ui.add_space(space::S);
        ui.label(theme::strong(&cell.title));
        ui.label(theme::caption(ui, format!("{} over {}, {}", cell.scale.unit, cell.variable, cell.unit)));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let note = if cell.named { "named" } else { words::NOT_NAMED };
            ui.label(RichText::new(note).size(11.5).color(if cell.named { p.good } else { p.secondary }));
        });
    });
    if let Some(entry) = law::cause(&cell.id) {
        ui.label(RichText::new(entry.equation).monospace());
        ui.add(
            egui::Label::new(theme::caption(
                ui,
                format!("It shows: {}", crate::text::diagnosis_words::small(entry.shows)),
            ))
            .wrap(),
        );
    }
    let score = format::number(cell.score, 0);
    let mut says = format!(
        "Alone it scores {score}: twice the log of how much likelier it makes the force, less what its parameters cost."
    );
    if let Some(passed) = diagnosis.passed_over.iter().find(|passed| passed.id == cell.id) {
        says = format!("{says} {}", sentence(&passed.why));
    }
    ui.add(egui::Label::new(theme::caption(ui, says)).wrap());
    ui.add_space(space::XS);
    let (rect, _) = ui.allocate_exact_size(ui.available_size().max(vec2(120.0, 120.0)), Sense::hover());
    let plot = Rect::from_min_max(rect.min + vec2(NUMBERS[0], 4.0), rect.max - vec2(8.0, NUMBERS[1]));
    picture(ui, plot, cell, true);
    numbers(ui, plot, cell);
}

/// Draws a quiet grid with its numbers.
fn numbers(ui: &Ui, plot: Rect, cell: &Cell) {
    let p = palette(ui);
    let (painter, font) = (ui.painter(), FontId::proportional(11.0));
    let grid = Stroke::new(0.5, p.border);
    for mark in marks(cell.range, 8.0).into_iter().filter(|m| (cell.range.0..=cell.range.1).contains(&m.value)) {
        let at = place(plot, cell.range, cell.scale.largest, mark.value, 0.0);
        painter.vline(at.x, plot.y_range(), grid);
        let text = format::number(mark.value, decimals(mark.step_size));
        painter.text(pos2(at.x, plot.bottom() + 4.0), Align2::CENTER_TOP, text, font.clone(), p.secondary);
    }
    let heights = (-cell.scale.largest, cell.scale.largest);
    for mark in marks(heights, 6.0).into_iter().filter(|m| m.value.abs() <= cell.scale.largest) {
        let at = place(plot, cell.range, cell.scale.largest, cell.range.0, mark.value);
        painter.hline(plot.x_range(), at.y, grid);
        let text = format::number(mark.value, decimals(mark.step_size));
        painter.text(pos2(plot.left() - 6.0, at.y), Align2::RIGHT_CENTER, text, font.clone(), p.secondary);
    }
}
