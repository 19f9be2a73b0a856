//! The devices page, left column: all devices for the fingers, one per line, to choose from.

use crate::ui::devices::panels::device_row::{Choice, row};
use crate::ui::devices::panels::remote::RemoteCard;
use crate::ui::document::state::Document;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::space;
use crate::ui::kit::widgets::{card, plain_card};
use crate::ui::session::Session;
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::panel::{Panel, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::trainer::hand::HandDevice;
use crate::ui::train::trainer::live::{Operator, Trainer};
use egui::{ScrollArea, Ui};
use haptics::device::haply;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const BUILT_IN: &str = "Built in";
    pub const OPEN_A_LOG: &str = "Open a log in Calibrate first.";
    pub const NO_PORT_FOUND: &str = "no port found";
    pub const ONE_PORT_FOUND: &str = "1 port found";
    pub const HAPLY_2DIY_BOARDS: &str = "Haply 2DIY boards";
    pub const TWO_BOARDS_MAKE: &str = "Two boards make two fingers. Plug them in over USB; on Linux your user \
        must be in the group dialout. They are found by themselves.";
}

/// Interval between scans for ports.
const LOOK_AGAIN: Duration = Duration::from_secs(2);

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Devices, 0)],
    at_the_left: true,
    ..Registration::new(PanelId::DEVICES, "Devices", Icon::Device, || Box::new(DeviceList::default()))
};

/// The list of devices.
#[derive(Default)]
pub struct DeviceList {
    ports: Vec<String>,
    looked_at: Option<Instant>,
    remote: RemoteCard,
}

impl Panel for DeviceList {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        self.look_for_ports(ui);
        let mut chosen = None;
        ScrollArea::vertical().id_salt("devices").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = space::S;
            plain_card(ui, words::BUILT_IN, |ui| {
                for hand in [HandDevice::Mouse, HandDevice::Touch, HandDevice::Keyboard] {
                    chosen = chosen.take().or(row(ui, &session.training.trainer, Choice::Hand(hand), Ok(())));
                }
                #[cfg(feature = "gamepad")]
                {
                    chosen =
                        chosen.take().or(row(ui, &session.training.trainer, Choice::Hand(HandDevice::Gamepad), Ok(())));
                }
                chosen = chosen.take().or(row(ui, &session.training.trainer, Choice::Scripted, Ok(())));
                let log = session.document.prepared().map(drop).ok_or(words::OPEN_A_LOG);
                chosen = chosen.take().or(row(ui, &session.training.trainer, Choice::Hand(HandDevice::Replay), log));
            });
            chosen = chosen.take().or(self.boards(ui, &session.training.trainer));
            chosen = chosen.take().or(self.remote.ui(ui, &mut session.training.trainer));
        });
        if let Some(choice) = chosen {
            take(&session.document, &mut session.training.trainer, &mut session.messages, choice);
        }
    }
}

impl DeviceList {
    fn look_for_ports(&mut self, ui: &Ui) {
        if self.looked_at.is_none_or(|at| at.elapsed() > LOOK_AGAIN) {
            self.ports = haply::ports();
            self.looked_at = Some(Instant::now());
        }
        ui.ctx().request_repaint_after(LOOK_AGAIN);
    }

    fn boards(&self, ui: &mut Ui, trainer: &Trainer) -> Option<Choice> {
        let found = match self.ports.len() {
            0 => words::NO_PORT_FOUND.to_owned(),
            1 => words::ONE_PORT_FOUND.to_owned(),
            many => format!("{many} ports found"),
        };
        let mut chosen = None;
        card(
            ui,
            words::HAPLY_2DIY_BOARDS,
            |ui| drop(ui.label(theme::caption(ui, found))),
            |ui| {
                // Any port may be the left board: both orders are offered.
                for left in &self.ports {
                    for right in self.ports.iter().filter(|right| *right != left) {
                        let hand = HandDevice::Haply(left.clone(), right.clone());
                        chosen = chosen.take().or(row(ui, trainer, Choice::Hand(hand), Ok(())));
                    }
                }
                if self.ports.len() < 2 {
                    let text = words::TWO_BOARDS_MAKE;
                    ui.label(theme::caption(ui, text));
                }
            },
        );
        chosen
    }
}

/// Restarts the engine with the device; a problem is reported.
fn take(document: &Document, trainer: &mut Trainer, messages: &mut Messages, choice: Choice) {
    let log = document.prepared().map(|prepared| Arc::new(prepared.recording.clone()));
    let taken = match choice {
        Choice::Hand(hand) => {
            trainer.settings.log = log;
            trainer.take_up(hand)
        }
        Choice::Scripted => trainer.hand_to(Operator::Scripted),
    };
    if let Err(problem) = taken {
        messages.fail(problem);
    }
}
