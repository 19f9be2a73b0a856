//! The command line: one command per file, `--json` everywhere, one sentence on an error.
//!
//! Exit codes: 0 done, 1 the input or the run failed, 2 wrong usage.

pub(crate) mod bench;
pub(crate) mod convert;
pub(crate) mod demo;
pub(crate) mod device;
pub(crate) mod diagnose;
mod enough;
pub(crate) mod export;
pub(crate) mod fit;
pub(crate) mod gallery;
pub(crate) mod history;
pub(crate) mod info;
pub(crate) mod lessons;
pub(crate) mod part;
mod progress;
pub(crate) mod record;
pub(crate) mod report;
pub(crate) mod score;
pub(crate) mod screenshot;
mod segment;
pub(crate) mod simulate;
mod stated;
pub(crate) mod suggest;
pub mod table;

use crate::tasks::Chosen;
use crate::ui::shell::run;
use clap::{Args, Parser, Subcommand};
use estimator::log::{LogError, Part, Watch};
use haptics::device::haply::farewell;
use haptics::recording::Recording;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

/// Touchstone: a trainer whose virtual objects are measured, not guessed.
#[derive(Parser)]
#[command(name = "touchstone", version, about, max_term_width = 100)]
struct Cli {
    /// One JSON object on standard output and nothing else there
    #[arg(long, global = true)]
    json: bool,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// The whole chain on built-in recordings: segment, fit, calibrate, simulate, diagnose, extend, pictures, report
    Demo(demo::Demo),
    /// Columns, units, rate, length, warnings of a log
    Info(info::Info),
    /// States and subtasks of a log
    Segment(segment::Segment),
    /// Parameters, constraints, uncertainty; writes a calibrated world
    Fit(fit::Fit),
    /// What the simulation gets wrong, why, and what mending it gains
    Diagnose(diagnose::Diagnose),
    /// The measured motion of a log through a world: predicted forces
    Simulate(simulate::Simulate),
    /// Everything about one or several logs on one HTML page that needs nothing else
    Report(report::Report),
    /// How well a task was done, from the recording of a trainee's attempt
    Score(score::Score),
    /// Who practised what, when, and how well; learning curves, and a table for other programs
    History(history::History),
    /// Lessons: what there is to learn, what their experts need
    Lessons(lessons::Lessons),
    /// Make a recording from the virtual hand
    Record(record::Record),
    /// A picture without a window
    Screenshot(screenshot::Screenshot),
    /// Every panel and scene as pictures, light and dark, with a page that shows them
    Gallery(gallery::Gallery),
    /// A log in another format: csv, mcap or parquet, by the ending of the output
    Convert(convert::Convert),
    /// A world as a file of another simulator: MuJoCo's MJCF, URDF or SDF, and what has no counterpart there
    Export(export::Export),
    /// Devices that drive the hand, and a self-test in words
    Device(device::Device),
    /// How punctual the servo is on this machine, and how good the diagnosis is
    Bench(bench::Bench),
    /// Open the app, optionally on a log or a world
    App(AppArgs),
    /// Ends a board's torque when the program that started this is gone (started by `touchstone` itself)
    #[command(name = farewell::ARGUMENT, hide = true)]
    TorqueGuard {
        /// The board's id
        id: u8,
    },
}

/// What the app opens with.
#[derive(Args, Default)]
struct AppArgs {
    /// Log to open
    log: Option<PathBuf>,
    /// Sidecar of the log, when it does not lie beside it
    #[arg(long)]
    meta: Option<PathBuf>,
    /// World to open in the trainer: a file, or stack, crank, needle, barrel, switch, guide or table
    #[arg(long)]
    world: Option<PathBuf>,
    /// Task of the log: block-stack, crank, needle, mechanism, barrel, switch, payload, a task of yours, or its JSON file
    #[arg(long, value_parser = find_task)]
    task: Option<Chosen>,
    /// Close the window when its first picture stands, and say so: what `touchstone bench` measures
    #[arg(long, hide = true)]
    until_first_picture: bool,
}

/// A log on the command line.
#[derive(Args, Clone)]
struct LogArgs {
    /// Sidecar, when it is not `<stem>.meta.json` beside the log
    #[arg(long)]
    meta: Option<PathBuf>,
    /// Task of the log: block-stack, crank, needle, mechanism, barrel, switch, payload, a task of yours, or its JSON file (docs/tasks.md);
    /// told from the sidecar and the columns when not given
    #[arg(long)]
    task: Option<String>,
    #[command(flatten)]
    part: part::PartArgs,
}

