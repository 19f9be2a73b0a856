//! `touchstone bench`. This file has `bench servo`: the timing of the servo on this machine, with and without drawing
//! beside it. Without a subcommand, `bench` prints all figures in one table (`whole`).

pub(crate) mod ablation;
pub(crate) mod blind;
pub(crate) mod delay;
mod diagnosis;
pub(crate) mod frames;
mod loglog;
pub(crate) mod online;
mod opening;
mod peers;
mod reliability;
pub(crate) mod scale;
pub(crate) mod table;
mod verdict;
mod whole;
mod window;

use super::{ControlArgs, Output};
use anyhow::Context;
use clap::{Args, Subcommand};
use haptics::device::{MouseTarget, mouse};
use haptics::servo::rate::RateChoice;
use haptics::servo::timing::Timing;
use haptics::servo::{Percentiles, Privileges, Servo, ServoConfig, Snapshot, Swap};
use haptics::world::{World, presets};
use render::{Headless, SceneView, ViewOptions};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Size of the pictures that are drawn beside the servo, pixels.
const PICTURE: (u32, u32) = (1280, 720);
/// Period of the fingers' motion, s.
const ROUND_S: f64 = 2.5;

/// Arguments of `bench`.
#[derive(Args)]
pub struct Bench {
    #[command(subcommand)]
    what: Option<What>,
    #[command(flatten)]
    whole: whole::WholeBench,
}

#[derive(Subcommand)]
enum What {
    /// Every figure in one table, beside other programs where they are installed; the same without a word
    All(whole::WholeBench),
    /// How the work grows with samples, blocks and logs, on choice as a picture
    Scale(scale::ScaleBench),
    /// Lateness, compute time, missed deadlines and stalls of the servo thread
    Servo(ServoBench),
    /// How often the diagnosis names what is hidden in generated recordings, and how often something where nothing is
    Blind(blind::BlindBench),
    /// Which constants of the estimation decide answers: each halved and doubled (for developers; builds the sources)
    Ablation(ablation::AblationBench),
    /// How long diagnoses of a minute at 1 kHz take
    Diagnosis(diagnosis::DiagnosisBench),
    /// What a picture of each panel costs the processor, with a long log
    Frames(frames::FramesBench),
    /// How long tasks take over a slow line, with and without a model that answers at once (simulated time)
    Delay(delay::DelayBench),
    /// Cost of a sample of the estimator beside the servo, against a tick of the servo
    Online(online::OnlineBench),
}

#[derive(Args)]
struct ServoBench {
    /// How long to measure
    #[arg(long, default_value_t = 60.0)]
    seconds: f64,
    /// Servo rate, Hz, or `auto`: what the servo would choose
    #[arg(long, default_value = "auto", value_parser = parse_rate)]
    rate: RateChoice,
    /// Draw the scene in software as fast as it goes on another thread
    #[arg(long)]
    render: bool,
    /// Do not ask the system for real-time scheduling
    #[arg(long)]
    no_real_time: bool,
    #[command(flatten)]
    control: ControlArgs,
}

fn parse_rate(text: &str) -> Result<RateChoice, String> {
    if text == "auto" {
        return Ok(RateChoice::Auto);
    }
    text.parse().map(RateChoice::Fixed).map_err(|_| format!("`{text}` is no rate; write a number in Hz or `auto`"))
}

/// What `bench servo --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said<'a> {
    /// The servo's punctuality.
    timing: &'a Timing,
    /// Why it ran at this rate.
    why: String,
    /// About single stalls; null without any.
    stalls: Option<String>,
    /// What the system granted.
    privileges: Privileges,
    /// How often the guard made the device safe because the servo stood still.
    guarded: u64,
    /// How long was measured, s.
    seconds: f64,
    /// Pictures that were drawn beside it; null: none were asked for.
    pictures: Option<u64>,
    /// What drew them.
    renderer: Option<&'a str>,
    /// Most damping of the passivity controller, N s/m; null: it was off.
    #[serde(rename = "passivity_control_N_s_m")]
    passivity_control_n_s_m: Option<f64>,
    /// Whether every limit is kept.
    holds: bool,
    /// The limits of this rate.
    limits: [verdict::Held; 4],
    /// The same for people.
    verdict: &'a str,
}

impl Bench {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        match self.what.as_ref() {
            None => self.whole.run(),
            Some(what) => what.run(),
        }
    }

    #[cfg(test)]
    pub(super) fn passivity_control(&self) -> Option<f64> {
        match self.what.as_ref()? {
            What::Servo(bench) => bench.control.passivity_control,
            _ => None,
        }
    }
}

impl What {
    fn run(&self) -> anyhow::Result<Output> {
        match self {
            Self::All(bench) => bench.run(),
            Self::Scale(bench) => bench.run(),
            Self::Servo(bench) => bench.run(),
            Self::Online(bench) => bench.run(),
            Self::Blind(bench) => bench.run(),
            Self::Ablation(bench) => bench.run(),
            Self::Diagnosis(bench) => bench.run(),
            Self::Frames(bench) => bench.run(),
            Self::Delay(bench) => bench.run(),
        }
    }
}

