//! Every picture of the gallery, and drawing them all.

use crate::ui::calibrate::panels::{scene, video};
use crate::ui::diagnose::panels::{causes, residuals};
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::gallery::samples::Samples;
use crate::ui::headless::gallery::small_png::small_png;
use crate::ui::headless::gallery::walk;
use crate::ui::headless::picture_input::PictureInput;
use crate::ui::headless::screenshot;
use crate::ui::headless::screenshot::pictures;
use crate::ui::scene::layers::SceneLayers;
use crate::ui::session::Session;
use crate::ui::shell::panel::{Framing, PAGE, Picture, SCENE};
use crate::ui::train::panels::trainer_view;
use crate::worlds;
use anyhow::Context as _;
use haptics::recording::Task;
use haptics::world::presets::BUILT_IN;
use std::fmt::Write as _;
use std::path::Path;

/// One picture of the gallery.
#[derive(Clone)]
pub struct Plate {
    /// Name of its files, without theme and ending.
    pub name: String,
    /// Description of the picture, one line.
    pub line: &'static str,
    /// Size, pixels.
    pub size: [u32; 2],
    /// The kind of picture.
    pub picture: &'static Picture,
    sample: Sample,
    layers: SceneLayers,
    /// Time of the cursor, s; `None` for an instructive moment.
    at_s: Option<f64>,
}

impl Plate {
    /// Same recording or world in another panel or page.
    #[cfg(test)]
    pub(crate) fn shown_in(&self, picture: &'static Picture) -> Self {
        Self { name: format!("{} in {}", self.name, picture.name), picture, size: PAGE, ..self.clone() }
    }

    /// True for a single panel with a margin around it.
    pub fn is_framed(&self) -> bool {
        matches!(self.picture.framing, Framing::Panel(_))
    }

    /// True for a 3D view of a recording with non-default layers.
    pub fn is_view(&self) -> bool {
        self.name.starts_with("scene-")
    }
}

/// All plates: pages and panels first, then the views of the scene, then the worlds of the trainer.
pub fn plates() -> Vec<Plate> {
    let panels = pictures().map(of_picture);
    let of_blocks = Plate {
        name: "atlas-blocks".to_owned(),
        sample: Sample::Leaking,
        line: "The same of blocks: a part for every channel that was compared",
        ..of_picture(&residuals::ATLAS)
    };
    let of_needle = Plate {
        name: "atlas-needle".to_owned(),
        sample: Sample::Needle,
        line: "The same of a needle: its sheet and its shaft, over depth, speed and time",
        ..of_picture(&residuals::ATLAS)
    };
    let of_hinge = Plate {
        name: "experiment-hinge".to_owned(),
        sample: Sample::Hinge,
        line: "What to record next of a mechanism without a handle: rehearsed, and planned for the real one",
        ..of_picture(&causes::EXPERIMENT)
    };
    panels
        .chain([of_blocks, of_needle, of_hinge])
        .chain(views())
        .chain(BUILT_IN.iter().filter_map(|(name, _)| of_world(name)))
        .collect()
}

fn of_picture(picture: &'static Picture) -> Plate {
    let Picture { name, line, size, sample, .. } = *picture;
    Plate { name: name.to_owned(), line, size, picture, sample, layers: SceneLayers::default(), at_s: None }
}

