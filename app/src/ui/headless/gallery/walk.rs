//! The complete workflow of a person, by pointer and keys. It drops a foreign table, maps its columns, checks the
//! states, moves a boundary, tries a value, diagnoses, extends, compares by feel, and writes the report. Every step is
//! checked and can be drawn.

use crate::text::format;
use crate::ui::diagnose::state::EXTEND;
use crate::ui::document::opening;
use crate::ui::headless::screenshot::in_whole_window;
use crate::ui::kit::theme;
use crate::ui::scene::callback;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::message_list::Tone;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::trainer::live::Clock;
use anyhow::{Context as _, anyhow, bail};
use blind::{Bench, Effect, Spec};
use egui::{Event, Key, Modifiers, Pos2, Role, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use egui_kittest::wgpu::WgpuTestRenderer;
use haptics::recording::Recording;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Maximum time of any operation that a person waits for.
const PATIENCE: Duration = Duration::from_mins(2);
/// Seed of the generated recording in the walk.
const SEED: u64 = 3;

/// Names of the steps, with a description each.
pub const STEPS: [(&str, &str); 9] = [
    ("drop", "Drop a log on the window"),
    ("map", "Its columns have foreign names: say what they mean, and see what comes of it"),
    ("states", "States and values are there"),
    ("boundary", "A boundary is dragged, and the fit follows"),
    ("value", "Another value is tried on the replay"),
    ("diagnose", "What the model gets wrong, with its name and its size"),
    ("extend", "The model with the cause in it, and the gain"),
    ("feel", "Before and after, under the hand"),
    ("report", "Everything on one page, to hand on"),
];

/// Performs the complete workflow in a folder; `look` receives every step's picture where `draw` is set.
pub fn walk(
    folder: &Path,
    size: [u32; 2],
    dark: bool,
    draw: bool,
    mut look: impl FnMut(&str, Option<image::RgbaImage>) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let table = foreign_crank(folder)?;
    let mut walker = Walker::new(size, dark, draw)?;
    let mut step = |walker: &mut Walker, name: &str| {
        look(name, walker.picture()?)?;
        // A person's pace would outlast these banners.
        walker.harness.state_mut().session.messages.banners.retain(|banner| banner.tone != Tone::Done);
        anyhow::Ok(())
    };
    walker.hover(&table);
    step(&mut walker, "drop")?;
    walker.drop_it(&table)?;
    step(&mut walker, "map")?;
    walker.accept_mapping()?;
    step(&mut walker, "states")?;
    walker.drag_a_boundary()?;
    step(&mut walker, "boundary")?;
    walker.take_back()?;
    walker.try_a_value()?;
    step(&mut walker, "value")?;
    walker.diagnose()?;
    step(&mut walker, "diagnose")?;
    walker.extend()?;
    step(&mut walker, "extend")?;
    walker.feel()?;
    step(&mut walker, "feel")?;
    walker.report(&folder.join("report.html"))?;
    step(&mut walker, "report")
}

/// A turned crank with an unmodelled ripple, as another program writes it.
pub(super) fn foreign_crank(folder: &Path) -> anyhow::Result<PathBuf> {
    let effects = vec![(Effect::Ripple, 0)];
    let spec = Spec::hiding(effects, 2.0, Bench::OneFinger);
    let made: Recording = blind::make(&spec, SEED).0.recordings.remove(0);
    let tip = estimator::signal::task::tip_series(&made, "").map_err(|error| anyhow!(error.to_string()))?;
    let (time, force) = (made.time_s.as_ref().context("there is no clock")?, tip.force.context("there is no force")?);
    let mut text = String::from("Takt [ms],Griff X (mm),Griff Y (mm),Kraft X / N,Kraft Y / N\n");
    for ((t, p), f) in time.iter().zip(&tip.position).zip(&force) {
        let _ = writeln!(text, "{:.3},{:.5},{:.5},{:.5},{:.5}", 1e3 * t, 1e3 * p.x, 1e3 * p.y, f.x, f.y);
    }
    let path = folder.join("kurbel-7.csv");
    std::fs::write(&path, text).context("the table could not be written")?;
    Ok(path)
}

fn window(size: [u32; 2], dark: bool, draw: bool) -> anyhow::Result<Harness<'static, App>> {
    let mut session = Session::new();
    session.training.trainer.clock = Clock::Manual;
    session.workspace = Workspace::Calibrate;
    // The walk waits for the refit; the duration of the first one on a busy machine must not decide whether it runs.
    session.calibration.refits.at_once = Duration::MAX;
    let builder = Harness::builder()
        .with_size(egui::vec2(size[0] as f32, size[1] as f32))
        .with_theme(if dark { egui::Theme::Dark } else { egui::Theme::Light })
        .with_accessibility_check(false)
        .allow_missing_glyphs()
        .with_render_cursor(false)
        .with_max_steps(8);
    let show = |ui: &mut egui::Ui, app: &mut App| in_whole_window(ui, |ui| app.show(ui));
    let app = App::new(session);
    if !draw {
        return Ok(builder.with_context_setup(theme::install).build_ui_state(show, app));
    }
    render::Headless::new().map(drop)?;
    let options = egui_wgpu::RendererOptions::default();
    let state = egui_kittest::wgpu::create_render_state(egui_kittest::wgpu::default_wgpu_setup(), options);
    let surface = state.clone();
    let builder = builder.with_context_setup(move |ctx| {
        theme::install(ctx);
        callback::announce(ctx, &surface);
    });
    Ok(builder.renderer(WgpuTestRenderer::from_render_state(state)).build_ui_state(show, app))
}

