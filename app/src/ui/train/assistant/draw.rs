//! The assistant's marks over the picture: a plate beside the held object, warning lines, and marks at the places
//! concerned.

use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, role, space};
use crate::ui::kit::widgets::compact;
use crate::ui::scene::view::SceneResponse;
use crate::ui::train::assistant::readings::{Circle, Said, said};
use crate::ui::train::assistant::state::Assistant;
use crate::ui::train::assistant::words;
use crate::ui::train::assistant::words::Urgency;
use crate::ui::train::state::Training;
use crate::ui::train::trainer::live::Trainer;
use egui::{
    Align, Color32, CornerRadius, Frame, Layout, Margin, Pos2, Rect, RichText, Shape, Stroke, Ui, UiBuilder, vec2,
};
use estimator::assistant::{Collision, Held, Warning};
use estimator::online::Pull;
use haptics::Vec2;
use render::ColorRole;

/// Half axes of an ellipse that holds 95 % of a normal distribution in the plane, in standard errors: √χ²₂(0.95).
const ELLIPSE_95: f64 = 2.4477;
/// Width of the plate, points, and its distance from the centre of the held object.
const PLATE: f32 = 198.0;
const ASIDE: f32 = 128.0;
/// Minimum width of a picture with room for the plate, points.
const ROOM: f32 = 480.0;
/// Distance of the warning lines from the picture's upper edge, points: below the hint.
const BELOW_HINT: f32 = 48.0;
/// Length of the line of a pull whose anchor is unknown, m.
const RAY_M: f64 = 0.06;
/// Half of the drawn arc of the workspace's edge, rad.
const ARC_RAD: f64 = 0.35;

/// Explanation of the slip margin, on request.
const ABOUT_SLIP: &str = "Share of the friction that is free. The friction is not known before it slips: it is above what has held so \
                          far, and otherwise as that of foam or rubber pads (0.4 to 1.6). In brackets: nineteen of twenty frictions";

/// Draws the assistant's output over the trainer's picture.
pub fn draw(ui: &mut Ui, view: &SceneResponse, training: &Training) {
    let Some(said) = said(training) else { return };
    let parts = training.assistant;
    let canvas = Canvas { ui, view };
    if parts.constraint {
        said.pulls.iter().for_each(|pull| canvas.pull(pull));
        said.circle.iter().for_each(|circle| canvas.circle(circle));
    }
    let wanted = |warning: &&Warning| match warning {
        Warning::Force { .. } => parts.force,
        Warning::Collision(_) => parts.collision,
        Warning::Edge { .. } => parts.edge,
    };
    let state = training.trainer.seen();
    let tips = state.map_or([Vec2::zeros(); 2], |s| s.input.tip_in_world);
    let warnings: Vec<&Warning> = said.warnings.iter().filter(wanted).collect();
    for warning in &warnings {
        match warning {
            Warning::Force { finger, over, .. } => canvas.force(tips[*finger], *over),
            Warning::Collision(met) => canvas.collision(met),
            Warning::Edge { at_m, .. } => canvas.edge(&training.trainer, *at_m),
        }
    }
    lines(ui, view.rect, &said, &warnings, parts);
    if let Some(held) = said.held.as_ref().filter(|held| !held.is_blank()) {
        plate(ui, view, held, said.held_at_m, parts);
    }
}

/// Draws warnings and findings, one pill per line, below the hint.
fn lines(ui: &mut Ui, rect: Rect, said: &Said, warnings: &[&Warning], parts: Assistant) {
    let mut all: Vec<(String, Urgency)> = warnings.iter().map(|w| words::warning(w)).collect();
    if parts.constraint {
        all.extend(said.pulls.iter().map(|p| (words::pull(p), Urgency::Note)));
        all.extend(said.circle.iter().map(|c| (words::circle(c), Urgency::Note)));
    }
    let room = rect.shrink(space::M);
    let room = room.with_min_y(rect.top() + BELOW_HINT);
    let mut ui = ui.new_child(UiBuilder::new().max_rect(room).layout(Layout::top_down(Align::Min)));
    ui.spacing_mut().item_spacing.y = space::XS;
    for (text, urgency) in all {
        let color = ink(&ui, urgency);
        let p = palette(&ui);
        Frame::new()
            .fill(p.card.gamma_multiply(0.94))
            .stroke(Stroke::new(1.0, if urgency == Urgency::Note { p.border } else { color }))
            .corner_radius(12)
            .inner_margin(Margin::symmetric(10, 4))
            .show(&mut ui, |ui| {
                ui.add(egui::Label::new(RichText::new(text).size(12.0).color(color)).selectable(false));
            });
    }
}

