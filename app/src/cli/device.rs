//! `touchstone device`: available devices, and a self-test with a text report.

mod open;
pub mod report;

use super::{ControlArgs, Output};
use crate::cli::device::report::limits;
use clap::{Args, Subcommand};
use haptics::Vec2;
use haptics::device::channel::ChannelConfig;
use haptics::device::haply;
use haptics::servo::force_test::MOST_N;
use haptics::servo::{Servo, ServoConfig, Swap, TickRecord};
use haptics::world::{State, World, presets};

use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write;
use std::time::{Duration, Instant};

/// Arguments of `device`.
#[derive(Args)]
pub struct Device {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Devices that are built in or plugged in, with what each can render
    List(List),
    /// Run the servo with a device and say how well it goes
    Test(Test),
}

#[derive(Args)]
struct List {
    /// Servo rate for which the limits are computed, Hz
    #[arg(long, default_value_t = 1000.0)]
    rate: f64,
}

#[derive(Args)]
struct Test {
    /// A device as `device list` writes it, like `udp:127.0.0.1,hand.key`
    #[arg(value_name = "DEVICE", conflicts_with = "device")]
    named: Option<String>,
    /// The same
    #[arg(long)]
    device: Option<String>,
    /// Servo rate, Hz
    #[arg(long, default_value_t = 1000.0)]
    rate: f64,
    /// How long to watch
    #[arg(long, default_value_t = 3.0)]
    seconds: f64,
    /// Push both fingers upwards with so much force, N, coming up softly; hold the device when you use this
    #[arg(long, default_value_t = 0.0)]
    push: f64,
    /// Put the device behind a network: delay one way, ms
    #[arg(long, default_value_t = 0.0)]
    delay: f64,
    /// Extra delay of each packet, up to this, ms
    #[arg(long, default_value_t = 0.0)]
    jitter: f64,
    /// Share of the packets that is lost, 0 to 1
    #[arg(long, default_value_t = 0.0)]
    loss: f64,
    /// Use wave variables on this network
    #[arg(long)]
    waves: bool,
    #[command(flatten)]
    control: ControlArgs,
}

/// What `device list --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Listed {
    /// Devices that are built in or plugged in.
    devices: Vec<OfDevice>,
    /// Serial ports that a board could be behind.
    serial_ports: Vec<String>,
}

/// A kind of device.
#[derive(JsonSchema, Serialize)]
struct OfDevice {
    /// How `device test` names it.
    id: String,
    /// What it is, for people.
    what: String,
    /// Its figures; null where these are known only once it is opened.
    spec: Option<report::Spec>,
    /// What it can render; null where no force is felt.
    limits: Option<limits::Limits>,
}

impl Device {
    /// Runs the test. Returns the report, and true if no check failed outright.
    pub(super) fn run(&self) -> anyhow::Result<(Output, bool)> {
        match &self.what {
            What::List(list) => Ok((list.run()?, true)),
            What::Test(test) => test.run(),
        }
    }
}

fn check_rate(rate_hz: f64) -> anyhow::Result<()> {
    anyhow::ensure!((50.0..=8000.0).contains(&rate_hz), "a rate of {rate_hz} Hz is not possible; choose 50 to 8000");
    Ok(())
}

