//! The devices page, right column: what came from the boards or over the network, and what was wrong with it.

use crate::boards::{ADVICE, Answers};
use crate::ui::icons::Icon;
use crate::ui::theme;
use crate::ui::trainer::{Steering, Trainer};
use crate::ui::widgets::{fact, plain_card, remark};
use egui::Ui;
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
            remark(ui, Icon::Doubt, text);
        }
    });
}

/// What two boards have answered, left and right.
pub fn boards(ui: &mut Ui, both: [Answers; 2]) {
    plain_card(ui, "Answers of the boards", |ui| {
        for (side, answers) in ["Left", "Right"].into_iter().zip(both) {
            let mark = if answers.are_fine() { Icon::Good } else { Icon::Doubt };
            remark(ui, mark, format!("{side}: {}.", answers.sentence()));
        }
        if both.iter().any(|answers| !answers.are_fine()) {
            ui.label(theme::caption(ui, ADVICE));
        }
    });
}
