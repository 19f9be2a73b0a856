//! Shown around: what is where, in a few cards, the first time and whenever it is asked for.

use super::app::App;
use super::icons::Icon;
use super::panel_id::PanelId;
use super::theme::{self, palette, space};
use super::widgets::primary_button;
use crate::ui::workspace::Workspace;
use egui::{Align2, Area, Color32, Frame, Key, Order, Rect, RichText, Stroke, StrokeKind, Ui, vec2};

/// Width of a card.
const WIDTH: f32 = 340.0;

struct Step {
    title: &'static str,
    text: &'static str,
    at: Option<(Workspace, PanelId)>,
}

const STEPS: [Step; 7] = [
    Step {
        title: "Touchstone",
        text: "Objects are measured from recordings of a haptic hand, and then felt. Four workspaces: touch, measure, find out what the \
               model gets wrong, and look after the device.",
        at: None,
    },
    Step {
        title: "Touch",
        text: "The mouse moves the hand; hold the button to pinch, and lift. The wheel changes how hard. Record what you do to measure \
               the object from it.",
        at: Some((Workspace::Train, PanelId::TRAINER)),
    },
    Step {
        title: "Open a recording",
        text: "Drop a log anywhere on the window: CSV, MCAP or Parquet. Columns with foreign names are asked about once.",
        at: Some((Workspace::Calibrate, PanelId::RECORDING)),
    },
    Step {
        title: "See what happened",
        text: "Plots share one time. The coloured band tells the states: drag a boundary, or right-click a state, and the fit follows.",
        at: Some((Workspace::Calibrate, PanelId::LOG)),
    },
    Step {
        title: "Measured values",
        text: "Every number comes with its error, or with the reason why the recording cannot show it. Click one to try another value \
               on the replay, to freeze it, or to state what you knew before.",
        at: Some((Workspace::Calibrate, PanelId::RESULTS)),
    },
    Step {
        title: "What the model gets wrong",
        text: "A diagnosis compares the model with what was measured, names the cause, extends the model and measures the gain on data \
               that took no part. Then feel the difference.",
        at: Some((Workspace::Diagnose, PanelId::DIAGNOSE)),
    },
    Step {
        title: "Everything by its name",
        text: "Ctrl+P finds every command. Ctrl+Z takes back. View, Arrange panels moves panels to where you want them. F1 shows this again.",
        at: None,
    },
];

/// Where in the tour somebody is.
#[derive(Debug, Default)]
pub struct Tour {
    step: Option<usize>,
    /// The workspace that was open before.
    before: Option<Workspace>,
    /// It was seen to its end, or left.
    pub seen: bool,
}

impl Tour {
    /// From the first card.
    pub fn begin(&mut self) {
        *self = Self { step: Some(0), before: None, seen: self.seen };
    }

    /// From a card in the middle.
    pub fn begin_at(&mut self, step: usize) {
        *self = Self { step: Some(step.min(STEPS.len() - 1)), before: None, seen: self.seen };
    }

    /// True while a card is shown.
    pub fn is_on(&self) -> bool {
        self.step.is_some()
    }
}

/// Draws the card of the step, and a frame about what it is about.
pub fn show(ui: &Ui, app: &mut App) {
    let Some(index) = app.tour.step else { return };
    let step = &STEPS[index];
    app.tour.before.get_or_insert(app.session.workspace);
    let about = step.at.and_then(|(workspace, pane)| {
        app.session.workspace = workspace;
        app.dock.rect(workspace, pane)
    });
    let ctx = ui.ctx().clone();
    shade(&ctx, about);
    let (mut next, mut back, mut leave) = (false, false, false);
    let area = Area::new(egui::Id::unique("tour")).order(Order::Foreground);
    let area = match about {
        Some(rect) => area.fixed_pos(beside(rect, ctx.content_rect())),
        None => area.anchor(Align2::CENTER_CENTER, [0.0, 0.0]),
    };
    area.show(&ctx, |ui| {
        let p = palette(ui);
        let frame = Frame::popup(ui.style()).inner_margin(space::L).stroke(Stroke::new(1.0, p.accent));
        frame.show(ui, |ui| {
            ui.set_width(WIDTH);
            ui.label(theme::title(step.title));
            ui.add_space(space::XS);
            ui.label(RichText::new(step.text).color(p.secondary));
            ui.add_space(space::M);
            ui.horizontal(|ui| {
                let last = index + 1 == STEPS.len();
                next =
                    primary_button(ui, true, if last { (Icon::Good, "Done") } else { (Icon::Next, "Next") }).clicked();
                back = index > 0 && ui.button((Icon::Back, "Back")).clicked();
                leave = !last && ui.link("Leave").clicked();
                ui.label(theme::caption(ui, format!("{} of {}", index + 1, STEPS.len())));
            });
        });
    });
    ctx.input(|i| {
        next |= i.key_pressed(Key::Enter) || i.key_pressed(Key::ArrowRight);
        back |= i.key_pressed(Key::ArrowLeft);
        leave |= i.key_pressed(Key::Escape);
    });
    let to = if next {
        Some(index + 1)
    } else if back {
        Some(index.saturating_sub(1))
    } else {
        Some(index)
    };
    app.tour.step = to.filter(|to| *to < STEPS.len() && !leave);
    if app.tour.step.is_none() {
        app.tour.seen = true;
        app.session.workspace = app.tour.before.take().unwrap_or_default();
    }
}

/// Everything but one place in the dark.
fn shade(ctx: &egui::Context, about: Option<Rect>) {
    let painter = ctx.layer_painter(egui::LayerId::new(Order::Middle, egui::Id::unique("tour shade")));
    let (whole, dark) = (ctx.content_rect(), Color32::from_black_alpha(110));
    let Some(light) = about else {
        painter.rect_filled(whole, 0, dark);
        return;
    };
    let light = light.expand(4.0).intersect(whole);
    let above = Rect::from_min_max(whole.min, egui::pos2(whole.right(), light.top()));
    let below = Rect::from_min_max(egui::pos2(whole.left(), light.bottom()), whole.max);
    let left = Rect::from_min_max(egui::pos2(whole.left(), light.top()), light.left_bottom());
    let right = Rect::from_min_max(light.right_top(), egui::pos2(whole.right(), light.bottom()));
    for part in [above, below, left, right] {
        painter.rect_filled(part, 0, dark);
    }
    let accent = theme::Palette::of(ctx.global_style().visuals.dark_mode).accent;
    painter.rect_stroke(light, 10, Stroke::new(2.0, accent), StrokeKind::Inside);
}

/// Beside what it is about where there is room, else over it.
fn beside(about: Rect, whole: Rect) -> egui::Pos2 {
    let wide = WIDTH + 2.0 * space::L + 16.0;
    if about.right() + wide < whole.right() {
        about.right_top() + vec2(16.0, 8.0)
    } else if about.left() - wide > whole.left() {
        about.left_top() + vec2(-wide, 8.0)
    } else {
        about.center() - vec2(0.5 * wide, 90.0)
    }
}
