//! The devices page, right column: data received from the boards or over the network, and faults in it.

use crate::boards::{ADVICE, Answers};
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::widgets::{fact, plain_card, remark};
use crate::ui::train::trainer::hand::Steering;
use crate::ui::train::trainer::live::Trainer;
use egui::Ui;
use haptics::device::haply::Tally;
use haptics::device::udp::{Refused, UdpMonitor};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const PACKETS: &str = "Packets";
    pub const LISTENS_AT: &str = "Listens at";
    pub const SESSIONS_ASKED_FOR: &str = "Sessions asked for";
    pub const TAKEN: &str = "Taken";
    pub const REFUSED: &str = "Refused";
    pub const SOMEBODY_SENDS_WITH_ANOTHER: &str = "Somebody sends with another key: give both sides the same file.";
    pub const ANSWERS_OF_THE_BOARDS: &str = "Answers of the boards";
    pub const LEFT: &str = "Left";
    pub const RIGHT: &str = "Right";
    pub const WITHOUT_CABLE: &str = "A cable was pulled";
    pub const PLUG_IN: &str = "plug it in and lay its arm where it rests, as at the start. Then let it be set up: it takes the pose it is in for that one.";
    pub const SET_UP: &str = "The arm rests: set it up";
    pub const LOOKING: &str = "Looking for the board at its port …";
}

/// Card of the running device; nothing for devices without a lossy connection.
pub fn answers(ui: &mut Ui, trainer: &Trainer) {
    match &trainer.steering {
        Steering::Udp(monitor) => packets(ui, monitor),
        Steering::Haply(tallies) => {
            boards(ui, tallies.each_ref().map(Answers::from));
            unplugged(ui, tallies);
        }
        _ => {}
    }
}

fn packets(ui: &mut Ui, monitor: &UdpMonitor) {
    plain_card(ui, words::PACKETS, |ui| {
        fact(ui, words::LISTENS_AT, monitor.address().to_string());
        fact(ui, words::SESSIONS_ASKED_FOR, monitor.greeted().to_string());
        fact(ui, words::TAKEN, monitor.accepted().to_string());
        let refused: u64 = Refused::ALL.into_iter().map(|why| monitor.refused(why)).sum();
        fact(ui, words::REFUSED, refused.to_string());
        for why in Refused::ALL.into_iter().filter(|why| monitor.refused(*why) > 0) {
            fact(ui, &format!("   {}", why.words()), monitor.refused(why).to_string());
        }
        if monitor.refused(Refused::Seal) > 0 {
            let text = words::SOMEBODY_SENDS_WITH_ANOTHER;
            remark(ui, Icon::Doubt, text);
        }
    });
}

/// Advice for a board whose cable was pulled; nothing while both are connected.
pub fn unplugged(ui: &mut Ui, tallies: &[Tally; 2]) {
    if !tallies.iter().any(Tally::is_unplugged) {
        return;
    }
    plain_card(ui, words::WITHOUT_CABLE, |ui| {
        for (side, tally) in [words::LEFT, words::RIGHT].into_iter().zip(tallies).filter(|(_, t)| t.is_unplugged()) {
            remark(ui, Icon::Doubt, format!("{side}: {}", words::PLUG_IN));
            if tally.is_looked_for() {
                ui.label(theme::caption(ui, words::LOOKING));
            } else if ui.push_id(side, |ui| ui.button(words::SET_UP)).inner.clicked() {
                tally.arm_rests();
            }
        }
    });
}

/// Answers of two boards, left and right.
pub fn boards(ui: &mut Ui, both: [Answers; 2]) {
    plain_card(ui, words::ANSWERS_OF_THE_BOARDS, |ui| {
        for (side, answers) in [words::LEFT, words::RIGHT].into_iter().zip(both) {
            let mark = if answers.are_fine() { Icon::Good } else { Icon::Doubt };
            remark(ui, mark, format!("{side}: {}.", answers.sentence()));
        }
        if both.iter().any(|answers| !answers.are_fine()) {
            ui.label(theme::caption(ui, ADVICE));
        }
    });
}
