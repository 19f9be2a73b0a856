//! The video of the hand: its frame at the time cursor, and its synchronization.

use crate::text::file_name::name_of;
use crate::text::format;
use crate::ui::background::jobs::Jobs;
use crate::ui::document::files;
use crate::ui::document::state::Document;
use crate::ui::document::video_actions;
use crate::ui::document::videos::{ALIGN_VIDEO, State, Videos};
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::stage;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{empty_state, primary_button, quiet_icon_button, sheet};
use crate::ui::session::Session;
use crate::ui::shell::dialogs;
use crate::ui::shell::panel::{Framing, PAGE, Panel, Picture, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::video::reading::Video;
use egui::{
    Align, Align2, Color32, CornerRadius, DragValue, FontId, Layout, Margin, Rect, RichText, Sense, Slider, Ui, pos2,
    vec2,
};
use egui_tiles::ContainerKind;
use std::sync::Arc;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const READING: &str = "Reading the video …";
    pub const READING_MORE: &str = "Its pictures are kept, so that any moment is there at once.";
    pub const NONE_MORE: &str = "Drop a video of the hand on the window, or choose one: it then runs with the time cursor. A \
        video that has its log's name, or that the sidecar names, is found by itself.";
    pub const NO_LOG: &str = "Open a log first; a video of the hand then runs here with the time cursor.";
    pub const NONE: &str = "No video";
    pub const CHOOSE: &str = "Choose a video …";
    pub const FAILED: &str = "The video cannot be shown";
    pub const AGAIN: &str = "Try again";
    pub const CHOOSE_ANOTHER: &str = "Choose another …";
    pub const TAKE_AWAY: &str = "Take it away";
    pub const PICTURE: &str = "Video of the hand";
    pub const BY_ITSELF_MORE: &str = "Look at the video by itself: find a moment that you recognise, put the time cursor where \
        the recording shows it, and say that they belong together";
    pub const BY_ITSELF: &str = "By itself";
    pub const TOGETHER: &str = "They belong together";
    pub const TOGETHER_MORE: &str = "This picture was taken at the time cursor";
    pub const BEGINS: &str = "begins at";
    pub const BEGINS_MORE: &str = "When its first picture was taken, on the recording's clock: drag, or click and type";
    pub const ALIGN_MORE: &str = "Shift it to where its pictures change when the recorded hand moves";
    pub const ALIGN: &str = "Align";
    pub const ALIGN_SPOKEN: &str = "Align video";
    pub const WHERE: &str = "Where in the video";
    pub const REMOVE: &str = "Take the video away";
}

/// Space for the controls below the picture, points.
const CONTROLS: f32 = 64.0;

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Calibrate, 6), (Workspace::Diagnose, 6)],
    neighbours: &[
        (PanelId::SCENE, ContainerKind::Horizontal, false),
        (PanelId::LOG, ContainerKind::Vertical, true),
        (PanelId::DIAGNOSIS, ContainerKind::Tabs, false),
    ],
    pictures: &[&PICTURE],
    ..Registration::new(PanelId::VIDEO, "Video of the hand", Icon::Video, || Box::new(VideoPanel))
};

/// The Calibrate workspace with a video of the hand; the log's, or the one that is named.
pub static PICTURE: Picture = Picture {
    name: "video",
    place: 250,
    help: "The Calibrate workspace with a video of the hand; the log's, or the one that is named",
    line: "A video of the hand (here of the virtual one) runs with the time cursor",
    size: PAGE,
    sample: Sample::Stack,
    session: stage::video,
    framing: Framing::Page,
};

/// The video panel.
#[derive(Default)]
pub struct VideoPanel;

impl Panel for VideoPanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let ctx = ui.ctx().clone();
        sheet(ui).show(ui, |ui| {
            ui.set_min_size(ui.available_size());
            match video_actions::video(&session.document, &mut session.jobs, &ctx) {
                State::None => none(ui, &session.document, &mut session.jobs),
                State::Reading => {
                    empty_state(ui, words::READING, words::READING_MORE, |ui| {
                        ui.spinner();
                    });
                }
                State::Failed(problem) => failed(ui, &mut session.document, &mut session.jobs, &problem),
                State::There(video) => shown(ui, &mut session.document, &mut session.jobs, &video),
            }
        });
    }
}