fn ink(ui: &Ui, urgency: Urgency) -> Color32 {
    let p = palette(ui);
    match urgency {
        Urgency::Note => p.text,
        Urgency::Caution => p.caution,
        Urgency::Danger => p.danger,
    }
}

/// Draws the estimates of the held object beside it.
fn plate(ui: &mut Ui, view: &SceneResponse, held: &Held, at_m: Vec2, parts: Assistant) {
    let lines = words::held(held, parts);
    let guess = held.contents.as_ref().filter(|_| parts.contents);
    let slip = held.slip.filter(|_| parts.slip);
    let nothing = lines.is_empty() && guess.is_none() && slip.is_none();
    if nothing || view.rect.width() < ROOM {
        return;
    }
    let height = 34.0
        + 18.0 * lines.len() as f32
        + if guess.is_some() { 34.0 } else { 0.0 }
        + if slip.is_some() { 30.0 } else { 0.0 };
    let at = on_screen(ui, view, at_m);
    let room = view.rect.shrink(space::M).with_max_y(view.rect.bottom() - 44.0);
    // On the side with more room, with hysteresis against jumps.
    let right = at.x < room.center().x + 0.25 * room.width();
    let x = if right { at.x + ASIDE } else { at.x - ASIDE - PLATE };
    let corner = Pos2::new(
        x.clamp(room.left(), (room.right() - PLATE).max(room.left())),
        (at.y - 0.5 * height).clamp(room.top() + BELOW_HINT, (room.bottom() - height).max(room.top())),
    );
    let p = palette(ui);
    let edge = if right { corner.x } else { corner.x + PLATE };
    let leader = [Pos2::new(edge, corner.y + 18.0), at];
    ui.painter().with_clip_rect(view.rect).line_segment(leader, Stroke::new(1.0, p.secondary.gamma_multiply(0.6)));
    let place = Rect::from_min_size(corner, vec2(PLATE, height));
    let mut ui = ui.new_child(UiBuilder::new().max_rect(place).layout(Layout::top_down(Align::Min)));
    Frame::new()
        .fill(p.card.gamma_multiply(0.94))
        .stroke(Stroke::new(1.0, p.border))
        .corner_radius(CornerRadius::same(theme::CARD_RADIUS))
        .inner_margin(Margin::symmetric(10, 7))
        .show(&mut ui, |ui| {
            ui.set_width(PLATE - 20.0);
            ui.spacing_mut().item_spacing.y = 3.0;
            ui.label(theme::strong(words::title(held)));
            for (label, value) in &lines {
                row(ui, label, value);
            }
            if let Some(guess) = guess {
                ui.add(egui::Label::new(RichText::new(words::contents(guess)).size(12.0)).wrap());
            }
            if let Some(slip) = slip {
                let (text, urgency) = words::slip(&slip);
                let color = if urgency == Urgency::Note { p.good } else { ink(ui, urgency) };
                ui.label(RichText::new(text).size(12.0).color(ink(ui, urgency))).on_hover_text(ABOUT_SLIP);
                crate::ui::kit::widgets::bar(ui, slip.free, 1.0, None, color);
            }
        });
}

fn row(ui: &mut Ui, label: &str, value: &str) {
    let p = palette(ui);
    compact(ui, |ui| {
        ui.label(RichText::new(label).size(12.0).color(p.secondary));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(RichText::new(value).size(12.0));
        });
    });
}

fn on_screen(ui: &Ui, view: &SceneResponse, point_in_world: Vec2) -> Pos2 {
    let pixel = view.camera.pixel_of(point_in_world, view.size);
    view.rect.min + vec2(pixel.x, pixel.y) / ui.pixels_per_point()
}

/// Marks at positions of the world.
struct Canvas<'a> {
    ui: &'a Ui,
    view: &'a SceneResponse,
}

