//! The devices page, left column: what has to be known of a remote device.

use super::devices::{Choice, row};
use crate::ui::icons::Icon;
use crate::ui::session::Session;
use crate::ui::theme::{self, space};
use crate::ui::trainer::{HandDevice, Operator, Remote};
use crate::ui::widgets::{plain_card, remark};
use egui::{TextEdit, Ui, vec2};
use haptics::device::udp::{Key, PORT};
use std::path::Path;
use std::time::{Duration, Instant};

/// The key file is looked at this often.
const LOOK_AGAIN: Duration = Duration::from_secs(2);

/// The card of the remote device.
#[derive(Default)]
pub struct RemoteCard {
    /// The fields that the running device was opened with.
    in_use: Option<Remote>,
    doubts: Vec<String>,
    doubted: Option<(String, Instant)>,
}

impl RemoteCard {
    /// Draws it; the choice when the device was asked for.
    pub(super) fn ui(&mut self, ui: &mut Ui, session: &mut Session) -> Option<Choice> {
        let mut chosen = None;
        plain_card(ui, "Over the network", |ui| {
            fields(ui, &mut session.trainer.settings.remote);
            ui.checkbox(&mut session.trainer.settings.remote.waves, "Wave variables").on_hover_text(
                "For long or jittering lines: contact stays stable, and is felt softer. The device's program must speak them too \
                 (docs/udp).",
            );
            let remote = session.trainer.settings.remote.clone();
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
                Some(_) => Err("Mend the field above first."),
                None if remote.key.trim().is_empty() => Err("Name the file with the key first."),
                None => Ok(()),
            };
            let choice = Choice::Hand(HandDevice::Udp);
            chosen = row(ui, session, choice.clone(), ready);
            let trainer = &session.trainer;
            let runs = trainer.operator == Operator::You && trainer.hand == HandDevice::Udp;
            if runs && self.in_use.as_ref().is_some_and(|used| *used != remote) {
                let again = egui::Button::new("Open again with these");
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

    /// What is to be doubted about the key, looked up now and then: the file can change at any time.
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
        (&mut remote.key, "Key file", "/path/to/key", "A file with the shared key: 64 hexadecimal digits"),
        (
            &mut remote.address,
            "Listen at",
            &address,
            "An address of this machine, with or without a port. To be reached from other machines: that of a network card",
        ),
        (
            &mut remote.damping,
            "Damping, N s/m",
            "not known",
            "The device\'s own damping. The stiffness that it can feel safely is computed with it; leave it empty where you do \
             not know it",
        ),
        (
            &mut remote.round_trip,
            "Round trip, ms",
            "0",
            "From here to the device and back. The longer, the softer the world has to be felt",
        ),
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