/// The passivity controller, where a command runs a servo.
#[derive(Args, Clone, Copy, Debug, Default)]
struct ControlArgs {
    /// Let the passivity controller brake while more energy was given out than taken in: it adds a damping of up to so many
    /// N s/m; the observer alone always watches
    #[arg(long, value_name = "MOST", num_args = 0..=1, require_equals = true, default_missing_value = USUAL_CONTROL,
        value_parser = parse_control)]
    passivity_control: Option<f64>,
}

/// Value of `--passivity-control` without a number, N s/m.
const USUAL_CONTROL: &str = "2";

fn parse_control(text: &str) -> Result<f64, String> {
    let most =
        text.parse().ok().filter(|most| *most > 0.0 && *most <= crate::ui::train::trainer::control::MOST_CONTROL_N_S_M);
    most.ok_or_else(|| {
        format!(
            "`{text}` is no damping; write up to {} N s/m, like 2",
            crate::ui::train::trainer::control::MOST_CONTROL_N_S_M
        )
    })
}

/// Task on the command line; an invalid one is wrong usage.
fn find_task(text: &str) -> Result<Chosen, String> {
    Chosen::find(text).map_err(|error| error.to_string())
}

/// Reads a log, with a progress message if it is long.
fn read(path: &Path, meta: Option<&Path>, part: &Part) -> Result<Vec<Recording>, LogError> {
    let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
    progress::during(&format!("reading {name}"), |share| {
        let never = AtomicBool::new(false);
        let watch = Watch { progress: &|done| share.tell(done), cancelled: &never, preview: None };
        estimator::log::load_part(path, meta, part, &watch)
    })
}

impl LogArgs {
    fn load(&self, path: &Path) -> anyhow::Result<Vec<Recording>> {
        let recordings = read(path, self.meta.as_deref(), &self.part.stated()?)?;
        self.with_task(recordings)
    }

    /// [`Self::load`] without a progress message.
    fn load_quietly(&self, path: &Path) -> anyhow::Result<Vec<Recording>> {
        let part = self.part.stated()?;
        self.with_task(estimator::log::load_part(path, self.meta.as_deref(), &part, &Watch::none())?)
    }

    fn with_task(&self, mut recordings: Vec<Recording>) -> anyhow::Result<Vec<Recording>> {
        if let Some(task) = self.task.as_deref().map(Chosen::find).transpose()? {
            for recording in &mut recordings {
                task.give_to(recording);
            }
        }
        Ok(recordings)
    }
}

/// Output of a command: text for the user, or one JSON object.
pub(crate) struct Output {
    /// Text for the user.
    pub text: String,
    /// JSON for programs.
    pub json: serde_json::Value,
}

impl Output {
    fn say(self, json: bool) {
        use std::io::Write;
        let text = if json { self.json.to_string() } else { self.text };
        // A closed pipe (`| head`) is not an error.
        let _ = writeln!(std::io::stdout(), "{}", text.trim_end());
    }
}

/// Parses the arguments and runs the command.
pub fn main() -> ExitCode {
    crate::tasks::use_own_folder();
    let cli = Cli::parse();
    start_log(cli.json);
    let result = match cli.command {
        None => return open_app(AppArgs::default()),
        Some(Command::App(args)) => return open_app(args),
        Some(Command::TorqueGuard { id }) => {
            let guarded = farewell::guard(std::io::stdin(), std::io::stdout(), id);
            return if guarded.is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
        }
        Some(Command::Demo(args)) => args.run(),
        Some(Command::Info(args)) => args.run(),
        Some(Command::Segment(args)) => args.run(),
        Some(Command::Fit(args)) => args.run(),
        Some(Command::Diagnose(args)) if args.is_fleet() => {
            return ended(args.run_fleet());
        }
        Some(Command::Diagnose(args)) => args.run(),
        Some(Command::Simulate(args)) => args.run(),
        Some(Command::Report(args)) => {
            // With a problem, the page is complete, but a log is missing in it.
            return ended(args.run().map(|(output, problem)| {
                output.say(cli.json);
                problem
            }));
        }
        Some(Command::Score(args)) => args.run(),
        Some(Command::History(args)) => args.run(),
        Some(Command::Lessons(args)) => args.run(),
        Some(Command::Record(args)) => args.run(),
        Some(Command::Screenshot(args)) => args.run(),
        Some(Command::Gallery(args)) => args.run(),
        Some(Command::Convert(args)) => args.run(),
        Some(Command::Export(args)) => args.run(),
        Some(Command::Device(args)) => {
            return match args.run() {
                Ok((output, passed)) => {
                    output.say(cli.json);
                    // A failed self-test sets the exit code, after its report.
                    if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
                }
                Err(error) => fail(&error),
            };
        }
        Some(Command::Bench(args)) => args.run(),
    };
    match result {
        Ok(output) => {
            output.say(cli.json);
            ExitCode::SUCCESS
        }
        Err(error) => fail(&error),
    }
}

