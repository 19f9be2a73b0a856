//! Every panel and every scene in light and dark: the pictures of `docs/gallery`, also used by the snapshot tests.

pub mod by_pointer;
mod filmed;
pub mod samples;
mod small_png;
pub mod walk;

use super::scene::SceneLayers;
use super::screenshot::{self, Panel, PanelInput};
use super::session::Session;
use crate::worlds;
use anyhow::Context as _;
use clap::ValueEnum as _;
use haptics::recording::Task;
use samples::Samples;
use std::fmt::Write as _;
use std::path::Path;

pub use samples::Sample;
pub use small_png::small_png;

/// Sizes of whole pages, of single panels and of scenes, pixels.
const PAGE: [u32; 2] = [1280, 720];
const PANEL: [u32; 2] = [640, 480];
const ATLAS: [u32; 2] = [720, 540];
const COLUMN: [u32; 2] = [440, 760];
const PRACTICE: [u32; 2] = [720, 760];
const SCENE: [u32; 2] = [720, 480];

/// One picture of the gallery.
#[derive(Clone, Debug)]
pub struct Plate {
    /// Name of its files, without theme and ending.
    pub name: String,
    /// Description of the picture, one line.
    pub line: &'static str,
    /// Size, pixels.
    pub size: [u32; 2],
    panel: Panel,
    sample: Sample,
    layers: SceneLayers,
    /// Time of the cursor, s; `None` for an instructive moment.
    at_s: Option<f64>,
}

impl Plate {
    /// Panel of the picture.
    pub fn panel(&self) -> Panel {
        self.panel
    }

    /// Same recording or world in another panel or page.
    #[cfg(test)]
    pub(super) fn shown_in(&self, panel: Panel) -> Self {
        Self { name: format!("{} in {panel:?}", self.name), panel, size: PAGE, ..self.clone() }
    }

    /// True for a single panel with a margin around it.
    pub fn is_framed(&self) -> bool {
        use Panel::{
            Assistant, Delay, LeftOver, Log, Parameters, Progress, Results, Scene, Segments, Sensitivity, Trainer, Xy,
        };
        matches!(
            self.panel,
            Log | Xy
                | LeftOver
                | Parameters
                | Progress
                | Results
                | Scene
                | Segments
                | Sensitivity
                | Trainer
                | Delay
                | Assistant
        )
    }

    /// True for a 3D view of a recording with non-default layers.
    pub fn is_view(&self) -> bool {
        self.name.starts_with("scene-")
    }
}

/// All plates: pages and panels first, then the views of the scene, then the worlds of the trainer.
pub fn plates() -> Vec<Plate> {
    let panels = Panel::value_variants().iter().map(|panel| of_panel(*panel));
    let of_blocks = Plate {
        name: "atlas-blocks".to_owned(),
        sample: Sample::Leaking,
        line: "The same of blocks: a part for every channel that was compared",
        ..of_panel(Panel::Atlas)
    };
    let of_needle = Plate {
        name: "atlas-needle".to_owned(),
        sample: Sample::Needle,
        line: "The same of a needle: its sheet and its shaft, over depth, speed and time",
        ..of_panel(Panel::Atlas)
    };
    let of_hinge = Plate {
        name: "experiment-hinge".to_owned(),
        sample: Sample::Hinge,
        line: "What to record next of a mechanism without a handle: rehearsed, and planned for the real one",
        ..of_panel(Panel::Experiment)
    };
    panels
        .chain([of_blocks, of_needle, of_hinge])
        .chain(views())
        .chain(worlds::BUILT_IN.iter().filter_map(|(name, _)| of_world(name)))
        .collect()
}

