//! The scripted operator: its skill level, its deliberate mistake, and replaying it.

use crate::operator;
use crate::ui::kit::theme;
use crate::ui::kit::widgets::{call, compact};
use crate::ui::shell::message_list::Messages;
use crate::ui::train::trainer::live::Trainer;
use crate::ui::train::trainer::script::Script;
use egui::{Align, ComboBox, Layout, Ui};
use haptics::device::Mistake;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const SKILL: &str = "Skill";
    pub const MISTAKE: &str = "Mistake";
    pub const NONE_IN_THIS_WORLD: &str = "none in this world";
    pub const DONE: &str = "Done.";
    pub const WORKS_LIKE_A_PERSON: &str = "Works and trembles like a person.";
    pub const WATCH_AGAIN: &str = "Watch again";
    pub const WATCH_AGAIN_MORE: &str = "Starts over with other small errors";
    pub const SKILL_MORE: &str = "How well it does it";
    pub const NONE: &str = "None";
    pub const NO_MISTAKE_MORE: &str = "Does it as well as it can";
}

/// Content of the operator's card while the script moves the fingers.
pub fn script(ui: &mut Ui, trainer: &mut Trainer, messages: &mut Messages) {
    let before = trainer.script.clone();
    let possible = trainer.scene().map(|(_, world)| operator::mistakes_in(world)).unwrap_or_default();
    let mut wanted = before.clone();
    labelled(ui, words::SKILL, |ui| level(ui, &mut wanted));
    let none_here = possible.is_empty();
    labelled(ui, words::MISTAKE, |ui| {
        if none_here {
            ui.label(theme::caption(ui, words::NONE_IN_THIS_WORLD));
        } else {
            mistake(ui, &mut wanted, &possible);
        }
    });
    let over = trainer.performance_over();
    let mut again = wanted != before;
    trainer.script = wanted;
    compact(ui, |ui| {
        let text = if over { words::DONE } else { words::WORKS_LIKE_A_PERSON };
        ui.label(theme::caption(ui, text));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            again |= ui.link(words::WATCH_AGAIN).on_hover_text(words::WATCH_AGAIN_MORE).clicked();
        });
    });
    if again && let Err(problem) = trainer.restart() {
        messages.fail(problem);
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
    call(&list.response, words::SKILL_MORE);
}

fn mistake(ui: &mut Ui, script: &mut Script, possible: &[Mistake]) {
    let chosen = script.mistake.filter(|mistake| possible.contains(mistake));
    let shown = chosen.map_or(words::NONE, |mistake| operator::mistake_words(mistake).0);
    let list = ComboBox::from_id_salt("mistake").selected_text(shown).width(190.0).show_ui(ui, |ui| {
        ui.selectable_value(&mut script.mistake, None, words::NONE).on_hover_text(words::NO_MISTAKE_MORE);
        for mistake in possible {
            let (shown, hint) = operator::mistake_words(*mistake);
            ui.selectable_value(&mut script.mistake, Some(*mistake), shown).on_hover_text(hint);
        }
    });
    call(&list.response, words::MISTAKE);
}