/// Exit code of a command that does its work in spite of a problem, and tells it.
fn ended(problem: anyhow::Result<Option<String>>) -> ExitCode {
    match problem {
        Ok(None) => ExitCode::SUCCESS,
        Ok(Some(problem)) => fail(&anyhow::Error::msg(problem)),
        Err(error) => fail(&error),
    }
}

fn fail(error: &anyhow::Error) -> ExitCode {
    eprintln!("{}", sentence(error));
    ExitCode::FAILURE
}

/// Text without line breaks and control characters, which the terminal could interpret: file names may contain them.
fn plain(text: &str) -> String {
    haptics::text_file::one_line(text)
}

/// Error as one line: the problem, then its causes.
fn sentence(error: &anyhow::Error) -> String {
    let chain: Vec<String> = error.chain().map(|cause| plain(&cause.to_string())).collect();
    let mut parts: Vec<&str> = Vec::new();
    for part in &chain {
        // Many causes are repeated in their parent's sentence.
        if !parts.iter().any(|before| before.contains(part.as_str())) {
            parts.push(part);
        }
    }
    parts.join(": ")
}

fn open_app(args: AppArgs) -> ExitCode {
    let options = run::RunOptions {
        log: args.log,
        meta: args.meta,
        world: args.world,
        task: args.task,
        dark: None,
        until_first_picture: args.until_first_picture,
    };
    match run::run(options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error),
    }
}

/// Starts the log messages on standard error: warnings by default, more with `RUST_LOG`.
fn start_log(quiet: bool) {
    let default = if quiet { "error" } else { "warn,winit=error,wgpu_hal=off,wgpu_core=error,zbus=error" };
    let filter = tracing_subscriber::EnvFilter::try_from_default_env()
        .unwrap_or_else(|_| tracing_subscriber::EnvFilter::new(default));
    let _ = tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).without_time().try_init();
}

/// Parses `1280x720`.
pub(crate) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let (w, h) = text.split_once(['x', 'X', '×']).ok_or("a size is written like 1280x720")?;
    let side = |s: &str| match s.trim().parse::<u32>() {
        Ok(n) if (16..=8192).contains(&n) => Ok(n),
        _ => Err(format!("`{s}` is not a side between 16 and 8192 pixels")),
    };
    Ok([side(w)?, side(h)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn sizes_are_read_or_refused_in_words() {
        assert_eq!(parse_size("1280x720"), Ok([1280, 720]));
        assert!(parse_size("1280").is_err_and(|e| e.contains("1280x720")));
        assert!(parse_size("9x9999999").is_err());
    }

    #[test]
    fn a_passivity_controller_has_a_number_or_the_usual_one() {
        let of = |flag: &str| {
            let cli = Cli::try_parse_from(["touchstone", "bench", "servo", flag]).ok()?;
            let Some(Command::Bench(bench)) = cli.command else { return None };
            bench.passivity_control()
        };
        assert_eq!(of("--passivity-control").map(|most| most.to_string()), Some(USUAL_CONTROL.to_owned()));
        assert_eq!(of("--passivity-control=7.5"), Some(7.5));
        assert_eq!(of("--no-real-time"), None);
        for wrong in ["0", "-1", "NaN", "1e9", "much"] {
            assert!(parse_control(wrong).is_err_and(|e| e.contains("N s/m")), "{wrong}");
        }
    }

    #[test]
    fn a_sentence_says_nothing_twice() {
        let inner = std::io::Error::other("disk full");
        let error = anyhow::Error::new(inner).context("the log could not be written (disk full)");
        assert_eq!(sentence(&error), "the log could not be written (disk full)");
    }
}
