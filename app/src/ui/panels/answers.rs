//! The devices page, right column: what came from the boards or over the network, and what was wrong with it.

use crate::boards::{ADVICE, Answers};
use crate::ui::theme::{self, palette};
use crate::ui::trainer::{Steering, Trainer};
use crate::ui::widgets::{fact, plain_card};
use egui::{RichText, Ui};
use haptics::device::udp::{Refused, UdpMonitor};

/// The card of the running device; nothing for those that cannot lose anything.
pub fn answers(ui: &mut Ui, trainer: &Trainer) {
    match &trainer.steering {
        Steering::Udp(monitor) => packets(ui, monitor),
        Steering::Haply(tallies) => boards(ui, tallies.each_ref().map(Answers::from)),
        _ => {}
    }
}

fn packets(ui: &mut Ui, monitor: &UdpMonitor) {
    plain_card(ui, "Packets", |ui| {
        fact(ui, "Listens at", monitor.address().to_string());
        fact(ui, "Sessions asked for", monitor.greeted().to_string());
        fact(ui, "Taken", monitor.accepted().to_string());
        let refused: u64 = Refused::ALL.into_iter().map(|why| monitor.refused(why)).sum();
        fact(ui, "Refused", refused.to_string());
        for why in Refused::ALL.into_iter().filter(|why| monitor.refused(*why) > 0) {
            fact(ui, &format!("   {}", why.words()), monitor.refused(why).to_string());
        }
        if monitor.refused(Refused::Seal) > 0 {
            let text = "Somebody sends with another key: give both sides the same file.";
            ui.label(RichText::new(text).size(11.5).color(palette(ui).caution));
        }
    });
}

/// What two boards have answered, left and right.
pub fn boards(ui: &mut Ui, both: [Answers; 2]) {
    plain_card(ui, "Answers of the boards", |ui| {
        for (side, answers) in ["Left", "Right"].into_iter().zip(both) {
            let p = palette(ui);
            let color = if answers.are_fine() { p.secondary } else { p.caution };
            ui.label(RichText::new(format!("{side}: {}.", answers.sentence())).size(11.5).color(color));
        }
        if both.iter().any(|answers| !answers.are_fine()) {
            ui.label(theme::caption(ui, ADVICE));
        }
    });
}
