//! The virtual world, touched with the mouse.

use crate::ui::diagnose::experiment_state::Experiments;
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::stage;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{empty_state, key_hint, sheet};
use crate::ui::scene::camera_rig::Rig;
use crate::ui::scene::view::{SceneResponse, Wheel, scene_view};
use crate::ui::session::Session;
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::panel::{Framing, PANEL, Panel, Picture, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::assistant::draw;
use crate::ui::train::panels::{guide, lessons, overlay_marks, touch_and_keys};
use crate::ui::train::state::Training;
use crate::ui::train::trainer::hand::{HandDevice, Steering};
use crate::ui::train::trainer::live::{Clock, Operator, Trainer};
use crate::ui::train::trainer::task::task_hint;
use egui::{Align, CursorIcon, Key, Rect, Ui, UiBuilder, pos2};
use haptics::Vec2;
use render::{Camera, ViewOptions};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const NO_SERVO: &str = "The servo is not running";
    pub const NO_SERVO_MORE: &str = "See the message above; then choose a world again.";
    pub const MOUSE: &str = "Mouse";
    pub const MOVES_THE_FINGERS: &str = "moves the fingers";
    pub const RIGHT_BUTTON: &str = "Right button";
    pub const WHEEL: &str = "Wheel";
    pub const LEFT_DRAG: &str = "Left drag";
    pub const TURNS_THE_VIEW: &str = "turns the view";
    pub const STARTS_OVER: &str = "starts over";
    pub const ARROWS: &str = "Arrows";
    pub const SPACE: &str = "Space";
    pub const PINCHES_AND_HOLDS: &str = "pinches and holds";
    pub const LEFT_BUTTON: &str = "Left button";
    pub const RIGHT_DRAG: &str = "Right drag";
    pub const TWO_FINGERS: &str = "Two fingers";
    pub const ON_THE_GLASS: &str = "on the glass are the two fingertips";
    pub const TOGETHER: &str = "Together";
    pub const BACKSPACE: &str = "Backspace";
    pub const SHIFT: &str = "Shift";
    #[cfg(feature = "gamepad")]
    pub const LEFT_STICK: &str = "Left stick";
    #[cfg(feature = "gamepad")]
    pub const TRIGGERS: &str = "Triggers";
    #[cfg(feature = "gamepad")]
    pub const CLOSE_AND_OPEN: &str = "close and open";
    pub const YOUR_DEVICE: &str = "Your device";
    pub const CTRL_4: &str = "Ctrl 4";
    pub const DEVICE_PAGE: &str = "device page";
    pub const SCRIPT_DONE: &str = "The scripted operator is done.";
    pub const SCRIPT_WORKS: &str = "The scripted operator at work";
    pub const THE_REPLAY_IS_OVER: &str = "The replay is over.";
    pub const REPLAY_OF_THE_OPEN: &str = "Replay of the open log";
}

/// Speed of the fingers by the arrow keys, m/s.
const KEY_SPEED_M_S: f64 = 0.04;
/// Change of pinch force per point of scrolling, N.
const WHEEL_N: f64 = 0.004;

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Train, 0)],
    at_the_left: true,
    pictures: &[&TRAINER, &DELAY, &ASSISTANT, &GUIDED],
    ..Registration::new(PanelId::TRAINER, "Virtual world", Icon::World, || Box::new(TrainerView::default()))
};

/// The virtual world.
pub static TRAINER: Picture = Picture {
    name: "trainer",
    place: 80,
    help: "The virtual world",
    line: "The virtual world, touched by the scripted operator",
    size: PANEL,
    sample: Sample::World("stack"),
    session: stage::trainer,
    framing: Framing::Panel(|| Box::new(TrainerView::default())),
};

/// The virtual world over half a second, on a model.
pub static DELAY: Picture = Picture {
    name: "delay",
    place: 90,
    help: "The virtual world over half a second, on a model",
    line: "Over half a second: the model under the hand solid, the far world a ghost",
    size: PANEL,
    sample: Sample::World("stack"),
    session: stage::delay,
    framing: Framing::Panel(|| Box::new(TrainerView::default())),
};

/// The assistant over the virtual world.
pub static ASSISTANT: Picture = Picture {
    name: "assistant",
    place: 100,
    help: "The assistant over the virtual world",
    line: "The assistant: what is held, what may be in it, and the cable that holds it",
    size: PANEL,
    sample: Sample::World("table"),
    session: stage::assistant,
    framing: Framing::Panel(|| Box::new(TrainerView::default())),
};

