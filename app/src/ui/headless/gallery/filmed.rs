//! The recorded hand as a film: a video for screenshots of the video panel.

use crate::ui::kit::theme;
use crate::ui::scene::overlay::{camera_for, options_for, scene_world};
use crate::ui::session::Session;
use crate::video::reading::VideoSource;
use crate::video::writer::Writer;
use anyhow::Context as _;
use render::{Headless, SceneView, ViewOptions};
use std::path::Path;

/// Size of the film, pixels.
const SIZE: [u32; 2] = [480, 320];
/// Frame rate, Hz.
const RATE_HZ: f64 = 8.0;
/// Duration, s; the session's cursor is at its middle.
const LENGTH_S: f64 = 1.0;
/// Rotation of the camera from the default one, rad to the right and up.
const ASIDE_RAD: [f32; 2] = [0.7, 0.18];

/// Films the shown recording about the time cursor.
pub fn filmed(session: &mut Session, file: &Path) -> anyhow::Result<VideoSource> {
    let prepared = session.document.prepared().cloned().context("there is no recording to film")?;
    let world = scene_world(&session.calibration, &prepared);
    let mut camera = camera_for(&session.document, &session.calibration, &prepared);
    camera.orbit(ASIDE_RAD[0], ASIDE_RAD[1]);
    let (middle_s, begins_at_s) = (session.document.cursor_s, session.document.cursor_s - 0.5 * LENGTH_S);
    let mut headless = Headless::new()?;
    let mut writer = Writer::begin(file, SIZE, RATE_HZ)?;
    for k in 0..=(LENGTH_S * RATE_HZ) as u32 {
        session.document.seek(begins_at_s + f64::from(k) / RATE_HZ);
        let (state, options) = options_for(session, &prepared, &world);
        let theme = theme::scene_theme(false);
        // A camera does not see force arrows.
        let plain = ViewOptions { show_forces: false, show_workspace: false, ..ViewOptions::default() };
        let options = ViewOptions { camera, theme, fingers: options.fingers, ..plain };
        let picture =
            headless.render(&SceneView { world: &world, state: &state, options: &options }, SIZE[0], SIZE[1])?;
        writer.add(&image::DynamicImage::ImageRgba8(picture).into_rgb8())?;
    }
    writer.finish(file)?;
    session.document.seek(middle_s);
    Ok(VideoSource { file: file.to_path_buf(), recording: session.document.current, begins_at_s })
}
