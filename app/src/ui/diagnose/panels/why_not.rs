//! *Why not …?*: any cause of the catalogue that was not named, and the evidence against it.

use crate::text::diagnosis_words::{small, title};
use crate::text::format;
use crate::text::sentence::sentence;
use crate::ui::diagnose::state::Diagnosing;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{bar, compact, plain_card};
use egui::{Align, ComboBox, Layout, RichText, Ui};
use estimator::diagnose::Diagnosis;
use haptics::law;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const CARD: &str = "Why not …?";
    pub const CHOOSE_A_CAUSE: &str = "Choose a cause";
    pub const WHY_NOT: &str = "Why not";
    pub const NOTHING_CHOSEN: &str = "Every cause that was not named has its reason.";
    pub const ALONE: &str = "Alone";
    pub const BESIDE_WHAT_WAS_FOUND: &str = "Beside what was found";
    pub const SCORE_MORE: &str = "Score in units of 2 ln(likelihood); the mark is where a cause is named.";
    pub const IT_IS_NOT_LOOKED: &str = "It is not looked for in recordings of this kind.";
}

/// Card below the causes.
pub fn card(ui: &mut Ui, diagnosing: &mut Diagnosing, diagnosis: &Diagnosis) {
    let mut others: Vec<&str> =
        law::causes().map(|c| c.id).filter(|id| diagnosis.causes.iter().all(|c| c.id != *id)).collect();
    others.sort_by_key(|id| title(id));
    plain_card(ui, words::CARD, |ui| {
        let asked = &mut diagnosing.asked_about;
        let shown = asked.as_deref().map_or(words::CHOOSE_A_CAUSE.to_owned(), title);
        let list = ComboBox::from_id_salt("why not").width(ui.available_width() - 22.0).selected_text(shown);
        let list = list.show_ui(ui, |ui| {
            for id in others {
                let mut chosen = asked.as_deref() == Some(id);
                if ui.toggle_value(&mut chosen, title(id)).clicked() {
                    *asked = Some(id.to_owned());
                }
            }
        });
        list.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, words::WHY_NOT));
        let Some(id) = asked.clone().filter(|id| diagnosis.causes.iter().all(|c| c.id != *id)) else {
            ui.label(theme::caption(ui, words::NOTHING_CHOSEN));
            return;
        };
        ui.add_space(space::XS);
        ui.add(egui::Label::new(reason(diagnosis, &id)).wrap());
        if let Some(passed) = diagnosis.passed_over.iter().find(|p| p.id == id) {
            let p = palette(ui);
            let most = passed.alone.max(passed.beside).max(passed.least);
            for (label, score) in [(words::ALONE, passed.alone), (words::BESIDE_WHAT_WAS_FOUND, passed.beside)] {
                compact(ui, |ui| {
                    ui.label(theme::caption(ui, label));
                    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                        ui.label(RichText::new(format::number(score, 0)).size(12.0));
                    });
                });
                bar(ui, score, most, Some(passed.least), if score < passed.least { p.faint } else { p.accent });
            }
            ui.label(theme::caption(ui, words::SCORE_MORE));
        }
        if let Some(entry) = law::cause(&id) {
            ui.label(theme::caption(ui, format!("It would show as {}", small(entry.shows))));
        }
    });
}

/// Reason why a cause was not named, as a sentence.
fn reason(diagnosis: &Diagnosis, id: &str) -> String {
    if let Some(other) = diagnosis.alternatives.iter().find(|a| a.id == id) {
        let share = format::number(100.0 * other.posterior, 0);
        let place = small(&title(&other.instead_of));
        return format!("It could stand in the place of {place} (probability {share} %): {}", other.why) + ".";
    }
    if let Some(hidden) = diagnosis.not_excited.iter().find(|n| n.id == id) {
        return format!("It is not excluded. {}", sentence(&hidden.why));
    }
    match diagnosis.passed_over.iter().find(|p| p.id == id) {
        Some(passed) => sentence(&passed.why),
        None => words::IT_IS_NOT_LOOKED.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::tests::diagnose::{RIPPLED, diagnosed};

    #[test]
    fn every_cause_has_its_reason_and_what_was_named_is_not_asked_about() {
        let session = diagnosed(RIPPLED.clone());
        let diagnosis = &session.diagnosing.answer.as_ref().expect("an answer").diagnosis;
        assert!(diagnosis.passed_over.iter().all(|p| p.id != "position-ripple"), "it was named");
        assert!(diagnosis.passed_over.len() > 5, "{:?}", diagnosis.passed_over);
        for passed in &diagnosis.passed_over {
            let weak = passed.beside < passed.least || passed.why.contains("took no part");
            assert!(weak && passed.why.len() > 20, "{passed:?}");
        }
        for entry in law::causes() {
            let why = reason(diagnosis, entry.id);
            assert!(why.ends_with('.') && why.len() > 20, "{}: {why}", entry.id);
        }
    }
}
