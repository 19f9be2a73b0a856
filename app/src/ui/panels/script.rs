//! The scripted operator: its level of skill, its deliberate mistake, and watching again.

use crate::operator;
use crate::ui::session::Session;
use crate::ui::theme;
use crate::ui::trainer::Script;
use crate::ui::widgets::{call, compact};
use egui::{Align, ComboBox, Layout, Ui};
use haptics::device::Mistake;

/// What stands in the operator's card while the script moves the fingers.
pub fn script(ui: &mut Ui, session: &mut Session) {
    let before = session.trainer.script.clone();
    let possible = session.trainer.scene().map(|(_, world)| operator::mistakes_in(world)).unwrap_or_default();
    let mut wanted = before.clone();
    labelled(ui, "Skill", |ui| level(ui, &mut wanted));
    let none_here = possible.is_empty();
    labelled(ui, "Mistake", |ui| {
        if none_here {
            ui.label(theme::caption(ui, "none in this world"));
        } else {
            mistake(ui, &mut wanted, &possible);
        }
    });
    let over = session.trainer.performance_over();
    let mut again = wanted != before;
    session.trainer.script = wanted;
    compact(ui, |ui| {
        let text = if over { "Done." } else { "Works and trembles like a person." };
        ui.label(theme::caption(ui, text));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            again |= ui.link("Watch again").on_hover_text("Starts over with other small errors").clicked();
        });
    });
    if again && let Err(problem) = session.trainer.restart() {
        session.fail(problem);
    }
}

fn labelled(ui: &mut Ui, label: &str, contents: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        ui.label(theme::caption(ui, label));
        ui.with_layout(Layout::right_to_left(Align::Center), contents);
    });
}

fn level(ui: &mut Ui, script: &mut Script) {
    let shown = operator::LEVELS.iter().find(|(name, ..)| *name == script.level).map_or("", |(_, shown, _)| shown);
    let list = ComboBox::from_id_salt("skill").selected_text(shown).width(190.0).show_ui(ui, |ui| {
        for (name, shown, hint) in operator::LEVELS {
            ui.selectable_value(&mut script.level, name, shown).on_hover_text(hint);
        }
    });
    call(&list.response, "How well it does it");
}

fn mistake(ui: &mut Ui, script: &mut Script, possible: &[Mistake]) {
    let chosen = script.mistake.filter(|mistake| possible.contains(mistake));
    let shown = chosen.map_or("None", |mistake| operator::mistake_words(mistake).0);
    let list = ComboBox::from_id_salt("mistake").selected_text(shown).width(190.0).show_ui(ui, |ui| {
        ui.selectable_value(&mut script.mistake, None, "None").on_hover_text("Does it as well as it can");
        for mistake in possible {
            let (shown, hint) = operator::mistake_words(*mistake);
            ui.selectable_value(&mut script.mistake, Some(*mistake), shown).on_hover_text(hint);
        }
    });
    call(&list.response, "Mistake");
}