fn of_panel(panel: Panel) -> Plate {
    let (sample, size, line) = match panel {
        Panel::Log => (Sample::Stack, PANEL, "The log: curves by quantity, the states as a band, one time cursor"),
        Panel::Xy => (Sample::Needle, PANEL, "XY: the force of a needle over its depth, coloured by state"),
        Panel::LeftOver => {
            (Sample::Crank, PANEL, "What is left over: measured less simulated, and less the extended model")
        }
        Panel::Segments => (Sample::Stack, PANEL, "Segments: what was done when, found in the recording"),
        Panel::Rules => (Sample::Stack, PAGE, "Rules of a task, open beside the states that they find"),
        Panel::Parameters => (Sample::Stack, COLUMN, "Parameters: values with errors, and how each was found"),
        Panel::Results => (Sample::Crank, COLUMN, "Results: constraints, warnings, what is still missing"),
        Panel::Scene => (Sample::Stack, SCENE, "The recording in space, in the world that was measured"),
        Panel::Trainer => (Sample::World("stack"), PANEL, "The virtual world, touched by the scripted operator"),
        Panel::Assistant => (
            Sample::World("table"),
            PANEL,
            "The assistant: what is held, what may be in it, and the cable that holds it",
        ),
        Panel::Workbench => (Sample::Stack, PAGE, "Calibrate: a recording of two blocks, segmented and fitted"),
        Panel::Train => (Sample::World("stack"), PAGE, "Train: the world, the forces, the servo's punctuality"),
        Panel::Lessons => (Sample::World("table"), PAGE, "Lessons: from the first touch to the real task"),
        Panel::Practice => (Sample::World("table"), PAGE, "A lesson is practised, beside an expert's ghost"),
        Panel::Debrief => (Sample::World("table"), PAGE, "What came of an attempt, beside the experts"),
        Panel::Devices => (Sample::World("stack"), PAGE, "Devices: what moves the fingers, and how well"),
        Panel::Diagnose => (Sample::Crank, PAGE, "Diagnose: what the model gets wrong, and why"),
        Panel::Atlas => (Sample::Askew, ATLAS, "The residual atlas: what is left over against every suspect"),
        Panel::Experiment => (Sample::Askew, COLUMN, "What to record next, rehearsed on simulated objects"),
        Panel::Delay => {
            (Sample::World("stack"), PANEL, "Over half a second: the model under the hand solid, the far world a ghost")
        }
        Panel::Guided => (Sample::Askew, PANEL, "An experiment done by hand in Train: two rings to follow"),
        Panel::Sensitivity => (Sample::Crank, COLUMN, "Sensitivity: what the force depends on, and what goes together"),
        Panel::Parameter => (Sample::Crank, PAGE, "Another value of a parameter, tried on the replay"),
        Panel::Arrange => (Sample::Stack, PAGE, "Panels while they are arranged: drag a title, close, bring back"),
        Panel::Commands => (Sample::Stack, PAGE, "Every command by a few letters of its name"),
        Panel::Tour => (Sample::Stack, PAGE, "Shown around, the first time"),
        Panel::Video => {
            (Sample::Stack, PAGE, "A video of the hand (here of the virtual one) runs with the time cursor")
        }
        Panel::Progress => {
            (Sample::World("stack"), PRACTICE, "Progress: a trainee's learning curve at a lesson (a made-up history)")
        }
        Panel::Mapping => (Sample::Foreign, PAGE, "A foreign table: what its columns mean, with a preview"),
    };
    let name = panel.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
    Plate { name, line, size, panel, sample, layers: SceneLayers::default(), at_s: None }
}

/// The thesis's figures as live views of the scene.
fn views() -> Vec<Plate> {
    let bare = SceneLayers::default();
    let view = |name: &str, sample, layers, at_s, line| Plate {
        name: format!("scene-{name}"),
        line,
        size: SCENE,
        panel: Panel::Scene,
        sample,
        layers,
        at_s,
    };
    vec![
        view(
            "crank",
            Sample::Crank,
            SceneLayers { forces_on_path: true, ..bare },
            None,
            "A crank: path, force of the hand, found circle and centre (thesis, figure 5.10)",
        ),
        view(
            "crank-unexplained",
            Sample::Crank,
            SceneLayers { unexplained: true, ..bare },
            None,
            "The force that weight and friction do not explain: the crank's own (figure 5.12)",
        ),
        view(
            "crank-virtual",
            Sample::Crank,
            SceneLayers { replay: true, path: false, ..bare },
            None,
            "Real and virtual crank, and how far they are apart (figure 5.22)",
        ),
        view(
            "blocks-virtual",
            Sample::Stack,
            SceneLayers { replay: true, path: false, ..bare },
            None,
            "Measured forces beside those of the virtual block (figures 5.18 to 5.21)",
        ),
        view(
            "door",
            Sample::Door,
            SceneLayers { unexplained: true, ..bare },
            None,
            "A door led by a tool: how well its hinge is known in each direction, and what it bears",
        ),
        view(
            "needle",
            Sample::Needle,
            SceneLayers { unexplained: true, ..bare },
            None,
            "A needle in its sheet, with the stiffness of the moment (figure 5.14)",
        ),
        view(
            "rail",
            Sample::Rail,
            bare,
            None,
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
        panel: Panel::Trainer,
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
        screenshot::draw(self.session(plate)?, plate.panel, plate.size, dark)
    }

    /// Session from which a plate is drawn.
    pub(super) fn session(&mut self, plate: &Plate) -> anyhow::Result<Session> {
        let input = self.input(plate).with_context(|| format!("the gallery's picture {}", plate.name))?;
        let mut input = input;
        if plate.panel == Panel::Video {
            input.video = Some(self.samples.film(&input)?);
        }
        let mut session = screenshot::session_for(&input, plate.panel)?;
        session.layers = plate.layers;
        Ok(session)
    }

    fn input(&mut self, plate: &Plate) -> anyhow::Result<PanelInput> {
        let mut input = PanelInput { time_s: plate.at_s, ..PanelInput::default() };
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