/// Driver of the walk.
pub(super) struct Walker {
    pub(super) harness: Harness<'static, App>,
    draw: bool,
    /// Positions of its clicks, points.
    pub(super) clicked: Vec<Pos2>,
}

impl Walker {
    pub(super) fn new(size: [u32; 2], dark: bool, draw: bool) -> anyhow::Result<Self> {
        Ok(Self { harness: window(size, dark, draw)?, draw, clicked: Vec::new() })
    }

    fn session(&self) -> &Session {
        &self.harness.state().session
    }

    fn picture(&mut self) -> anyhow::Result<Option<image::RgbaImage>> {
        self.harness.run_steps(4);
        if !self.draw {
            return Ok(None);
        }
        self.harness.render().map(Some).map_err(|error| anyhow!(error))
    }

    /// Runs frames until a condition holds.
    fn until(&mut self, what: &str, so: impl Fn(&Session) -> bool) -> anyhow::Result<()> {
        let begun = Instant::now();
        while !so(self.session()) {
            if begun.elapsed() > PATIENCE {
                bail!("{what} did not come: {:?}", self.session().messages.banners);
            }
            std::thread::sleep(Duration::from_millis(5));
            self.harness.run_steps(1);
        }
        self.harness.run_steps(3);
        Ok(())
    }

    /// Runs frames until no job is active and a change counts as complete.
    fn calm(&mut self) -> anyhow::Result<()> {
        self.harness.run_steps(3);
        self.until("rest", |s| !s.jobs.is_busy() && !s.calibration.stale)?;
        self.harness.run_steps(50);
        Ok(())
    }

    fn click(&mut self, role: Role, label: &str) -> anyhow::Result<()> {
        let node = self.harness.query_by_role_and_label(role, label);
        let node = node.with_context(|| format!("there is no `{label}` to click"))?;
        self.clicked.push(node.rect().center());
        node.click();
        self.harness.run_steps(3);
        Ok(())
    }

