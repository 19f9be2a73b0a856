//! A program that is killed leaves no torque in a board: the guard process ends it.

#![cfg(unix)]

use serialport::{SerialPort, TTYPort};
use std::io::{Read, Write};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// What an emulated board has been told: the torque that it would hold now, and how many commands came.
#[derive(Clone, Copy, Default)]
struct Held {
    torque_nm: [f32; 2],
    commands: u64,
    largest_nm: f32,
}

/// A board at the far end of a pseudo-terminal. It keeps its last torque for ever, as the firmware does. Its encoders swing a
/// little.
fn board(mut line: TTYPort, held: &Mutex<Held>, stop: &AtomicBool) {
    line.set_timeout(Duration::from_millis(5)).expect("a pseudo-terminal has time-outs");
    let mut bytes = Vec::new();
    let (mut set_up, begun) = (false, Instant::now());
    while !stop.load(Ordering::Relaxed) {
        let mut some = [0; 64];
        let count = line.read(&mut some).unwrap_or(0);
        bytes.extend_from_slice(&some[..count]);
        loop {
            let wanted = match bytes.first() {
                Some(1) => 26,
                Some(2) => 10,
                Some(_) => 2,
                None => break,
            };
            if bytes.len() < wanted {
                break;
            }
            let frame: Vec<u8> = bytes.drain(..wanted).collect();
            let mut held = held.lock().expect("not poisoned");
            match frame[0] {
                1 => set_up = true,
                2 => {
                    let torque = |at: usize| f32::from_le_bytes(frame[at..at + 4].try_into().expect("four bytes"));
                    held.torque_nm = [torque(2), torque(6)];
                    held.commands += 1;
                    held.largest_nm = held.torque_nm.iter().fold(held.largest_nm, |most, t| most.max(t.abs()));
                    let swing = 2.0 * (begun.elapsed().as_secs_f32() * 3.0).sin();
                    let mut reply = vec![5_u8];
                    reply.extend((60.0 + swing).to_le_bytes());
                    reply.extend((120.0 - swing).to_le_bytes());
                    if set_up {
                        let _ = line.write_all(&reply);
                    }
                }
                _ => held.torque_nm = [0.0; 2],
            }
        }
    }
}

fn wait_for(limit: Duration, mut done: impl FnMut() -> bool) -> bool {
    let begun = Instant::now();
    while begun.elapsed() < limit {
        if done() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    false
}

#[test]
fn a_killed_program_leaves_no_torque() {
    let stop = Arc::new(AtomicBool::new(false));
    let (mut names, mut boards, mut threads) = (Vec::new(), Vec::new(), Vec::new());
    let mut keep = Vec::new();
    for _ in 0..2 {
        let (far, near) = TTYPort::pair().expect("the system has pseudo-terminals");
        names.push(near.name().expect("the near end has a name"));
        // A pseudo-terminal hangs up when its last near end closes; a USB line does not.
        keep.push(near);
        let held = Arc::new(Mutex::new(Held::default()));
        boards.push(Arc::clone(&held));
        let stop = Arc::clone(&stop);
        threads.push(std::thread::spawn(move || board(far, &held, &stop)));
    }
    let device = format!("haply:{},{}", names[0], names[1]);
    let mut program = Command::new(tests::touchstone())
        .args(["device", "test", "--push", "1.5", "--seconds", "20", &device])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let now = |board: usize| *boards[board].lock().expect("not poisoned");
    // The push comes up in the second half.
    let pushed = wait_for(Duration::from_secs(18), || (0..2).all(|b| now(b).torque_nm.iter().any(|t| t.abs() > 0.01)));
    if !pushed {
        let _ = program.kill();
        let mut said = String::new();
        let _ = program.stderr.take().expect("piped").read_to_string(&mut said);
        panic!("no torque came: {} and {} commands; {said}", now(0).commands, now(1).commands);
    }
    program.kill().expect("SIGKILL");
    let _ = program.wait();
    let ended = wait_for(Duration::from_secs(5), || (0..2).all(|b| now(b).torque_nm == [0.0; 2]));
    assert!(ended, "torque is left: {:?} and {:?}", now(0).torque_nm, now(1).torque_nm);
    stop.store(true, Ordering::Relaxed);
    for thread in threads {
        thread.join().expect("the emulator ends");
    }
}

#[test]
fn a_self_test_of_boards_that_never_answer_ends_with_one_and_says_why() {
    let mut keep = Vec::new();
    let names: Vec<String> = (0..2)
        .map(|_| {
            // Nobody reads or writes at the far end: cables without boards.
            let (far, near) = TTYPort::pair().expect("the system has pseudo-terminals");
            let name = near.name().expect("the near end has a name");
            keep.push((far, near));
            name
        })
        .collect();
    let device = format!("haply:{},{}", names[0], names[1]);
    let output = Command::new(tests::touchstone())
        .args(["device", "test", &device, "--seconds", "1", "--json"])
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("the report is printed all the same");
    assert!(report["verdict"].as_str().is_some_and(|v| v.contains("No positions came")), "{report}");
    for board in report["boards"].as_array().expect("two boards") {
        let count = |key: &str| board[key].as_u64().expect("a count");
        assert!(count("answers") > 0 && count("late") == count("answers"), "every answer was late: {board}");
    }
    drop(keep);
}
