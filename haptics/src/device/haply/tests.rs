//! The real code against an emulator of the real protocol, on a pseudo-terminal pair.

use super::*;
use serialport::{SerialPort, TTYPort};
use std::io::{Read, Write};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// What the emulated board does wrong.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fault {
    None,
    /// Every tenth reply is cut short.
    Truncate,
    /// Every tenth reply carries another id.
    WrongId,
    /// Answers nothing at all after the hundredth reply.
    Stall,
}

struct Emulator {
    torques: Arc<Mutex<[f32; 2]>>,
    replies: Arc<AtomicU32>,
    stop: Arc<AtomicBool>,
    thread: Option<std::thread::JoinHandle<Vec<u8>>>,
    open: Option<TTYPort>,
}

impl Emulator {
    /// A board at the other end of `line` whose encoders stand at 60° (port 1) and 120° (port 2).
    fn start(mut line: TTYPort, fault: Fault) -> Self {
        let torques = Arc::new(Mutex::new([0.0; 2]));
        let replies = Arc::new(AtomicU32::new(0));
        let stop = Arc::new(AtomicBool::new(false));
        let (shared, count, end) = (Arc::clone(&torques), Arc::clone(&replies), Arc::clone(&stop));
        line.set_timeout(Duration::from_millis(5)).expect("a pseudo-terminal has time-outs");
        let thread = std::thread::spawn(move || {
            let mut setup = vec![0; 26];
            let mut got = 0;
            while got < 26 && !end.load(Ordering::Relaxed) {
                got += line.read(&mut setup[got..]).unwrap_or(0);
            }
            let mut frame = [0; 10];
            let mut filled = 0;
            while !end.load(Ordering::Relaxed) {
                filled += line.read(&mut frame[filled..]).unwrap_or(0);
                if filled < frame.len() {
                    continue;
                }
                filled = 0;
                let torque = |at: usize| f32::from_le_bytes(frame[at..at + 4].try_into().expect("four bytes"));
                *shared.lock().expect("not poisoned") = [torque(2), torque(6)];
                let number = count.fetch_add(1, Ordering::Relaxed);
                let mut reply = vec![5_u8];
                reply.extend(60.0_f32.to_le_bytes());
                reply.extend(120.0_f32.to_le_bytes());
                match fault {
                    Fault::Truncate if number % 10 == 9 => reply.truncate(4),
                    Fault::WrongId if number % 10 == 9 => reply[0] = 7,
                    Fault::Stall if number >= 100 => reply.clear(),
                    _ => {}
                }
                let _ = line.write_all(&reply);
            }
            setup
        });
        Self { torques, replies, stop, thread: Some(thread), open: None }
    }

    fn torques(&self) -> [f32; 2] {
        *self.torques.lock().expect("not poisoned")
    }

    fn finish(mut self) -> Vec<u8> {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.take().expect("runs once").join().expect("the emulator ends")
    }
}

fn pair(fault: Fault) -> (Board, Emulator) {
    let (mut host, far) = TTYPort::pair().expect("the system has pseudo-terminals");
    host.set_timeout(READ_TIMEOUT).expect("time-out");
    // A pseudo-terminal forgets what was not read when its host end closes; a USB line does not. So it stays open.
    let open = host.try_clone_native().expect("a second handle");
    let mut emulator = Emulator::start(far, fault);
    emulator.open = Some(open);
    let board = Board::start(Box::new(host), BoardModel::V3).expect("a thread");
    (board, emulator)
}

/// Polls until the condition holds; the condition decides, the limit only ends a broken test.
fn until(mut done: impl FnMut() -> bool) -> bool {
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(10) {
        if done() {
            return true;
        }
        std::thread::yield_now();
    }
    false
}

#[test]
fn golden_pose_and_torque_over_the_wire() {
    let (mut board, emulator) = pair(Fault::None);
    assert!(until(|| {
        board.order(Vec2::new(0.0, 1.0));
        board.answer().number > 20 && emulator.torques()[0] > 0.0
    }));
    let tip = board.answer().tip_m;
    assert!((tip - Vec2::new(0.0190, 0.13262)).norm() < 1e-5, "{tip}");
    let [port_1, port_2] = emulator.torques();
    assert!((port_1 - 0.04023).abs() < 1e-5 && (port_2 + 0.04023).abs() < 1e-5, "{port_1} {port_2}");
    drop(board);
    assert!(until(|| emulator.torques() == [0.0; 2]), "the last word is zero torque");
    let setup = emulator.finish();
    assert_eq!(setup[..5], [1, 5, 3, 1, 1]);
}

#[test]
fn silence_from_the_servo_ends_in_zero_torque() {
    let (mut board, emulator) = pair(Fault::None);
    assert!(until(|| {
        board.order(Vec2::new(0.0, 1.0));
        emulator.torques()[0] > 0.0
    }));
    // No order any more: the guard writes zeros by itself.
    assert!(until(|| emulator.torques() == [0.0; 2]));
    drop(board);
    emulator.finish();
}

#[test]
fn cut_and_foreign_replies_are_counted_and_survived() {
    for fault in [Fault::Truncate, Fault::WrongId] {
        let (mut board, emulator) = pair(fault);
        assert!(until(|| {
            board.order(Vec2::zeros());
            board.answer().number > 60
        }));
        let answer = board.answer();
        assert!(answer.faults >= 3, "{} faults seen", answer.faults);
        assert!((answer.tip_m - Vec2::new(0.0190, 0.13262)).norm() < 1e-5, "no wrong position came through");
        drop(board);
        emulator.finish();
    }
}

#[test]
fn a_stalled_board_makes_the_hand_stale_and_the_servo_safe() {
    use crate::servo::safety::Limits;
    use crate::servo::{Loop, Swap};
    let (left, one) = pair(Fault::Stall);
    let (right, two) = pair(Fault::None);
    let world = crate::world::presets::table();
    let place = |x: f64| Placement {
        device_m: Vec2::new(0.019, 0.13262),
        // Both tips pressed 2 mm into the table: there is a force to lose.
        world_m: Vec2::new(x, -0.127),
        scale: 1.0,
    };
    let hand = HaplyHand::new([left, right], [place(-0.02), place(0.02)]);
    let mut servo = Loop::new(Swap::new(world), Box::new(hand), Limits { ramp_s: 0.001, ..Limits::default() });
    // Ticks as fast as the board answers; simulated time counts the watchdog.
    let mut felt = false;
    assert!(until(|| {
        let tick = servo.tick(1e-3);
        // Through the coupling that a board with so little damping needs: 2 mm of 150 N/m.
        felt |= tick.sent_force_n[0].norm() > 0.2;
        if !tick.flags.stale {
            std::thread::sleep(Duration::from_micros(500));
        }
        felt && tick.flags.stale && one.replies.load(Ordering::Relaxed) >= 100
    }));
    assert_eq!(servo.tick(1e-3).sent_force_n, [Vec2::zeros(); 2]);
    drop(servo);
    one.finish();
    two.finish();
}