/// Picture of the requested experiment, half done by hand in the virtual world.
pub static GUIDED: Picture = Picture {
    name: "guided",
    place: 200,
    help: "That experiment done by hand in the virtual world, half done",
    line: "An experiment done by hand in Train: two rings to follow",
    size: PANEL,
    sample: Sample::Askew,
    session: stage::guided,
    framing: Framing::LargePanel(|| Box::new(TrainerView::default())),
};

/// Picture of the trainer, and its mouse control.
pub struct TrainerView {
    rig: Rig,
    /// True if the window had the focus in the previous frame.
    had_focus: bool,
    #[cfg(feature = "sound")]
    sound: Option<Result<crate::ui::kit::sound::Sound, String>>,
}

impl Default for TrainerView {
    fn default() -> Self {
        Self {
            rig: Rig::new(home()),
            had_focus: false,
            #[cfg(feature = "sound")]
            sound: None,
        }
    }
}

/// Camera that shows the whole hand, with fingers and objects as large as possible.
fn home() -> Camera {
    Camera { pitch_rad: 0.16, ..Camera::hand() }.framing([-0.094, -0.142].into(), [0.094, 0.014].into())
}

impl Panel for TrainerView {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        // The window's first frame comes before the servo, which occupies a processor.
        if session.training.trainer.clock == Clock::RealTime && ui.ctx().cumulative_frame_nr() == 0 {
            ui.ctx().request_repaint();
            sheet(ui).show(ui, |ui| ui.set_min_size(ui.available_size()));
            return;
        }
        if let Err(problem) = session.training.trainer.ensure_running() {
            session.messages.fail(problem);
        }
        crate::ui::train::panels::before_after::key(ui, &mut session.training.trainer, &mut session.messages);
        let has_focus = ui.input(|i| i.focused);
        // Without a window manager nothing ever has the focus, so none can be lost.
        if std::mem::replace(&mut self.had_focus, has_focus) && !has_focus && session.training.comfort.pauses {
            session.training.trainer.lose_focus();
        }
        self.rig.turned_by = session.training.comfort.turns();
        let frame_s = f64::from(ui.input(|i| i.stable_dt));
        session.training.trainer.update(frame_s);
        #[cfg(feature = "sound")]
        self.knock(&mut session.training, &mut session.messages);
        sheet(ui).show(ui, |ui| {
            ui.set_min_size(ui.available_size());
            let Some((snapshot, world)) = session.training.trainer.scene() else {
                empty_state(ui, (Icon::Doubt, words::NO_SERVO), words::NO_SERVO_MORE, |_| {});
                return;
            };
            let limit = session.training.trainer.config().limits.max_force_n;
            let trainer = &session.training.trainer;
            let state = trainer.seen().unwrap_or(&snapshot.state).clone();
            let saturated = state.tip_force_n.map(|f| f.norm() > limit);
            // The remote world is shown as a ghost behind the model; without a model only its delayed picture is shown.
            let ghost = trainer.view().filter(|view| view.predicted).map(|view| view.there.clone());
            let options = ViewOptions { saturated, ghost, ..ViewOptions::default() };
            let scene = (std::sync::Arc::clone(world), state, options);
            let fault = snapshot.fault;
            let view = scene_view(ui, "trainer", &mut self.rig, Wheel::ZoomsWithCtrl, scene);
            session.training.trainer_place = Some(view.place(ui));
            over(ui, &view, &session.experiments, &session.training);
            if session.training.trainer.held().is_some() {
                crate::ui::train::panels::comfort::paused(ui, view.rect, &mut session.training.trainer);
            } else {
                operate(ui, &view, &session.experiments, &mut session.training, &mut session.messages, frame_s);
                guide::card(ui, &view, session);
            }
            if let Some(fault) = fault {
                session.messages.fail(fault);
            }
        });
        if session.training.trainer.is_moving() {
            ui.ctx().request_repaint();
        } else {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(66));
        }
    }
}