/// Result of a measurement.
struct Measured {
    timing: Timing,
    privileges: Privileges,
    guarded: u64,
    wall_s: f64,
    /// Maximum damping of the passivity controller, N s/m.
    control: Option<f64>,
    frames: Option<u64>,
    renderer: Option<String>,
}

impl ServoBench {
    fn run(&self) -> anyhow::Result<Output> {
        anyhow::ensure!(
            self.seconds > 0.0 && self.seconds <= 86_400.0,
            "a bench of {} s is not possible; choose up to a day",
            self.seconds
        );
        let painter = if self.render { Some(Painter::start()?) } else { None };
        let mut measured = self.measure(painter.as_ref())?;
        if let Some(painter) = painter {
            (measured.frames, measured.renderer) = (Some(painter.frames()), Some(painter.adapter.clone()));
            painter.finish()?;
        }
        Ok(report(&measured)?)
    }

    /// Runs the pinch scene under fingers that circle, close and open: contacts come and go as they do for a person.
    fn measure(&self, painter: Option<&Painter>) -> anyhow::Result<Measured> {
        let world = presets::stacking();
        let center = world.blocks[0].start.center_m;
        let start = MouseTarget { center_in_world: center, aperture_m: 0.04 };
        let (mut handle, device) = mouse(start, world.hand.workspace);
        let config = ServoConfig {
            rate: self.rate,
            real_time: !self.no_real_time,
            passivity_control_n_s_m: self.control.passivity_control,
            ..ServoConfig::default()
        };
        let mut servo = Servo::start(Swap::new(world), Box::new(device), config)?;
        let mut ticks = Vec::new();
        let begun = Instant::now();
        while begun.elapsed().as_secs_f64() < self.seconds && servo.is_running() {
            // As in a window: at the refresh rate of a screen.
            std::thread::sleep(Duration::from_millis(16));
            let (sin, cos) = (std::f64::consts::TAU * begun.elapsed().as_secs_f64() / ROUND_S).sin_cos();
            let moved = haptics::Vec2::new(0.01 * sin, 0.012 * (1.0 + cos));
            handle.set(MouseTarget { center_in_world: center + moved, aperture_m: 0.022 + 0.012 * cos });
            ticks.clear();
            servo.drain(&mut ticks);
            if let Some(painter) = painter {
                painter.show(servo.newest());
            }
        }
        let wall_s = begun.elapsed().as_secs_f64();
        let (privileges, guarded) = (servo.privileges(), servo.guarded());
        let snapshot = servo.newest();
        if let Some(fault) = snapshot.fault {
            anyhow::bail!("{fault}");
        }
        let timing = snapshot.timing;
        anyhow::ensure!(timing.ticks > 0, "{} s are too short for a figure; choose a second or more", self.seconds);
        let control = config.passivity_control_n_s_m;
        Ok(Measured { timing, privileges, guarded, wall_s, control, frames: None, renderer: None })
    }
}

fn report(m: &Measured) -> serde_json::Result<Output> {
    let t = &m.timing;
    let mut text = format!("Servo: {}\n  {}\n", t.rate.sentence(), m.privileges.sentence());
    let _ = writeln!(text, "  {} ticks of {:.0} µs in {:.1} s", t.ticks, 1e6 * t.period_s, m.wall_s);
    for (what, p) in percentiles(t) {
        let [p50, p99, p999, max] = [p.p50_s, p.p99_s, p.p999_s, p.max_s].map(crate::text::format::short_time);
        let _ = writeln!(text, "  {what:<10} p50 {p50:>9}   p99 {p99:>9}   p99.9 {p999:>9}   max {max:>9}");
    }
    let share = 100.0 * t.missed as f64 / t.ticks.max(1) as f64;
    let _ = writeln!(text, "  missed deadlines: {} ({share:.3} %); the guard acted {} times", t.missed, m.guarded);
    let _ = writeln!(text, "  {}", t.stall_sentence().unwrap_or_else(|| "No single stall above 1 ms.".to_owned()));
    match (m.frames, &m.renderer) {
        (Some(frames), Some(name)) => {
            let rate = frames as f64 / m.wall_s;
            let size = format!("{} × {}", PICTURE.0, PICTURE.1);
            let _ = writeln!(text, "  beside it: {frames} pictures of {size} drawn by {name}, {rate:.1} a second");
        }
        _ => text.push_str("  nothing was drawn beside it\n"),
    }
    if let Some(most) = m.control {
        let _ = writeln!(text, "  the passivity controller was on, with up to {most} N s/m");
    }
    let limits = verdict::limits(t);
    let verdict = verdict::sentence(&limits);
    let _ = writeln!(text, "  {verdict}");
    let said = Said {
        timing: t,
        why: t.rate.sentence(),
        stalls: t.stall_sentence(),
        privileges: m.privileges,
        guarded: m.guarded,
        seconds: m.wall_s,
        pictures: m.frames,
        renderer: m.renderer.as_deref(),
        passivity_control_n_s_m: m.control,
        holds: limits.iter().all(verdict::Limit::is_kept),
        limits: limits.each_ref().map(verdict::Held::from),
        verdict: &verdict,
    };
    Ok(Output { text, json: serde_json::to_value(&said)? })
}