fn none(ui: &mut Ui, document: &Document, jobs: &mut Jobs<Session>) {
    let loaded = document.prepared().is_some();
    let text = if loaded { words::NONE_MORE } else { words::NO_LOG };
    empty_state(ui, (Icon::Video, words::NONE), text, |ui| {
        if primary_button(ui, loaded, (Icon::Open, words::CHOOSE)).clicked() {
            files::ask(ui.ctx(), jobs, dialogs::OPEN_VIDEO);
        }
    });
}

fn failed(ui: &mut Ui, document: &mut Document, jobs: &mut Jobs<Session>, problem: &str) {
    empty_state(ui, (Icon::Doubt, words::FAILED), problem, |ui| {
        ui.horizontal(|ui| {
            // Buttons in the middle of the text's line.
            ui.add_space((0.5 * ui.available_width() - 170.0).max(0.0));
            if ui.button((Icon::Reload, words::AGAIN)).clicked() {
                video_actions::read_video_again(document);
            }
            if ui.button((Icon::Open, words::CHOOSE_ANOTHER)).clicked() {
                files::ask(ui.ctx(), jobs, dialogs::OPEN_VIDEO);
            }
            if ui.button((Icon::Close, words::TAKE_AWAY)).clicked() {
                video_actions::forget_video(document, jobs);
            }
        });
    });
}

fn shown(ui: &mut Ui, document: &mut Document, jobs: &mut Jobs<Session>, video: &Arc<Video>) {
    let whole = ui.available_rect_before_wrap();
    let (above, below) = whole.split_top_bottom_at_y((whole.bottom() - CONTROLS).max(whole.top()));
    picture(ui, document, jobs, video, above.shrink(1.0));
    let layout = Layout::top_down(Align::Min);
    ui.scope_builder(egui::UiBuilder::new().max_rect(below).layout(layout), |ui| {
        egui::Frame::new()
            .inner_margin(Margin::symmetric(space::M as i8, 6))
            .show(ui, |ui| controls(ui, document, jobs, video));
    });
}

fn picture(ui: &mut Ui, document: &mut Document, jobs: &mut Jobs<Session>, video: &Arc<Video>, room: Rect) {
    let p = palette(ui);
    let corners = CornerRadius { nw: theme::CARD_RADIUS, ne: theme::CARD_RADIUS, sw: 0, se: 0 };
    ui.painter().rect_filled(room, corners, p.sunken);
    let time_s = video_actions::video_time_s(document).unwrap_or(0.0);
    let now = video.index_at(time_s);
    // Before its start and after its end, its first and last frame are shown, dimmed.
    let index = now.unwrap_or(if time_s < 0.0 { 0 } else { video.count() - 1 });
    let ctx = ui.ctx().clone();
    let texture = video_actions::video_picture(document, jobs, &ctx, video, index);
    let size = vec2(video.size[0] as f32, video.size[1] as f32);
    let scale = (room.width() / size.x).min(room.height() / size.y).max(0.0);
    let at = Rect::from_center_size(room.center(), size * scale);
    if let Some(texture) = &texture {
        let tint = if now.is_some() { Color32::WHITE } else { Color32::from_white_alpha(90) };
        ui.painter().image(texture.id(), at, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), tint);
    }
    let response = ui.interact(room, ui.scope_id().with("video picture"), Sense::drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, words::PICTURE));
    scrub(document, video, &response);
    if now.is_none() {
        let text = if time_s < 0.0 {
            format!("The video begins in {} s", format::number(-time_s, 1))
        } else {
            format!("The video ended {} s ago", format::number(time_s - video.duration_s(), 1))
        };
        let galley = ui.painter().layout_no_wrap(text, FontId::proportional(12.0), p.text);
        let back = Rect::from_center_size(room.center(), galley.size() + vec2(20.0, 10.0));
        ui.painter().rect_filled(back, 7, p.card);
        ui.painter().galley(back.center() - 0.5 * galley.size(), galley, p.text);
    } else if texture.is_none() {
        let font = FontId::proportional(12.0);
        ui.painter().text(room.center(), Align2::CENTER_CENTER, "…", font, p.secondary);
    }
}

