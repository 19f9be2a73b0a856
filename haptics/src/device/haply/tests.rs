//! The real code against an emulator of the real protocol, on a pseudo-terminal pair.

use super::protocol::setup_frame;
use super::turns::Turns;
use super::*;
use serialport::{SerialPort, TTYPort};
use std::io::{Read, Write};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// Fault of the emulated board.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fault {
    None,
    /// Every tenth reply is cut short.
    Truncate,
    /// Every tenth reply carries another id.
    WrongId,
    /// Three bytes of noise stand before every tenth reply.
    Noise,
    /// Every fiftieth reply has angles of 30° and 150°: 60 mm away.
    Jump,
    /// Answers nothing any more once `Shared::stalled` is set.
    Stall,
    /// The thirtieth reply comes 35 ms late. The first angle says which question is answered: a tenth of a degree each.
    Late,
}

/// Encoder angles unless told otherwise, degrees in port order.
const POSE: [f32; 2] = [60.0, 120.0];

/// State shared by the test and the emulator.
#[derive(Default)]
struct Shared {
    /// Every torque so far, N m in port order.
    torques: Mutex<Vec<[f32; 2]>>,
    pose: Mutex<[f32; 2]>,
    replies: AtomicU32,
    stalled: AtomicBool,
    stop: AtomicBool,
}

impl Shared {
    fn reply(&self, fault: Fault) -> Vec<u8> {
        let number = self.replies.fetch_add(1, Ordering::Relaxed);
        let mut pose = *self.pose.lock().expect("not poisoned");
        if fault == Fault::Late {
            pose[0] = 0.1 * number as f32;
            let late_ms = if number == 29 { 35 } else { 0 };
            std::thread::sleep(Duration::from_millis(late_ms));
        }
        let tenth = number % 10 == 9;
        let [one, two] = if fault == Fault::Jump && number % 50 == 49 { [30.0, 150.0] } else { pose };
        let mut reply = vec![5_u8];
        reply.extend(one.to_le_bytes());
        reply.extend(two.to_le_bytes());
        match fault {
            Fault::Truncate if tenth => reply.truncate(4),
            Fault::WrongId if tenth => reply[0] = 7,
            Fault::Noise if tenth => drop(reply.splice(0..0, [9, 9, 9])),
            Fault::Stall if self.stalled.load(Ordering::Relaxed) => reply.clear(),
            _ => {}
        }
        reply
    }
}

struct Emulator {
    shared: Arc<Shared>,
    thread: Option<std::thread::JoinHandle<Vec<u8>>>,
    open: Option<TTYPort>,
}

impl Emulator {
    /// A board at the other end of `line`.
    fn start(mut line: TTYPort, fault: Fault) -> Self {
        let shared = Arc::new(Shared { pose: Mutex::new(POSE), ..Shared::default() });
        let own = Arc::clone(&shared);
        line.set_timeout(Duration::from_millis(5)).expect("a pseudo-terminal has time-outs");
        let thread = std::thread::spawn(move || {
            let mut setup = vec![0; 26];
            let mut got = 0;
            while got < 26 && !own.stop.load(Ordering::Relaxed) {
                got += line.read(&mut setup[got..]).unwrap_or(0);
            }
            let mut frame = [0; 10];
            let mut filled = 0;
            while !own.stop.load(Ordering::Relaxed) {
                filled += line.read(&mut frame[filled..]).unwrap_or(0);
                if filled < frame.len() {
                    continue;
                }
                filled = 0;
                let torque = |at: usize| f32::from_le_bytes(frame[at..at + 4].try_into().expect("four bytes"));
                own.torques.lock().expect("not poisoned").push([torque(2), torque(6)]);
                let _ = line.write_all(&own.reply(fault));
            }
            setup
        });
        Self { shared, thread: Some(thread), open: None }
    }

    /// The newest torques, N m in port order.
    fn torques(&self) -> [f32; 2] {
        self.shared.torques.lock().expect("not poisoned").last().copied().unwrap_or_default()
    }

    /// Puts the encoders elsewhere, degrees in port order; returns where the tip is then, m in the device's frame.
    fn turn_to(&self, pose: [f32; 2]) -> Vec2 {
        *self.shared.pose.lock().expect("not poisoned") = pose;
        FiveBar::V3.tip([pose[1], pose[0]].map(|degrees| f64::from(degrees).to_radians())).expect("within reach")
    }