impl Canvas<'_> {
    fn at(&self, point_in_world: Vec2) -> Pos2 {
        on_screen(self.ui, self.view, point_in_world)
    }

    fn painter(&self) -> egui::Painter {
        self.ui.painter().with_clip_rect(self.view.rect)
    }

    /// Draws a line that is legible on both bright metal and dark ground.
    fn line(&self, points: Vec<Pos2>, width: f32, color: Color32) {
        let painter = self.painter();
        let halo = palette(self.ui).card.gamma_multiply(0.7);
        painter.add(Shape::line(points.clone(), Stroke::new(width + 2.5, halo)));
        painter.add(Shape::line(points, Stroke::new(width, color)));
    }

    fn dashed(&self, points: &[Pos2], color: Color32) {
        self.painter().extend(Shape::dashed_line(points, Stroke::new(2.0, color), 6.0, 5.0));
    }

    /// Draws a ring around a finger that presses too hard.
    fn force(&self, tip_m: Vec2, over: bool) {
        let p = palette(self.ui);
        let color = if over { p.danger } else { p.caution };
        self.painter().circle_stroke(self.at(tip_m), 17.0, Stroke::new(if over { 4.0 } else { 2.5 }, color));
    }

    /// Draws the path from a moving object to the predicted impact.
    fn collision(&self, met: &Collision) {
        let color = palette(self.ui).caution;
        let (from, to) = (self.at(met.from_m), self.at(met.to_m));
        self.dashed(&[from, to], color);
        let painter = self.painter();
        painter.circle_filled(to, 3.5, color);
        painter.circle_stroke(to, 9.0, Stroke::new(2.0, color));
    }

    /// Draws the nearby arc of the workspace's edge.
    fn edge(&self, trainer: &Trainer, at_m: Vec2) {
        const PIECES: u32 = 24;
        let Some((_, world)) = trainer.scene() else { return };
        let workspace = world.hand.workspace;
        let middle = (at_m - workspace.center_m).y.atan2((at_m - workspace.center_m).x);
        let arc = (0..=PIECES).map(|k| {
            let angle = middle + ARC_RAD * (2.0 * f64::from(k) / f64::from(PIECES) - 1.0);
            self.at(workspace.center_m + workspace.radius_m * Vec2::new(angle.cos(), angle.sin()))
        });
        self.line(arc.collect(), 3.0, palette(self.ui).caution);
    }

    /// Draws the constraint of an object: the line of the pull, and the 95 % region of its anchor.
    fn pull(&self, pull: &Pull) {
        let color = role(self.ui.visuals().dark_mode, ColorRole::Constraint);
        let Some(along) = pull.force_n.try_normalize(1e-9) else { return };
        if let Some(anchor) = pull.anchor {
            self.dashed(&[self.at(pull.at_m), self.at(anchor.at_m)], color);
            let [long, short] = anchor.axes_m;
            self.line(self.ring(anchor.at_m, ELLIPSE_95 * long, ELLIPSE_95 * short), 2.0, color);
            self.painter().circle_filled(self.at(anchor.at_m), 3.0, color);
            return;
        }
        // Opening by the uncertainty of the direction.
        let turn = 2.0 * (pull.std_error_n / pull.force_n.norm()).min(0.7);
        for side in [-turn, turn] {
            let (sin, cos) = side.sin_cos();
            let way = Vec2::new(cos * along.x - sin * along.y, sin * along.x + cos * along.y);
            self.dashed(&[self.at(pull.at_m), self.at(pull.at_m + RAY_M * way)], color.gamma_multiply(0.7));
        }
        self.line(vec![self.at(pull.at_m), self.at(pull.at_m + RAY_M * along)], 2.0, color);
    }

    /// Draws the detected circle of a handle, and its centre.
    fn circle(&self, circle: &Circle) {
        let color = role(self.ui.visuals().dark_mode, ColorRole::Constraint);
        let radius = circle.radius.value;
        self.dashed(&self.ring(circle.center_m, Vec2::new(radius, 0.0), Vec2::new(0.0, radius)), color);
        let error = ELLIPSE_95 * circle.center_error_m;
        self.line(self.ring(circle.center_m, Vec2::new(error.x, 0.0), Vec2::new(0.0, error.y)), 2.0, color);
        self.painter().circle_filled(self.at(circle.center_m), 3.0, color);
    }

    fn ring(&self, center_m: Vec2, a: Vec2, b: Vec2) -> Vec<Pos2> {
        const PIECES: u32 = 48;
        let place = |k: u32| {
            let (sin, cos) = (f64::from(k) / f64::from(PIECES) * std::f64::consts::TAU).sin_cos();
            self.at(center_m + a * cos + b * sin)
        };
        (0..=PIECES).map(place).collect()
    }
}
