//! `touchstone device`: what could drive the hand, and a self-test in words.

use super::Output;
use clap::{Args, Subcommand};
use haptics::Vec2;
use haptics::device::haply::{self, BoardModel, HaplyHand, Placement};
use haptics::device::{Device as Hand, DeviceSpec, ScriptedOperator, Skill};
use haptics::servo::timing::Timing;
use haptics::servo::{Privileges, Servo, ServoConfig, Swap, passivity};
use haptics::world::{State, World, presets};
use serde_json::json;
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
    /// Devices that are built in or plugged in
    List,
    /// Run the servo with a device and say how well it goes
    Test(Test),
}

#[derive(Args)]
struct Test {
    /// `scripted`, or `haply:LEFT_PORT,RIGHT_PORT`
    #[arg(long, default_value = "scripted")]
    device: String,
    /// Servo rate, Hz
    #[arg(long, default_value_t = 1000.0)]
    rate: f64,
    /// How long to watch
    #[arg(long, default_value_t = 3.0)]
    seconds: f64,
}

impl Device {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        match &self.what {
            What::List => Ok(list()),
            What::Test(test) => test.run(),
        }
    }
}

fn list() -> Output {
    let built_in = [
        ("mouse", "Mouse: moves both fingers, the left button pinches; the force is shown, not felt"),
        ("scripted", "Scripted operator: does the tasks like a person"),
        ("replay:LOG", "Replay of a log"),
    ];
    let ports = haply::ports();
    let mut text = String::from("Built in\n");
    for (id, what) in built_in {
        let _ = writeln!(text, "  {id:<12} {what}");
    }
    text.push_str("Serial ports that a Haply board could be behind\n");
    if ports.is_empty() {
        text.push_str("  none; plug a board in, and see that you are in the group dialout\n");
    }
    for port in &ports {
        let _ = writeln!(text, "  {port}");
    }
    if ports.len() >= 2 {
        let _ = writeln!(text, "Try: touchstone device test --device haply:{},{}", ports[0], ports[1]);
    }
    let devices: Vec<_> = built_in.iter().map(|(id, what)| json!({ "id": id, "what": what })).collect();
    Output { text, json: json!({ "devices": devices, "serial_ports": ports }) }
}

impl Test {
    fn run(&self) -> anyhow::Result<Output> {
        anyhow::ensure!(
            self.seconds > 0.0 && self.seconds <= 3600.0,
            "a test of {} s is not possible; choose up to 3600 s",
            self.seconds
        );
        let world = presets::stacking();
        let device = self.device(&world)?;
        let spec = device.spec().clone();
        let config = ServoConfig::at(self.rate);
        let mut servo = Servo::start(Swap::new(world), device, config)?;
        let mut ticks = Vec::new();
        let begun = Instant::now();
        while begun.elapsed().as_secs_f64() < self.seconds && servo.is_running() {
            // The servo works on its own thread; this one only empties the ring in time.
            std::thread::sleep(Duration::from_millis(50));
            servo.drain(&mut ticks);
        }
        let stale = ticks.iter().filter(|t| t.flags.stale).count();
        let privileges = servo.privileges();
        let snapshot = servo.newest();
        if let Some(fault) = snapshot.fault {
            anyhow::bail!("{fault}");
        }
        let timing = snapshot.timing;
        Ok(report(&spec, &timing, privileges, ticks.len(), stale))
    }

    fn device(&self, world: &World) -> anyhow::Result<Box<dyn Hand>> {
        if self.device == "scripted" {
            return Ok(Box::new(ScriptedOperator::new(world, &State::resting(world), Skill::default(), 1)));
        }
        let Some((left, right)) = self.device.strip_prefix("haply:").and_then(|ports| ports.split_once(',')) else {
            anyhow::bail!("there is no device `{}`; use scripted or haply:LEFT_PORT,RIGHT_PORT", self.device);
        };
        let boards = [haply::open(left, BoardModel::V3)?, haply::open(right, BoardModel::V3)?];
        let center = world.hand.workspace.center_m;
        let place = |x: f64| Placement {
            // The middle of a 2DIY's workspace.
            device_m: Vec2::new(0.019, 0.12),
            world_m: center + Vec2::new(x, 0.0),
            scale: 1.0,
        };
        Ok(Box::new(HaplyHand::new(boards, [place(-0.012), place(0.012)])))
    }
}

fn report(spec: &DeviceSpec, timing: &Timing, privileges: Privileges, ticks: usize, stale: usize) -> Output {
    let period_s = timing.period_s;
    let stiffness = passivity::passive_stiffness(spec, 0.0, period_s);
    let mut text = format!("{}\n", spec.name);
    let _ = writeln!(text, "  {} ticks at {:.0} Hz; {}", ticks, 1.0 / period_s, privileges.sentence());
    for (what, p) in [("late by", timing.lateness), ("working for", timing.compute)] {
        let [p50, p99, p999, max] = [p.p50_s, p.p99_s, p.p999_s, p.max_s].map(crate::ui::format::short_time);
        let _ = writeln!(text, "  {what:<12} p50 {p50:>9}   p99 {p99:>9}   p99.9 {p999:>9}   max {max:>9}");
    }
    let _ = writeln!(text, "  deadlines missed: {}; ticks without fresh positions: {stale}", timing.missed);
    let _ = writeln!(
        text,
        "  stiffest wall that stays passive at this rate: {stiffness:.0} N/m ({})",
        if spec.force_feedback { "computed from the device's damping, friction and resolution" } else { "not felt" }
    );
    let verdict = if stale > 0 {
        "The device did not keep up: positions were stale and the force was zero then. Check the cable."
    } else if timing.lateness.p99_s > 0.5 * period_s {
        "The machine does not hold this rate; choose a lower one."
    } else {
        "The servo holds this rate."
    };
    let _ = writeln!(text, "  {verdict}");
    let json = json!({
        "device": spec.name,
        "ticks": ticks,
        "stale_ticks": stale,
        "timing": timing,
        "privileges": privileges,
        "passive_stiffness_N_m": stiffness,
        "verdict": verdict,
    });
    Output { text, json }
}