    /// Opens a drop-down and selects one of its entries.
    fn choose(&mut self, list: &str, entry: &str) -> anyhow::Result<()> {
        self.click(Role::ComboBox, list)?;
        let last = |h: &Harness<'static, App>| h.query_all_by_label(entry).last().map(|node| node.scroll_to_me());
        last(&self.harness).with_context(|| format!("`{list}` has no entry `{entry}`"))?;
        // Long lists scroll.
        self.harness.run_steps(6);
        if let Some(node) = self.harness.query_all_by_label(entry).last() {
            self.clicked.push(node.rect().center());
            node.click();
        }
        self.harness.run_steps(3);
        Ok(())
    }

    fn hover(&mut self, path: &Path) {
        let file = egui::HoveredFile { path: Some(path.to_path_buf()), ..egui::HoveredFile::default() };
        self.harness.input_mut().hovered_files.push(file);
        self.harness.run_steps(2);
    }

    pub(super) fn drop_it(&mut self, path: &Path) -> anyhow::Result<()> {
        self.harness.input_mut().hovered_files.clear();
        let ctx = self.harness.ctx.clone();
        opening::open_dropped(&mut self.harness.state_mut().session, &ctx, &[path.to_path_buf()]);
        self.until("the mapping", |s| s.mapping.is_some())?;
        self.until("its preview", previewed)?;
        let meanings = [
            ("Takt [ms]", "t_s · time"),
            ("Griff X (mm)", "x_m · position, horizontal"),
            ("Griff Y (mm)", "y_m · position, vertical"),
            ("Kraft X / N", "fx_N · force, horizontal"),
            ("Kraft Y / N", "fy_N · force, vertical"),
        ];
        for (column, meaning) in meanings {
            let name = meaning.split(' ').next().unwrap_or_default();
            let rows = self.session().mapping.as_ref().map(|m| m.draft.sidecar().columns).unwrap_or_default();
            let stem = name.split('_').next().unwrap_or_default();
            // A correct guess needs no click.
            if rows.iter().any(|(key, file)| file == column && key.split('_').next() == Some(stem)) {
                continue;
            }
            self.choose(&format!("Meaning of {column}"), meaning)?;
        }
        self.choose("Task", "crank")?;
        self.until("the preview", previewed)
    }

    pub(super) fn accept_mapping(&mut self) -> anyhow::Result<()> {
        self.click(Role::Button, "Save sidecar and open")?;
        self.until("the fit", |s| s.mapping.is_none() && s.calibration.analysis.is_some())?;
        self.calm()
    }

    pub(super) fn drag_a_boundary(&mut self) -> anyhow::Result<()> {
        let states = self
            .session()
            .calibration
            .segmentation(self.session().document.current)
            .context("there are no states")?
            .states
            .clone();
        let (index, first) =
            states.iter().enumerate().find(|(_, i)| i.t1 - i.t0 > 0.5).context("all states are short")?;
        let label = format!("Boundary at {} s", format::number(first.t1, 2));
        let grip = self.harness.query_by_label(&label).context("the boundary cannot be taken hold of")?.rect().center();
        self.harness.drag_at(grip);
        self.harness.run_steps(1);
        for part in 1..=8_u8 {
            self.harness.hover_at(pos2(grip.x - 3.0 * f32::from(part), grip.y));
            self.harness.run_steps(1);
        }
        self.harness.drop_at(pos2(grip.x - 24.0, grip.y));
        self.calm()?;
        let now = self
            .session()
            .calibration
            .segmentation(self.session().document.current)
            .and_then(|s| s.states.get(index))
            .map_or(first.t1, |i| i.t1);
        if now > first.t1 - 0.05
            || !self.session().calibration.segmentation(self.session().document.current).is_some_and(|s| s.by_hand)
        {
            bail!("the boundary at {} s did not move ({now} s)", first.t1);
        }
        Ok(())
    }

    /// Undoes the move of the boundary.
    fn take_back(&mut self) -> anyhow::Result<()> {
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        self.calm()?;
        if self.session().calibration.segmentation(self.session().document.current).is_some_and(|s| s.by_hand) {
            bail!("Ctrl+Z did not take the boundary back");
        }
        Ok(())
    }