/// Lets the trainee steer the fingers, or names the operator that does.
fn operate(
    ui: &mut Ui,
    view: &SceneResponse,
    experiments: &Experiments,
    training: &mut Training,
    messages: &mut Messages,
    frame_s: f64,
) {
    if training.trainer.operator != Operator::You || training.trainer.hand == HandDevice::Replay {
        let hint = lessons::hint(training);
        pill(ui, view.rect, hint.as_deref().unwrap_or_else(|| watching(&training.trainer)));
        return;
    }
    if let Err(problem) = touch_and_keys::touches(ui, view, &mut training.trainer) {
        messages.fail(problem);
    }
    touch_and_keys::keys(ui, &mut training.trainer);
    if matches!(training.trainer.steering, Steering::Mouse(_)) {
        steer(ui, view, training, frame_s);
    }
    hints(ui, view.rect, &training.trainer.hand, training.comfort.left_handed);
    if let Some(hint) = lessons::hint(training) {
        pill(ui, view.rect, &hint);
    } else if let Some((_, world)) = training.trainer.scene().filter(|_| experiments.guided.is_none()) {
        pill(ui, view.rect, task_hint(world));
    }
}

/// Draws the overlays of the picture.
fn over(ui: &mut Ui, view: &SceneResponse, experiments: &Experiments, training: &Training) {
    if let Some((snapshot, _)) = training.trainer.scene() {
        overlay_marks::device(ui, view, snapshot);
    }
    overlay_marks::flashes(ui, view, &training.trainer.impacts);
    draw::draw(ui, view, training);
    guide::ghost(ui, view, experiments, &training.trainer);
    guide::expert(ui, view, &training.lessons);
}

impl TrainerView {
    /// Plays impacts, slips and excessive forces. The first of them opens the audio output; a machine without sound is
    /// reported once.
    #[cfg(feature = "sound")]
    fn knock(&mut self, training: &mut Training, messages: &mut Messages) {
        let struck_m_s = training.trainer.struck_m_s.take();
        let limit_n = training.trainer.config().limits.max_force_n;
        let seen = training.trainer.seen().filter(|_| training.trainer.held().is_none());
        let slip_m_s = seen.map_or(0.0, crate::ui::train::trainer::slip_sound::slip_m_s);
        let excess = seen.is_some_and(|state| state.tip_force_n.iter().any(|force| force.norm() > limit_n));
        if self.sound.is_none() && struck_m_s.is_none() && slip_m_s == 0.0 && !excess {
            return;
        }
        match self.sound.get_or_insert_with(crate::ui::kit::sound::Sound::open) {
            Ok(sound) => {
                sound.follow(training.comfort.loudness(), slip_m_s, excess);
                if let Some(speed_m_s) = struck_m_s {
                    sound.strike(speed_m_s);
                }
            }
            Err(problem) if !problem.is_empty() => messages.fail(std::mem::take(problem)),
            Err(_) => {}
        }
    }
}

fn steer(ui: &Ui, view: &SceneResponse, training: &mut Training, frame_s: f64) {
    let (pinches, trainer) = (training.comfort.pinches(), &mut training.trainer);
    let response = &view.response;
    let pointer = ui.input(|i| i.pointer.latest_pos()).filter(|at| view.rect.contains(*at));
    if let (Some(at), false) = (pointer.filter(|_| response.contains_pointer()), view.camera_moves) {
        if ui.input(|i| i.pointer.delta() != egui::Vec2::ZERO || i.pointer.any_pressed())
            && let Some(point) = view.point_in_world(ui, at)
        {
            trainer.pinch.move_to(point);
        }
        ui.ctx().set_cursor_icon(if trainer.pinch.closed() { CursorIcon::Grabbing } else { CursorIcon::Crosshair });
        let (scroll, ctrl) = ui.input(|i| (f64::from(i.smooth_scroll_delta().y), i.modifiers.command));
        if scroll != 0.0 && !ctrl {
            trainer.pinch.strengthen(scroll * WHEEL_N);
        }
    }
    trainer.pinch.button = response.is_pointer_button_down_on() && ui.input(|i| i.pointer.button_down(pinches));
    if !ui.ctx().egui_wants_keyboard_input() {
        keys(ui, trainer, frame_s);
    }
}

