//! Serial boards whose cable is pulled, that fall silent, answer in halves or in noise, and come back: a board that does not answer is
//! told zero torque.

use crate::Chaos;

#[cfg(not(unix))]
pub fn unplugged(_: &mut Chaos) {
    tests::skipped("emulated boards need pseudo-terminals");
}

#[cfg(unix)]
pub use on_unix::unplugged;

#[cfg(unix)]
mod on_unix {
    use super::Chaos;
    use haptics::Vec2;
    use haptics::device::haply::{Board, BoardModel, FiveBar, HaplyHand, Placement};
    use haptics::servo::safety::Limits;
    use haptics::servo::{Loop, Swap};
    use haptics::world::presets;
    use rand::RngExt as _;
    use serialport::{SerialPort as _, TTYPort};
    use std::io::{Read as _, Write as _};
    use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering};
    use std::sync::{Arc, Mutex, PoisonError};
    use std::thread::JoinHandle;
    use std::time::{Duration, Instant};

    /// Encoders of a board at rest, degrees in port order.
    const POSE: [f32; 2] = [60.0, 120.0];
    const TIMEOUT: Duration = Duration::from_millis(5);
    /// Questions that a phase lasts.
    const QUESTIONS: u64 = 12;
    const PHASES: usize = 12;
    /// From the third question without an answer on there may be no torque: the second one was asked when the first was given up.
    const PATIENCE: u64 = 3;

    const ANSWER: u8 = 0;
    const SILENT: u8 = 1;
    const NOISE: u8 = 2;
    const HALVES: u8 = 3;
    const GONE: u8 = 4;

    #[derive(Default)]
    struct Shared {
        mode: AtomicU8,
        questions: AtomicU64,
        pressed: AtomicU64,
        stop: AtomicBool,
        wrong: Mutex<Vec<String>>,
    }

    /// The far end of the line: set-up frames of 26 bytes, torques of 10.
    fn emulate(mut line: TTYPort, shared: &Shared) {
        line.set_timeout(TIMEOUT).expect("a pseudo-terminal has time-outs");
        let (mut bytes, mut some, mut unanswered) = (Vec::new(), [0; 64], 0);
        while !shared.stop.load(Ordering::Relaxed) {
            let mode = shared.mode.load(Ordering::Relaxed);
            if mode == GONE {
                return; // the line is dropped: a pulled cable
            }
            let count = line.read(&mut some).unwrap_or(0);
            bytes.extend_from_slice(&some[..count]);
            while let Some(length) = bytes.first().map(|kind| if *kind == 1 { 26 } else { 10 })
                && bytes.len() >= length
            {
                let frame: Vec<u8> = bytes.drain(..length).collect();
                if frame[0] != 2 {
                    continue;
                }
                let torque = |at: usize| f32::from_le_bytes(frame[at..at + 4].try_into().expect("four bytes"));
                let torques = [torque(2), torque(6)];
                unanswered += 1;
                judge(shared, torques, unanswered);
                if answer(&mut line, mode) {
                    unanswered = 0;
                }
                shared.questions.fetch_add(1, Ordering::Relaxed);
            }
        }
    }

    fn judge(shared: &Shared, torques: [f32; 2], unanswered: u64) {
        shared.pressed.fetch_add(u64::from(torques != [0.0; 2]), Ordering::Relaxed);
        let bounded = torques.iter().all(|t| t.abs() <= haptics::device::haply::MAX_TORQUE_NM + 1e-6);
        if !bounded || (unanswered >= PATIENCE && torques != [0.0; 2]) {
            let wrong = format!("{torques:?} N m at question {unanswered} without an answer");
            shared.wrong.lock().unwrap_or_else(PoisonError::into_inner).push(wrong);
        }
    }

    /// True when what was sent may be believed.
    fn answer(line: &mut TTYPort, mode: u8) -> bool {
        let mut reply = vec![5_u8];
        for angle in POSE {
            reply.extend(angle.to_le_bytes());
        }
        match mode {
            SILENT => return false,
            NOISE => reply.iter_mut().for_each(|byte| *byte = 0xa7),
            HALVES => reply.truncate(4),
            _ => {}
        }
        // A host that has hung up gets nothing.
        let _ = line.write_all(&reply);
        mode == ANSWER
    }

    struct Emulator {
        shared: Arc<Shared>,
        thread: JoinHandle<()>,
    }

    fn plug_in() -> (Board, Emulator) {
        let (far, mut near) = TTYPort::pair().expect("the system has pseudo-terminals");
        near.set_timeout(TIMEOUT).expect("a pseudo-terminal has time-outs");
        let shared = Arc::new(Shared::default());
        let theirs = Arc::clone(&shared);
        let thread = std::thread::spawn(move || emulate(far, &theirs));
        (Board::start(Box::new(near), BoardModel::V3).expect("takes its set-up"), Emulator { shared, thread })
    }

    /// A hand that leans on the table.
    fn hand(boards: [Board; 2]) -> HaplyHand {
        let angles = [f64::from(POSE[1]).to_radians(), f64::from(POSE[0]).to_radians()];
        let device_m = FiveBar::V3.tip(angles).expect("a pose of the linkage");
        let place = |x: f64| Placement { device_m, world_m: Vec2::new(x, -0.1258), scale: 1.0 };
        HaplyHand::new(boards, [place(-0.02), place(0.02)])
    }

    pub fn unplugged(chaos: &mut Chaos) {
        let ((left, first), (right, second)) = (plug_in(), plug_in());
        let emulators = [first, second];
        let limits = Limits { ramp_s: 0.02, ..Limits::default() };
        let mut body = Loop::new(Swap::new(presets::table()), Box::new(hand([left, right])), limits);
        let mut last = Instant::now();
        for _ in 0..PHASES {
            let modes: [u8; 2] = std::array::from_fn(|_| match chaos.rng.random_range(0..6) {
                mode @ 1..=3 => mode,
                _ => ANSWER,
            });
            phase(chaos, &mut body, &emulators, modes, &mut last);
        }
        phase(chaos, &mut body, &emulators, [GONE, ANSWER], &mut last);
        for emulator in &emulators {
            chaos.count("torques that pressed", emulator.shared.pressed.load(Ordering::Relaxed));
        }
        drop(body);
        for emulator in emulators {
            emulator.shared.stop.store(true, Ordering::Relaxed);
            emulator.thread.join().expect("the emulator ends");
            let wrong = emulator.shared.wrong.lock().unwrap_or_else(PoisonError::into_inner);
            assert!(wrong.is_empty(), "{wrong:?}");
        }
    }

    /// Ticks until both boards have been asked often enough; one that is gone is not asked.
    fn phase(chaos: &mut Chaos, body: &mut Loop, emulators: &[Emulator; 2], modes: [u8; 2], last: &mut Instant) {
        let asked = |e: &Emulator| e.shared.questions.load(Ordering::Relaxed);
        let before = emulators.each_ref().map(asked);
        for (emulator, mode) in emulators.iter().zip(modes) {
            emulator.shared.mode.store(mode, Ordering::Relaxed);
        }
        let begun = Instant::now();
        let done = || (0..2).all(|k| modes[k] == GONE || asked(&emulators[k]) >= before[k] + QUESTIONS);
        while !done() {
            assert!(begun.elapsed() < Duration::from_secs(30), "boards are asked no more: {modes:?}");
            // The servo's own pace.
            std::thread::sleep(Duration::from_millis(1));
            let now = Instant::now();
            let tick = body.tick((now - *last).as_secs_f64().clamp(1e-4, 0.01));
            *last = now;
            let is_zero = tick.sent_force_n == [Vec2::zeros(); 2];
            assert!(!tick.flags.stale || is_zero, "{:?} N from boards that do not answer", tick.sent_force_n);
            chaos.count("ticks with force", u64::from(!is_zero));
        }
    }
}
