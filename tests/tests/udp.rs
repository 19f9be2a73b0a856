//! The example clients of `docs/udp`, run against the real device: they press on the table and feel it.

use haptics::device::Device;
use haptics::device::udp::{Key, Refused, UdpConfig, UdpDevice, UdpMonitor, Waves};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, presets};
use std::net::{Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const DIGITS: &str = "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f";
/// A client that hangs is stopped after this: it only ends a broken test.
const LIMIT: Duration = Duration::from_mins(1);

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/udp")
}

/// A loop in which a remote device touches the empty table, on choice by waves, and its packet counters.
fn servo(with_waves: bool) -> (Loop, UdpMonitor) {
    let world = presets::table();
    let key = Key::from_hex(DIGITS).expect("64 digits");
    let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
    let mut config = UdpConfig { listen, ..UdpConfig::loopback(key) };
    config.spec.damping_n_s_m = 10.0;
    config.waves = with_waves.then(|| Waves::new(&config.spec, &world, 1e-3));
    let start = State::resting(&world).input.tip_in_world;
    let device = UdpDevice::open(config, start).expect("a free port");
    assert!(device.spec().force_feedback);
    let monitor = device.monitor();
    (Loop::new(Swap::new(world), Box::new(device), Limits::default()), monitor)
}

/// Ticks until the client is done; returns what it printed.
fn serve(servo: &mut Loop, mut client: Child) -> serde_json::Value {
    let begun = Instant::now();
    let mut last = begun;
    while client.try_wait().expect("a child of ours").is_none() {
        std::thread::sleep(Duration::from_millis(1));
        let now = Instant::now();
        servo.tick((now - last).as_secs_f64().clamp(1e-4, 0.01));
        last = now;
        if begun.elapsed() > LIMIT {
            let _ = client.kill();
        }
    }
    let output = client.wait_with_output().expect("it has ended");
    let (text, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{text}{errors}");
    serde_json::from_str(&text).expect("one JSON object")
}

fn check(report: &serde_json::Value, monitor: &UdpMonitor, with_waves: bool) {
    let number = |name: &str| report[name].as_f64().expect("a number");
    // 2 to 3 mm into a pad of 2500 N/m, limited to 4 N. By waves, of which a busy machine's bursts lose some, what the line carries:
    // 1.2 N where packets come evenly, 0.8 N where four programs want two processors.
    let force = number("largest_force_N");
    let least_n = if with_waves { 0.4 } else { 1.0 };
    assert!(force > least_n && force <= 4.001, "{report}");
    assert!(number("answers") > 20.0, "{report}");
    assert!(monitor.accepted() > 20 && monitor.greeted() >= 1);
    assert_eq!(monitor.refused(Refused::Seal), 0, "both sides seal alike");
}

fn has(program: &str) -> bool {
    Command::new(program)
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|s| s.success())
}

fn key_file(folder: &Path, digits: &str) -> PathBuf {
    let path = folder.join("hand.key");
    std::fs::write(&path, format!("{digits}\n")).expect("a temporary folder");
    path
}

fn python(monitor: &UdpMonitor, key: &Path, seconds: &str, more: &[&str]) -> Child {
    Command::new("python3")
        .arg(docs().join("client.py"))
        .args(["--port", &monitor.address().port().to_string(), "--seconds", seconds, "--key"])
        .arg(key)
        .args(more)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("python3 starts")
}

#[test]
fn the_python_client_feels_the_table() {
    if !has("python3") {
        tests::skipped("there is no python3 here");
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (mut servo, monitor) = servo(false);
    let report = serve(&mut servo, python(&monitor, &key_file(folder.path(), DIGITS), "3", &[]));
    check(&report, &monitor, false);
}

#[test]
fn the_python_client_leans_on_the_table_by_waves_over_a_slow_network() {
    if !has("python3") {
        tests::skipped("there is no python3 here");
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (mut servo, monitor) = servo(true);
    let client = python(&monitor, &key_file(folder.path(), DIGITS), "8", &["--waves", "--delay", "60"]);
    let report = serve(&mut servo, client);
    let number = |name: &str| report[name].as_f64().expect("a number");
    assert!(monitor.accepted() > 100 && monitor.refused(Refused::Seal) == 0, "{report}");
    assert!(number("round_trip_s") >= 0.12, "the network is slow: {report}");
    // 10 mm under the table with 400 N/m of arm and b/d, about 150 N/m, of line: about 1 N. A busy machine, whose packets come
    // in bursts, loses some of it with time; it never swings.
    assert!((0.4..2.5).contains(&number("largest_force_N")), "it leans: {report}");
    assert!(number("last_swing_m") < 3e-3, "at rest: {report}");
    assert!(number("least_energy_J") > -1e-4, "no energy was given out: {report}");
}

#[test]
fn a_client_with_another_key_gets_no_answer() {
    if !has("python3") {
        tests::skipped("there is no python3 here");
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (mut servo, monitor) = servo(false);
    let mut client = python(&monitor, &key_file(folder.path(), &DIGITS.replace("00", "ff")), "1", &[]);
    let begun = Instant::now();
    while client.try_wait().expect("a child of ours").is_none() && begun.elapsed() < LIMIT {
        std::thread::sleep(Duration::from_millis(1));
        servo.tick(1e-3);
    }
    let _ = client.kill();
    let output = client.wait_with_output().expect("it has ended");
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && errors.contains("nobody answers"), "{errors}");
    assert!(monitor.refused(Refused::Seal) > 0);
    assert_eq!((monitor.accepted(), monitor.greeted()), (0, 0));
}

#[test]
#[cfg(unix)]
fn the_c_client_compiles_without_warnings_and_feels_the_table() {
    if !has("cc") {
        tests::skipped("there is no C compiler here");
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let program = folder.path().join("client");
    let status = Command::new("cc")
        .args(["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-o"])
        .arg(&program)
        .arg(docs().join("client.c"))
        .arg("-lm")
        .status()
        .expect("cc starts");
    assert!(status.success(), "client.c compiles");
    for (with_waves, more) in [(false, None), (true, Some("waves"))] {
        let (mut servo, monitor) = servo(with_waves);
        let client = Command::new(&program)
            .args(["127.0.0.1", &monitor.address().port().to_string()])
            .arg(key_file(folder.path(), DIGITS))
            .arg("2")
            .args(more)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it starts");
        let report = serve(&mut servo, client);
        check(&report, &monitor, with_waves);
    }
}
