//! `touchstone screenshot`: a picture without a window.

use super::{LogArgs, Output, parse_size, record};
use crate::ui::headless::picture_input::PictureInput;
use crate::ui::headless::screenshot;
use crate::ui::headless::screenshot::{MAPPING, PictureName, WORKBENCH};
use anyhow::Context;
use clap::Args;
use haptics::device::{Device, ScriptedOperator, Skill};
use haptics::recording::Recording;
use haptics::servo::{Loop, Swap, safety::Limits};
use haptics::world::State;
use render::{Headless, SceneView, Theme, Trajectory, ViewOptions};
use schemars::JsonSchema;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Arguments of `screenshot`.
#[derive(Args)]
pub struct Screenshot {
    /// A scene performed by the scripted operator: `stack`, `crank`, `needle`, `barrel`, `switch`, `guide`, `table`, or a world file
    #[arg(long, conflicts_with = "log", required_unless_present = "log")]
    scene: Option<String>,
    /// A log, drawn in one of the app's panels
    #[arg(long)]
    log: Option<PathBuf>,
    #[command(flatten)]
    source: LogArgs,
    /// Which panel of the app
    #[arg(long, requires = "log", default_value = "workbench")]
    panel: PictureName,
    /// Time in the performance or in the log, s; a telling moment when not given
    #[arg(long)]
    at: Option<f64>,
    /// Size in pixels
    #[arg(long, default_value = "1280x720", value_parser = parse_size)]
    size: [u32; 2],
    /// Dark theme
    #[arg(long)]
    dark: bool,
    /// Where to write the picture
    #[arg(long)]
    out: PathBuf,
}

/// What `screenshot --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// The picture.
    out: PathBuf,
    /// Pixels from left to right.
    width: u32,
    /// Pixels from top to bottom.
    height: u32,
}

impl Screenshot {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let picture = match (&self.scene, &self.log) {
            (Some(scene), _) => scene_picture(scene, self.at, self.size, self.dark)?,
            (None, Some(log)) => self.panel_picture(log)?,
            (None, None) => anyhow::bail!("name a scene or a log"),
        };
        save(&picture, &self.out)?;
        let [width, height] = self.size;
        let said = Said { out: self.out.clone(), width, height };
        Ok(Output { text: self.out.display().to_string(), json: serde_json::to_value(&said)? })
    }

    fn panel_picture(&self, log: &Path) -> anyhow::Result<image::RgbaImage> {
        if self.panel.0.name == MAPPING.name {
            // The dialog exists for logs that cannot be loaded as they are.
            let (log, meta) = (Some(log.to_path_buf()), self.source.meta.clone());
            let input = PictureInput { log, meta, ..Default::default() };
            return screenshot::picture(&input, self.panel.0, self.size, self.dark);
        }
        let recordings = self.source.load(log)?;
        screenshot::recordings(recordings, self.panel.0, self.at, self.size, self.dark)
    }
}

/// Screenshot of the whole calibration workspace with these recordings loaded and fitted.
pub(super) fn workbench(recordings: Vec<Recording>, size: [u32; 2], dark: bool) -> anyhow::Result<image::RgbaImage> {
    screenshot::recordings(recordings, &WORKBENCH, None, size, dark)
}

/// Writes a picture as PNG.
pub(super) fn save(picture: &image::RgbaImage, path: &Path) -> anyhow::Result<()> {
    picture
        .save_with_format(path, image::ImageFormat::Png)
        .with_context(|| format!("the picture could not be written: {}", path.display()))
}

/// Picture of a scene with the scripted operator at work, `at` seconds into its performance.
pub(super) fn scene_picture(
    scene: &str,
    at: Option<f64>,
    [width, height]: [u32; 2],
    dark: bool,
) -> anyhow::Result<image::RgbaImage> {
    /// Instructive moment, s: the first block is in the air, the crank on its first turn.
    const TELLING_S: f64 = 5.6;
    const RATE_HZ: f64 = 1000.0;
    let world = crate::worlds::find(Path::new(scene))?;
    world.check()?;
    let state = State::resting(&world);
    let operator = ScriptedOperator::new(&world, &state, Skill::default(), 1);
    let limits = Limits { max_force_n: operator.spec().max_force_n, ..Limits::default() };
    let mut servo = Loop::new(Swap::at(world.clone(), state), Box::new(operator), limits);
    let mut trail = Vec::new();
    for tick in 0..(at.unwrap_or(TELLING_S).clamp(0.0, record::LONGEST_S) * RATE_HZ) as usize {
        let sample = servo.tick(1.0 / RATE_HZ);
        if tick % 20 == 0 {
            trail.push(0.5 * (sample.input.tip_in_world[0] + sample.input.tip_in_world[1]));
        }
    }
    let options = ViewOptions {
        theme: if dark { Theme::Dark } else { Theme::Light },
        show_forces: true,
        trajectories: vec![Trajectory {
            points_m: trail,
            role: render::ColorRole::Measured,
            width_px: 2.0,
            dashed: false,
        }],
        ..ViewOptions::default()
    };
    let view = SceneView { world: &world, state: servo.state(), options: &options };
    Ok(Headless::new()?.render(&view, width, height)?)
}