/// The thesis's figures as live views of the scene.
fn views() -> Vec<Plate> {
    let bare = SceneLayers::default();
    let view = |name: &str, sample, layers, line| Plate {
        name: format!("scene-{name}"),
        line,
        size: SCENE,
        picture: &scene::SCENE_PICTURE,
        sample,
        layers,
        at_s: None,
    };
    let unexplained = SceneLayers { unexplained: true, ..bare };
    let replay = SceneLayers { replay: true, path: false, ..bare };
    vec![
        view(
            "crank",
            Sample::Crank,
            SceneLayers { forces_on_path: true, ..bare },
            "A crank: path, force of the hand, found circle and centre (thesis, figure 5.10)",
        ),
        view(
            "crank-unexplained",
            Sample::Crank,
            unexplained,
            "The force that weight and friction do not explain: the crank's own (figure 5.12)",
        ),
        view(
            "crank-virtual",
            Sample::Crank,
            replay,
            "Real and virtual crank, and how far they are apart (figure 5.22)",
        ),
        view(
            "blocks-virtual",
            Sample::Stack,
            replay,
            "Measured forces beside those of the virtual block (figures 5.18 to 5.21)",
        ),
        view(
            "door",
            Sample::Door,
            unexplained,
            "A door led by a tool: how well its hinge is known in each direction, and what it bears",
        ),
        view(
            "needle",
            Sample::Needle,
            unexplained,
            "A needle in its sheet, with the stiffness of the moment (figure 5.14)",
        ),
        view(
            "rail",
            Sample::Rail,
            bare,
            "A recording of one coordinate: a carriage on a rail, and the force that pushes it",
        ),
    ]
}

/// A built-in world with the scripted operator at work.
fn of_world(name: &'static str) -> Option<Plate> {
    let line = match name {
        "crank" => "A crank to turn",
        "needle" => "A needle and a paper cup",
        "barrel" => "A barrel on a cable, its content unknown",
        "switch" => "A toggle switch",
        "guide" => "A slider in a bent slot",
        "table" => "An empty table",
        // The first plate of the trainer shows the blocks.
        _ => return None,
    };
    Some(Plate {
        name: format!("world-{name}"),
        line,
        size: SCENE,
        picture: &trainer_view::TRAINER,
        sample: Sample::World(name),
        layers: SceneLayers::default(),
        at_s: None,
    })
}

/// Draws plates; keeps the recordings that they are drawn from.
#[derive(Default)]
pub struct Studio {
    samples: Samples,
}

impl Studio {
    /// Draws one plate.
    pub fn draw(&mut self, plate: &Plate, dark: bool) -> anyhow::Result<image::RgbaImage> {
        screenshot::draw(self.session(plate)?, plate.picture, plate.size, dark)
    }

    /// Session from which a plate is drawn.
    pub(crate) fn session(&mut self, plate: &Plate) -> anyhow::Result<Session> {
        let input = self.input(plate).with_context(|| format!("the gallery's picture {}", plate.name))?;
        let mut input = input;
        if plate.picture.name == video::PICTURE.name {
            input.video = Some(self.samples.film(&input)?);
        }
        let mut session = (plate.picture.session)(&input)?;
        session.layers = plate.layers;
        Ok(session)
    }

    fn input(&mut self, plate: &Plate) -> anyhow::Result<PictureInput> {
        let mut input = PictureInput { time_s: plate.at_s, ..PictureInput::default() };
        match plate.sample {
            Sample::World(name) => input.world = Some(worlds::find(Path::new(name))?),
            Sample::Foreign => input.log = Some(self.samples.foreign()?),
            sample => {
                input.recordings = self.samples.recordings(sample)?;
                input.task = (sample == Sample::Needle).then_some(Task::Needle);
            }
        }
        Ok(input)
    }
}

/// Draws all plates into `folder`, with a page that shows them, or only those that `only` names. `tell` receives the
/// completed share. Returns the number of pictures and their size in bytes.
pub fn write_to(folder: &Path, only: Option<&str>, mut tell: impl FnMut(f64)) -> anyhow::Result<(usize, usize)> {
    std::fs::create_dir_all(folder).with_context(|| format!("the folder could not be made: {}", folder.display()))?;
    let mut studio = Studio::default();
    let (mut pictures, mut bytes) = (0, 0);
    let plates = plates();
    let wanted: Vec<&Plate> = plates.iter().filter(|p| only.is_none_or(|name| p.name.starts_with(name))).collect();
    for (index, plate) in wanted.iter().enumerate() {
        tell(index as f64 / wanted.len() as f64);
        for dark in [false, true] {
            let png = small_png(&studio.draw(plate, dark)?)?;
            (pictures, bytes) = (pictures + 1, bytes + png.len());
            let path = folder.join(file_name(plate, dark));
            std::fs::write(&path, png)
                .with_context(|| format!("the picture could not be written: {}", path.display()))?;
        }
    }
    for dark in [false, true] {
        let (more, size) = walked(folder, only, dark)?;
        (pictures, bytes) = (pictures + more, bytes + size);
    }
    if only.is_none() {
        let path = folder.join("README.md");
        std::fs::write(&path, page(&plates))
            .with_context(|| format!("the page could not be written: {}", path.display()))?;
    }
    Ok((pictures, bytes))
}

