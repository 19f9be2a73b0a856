//! What the system granted to the servo is what the servo says, with the right to real time and without it; both work.
//!
//! The test runs its own program once more with the rights taken away (`setpriv`, `prlimit` of util-linux), and looks the truth up
//! in `/proc`.

#![cfg(target_os = "linux")]

use haptics::device::{ScriptedOperator, Skill};
use haptics::servo::{Privileges, Servo, ServoConfig, Swap};
use haptics::world::{State, presets};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Set in the run that has no right to anything.
const WITHOUT: &str = "TOUCHSTONE_TEST_WITHOUT_RIGHTS";

/// Scheduling policy of this process's thread of a name, as the kernel sees it; 1 is `SCHED_FIFO`.
fn policy_of(thread: &str) -> Option<u32> {
    let tasks = std::fs::read_dir("/proc/self/task").ok()?;
    let task = tasks
        .flatten()
        .map(|task| task.path())
        .find(|task| std::fs::read_to_string(task.join("comm")).is_ok_and(|name| name.trim() == thread))?;
    let stat = std::fs::read_to_string(task.join("stat")).ok()?;
    // proc(5): field 41 is the policy; the name before may hold blanks and ends with the last bracket.
    stat.rsplit_once(')')?.1.split_whitespace().nth(41 - 3)?.parse().ok()
}

/// Memory that is locked, kB.
fn locked_kb() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find(|line| line.starts_with("VmLck:"))?.split_whitespace().nth(1)?.parse().ok()
}

/// Whether this process may have real time at the servo's priority: by capability or by limit.
fn may_have_real_time() -> Option<bool> {
    const SYS_NICE: u64 = 1 << 23;
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let effective = status.lines().find(|line| line.starts_with("CapEff:"))?.split_whitespace().nth(1)?;
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let limit = limits.lines().find(|line| line.starts_with("Max realtime priority"))?.split_whitespace().nth(3)?;
    let limit = limit.parse().unwrap_or(u64::MAX);
    Some(u64::from_str_radix(effective, 16).ok()? & SYS_NICE != 0 || limit >= 50)
}

/// Starts a servo, lets it tick, and compares what it says with what the kernel says.
fn run(real_time: bool) -> Privileges {
    let world = presets::stacking();
    let operator = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 1);
    let config = ServoConfig { real_time, ..ServoConfig::at(1000.0) };
    let mut servo = Servo::start(Swap::new(world), Box::new(operator), config).expect("a thread");
    let begun = Instant::now();
    while servo.newest().timing.ticks < 600 && begun.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(5));
    }
    let granted = servo.privileges();
    assert_eq!(granted.asked, real_time);
    assert_eq!(policy_of("servo"), Some(u32::from(granted.fifo)), "{granted:?}");
    assert_eq!(locked_kb().map(|kb| kb > 0), Some(granted.memory_locked), "{granted:?}");
    let snapshot = servo.newest();
    // It works in any case, and says in numbers what it reaches.
    assert!(snapshot.fault.is_none() && snapshot.timing.ticks >= 600, "{:?}", snapshot.timing);
    let reached = snapshot.timing.recent;
    assert!(reached.ticks > 0 && (1e-4..0.1).contains(&reached.period.p50_s) && reached.lateness.p99_s > 0.0);
    assert!(snapshot.tick.sent_force_n.iter().all(|force| force.norm() <= config.limits.max_force_n + 1e-9));
    granted
}

#[test]
fn what_the_servo_says_of_its_rights_is_what_the_kernel_gave() {
    if std::env::var_os(WITHOUT).is_some() {
        let refused = run(true);
        assert_eq!(refused, Privileges { asked: true, fifo: false, memory_locked: false });
        assert!(refused.sentence().contains("refused real time"), "{}", refused.sentence());
        return;
    }
    // First without asking: nothing may have been locked before.
    let unasked = run(false);
    assert_eq!(unasked, Privileges::default());
    let granted = run(true);
    assert_eq!(Some(granted.fifo), may_have_real_time(), "{}", granted.sentence());
    assert_eq!(granted.sentence().starts_with("Real-time"), granted.fifo);
}

fn has(program: &str) -> bool {
    let run = Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    run.is_ok_and(|status| status.success())
}

/// The other test of this file, without the right to real time and locked memory.
fn without_rights(program: &Path) -> Command {
    let mut command = if may_have_real_time() == Some(true) && has("setpriv") {
        // The limits of a user who may everything count for nothing: the capabilities have to go.
        let mut command = Command::new("setpriv");
        command
            .args(["--bounding-set", "-sys_nice,-ipc_lock,-sys_resource", "--inh-caps", "-sys_nice,-ipc_lock"])
            .arg("prlimit");
        command
    } else {
        Command::new("prlimit")
    };
    command.args(["--rtprio=0", "--memlock=0", "--"]).arg(program);
    command.args(["--exact", "what_the_servo_says_of_its_rights_is_what_the_kernel_gave"]).env(WITHOUT, "1");
    command
}

#[test]
fn a_servo_that_is_refused_real_time_and_locked_memory_works_and_says_so() {
    if !has("prlimit") {
        tests::skipped("there is no prlimit here");
        return;
    }
    let program = std::env::current_exe().expect("this program has a place");
    let output = without_rights(&program).output().expect("it starts");
    let text = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success() && text.contains("1 passed"), "{text}");
}