fn keys(ui: &Ui, trainer: &mut Trainer, frame_s: f64) {
    ui.input(|i| {
        let mut step = Vec2::zeros();
        for (key, along) in [
            (Key::ArrowLeft, Vec2::new(-1.0, 0.0)),
            (Key::ArrowRight, Vec2::new(1.0, 0.0)),
            (Key::ArrowUp, Vec2::new(0.0, 1.0)),
            (Key::ArrowDown, Vec2::new(0.0, -1.0)),
        ] {
            if i.key_down(key) {
                step += along;
            }
        }
        if step != Vec2::zeros() {
            trainer.pinch.move_by(step * KEY_SPEED_M_S * frame_s.min(0.1));
        }
        if i.num_presses(Key::Space) % 2 == 1 {
            trainer.pinch.latched = !trainer.pinch.latched;
        }
        // At a low frame rate, one frame may contain several presses.
        let times = |key: Key| i.num_presses(key) as f64;
        let change = times(Key::Plus) + times(Key::Equals) - times(Key::Minus);
        trainer.pinch.strengthen(0.2 * change);
    });
}

/// Draws the functions of mouse and keys along the lower edge.
fn hints(ui: &mut Ui, rect: Rect, hand: &HandDevice, left_handed: bool) {
    let line = Rect::from_min_max(pos2(rect.left() + space::M, rect.bottom() - 34.0), rect.right_bottom());
    let layout = egui::Layout::left_to_right(Align::Center);
    let mut ui = ui.new_child(UiBuilder::new().max_rect(line.with_max_y(rect.bottom() - 8.0)).layout(layout));
    ui.spacing_mut().item_spacing.x = 12.0;
    for (key, what) in hints_of(hand, left_handed) {
        if ui.available_width() > 150.0 {
            key_hint(&mut ui, key, what);
        }
    }
}

fn hints_of(hand: &HandDevice, left_handed: bool) -> &'static [(&'static str, &'static str)] {
    match hand {
        HandDevice::Mouse if left_handed => &[
            (words::MOUSE, words::MOVES_THE_FINGERS),
            (words::RIGHT_BUTTON, "pinches"),
            (words::WHEEL, "strength"),
            (words::LEFT_DRAG, words::TURNS_THE_VIEW),
            ("N", words::STARTS_OVER),
            (words::ARROWS, "move"),
            (words::SPACE, words::PINCHES_AND_HOLDS),
        ],
        HandDevice::Mouse => &[
            (words::MOUSE, words::MOVES_THE_FINGERS),
            (words::LEFT_BUTTON, "pinches"),
            (words::WHEEL, "strength"),
            (words::RIGHT_DRAG, words::TURNS_THE_VIEW),
            ("N", words::STARTS_OVER),
            (words::ARROWS, "move"),
            (words::SPACE, words::PINCHES_AND_HOLDS),
        ],
        HandDevice::Touch => &[(words::TWO_FINGERS, words::ON_THE_GLASS), (words::TOGETHER, "pinches")],
        HandDevice::Keyboard => {
            &[(words::ARROWS, "move"), (words::SPACE, "closes"), (words::BACKSPACE, "opens"), (words::SHIFT, "slowly")]
        }
        HandDevice::Replay => &[],
        #[cfg(feature = "gamepad")]
        HandDevice::Gamepad => &[(words::LEFT_STICK, "moves"), (words::TRIGGERS, words::CLOSE_AND_OPEN)],
        HandDevice::Haply(..) | HandDevice::Udp => &[
            (words::YOUR_DEVICE, words::MOVES_THE_FINGERS),
            (words::RIGHT_DRAG, words::TURNS_THE_VIEW),
            (words::CTRL_4, words::DEVICE_PAGE),
        ],
    }
}

fn watching(trainer: &Trainer) -> &'static str {
    match (trainer.operator, trainer.performance_over()) {
        (Operator::Scripted, true) => words::SCRIPT_DONE,
        (Operator::Scripted, false) => words::SCRIPT_WORKS,
        (Operator::You, true) => words::THE_REPLAY_IS_OVER,
        (Operator::You, false) => words::REPLAY_OF_THE_OPEN,
    }
}

/// Draws one line along the upper edge, beside the button that resets the view.
fn pill(ui: &mut Ui, rect: Rect, text: &str) {
    let p = palette(ui);
    let room = rect.shrink(space::M).with_max_x(rect.right() - 116.0);
    let mut ui = ui.new_child(UiBuilder::new().max_rect(room).layout(egui::Layout::left_to_right(Align::Min)));
    egui::Frame::new()
        .fill(p.card)
        .stroke(egui::Stroke::new(1.0, p.border))
        .corner_radius(14)
        .inner_margin(egui::Margin::symmetric(12, 5))
        .show(&mut ui, |ui| ui.add(egui::Label::new(theme::strong(text)).selectable(false).wrap()));
}