/// Scrubs through the video by dragging across the picture: its width is ten seconds, or the whole length if that is
/// shorter.
fn scrub(document: &mut Document, video: &Video, response: &egui::Response) {
    let by = response.drag_delta().x;
    if !response.dragged() || by == 0.0 {
        return;
    }
    let step_s = f64::from(by / response.rect.width().max(1.0)) * video.duration_s().min(10.0);
    document.playing = false;
    match document.videos.loose_s {
        Some(loose_s) => document.videos.loose_s = Some((loose_s + step_s).clamp(0.0, video.duration_s())),
        None => document.seek(document.cursor_s + step_s),
    }
}

fn controls(ui: &mut Ui, document: &mut Document, jobs: &mut Jobs<Session>, video: &Video) {
    ui.spacing_mut().interact_size.y = 20.0;
    ui.spacing_mut().button_padding.y = 2.0;
    let loose = document.videos.loose_s;
    ui.horizontal(|ui| {
        let mut by_itself = loose.is_some();
        let hint = words::BY_ITSELF_MORE;
        if ui.checkbox(&mut by_itself, words::BY_ITSELF).on_hover_text(hint).changed() {
            video_actions::loosen_video(document, by_itself);
        }
        if loose.is_none() {
            place(ui, document, jobs);
        } else if ui.button(words::TOGETHER).on_hover_text(words::TOGETHER_MORE).clicked() {
            video_actions::video_belongs_here(document);
        }
    });
    ui.horizontal(|ui| match document.videos.loose_s {
        Some(at_s) => runner(ui, &mut document.videos, video, at_s),
        None => facts(ui, document, jobs, video),
    });
}

/// Draws the position of the video in time.
fn place(ui: &mut Ui, document: &mut Document, jobs: &mut Jobs<Session>) {
    let Some(mut begins_at_s) = video_actions::video_source(document).map(|s| s.begins_at_s) else { return };
    ui.label(theme::caption(ui, words::BEGINS));
    let drag = DragValue::new(&mut begins_at_s).speed(0.02).max_decimals(3).suffix(" s");
    let hint = words::BEGINS_MORE;
    if ui.add(drag).on_hover_text(hint).changed() {
        video_actions::shift_video(document, begins_at_s);
    }
    let free = !jobs.is_running(ALIGN_VIDEO);
    let hint = words::ALIGN_MORE;
    let align = ui.add_enabled(free, egui::Button::new((Icon::Align, words::ALIGN))).on_hover_text(hint);
    align.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, free, words::ALIGN_SPOKEN));
    if align.clicked() {
        let ctx = ui.ctx().clone();
        video_actions::align_video(document, jobs, &ctx);
    }
}

/// Draws a scrubber while the video is unlinked.
fn runner(ui: &mut Ui, videos: &mut Videos, video: &Video, mut at_s: f64) {
    let step_s = 1.0 / video.rate_hz;
    ui.spacing_mut().slider_width = (ui.available_width() - 72.0).max(40.0);
    let slider = Slider::new(&mut at_s, 0.0..=(video.duration_s() - step_s).max(0.0));
    if ui.add(slider.step_by(step_s).max_decimals(2).suffix(" s")).on_hover_text(words::WHERE).changed() {
        videos.loose_s = Some(at_s);
    }
}

fn facts(ui: &mut Ui, document: &mut Document, jobs: &mut Jobs<Session>, video: &Video) {
    let Some(file) = video_actions::video_source(document).map(|s| s.file.clone()) else { return };
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let away = quiet_icon_button(ui, Icon::Close, true, words::REMOVE).on_hover_text(words::REMOVE);
        if away.clicked() {
            video_actions::forget_video(document, jobs);
        }
        let [wide, high] = video.size;
        let facts = format!("{wide} × {high}, {} s", format::number(video.duration_s(), 1));
        ui.label(theme::caption(ui, facts));
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let name = RichText::new(name_of(&file)).size(11.5).color(palette(ui).secondary);
            ui.add(egui::Label::new(name).truncate()).on_hover_text(file.display().to_string());
        });
    });
}