/// Draws the steps of the complete workflow, as a person performs it.
fn walked(folder: &Path, only: Option<&str>, dark: bool) -> anyhow::Result<(usize, usize)> {
    let (mut pictures, mut bytes) = (0, 0);
    if only.is_some_and(|name| !"walk".starts_with(name) && !name.starts_with("walk")) {
        return Ok((0, 0));
    }
    let place = tempfile::tempdir().context("there is no room for temporary files")?;
    walk::walk(place.path(), PAGE, dark, true, |step, picture| {
        if let Some(picture) = picture {
            let png = small_png(&picture)?;
            (pictures, bytes) = (pictures + 1, bytes + png.len());
            std::fs::write(folder.join(step_file(step, dark)), png).context("the picture could not be written")?;
        }
        Ok(())
    })?;
    Ok((pictures, bytes))
}

fn file_name(plate: &Plate, dark: bool) -> String {
    themed(&plate.name, dark)
}

/// Numbered file name, so that files sort in the order of the steps.
fn step_file(step: &str, dark: bool) -> String {
    let place = walk::STEPS.iter().position(|(name, _)| *name == step).unwrap_or_default();
    themed(&format!("walk-{}-{step}", place + 1), dark)
}

fn themed(name: &str, dark: bool) -> String {
    format!("{name}-{}.png", if dark { "dark" } else { "light" })
}

/// The page beside the pictures.
fn page(plates: &[Plate]) -> String {
    let mut text = String::from(
        "# Gallery\n\nEvery panel and every scene, light and dark, drawn by the program itself:\n\
         `cargo run --release -p app -- gallery --out docs/gallery`\n\n| light | dark |\n|---|---|\n",
    );
    for (step, line) in walk::STEPS {
        let [light, dark] = [false, true].map(|dark| step_file(step, dark));
        let _ = writeln!(
            text,
            "| From a log to a report: {line}<br>![{line}, light]({light}) | <br>![{line}, dark]({dark}) |"
        );
    }
    for plate in plates {
        let [light, dark] = [false, true].map(|dark| file_name(plate, dark));
        let line = plate.line;
        let _ = writeln!(text, "| {line}<br>![{line}, light]({light}) | <br>![{line}, dark]({dark}) |");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_picture_has_a_name_of_its_own_and_a_line() {
        let plates = plates();
        let names: BTreeSet<&str> = plates.iter().map(|plate| plate.name.as_str()).collect();
        assert_eq!(names.len(), plates.len());
        assert!(plates.iter().all(|plate| !plate.name.is_empty() && plate.line.len() > 10));
    }

    #[test]
    fn the_page_in_the_sources_is_that_of_the_program() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/gallery/README.md");
        let kept = std::fs::read_to_string(path).expect("docs/gallery/README.md is there");
        let again = "run `cargo run --release -p app -- gallery --out docs/gallery` again";
        assert!(kept == page(&plates()), "the gallery has changed: {again}");
        for plate in plates() {
            for dark in [false, true] {
                let picture = Path::new(path).with_file_name(file_name(&plate, dark));
                assert!(picture.is_file(), "{} is missing: {again}", picture.display());
            }
        }
        for (step, _) in walk::STEPS {
            for dark in [false, true] {
                let picture = Path::new(path).with_file_name(step_file(step, dark));
                assert!(picture.is_file(), "{} is missing: {again}", picture.display());
            }
        }
    }
}