impl List {
    fn run(&self) -> anyhow::Result<Output> {
        check_rate(self.rate)?;
        let period_s = 1.0 / self.rate;
        let kinds = open::kinds(&presets::stacking());
        let ports = haply::ports();
        let mut text = String::from("Devices\n");
        for kind in &kinds {
            let _ = writeln!(text, "  {}\n      {}", kind.id, kind.what);
            if let Some(spec) = &kind.spec {
                let _ = writeln!(text, "      {}", limits::limit_sentence(spec, period_s, 0.0));
            }
        }
        text.push_str("Serial ports that a Haply board could be behind\n");
        if ports.is_empty() {
            text.push_str("  none; plug a board in, and see that you are in the group dialout\n");
        }
        for port in &ports {
            let _ = writeln!(text, "  {port}");
        }
        if let [left, right, ..] = ports.as_slice() {
            let _ = writeln!(text, "Try: touchstone device test haply:{left},{right}");
        }
        let devices = kinds.iter().map(|kind| OfDevice {
            id: kind.id.to_string(),
            what: kind.what.to_string(),
            spec: kind.spec.as_ref().map(report::Spec::from),
            limits: kind.spec.as_ref().and_then(|spec| limits::limits(spec, period_s, 0.0)),
        });
        let listed = Listed { devices: devices.collect(), serial_ports: ports };
        Ok(Output { text, json: serde_json::to_value(&listed)? })
    }
}

impl Test {
    fn run(&self) -> anyhow::Result<(Output, bool)> {
        check_rate(self.rate)?;
        anyhow::ensure!(
            self.seconds > 0.0 && self.seconds <= 3600.0,
            "a test of {} s is not possible; choose up to 3600 s",
            self.seconds
        );
        anyhow::ensure!(
            (0.0..=MOST_N).contains(&self.push),
            "a push of {} N is not possible; choose up to {MOST_N} N",
            self.push
        );
        let world = presets::stacking();
        let name = self.named.as_deref().or(self.device.as_deref()).unwrap_or("scripted");
        let opened = self.behind_a_network(open::open(name, &world)?, &world)?;
        let spec = opened.device.spec().clone();
        // Lives until the test is over: the thread that reads a gamepad, for example.
        let _keep = opened.keep;
        let state = State::new(&world, opened.start_in_world);
        let config =
            ServoConfig { passivity_control_n_s_m: self.control.passivity_control, ..ServoConfig::at(self.rate) };
        let mut servo = Servo::start(Swap::at(world, state), opened.device, config)?;
        eprintln!("{}: watching for {} s. {}", spec.name, self.seconds, opened.hint);
        let ticks = self.watch(&mut servo);
        let privileges = servo.privileges();
        let snapshot = servo.newest();
        if let Some(fault) = snapshot.fault {
            anyhow::bail!("{fault}");
        }
        let measured = report::Measured {
            spec: &spec,
            delay_s: snapshot.delay_s,
            timing: &snapshot.timing,
            privileges,
            ticks: &ticks,
            hint: opened.hint,
            packets: opened.packets.as_ref(),
            answers: opened.answers.as_ref(),
            push_n: self.push,
            line_n_m: snapshot.line_n_m,
            coupling_n_m: snapshot.coupling.map(|coupling| coupling.stiffness_n_m),
        };
        Ok((measured.report()?, !measured.has_failed()))
    }

    fn behind_a_network(&self, opened: open::Opened, world: &World) -> anyhow::Result<open::Opened> {
        let config = ChannelConfig {
            delay_s: 1e-3 * self.delay,
            jitter_s: 1e-3 * self.jitter,
            loss: self.loss,
            seed: 1,
            waves: None,
        };
        open::behind_a_network(opened, config, self.waves, world, 1.0 / self.rate)
    }

    /// Runs the servo; pushes in the second half if that was requested.
    fn watch(&self, servo: &mut Servo) -> Vec<TickRecord> {
        let mut ticks = Vec::new();
        let begun = Instant::now();
        loop {
            let elapsed_s = begun.elapsed().as_secs_f64();
            if elapsed_s >= self.seconds || !servo.is_running() {
                break;
            }
            let pushing = self.push > 0.0 && elapsed_s > 0.5 * self.seconds;
            servo.test_force(pushing.then(|| [Vec2::new(0.0, self.push); 2]));
            // The servo runs on its own thread; this one only empties the ring in time.
            std::thread::sleep(Duration::from_millis(50));
            servo.drain(&mut ticks);
        }
        servo.test_force(None);
        ticks
    }
}
