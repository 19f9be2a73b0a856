//! Every page, panel and dialog at the sizes of usual screens.

use super::faults::faults;
use super::painted::Paint;
use crate::ui::headless::gallery::plates::plates;
use crate::ui::headless::gallery::plates::{Plate, Studio};
use crate::ui::headless::screenshot;
use crate::ui::headless::screenshot::in_whole_window;
use crate::ui::kit::theme;
use crate::ui::scene::callback;
use crate::ui::shell::app::App;
use crate::ui::shell::panel::Picture;
use crate::ui::tests::{keep, picture};
use egui_kittest::wgpu::WgpuTestRenderer;
use egui_kittest::{Harness, HarnessBuilder};
use std::fmt::Write as _;

/// Pixels of a screen, and pixels a point.
const SCREENS: [([f32; 2], f32); 4] =
    [([1280.0, 720.0], 1.0), ([1366.0, 768.0], 1.0), ([1920.0, 1080.0], 1.5), ([3840.0, 2160.0], 2.0)];

/// The smallest place in which a panel has to be read, points.
const SMALL: [f32; 2] = [420.0, 420.0];

/// A window to look at by machine.
pub struct Stage {
    /// The window.
    pub harness: Harness<'static, App>,
    paint: Paint,
    whole_page: bool,
}

impl Stage {
    fn of_plate(studio: &mut Studio, plate: &Plate, size: Option<[f32; 2]>) -> Self {
        let session = studio.session(plate).expect("the gallery's samples are there");
        let whole_page = !plate.is_framed();
        let size = size.unwrap_or(plate.size.map(|pixels| pixels as f32));
        Self::new(screenshot::app_for(session, plate.picture), plate.picture, whole_page, size)
    }

    /// A window in which a panel or a page is drawn.
    pub fn new(app: App, shown: &'static Picture, whole_page: bool, size: [f32; 2]) -> Self {
        let paint = Paint::default();
        let kept = paint.clone();
        let mut contents = screenshot::contents(shown);
        let builder = Harness::builder().with_size(size).with_accessibility_check(false);
        let builder = if draws() { drawing(builder) } else { builder.with_context_setup(theme::install) };
        let show = move |ui: &mut egui::Ui, app: &mut App| {
            in_whole_window(ui, |ui| contents(ui, app));
            kept.take(ui.ctx());
        };
        Self { harness: builder.build_ui_state(show, app), paint, whole_page }
    }

    /// The faults on every screen, a line each.
    pub fn look(&mut self, name: &str) -> String {
        let mut found = String::new();
        let size = self.harness.ctx.content_rect().size();
        for (pixels, scale) in SCREENS {
            let points = if self.whole_page { egui::vec2(pixels[0], pixels[1]) / scale } else { size };
            // As the window system says it, not by zooming.
            let screen = self.harness.input_mut().viewports.entry(egui::ViewportId::ROOT).or_default();
            screen.native_pixels_per_point = Some(scale);
            self.harness.set_size(points);
            self.harness.run_steps(4);
            assert_eq!((self.harness.ctx.content_rect().size(), self.harness.ctx.pixels_per_point()), (points, scale));
            for fault in faults(&self.paint.window(&self.harness)) {
                let _ = writeln!(found, "{name}, {} × {} points, scale {scale}: {fault}", points.x, points.y);
            }
            if draws() {
                let picture = self.harness.render().expect("drawn");
                keep(&format!("{name}, {} at {scale}", points.x * scale), &picture);
            }
        }
        found
    }
}

/// Pictures are drawn to be looked at by eye, too, where the folder for them is named.
fn draws() -> bool {
    std::env::var_os("TOUCHSTONE_PICTURES").is_some()
}

fn drawing<State>(builder: HarnessBuilder<State>) -> HarnessBuilder<State> {
    let options = egui_wgpu::RendererOptions::default();
    let state = egui_kittest::wgpu::create_render_state(egui_kittest::wgpu::default_wgpu_setup(), options);
    let surface = state.clone();
    let builder = builder.with_context_setup(move |ctx| {
        theme::install(ctx);
        callback::announce(ctx, &surface);
    });
    builder.with_render_cursor(false).renderer(WgpuTestRenderer::from_render_state(state))
}

fn look_at_all(wanted: impl Fn(&Plate) -> bool) {
    let mut studio = Studio::default();
    let mut found = String::new();
    let plates: Vec<Plate> = plates().into_iter().filter(wanted).collect();
    assert!(!plates.is_empty());
    for plate in plates {
        found += &Stage::of_plate(&mut studio, &plate, None).look(&plate.name);
        // The table of parameters stands among the results, which scroll.
        if plate.is_framed() && plate.picture.name != "parameters" {
            found += &Stage::of_plate(&mut studio, &plate, Some(SMALL)).look(&plate.name);
        }
    }
    assert!(found.is_empty(), "{found}");
}

#[test]
fn every_panel_can_be_read() {
    look_at_all(Plate::is_framed);
}

#[test]
fn every_page_can_be_read_on_every_screen() {
    look_at_all(|plate| !plate.is_framed());
}

#[test]
fn every_recording_and_world_can_be_read_in_a_whole_page() {
    let mut studio = Studio::default();
    let mut found = String::new();
    for plate in plates().iter().filter(|p| p.is_view() || p.picture.name == "trainer") {
        let page = if plate.is_view() { picture("workbench") } else { picture("train") };
        let plate = plate.shown_in(page);
        found += &Stage::of_plate(&mut studio, &plate, None).look(&plate.name);
        if plate.name.contains("crank") || plate.name.contains("needle") {
            let plate = plate.shown_in(picture("rules"));
            found += &Stage::of_plate(&mut studio, &plate, None).look(&plate.name);
        }
    }
    assert!(found.is_empty(), "{found}");
}
