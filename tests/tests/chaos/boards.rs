//! Serial boards whose cable is pulled and put in again, that fall silent, answer in halves or in noise, and come back: a board that does
//! not answer is told zero torque, and one that comes back none until it has answered for a while.

use crate::Chaos;

/// What must have happened.
#[cfg(unix)]
pub const MUST: &[&str] = &["torques that pressed", "cables put in again", "ticks with force"];
#[cfg(not(unix))]
pub const MUST: &[&str] = &[];

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
    use haptics::device::haply::{self, Board, BoardModel, FiveBar, HaplyHand, Placement, Tally};
    use haptics::servo::safety::Limits;
    use haptics::servo::{Loop, Swap};
    use haptics::world::presets;
    use rand::RngExt as _;
    use serialport::{SerialPort as _, TTYPort};
    use std::io::{Read as _, Write as _};
    use std::path::{Path, PathBuf};
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
    /// Before a board has answered so often since it was plugged in, there may be no torque.
    const ACQUAINTANCE: u64 = 5;
    /// A board that is in again waits for a word, here for so long.
    const UNSAID: Duration = Duration::from_millis(400);
    /// After so many ticks without one of the boards there may be no force at all: a tick counts at most 10 ms.
    const LATE: u32 = 40;

    const ANSWER: u8 = 0;
    const SILENT: u8 = 1;
    const NOISE: u8 = 2;
    const HALVES: u8 = 3;

    #[derive(Default)]
    struct Shared {
        mode: AtomicU8,
        questions: AtomicU64,
        /// Whole answers since it was plugged in.
        answers: AtomicU64,
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
                    shared.answers.fetch_add(1, Ordering::Relaxed);
                }
                shared.questions.fetch_add(1, Ordering::Relaxed);
            }
        }
    }

    fn judge(shared: &Shared, torques: [f32; 2], unanswered: u64) {
        shared.pressed.fetch_add(u64::from(torques != [0.0; 2]), Ordering::Relaxed);
        let bounded = torques.iter().all(|t| t.abs() <= haply::MAX_TORQUE_NM + 1e-6);
        let answers = shared.answers.load(Ordering::Relaxed);
        let silent = unanswered >= PATIENCE || answers < ACQUAINTANCE;
        if !bounded || (silent && torques != [0.0; 2]) {
            let wrong = format!("{torques:?} N m at question {unanswered} without an answer, after {answers} answers");
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
        /// A pseudo-terminal hangs up when its last near end closes; a USB line does not.
        near: TTYPort,
    }

    impl Emulator {
        /// A board behind the port of this name, whatever was there before.
        fn plug_in(port: &Path) -> Self {
            let (far, near) = TTYPort::pair().expect("the system has pseudo-terminals");
            let shared = Arc::new(Shared::default());
            let theirs = Arc::clone(&shared);
            let thread = std::thread::spawn(move || emulate(far, &theirs));
            let beside = port.with_extension("new");
            std::os::unix::fs::symlink(near.name().expect("the near end has a name"), &beside).expect("a name");
            std::fs::rename(&beside, port).expect("a name");
            Self { shared, thread, near }
        }

        /// Its cable is pulled, or the test is over.
        fn unplug(self) {
            self.shared.stop.store(true, Ordering::Relaxed);
            self.thread.join().expect("the emulator ends");
            drop(self.near);
            let wrong = self.shared.wrong.lock().unwrap_or_else(PoisonError::into_inner);
            assert!(wrong.is_empty(), "{wrong:?}");
        }

        fn answers(&self) -> u64 {
            self.shared.answers.load(Ordering::Relaxed)
        }

        fn pressed(&self) -> u64 {
            self.shared.pressed.load(Ordering::Relaxed)
        }
    }

    /// A hand that leans on the table.
    fn hand(boards: [Board; 2]) -> HaplyHand {
        let angles = [f64::from(POSE[1]).to_radians(), f64::from(POSE[0]).to_radians()];
        let device_m = FiveBar::V3.tip(angles).expect("a pose of the linkage");
        let place = |x: f64| Placement { device_m, world_m: Vec2::new(x, -0.1258), scale: 1.0 };
        HaplyHand::new(boards, [place(-0.02), place(0.02)])
    }

    /// A hand on two boards, ticked at the servo's own pace.
    struct Bench {
        body: Loop,
        last: Instant,
        ports: [PathBuf; 2],
        emulators: [Emulator; 2],
        tallies: [Tally; 2],
    }

    impl Bench {
        /// A tick; whether there was a force in it.
        fn tick(&mut self, chaos: &mut Chaos) -> bool {
            std::thread::sleep(Duration::from_millis(1));
            let now = Instant::now();
            let tick = self.body.tick((now - self.last).as_secs_f64().clamp(1e-4, 0.01));
            self.last = now;
            let is_zero = tick.sent_force_n == [Vec2::zeros(); 2];
            assert!(!tick.flags.stale || is_zero, "{:?} N from boards that do not answer", tick.sent_force_n);
            chaos.count("ticks with force", u64::from(!is_zero));
            !is_zero
        }

        /// Ticks until both boards have been asked often enough.
        fn phase(&mut self, chaos: &mut Chaos, modes: [u8; 2]) {
            let asked = |e: &Emulator| e.shared.questions.load(Ordering::Relaxed);
            let before = self.emulators.each_ref().map(asked);
            for (emulator, mode) in self.emulators.iter().zip(modes) {
                emulator.shared.mode.store(mode, Ordering::Relaxed);
            }
            let begun = Instant::now();
            while (0..2).any(|k| asked(&self.emulators[k]) < before[k] + QUESTIONS) {
                assert!(begun.elapsed() < Duration::from_secs(30), "boards are asked no more: {modes:?}");
                self.tick(chaos);
            }
        }

        /// The cable of one board is pulled and, later, another one put in at the same port: the force goes, and comes back once the
        /// board that is there now has answered.
        fn pull_and_put_in(&mut self, chaos: &mut Chaos, k: usize) {
            chaos.count("torques that pressed", self.emulators[k].pressed());
            std::fs::remove_file(&self.ports[k]).expect("the name goes with the board");
            let [left, right] = &mut self.emulators;
            let (pulled, stays) = if k == 0 { (left, right) } else { (right, left) };
            stays.shared.mode.store(ANSWER, Ordering::Relaxed);
            let next = Emulator::plug_in(&self.ports[k].with_extension("drawer"));
            std::mem::replace(pulled, next).unplug();
            let (begun, out) = (Instant::now(), Duration::from_millis(chaos.rng.random_range(300..900)));
            let mut ticks = 0;
            while begun.elapsed() < out || ticks < LATE {
                let force = self.tick(chaos);
                ticks += 1;
                assert!(!force || ticks < LATE, "a force without one of the boards");
            }
            std::fs::rename(self.ports[k].with_extension("drawer"), &self.ports[k]).expect("a name");
            let begun = Instant::now();
            while begun.elapsed() < UNSAID {
                assert!(!self.tick(chaos), "a force from an arm of which nobody has said that it rests");
            }
            assert!(self.tallies[k].is_unplugged() && self.emulators[k].answers() == 0, "it was set up unasked");
            self.tallies[k].arm_rests();
            let begun = Instant::now();
            while !self.tick(chaos) {
                assert!(begun.elapsed() < Duration::from_secs(30), "a board that was plugged in again is not found");
            }
            assert!(self.emulators[k].answers() >= ACQUAINTANCE, "a force before the board has answered");
            chaos.count("cables put in again", 1);
        }
    }

    pub fn unplugged(chaos: &mut Chaos) {
        let folder = chaos.scratch();
        let ports = ["left", "right"].map(|name| folder.path().join(name));
        let emulators = ports.each_ref().map(|port| Emulator::plug_in(port));
        let boards = ports.each_ref().map(|port| {
            haply::open(port.to_str().expect("a plain name"), BoardModel::V3, None).expect("takes its set-up")
        });
        let limits = Limits { ramp_s: 0.02, ..Limits::default() };
        let hand = hand(boards);
        let tallies = hand.tallies();
        let body = Loop::new(Swap::new(presets::table()), Box::new(hand), limits);
        let mut bench = Bench { body, last: Instant::now(), ports, emulators, tallies };
        for number in 0..PHASES {
            let modes: [u8; 2] = std::array::from_fn(|_| match chaos.rng.random_range(0..6) {
                mode @ 1..=3 => mode,
                _ => ANSWER,
            });
            bench.phase(chaos, modes);
            if number % 5 == 4 {
                let k = chaos.rng.random_range(0..2);
                bench.pull_and_put_in(chaos, k);
            }
        }
        let Bench { body, emulators: [left, right], .. } = bench;
        chaos.count("torques that pressed", left.pressed() + right.pressed());
        // A cable that is out when the program ends.
        left.unplug();
        drop(body);
        right.unplug();
    }
}
