//! The progress of the tour.

use crate::ui::kit::theme;
use crate::ui::kit::theme::space;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use egui::{Color32, Order, Rect, Stroke, StrokeKind, vec2};

/// Width of a card.
pub(crate) const WIDTH: f32 = 340.0;

pub(crate) struct Step {
    pub(crate) title: &'static str,
    pub(crate) text: &'static str,
    pub(crate) at: Option<(Workspace, PanelId)>,
}

pub(crate) const STEPS: [Step; 7] = [
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
        text: "Drop a log anywhere on the window: CSV, MCAP, Parquet or MATLAB. Columns with foreign names are asked about once.",
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

/// Progress of a user in the tour.
#[derive(Debug, Default)]
pub struct Tour {
    pub(crate) step: Option<usize>,
    /// The workspace that was open before.
    pub(crate) before: Option<Workspace>,
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

/// Everything but one place in the dark.
pub(crate) fn shade(ctx: &egui::Context, about: Option<Rect>) {
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
pub(crate) fn beside(about: Rect, whole: Rect) -> egui::Pos2 {
    let wide = WIDTH + 2.0 * space::L + 16.0;
    if about.right() + wide < whole.right() {
        about.right_top() + vec2(16.0, 8.0)
    } else if about.left() - wide > whole.left() {
        about.left_top() + vec2(-wide, 8.0)
    } else {
        about.center() - vec2(0.5 * wide, 90.0)
    }
}
