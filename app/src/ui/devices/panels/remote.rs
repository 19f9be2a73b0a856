//! The devices page, left column: settings of a remote device.

use crate::ui::devices::panels::device_row::{Choice, row};
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::space;
use crate::ui::kit::widgets::{plain_card, remark};
use crate::ui::train::trainer::hand::HandDevice;
use crate::ui::train::trainer::live::{Operator, Trainer};
use crate::ui::train::trainer::remote::Remote;
use egui::{TextEdit, Ui, vec2};
use haptics::device::udp::{Key, PORT};
use std::path::Path;
use std::time::{Duration, Instant};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const OVER_THE_NETWORK: &str = "Over the network";
    pub const WAVE_VARIABLES: &str = "Wave variables";
    pub const WAVE_VARIABLES_MORE: &str = "For long or jittering lines: contact stays stable, and is felt softer. \
        The device's program must speak them too (docs/udp).";
    pub const MEND_THE_FIELD: &str = "Mend the field above first.";
    pub const NAME_THE_FILE: &str = "Name the file with the key first.";
    pub const OPEN_AGAIN_WITH_THESE: &str = "Open again with these";
    pub const KEY_FILE: &str = "Key file";
    pub const KEY_FILE_MORE: &str = "A file with the shared key: 64 hexadecimal digits";
    pub const LISTEN_AT: &str = "Listen at";
    pub const LISTEN_AT_MORE: &str = "An address of this machine, with or without a port. To be reached from \
        other machines: that of a network card";
    pub const DAMPING: &str = "Damping, N s/m";
    pub const NOT_KNOWN: &str = "not known";
    pub const DAMPING_MORE: &str = "The device\'s own damping. The stiffness that it can feel safely is computed \
        with it; leave it empty where you do not know it";
    pub const ROUND_TRIP_MS: &str = "Round trip, ms";
    pub const ROUND_TRIP_MS_MORE: &str =
        "From here to the device and back. The longer, the softer the world has to be felt";
}

/// Interval between checks of the key file.
const LOOK_AGAIN: Duration = Duration::from_secs(2);

/// The card of the remote device.
#[derive(Default)]
pub struct RemoteCard {
    /// Fields with which the running device was opened.
    in_use: Option<Remote>,
    doubts: Vec<String>,
    doubted: Option<(String, Instant)>,
}

impl RemoteCard {
    /// Draws the card. Returns the choice when the device was requested.
    pub(crate) fn ui(&mut self, ui: &mut Ui, trainer: &mut Trainer) -> Option<Choice> {
        let mut chosen = None;
        plain_card(ui, words::OVER_THE_NETWORK, |ui| {
            fields(ui, &mut trainer.settings.remote);
            ui.checkbox(&mut trainer.settings.remote.waves, words::WAVE_VARIABLES)
                .on_hover_text(words::WAVE_VARIABLES_MORE);
            let remote = trainer.settings.remote.clone();
            self.doubt(&remote.key);
            for doubt in &self.doubts {
                remark(ui, Icon::Doubt, doubt);
            }
            let problem = remote.problem();
            if let Some(problem) = &problem {
                remark(ui, Icon::Wrong, problem);
            }
            ui.add_space(space::XS);
            let ready = match &problem {
                Some(_) => Err(words::MEND_THE_FIELD),
                None if remote.key.trim().is_empty() => Err(words::NAME_THE_FILE),
                None => Ok(()),
            };
            let choice = Choice::Hand(HandDevice::Udp);
            chosen = row(ui, trainer, choice.clone(), ready);
            let runs = trainer.operator == Operator::You && trainer.hand == HandDevice::Udp;
            if runs && self.in_use.as_ref().is_some_and(|used| *used != remote) {
                let again = egui::Button::new(words::OPEN_AGAIN_WITH_THESE);
                if ui.add_enabled(ready.is_ok(), again).clicked() {
                    chosen = Some(choice);
                }
            }
            if chosen.is_some() || (runs && self.in_use.is_none()) {
                self.in_use = Some(remote);
            }
        });
        chosen
    }

    /// Problem with the key, checked at intervals: the file can change at any time.
    fn doubt(&mut self, key: &str) {
        let known = self.doubted.as_ref().is_some_and(|(of, at)| of == key && at.elapsed() < LOOK_AGAIN);
        if !known {
            let named = !key.trim().is_empty();
            self.doubts = if named { Key::doubts(Path::new(key.trim())) } else { Vec::new() };
            self.doubted = Some((key.to_owned(), Instant::now()));
        }
    }
}

fn fields(ui: &mut Ui, remote: &mut Remote) {
    let address = format!("127.0.0.1:{PORT}");
    let lines: [(&mut String, &str, &str, &str); 4] = [
        (&mut remote.key, words::KEY_FILE, "/path/to/key", words::KEY_FILE_MORE),
        (&mut remote.address, words::LISTEN_AT, &address, words::LISTEN_AT_MORE),
        (&mut remote.damping, words::DAMPING, words::NOT_KNOWN, words::DAMPING_MORE),
        (&mut remote.round_trip, words::ROUND_TRIP_MS, "0", words::ROUND_TRIP_MS_MORE),
    ];
    egui::Grid::new("remote").num_columns(2).spacing(vec2(space::S, space::XS)).show(ui, |ui| {
        for (text, label, hint, tip) in lines {
            let name = ui.label(theme::caption(ui, label)).on_hover_text(tip);
            let field = TextEdit::singleline(text).hint_text(hint).desired_width(f32::INFINITY);
            ui.add(field).labelled_by(name.id).on_hover_text(tip);
            ui.end_row();
        }
    });
}
