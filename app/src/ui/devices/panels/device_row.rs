//! One device of the list, as a clickable line.

use crate::ui::kit::theme;
use crate::ui::kit::theme::palette;
use crate::ui::train::trainer::hand::HandDevice;
use crate::ui::train::trainer::live::{Operator, Trainer};
use egui::{CornerRadius, Frame, Margin, RichText, Sense, Stroke, Ui};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const SCRIPTED_OPERATOR: &str = "Scripted operator";
    pub const SCRIPTED_OPERATOR_MORE: &str =
        "Does the task of the world like a person: reaches, trembles, reacts late.";
}

/// Request of a click.
#[derive(Clone, PartialEq)]
pub(crate) enum Choice {
    Hand(HandDevice),
    Scripted,
}

/// Draws one device as a clickable line. Returns its choice when it was clicked.
pub(crate) fn row(ui: &mut Ui, trainer: &Trainer, choice: Choice, ready: Result<(), &str>) -> Option<Choice> {
    let p = palette(ui);
    let (title, sentence) = match &choice {
        Choice::Hand(hand) => (hand.title(), hand.sentence()),
        Choice::Scripted => (words::SCRIPTED_OPERATOR.to_owned(), words::SCRIPTED_OPERATOR_MORE),
    };
    let active = match &choice {
        Choice::Hand(hand) => trainer.operator == Operator::You && trainer.hand == *hand,
        Choice::Scripted => trainer.operator == Operator::Scripted,
    };
    let fill = if active { theme::mix(p.card, p.accent, 0.12) } else { p.sunken };
    let edge = if active { p.accent } else { p.border };
    let text = if ready.is_ok() { p.text } else { p.faint };
    let inner = Frame::new()
        .fill(fill)
        .stroke(Stroke::new(1.0, edge))
        .corner_radius(CornerRadius::same(6))
        .inner_margin(Margin::symmetric(10, 5))
        .show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.spacing_mut().item_spacing.y = 2.0;
            ui.add(egui::Label::new(theme::strong(title.clone()).color(text)).selectable(false));
            let under = ready.err().unwrap_or(sentence);
            ui.add(egui::Label::new(RichText::new(under).size(11.5).color(p.secondary)).selectable(false).wrap());
        });
    let response = ui.interact(inner.response.rect, ui.scope_id().with(("device", &title)), Sense::click());
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::RadioButton, ready.is_ok(), active, &title));
    (response.clicked() && ready.is_ok() && !active).then_some(choice)
}