    fn finish(mut self) -> Vec<u8> {
        self.shared.stop.store(true, Ordering::Relaxed);
        self.thread.take().expect("runs once").join().expect("the emulator ends")
    }
}

fn pair(fault: Fault) -> (Board, Emulator) {
    let (mut host, far) = TTYPort::pair().expect("the system has pseudo-terminals");
    host.set_timeout(READ_TIMEOUT).expect("time-out");
    // The host end stays open: a pseudo-terminal forgets unread bytes when its host end closes; a USB line does not.
    let open = host.try_clone_native().expect("a second handle");
    let mut emulator = Emulator::start(far, fault);
    emulator.open = Some(open);
    let board = Board::start(Box::new(host), BoardModel::V3).expect("a thread");
    (board, emulator)
}

/// A pose a little further on every step: 0.1° of both cranks, a fraction of a millimetre.
fn pose_at(step: u16) -> [f32; 2] {
    POSE.map(|degrees| degrees + 0.1 * f32::from(step % 200))
}

/// Polls until the condition holds; the condition decides, the limit only ends a broken test.
pub(super) fn until(mut done: impl FnMut() -> bool) -> bool {
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
fn silence_from_the_servo_ends_in_zero_torque_within_hundredths_of_a_second() {
    let (mut board, emulator) = pair(Fault::None);
    // Any try shows that the guard's time is short; a busy machine may spoil some.
    let quick = (0..20).any(|_| {
        assert!(until(|| {
            board.order(Vec2::new(0.0, 1.0));
            emulator.torques()[0] > 0.0
        }));
        // No order any more: the guard writes zeros by itself.
        let silent = Instant::now();
        assert!(until(|| emulator.torques() == [0.0; 2]));
        // Three times the 20 ms that are promised.
        silent.elapsed() < Duration::from_millis(60)
    });
    assert!(quick, "the torque stayed for longer than 60 ms in every try");
    drop(board);
    emulator.finish();
}

#[test]
fn after_every_broken_reply_the_next_are_right() {
    let told = [
        (Fault::Truncate, tally::Fault::Late),
        (Fault::WrongId, tally::Fault::Foreign),
        (Fault::Noise, tally::Fault::Foreign),
    ];
    for (fault, why) in told {
        let (mut board, emulator) = pair(fault);
        assert!(until(|| board.answer().number > 0));
        // Each pose is a new one: an answer of before cannot pass for that of now.
        for step in 1..=100 {
            let tip = emulator.turn_to(pose_at(step));
            assert!(until(|| (board.answer().tip_m - tip).norm() < 1e-7), "the answer to step {step} never came");
        }
        let (answer, tally) = (board.answer(), board.tally());
        assert!(answer.faults >= 3 && tally.faults() >= answer.faults, "{} faults seen", answer.faults);
        assert!(tally.count(why) >= 3, "{} counted as {why:?}", tally.count(why));
        // At least every tenth; a busy machine loses more.
        assert!(tally.faults() * 15 >= tally.asked(), "{} of {} were counted", tally.faults(), tally.asked());
        drop(board);
        emulator.finish();
    }
}

#[test]
fn after_a_late_reply_the_positions_are_again_of_the_same_turn() {
    let (mut host, far) = TTYPort::pair().expect("the system has pseudo-terminals");
    host.set_timeout(READ_TIMEOUT).expect("time-out");
    host.write_all(&setup_frame(BoardModel::V3.id, BoardModel::V3.ports)).expect("it takes the set-up");
    let emulator = Emulator::start(far, Fault::Late);
    let mut turns = Turns::new(Box::new(host), BoardModel::V3.id);
    let answers: Vec<Option<u32>> =
        (0..500).map(|_| turns.turn([0.0; 2]).ok().map(|angles| (10.0 * angles[0]).round() as u32)).collect();
    assert!(answers[29].is_none(), "the late one is not believed");
    // Nothing is ever taken for the answer to another question, whatever a busy machine delays besides.
    for (question, answer) in answers.iter().enumerate() {
        assert!(answer.is_none_or(|answer| answer == question as u32), "turn {question}: {answer:?} of {answers:?}");
    }
    assert!(answers[40..].iter().filter(|answer| answer.is_some()).count() > 400, "and soon they come again");
    drop(turns);
    emulator.finish();
}

#[test]
fn a_reply_that_jumps_moves_no_finger_and_makes_no_torque() {
    let (mut board, emulator) = pair(Fault::Jump);
    let tip = emulator.turn_to(POSE);
    let mut farthest_m = 0.0_f64;
    assert!(until(|| {
        board.order(Vec2::new(0.0, 1.0));
        let answer = board.answer();
        if answer.number > 0 {
            farthest_m = farthest_m.max((answer.tip_m - tip).norm());
        }
        answer.number > 1_000 && answer.faults > 10
    }));
    assert!(farthest_m < 1e-7, "the tip moved by {farthest_m} m");
    let right = |t: &[f32; 2]| (t[0] - 0.04023).abs() < 1e-5 && (t[1] + 0.04023).abs() < 1e-5;
    let torques = emulator.shared.torques.lock().expect("not poisoned").clone();
    assert!(torques.iter().all(|t| *t == [0.0; 2] || right(t)), "no torque of a pose that was not there");
    assert!(torques.iter().filter(|t| right(t)).count() > 100, "and the right one often");
    assert!(board.tally().count(tally::Fault::Impossible) > 10 && board.tally().asked() > 1_000);
    drop(board);
    emulator.finish();
}

/// A hand of two boards whose tips are shown where the boards have them.
fn hand() -> (HaplyHand, [Emulator; 2]) {
    let ((left, one), (right, two)) = (pair(Fault::None), pair(Fault::None));
    let place = Placement { device_m: Vec2::zeros(), world_m: Vec2::zeros(), scale: 1.0 };
    (HaplyHand::new([left, right], [place; 2]), [one, two])
}

#[test]
fn the_velocity_is_that_of_the_tips_also_when_the_servo_ticks_faster_than_the_boards_answer() {
    for ticks in [1_u32, 4] {
        let (mut hand, emulators) = hand();
        let mut tips = [0, 1].map(|finger: usize| emulators[finger].turn_to(pose_at(0)));
        let (mut sample, mut wanted) = (Sample::default(), [Vec2::zeros(); 2]);
        for step in 0..=60 {
            for (finger, emulator) in emulators.iter().enumerate() {
                let tip = emulator.turn_to(pose_at(step));
                // Each step stands for a millisecond of the servo's time, however long the boards take.
                (wanted[finger], tips[finger]) = ((tip - tips[finger]) / 1e-3, tip);
                let board = &mut hand.boards[finger];
                assert!(until(|| (board.answer().tip_m - tip).norm() < 1e-7), "step {step}");
            }
            // As if the ticks before the last had brought nothing new: the emulated boards are too fast for that.
            let tick_s = 1e-3 / f64::from(ticks);
            hand.since_s = [1e-3 - tick_s; 2];
            sample = hand.exchange(&Command::default(), tick_s);
            assert_eq!(sample.tip_in_world, tips);
        }
        for (velocity, wanted) in sample.tip_velocity.iter().zip(wanted) {
            assert!(wanted.norm() > 0.05);
            assert!((velocity - wanted).norm() < 0.02 * wanted.norm(), "{velocity} against {wanted}");
        }
        drop(hand);
        for emulator in emulators {
            emulator.finish();
        }
    }
}

#[test]
fn a_hand_that_is_really_elsewhere_is_believed_later_and_starts_at_rest() {
    let (mut hand, emulators) = hand();
    for emulator in &emulators {
        emulator.turn_to(POSE);
    }
    assert!(until(|| hand.exchange(&Command::default(), 1e-3).is_fresh()));
    let elsewhere = emulators[0].turn_to([30.0, 150.0]);
    let mut sample = Sample::default();
    assert!(until(|| {
        sample = hand.exchange(&Command::default(), 1e-3);
        (sample.tip_in_world[0] - elsewhere).norm() < 1e-7
    }));
    assert_eq!(sample.tip_velocity[0], Vec2::zeros());
    assert!(hand.tallies()[0].faults() >= 4, "the answers before were doubted");
    drop(hand);
    for emulator in emulators {
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
        one.shared.stalled.store(felt, Ordering::Relaxed);
        if !tick.flags.stale {
            std::thread::sleep(Duration::from_micros(500));
        }
        felt && tick.flags.stale
    }));
    assert_eq!(servo.tick(1e-3).sent_force_n, [Vec2::zeros(); 2]);
    drop(servo);
    one.finish();
    two.finish();
}