fn percentiles(t: &Timing) -> [(&'static str, Percentiles); 4] {
    [("period", t.period), ("lateness", t.lateness), ("compute", t.compute), ("force age", t.force_age)]
}

/// Thread that draws the newest state repeatedly.
struct Painter {
    newest: Arc<std::sync::Mutex<Option<Snapshot>>>,
    stop: Arc<AtomicBool>,
    count: Arc<AtomicU64>,
    adapter: String,
    thread: std::thread::JoinHandle<Result<(), render::RenderError>>,
}

impl Painter {
    fn start() -> anyhow::Result<Self> {
        let mut headless = Headless::software().context("nothing can be drawn beside the servo")?;
        let adapter = headless.adapter().to_owned();
        let world = presets::stacking();
        let newest = Arc::new(std::sync::Mutex::new(None));
        let (stop, count) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicU64::new(0)));
        let (seen, asked, drawn) = (Arc::clone(&newest), Arc::clone(&stop), Arc::clone(&count));
        let thread = std::thread::Builder::new().name("painter".to_owned()).spawn(move || {
            while !asked.load(Ordering::Relaxed) {
                if let Some(snapshot) = newest_of(&seen) {
                    paint(&mut headless, &world, &snapshot)?;
                    drawn.fetch_add(1, Ordering::Relaxed);
                } else {
                    std::thread::yield_now();
                }
            }
            Ok(())
        })?;
        Ok(Self { newest, stop, count, adapter, thread })
    }

    fn show(&self, snapshot: &Snapshot) {
        // A panic of the painter is reported at the end.
        if let Ok(mut newest) = self.newest.lock() {
            *newest = Some(snapshot.clone());
        }
    }

    fn frames(&self) -> u64 {
        self.count.load(Ordering::Relaxed)
    }

    fn finish(self) -> anyhow::Result<()> {
        self.stop.store(true, Ordering::Relaxed);
        match self.thread.join() {
            Ok(drawn) => drawn.context("the scene could not be drawn beside the servo"),
            Err(_) => anyhow::bail!("the drawing beside the servo ended in a fault; measure without --render"),
        }
    }
}

fn newest_of(shared: &std::sync::Mutex<Option<Snapshot>>) -> Option<Snapshot> {
    shared.lock().ok()?.clone()
}

fn paint(headless: &mut Headless, world: &World, snapshot: &Snapshot) -> Result<(), render::RenderError> {
    let options = ViewOptions::default();
    let view = SceneView { world, state: &snapshot.state, options: &options };
    headless.render(&view, PICTURE.0, PICTURE.1).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_bench_measures_everything_it_prints() {
        let control = ControlArgs { passivity_control: Some(2.0) };
        let bench =
            ServoBench { seconds: 0.8, rate: RateChoice::Fixed(500.0), render: false, no_real_time: true, control };
        let output = bench.run().expect("a servo");
        assert!(output.json["timing"]["ticks"].as_u64().is_some_and(|n| n >= 100), "{}", output.json);
        assert_eq!(output.json["privileges"]["fifo"], false);
        for quantity in ["period", "lateness", "compute", "force_age"] {
            let p = &output.json["timing"][quantity];
            let [p50, p999] = ["p50_s", "p999_s"].map(|key| p[key].as_f64().expect("a number"));
            assert!(p50 > 0.0 && p999 >= p50, "{quantity}: {p}");
        }
        assert!(output.text.contains("500 Hz, as asked for."), "{}", output.text);
        assert_eq!(output.json["passivity_control_N_s_m"], 2.0);
        let kept = output.json["limits"].as_array().is_some_and(|all| all.iter().all(|limit| limit["holds"] == true));
        assert_eq!(output.json["holds"], kept);
        assert!(output.text.contains(if kept { "holds this rate" } else { "does not hold this rate" }));
        let nonsense = ServoBench { seconds: -1.0, ..bench };
        assert!(nonsense.run().is_err());
    }

    #[test]
    fn rates_are_read_or_refused_in_words() {
        assert_eq!(parse_rate("auto"), Ok(RateChoice::Auto));
        assert_eq!(parse_rate("4000"), Ok(RateChoice::Fixed(4000.0)));
        assert!(parse_rate("fast").is_err_and(|e| e.contains("auto")));
    }
}