    fn try_a_value(&mut self) -> anyhow::Result<()> {
        self.click(Role::Row, "crank.weight_N")?;
        // The other slider is the time, in the middle.
        let sliders = self.harness.query_all_by_role(Role::Slider).map(|s| s.rect());
        let slider = sliders.max_by(|a, b| a.left().total_cmp(&b.left()));
        let at = slider.context("there is no slider for the value")?;
        let half = pos2(at.left() + 0.78 * at.width(), at.center().y);
        self.harness.drag_at(half);
        self.harness.run_steps(2);
        self.harness.drop_at(half);
        self.until("the replay of another value", |s| {
            s.calibration.what_if.is_on() && !s.calibration.what_if.is_behind()
        })?;
        self.calm()
    }

    fn diagnose(&mut self) -> anyhow::Result<()> {
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::D);
        self.harness.run_steps(2);
        self.until("the diagnosis", |s| s.diagnosing.answer.is_some() || s.diagnosing.problem.is_some())?;
        let answer = self.session().diagnosing.answer.as_ref().context("there is no diagnosis")?;
        let found: Vec<&str> = answer.diagnosis.causes.iter().map(|c| c.id.as_str()).collect();
        if found != ["position-ripple"] {
            bail!("a ripple was hidden, and found was {found:?}");
        }
        Ok(())
    }

    fn extend(&mut self) -> anyhow::Result<()> {
        self.click(Role::Button, "Extend the model")?;
        self.until("the extended model", |s| s.diagnosing.worlds.is_some() && !s.jobs.is_running(EXTEND))
    }

    fn feel(&mut self) -> anyhow::Result<()> {
        self.click(Role::Button, "Feel it in Train")?;
        self.until("the trainer", |s| s.workspace == Workspace::Train && s.training.trainer.compare.is_some())?;
        let before = self.session().training.trainer.choice;
        self.harness.key_press(Key::B);
        self.harness.run_steps(3);
        if self.session().training.trainer.choice == before {
            bail!("the key B did not switch between the worlds");
        }
        Ok(())
    }

    fn report(&mut self, to: &Path) -> anyhow::Result<()> {
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::Num2);
        self.harness.run_steps(3);
        self.write_into("Where the report goes", &to.display().to_string())?;
        self.click(Role::Button, "Write report")?;
        let begun = Instant::now();
        while !std::fs::read_to_string(to).is_ok_and(|text| text.trim_end().ends_with("</html>")) {
            if begun.elapsed() > PATIENCE {
                bail!("the report was not written: {:?}", self.session().messages.banners);
            }
            std::thread::sleep(Duration::from_millis(20));
            self.harness.run_steps(1);
        }
        // The name of a temporary folder should not appear.
        self.write_into("Where the report goes", "report.html")?;
        self.calm()
    }

    fn write_into(&mut self, field: &str, text: &str) -> anyhow::Result<()> {
        let node = self.harness.query_by_role_and_label(Role::TextInput, field);
        let node = node.with_context(|| format!("there is no field `{field}`"))?;
        node.scroll_to_me();
        node.focus();
        self.harness.run_steps(3);
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.harness.event(Event::Text(text.to_owned()));
        self.harness.run_steps(2);
        Ok(())
    }
}

fn previewed(session: &Session) -> bool {
    session.mapping.as_ref().is_some_and(|m| m.preview.seen.is_some() && !m.preview.is_stale(&session.jobs))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_whole_way_is_walked_by_pointer_and_keys() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut seen = Vec::new();
        let walked = walk(folder.path(), [1280, 720], true, false, |name, _| {
            seen.push(name.to_owned());
            Ok(())
        });
        assert!(walked.is_ok(), "{walked:?} after {seen:?}");
        assert_eq!(seen, STEPS.map(|(name, _)| name));
        let report = std::fs::read_to_string(folder.path().join("report.html")).expect("written");
        assert!(report.contains("kurbel-7.csv") && report.contains("ipple"));
    }
}
