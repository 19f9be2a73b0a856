//! A real servo on a thread of its own, its hand, its recorder and its worlds. Every tick that it has made is held against what its
//! device was told and has said.

use super::Counts;
use crate::force::{Exchange, FAULTS, Failing, Fault, Said, open};
use crate::udp::Client;
use crate::{child, documents};
use app::recorder::{Order, Recorder, Stopping};
use estimator::log;
use haptics::Vec2;
use haptics::device::{Device, MouseHandle, MouseTarget, ScriptedOperator, Skill, mouse};
use haptics::servo::safety::Limits;
use haptics::servo::{Servo, ServoConfig, Swap, TickRecord};
use haptics::world::{State, World, presets};
use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

const DT_S: f64 = 1e-3;
/// How long anything may take that the servo does at its next tick, on a machine that does much else.
const PATIENCE: Duration = Duration::from_secs(20);

/// Ticks with a force, by what moves the fingers.
pub const FORCES: [&str; 3] = [
    "together: ticks with a force on a scripted hand",
    "together: ticks with a force on a mouse",
    "together: ticks with a force on a remote hand",
];

/// Ticks whose samples were older than the watchdog allows.
pub const STALE: &str = "together: ticks without fresh data";

/// Choice of the device.
enum Hand {
    Scripted,
    Mouse(MouseHandle),
    Remote(Box<Client>),
}

impl Hand {
    /// The one of this number, on a world.
    fn of(number: u64, world: &World, rng: &mut StdRng) -> (Box<dyn Device>, Self) {
        let state = State::resting(world);
        match number % 3 {
            0 => {
                let device = ScriptedOperator::new(world, &state, Skill::default(), rng.random());
                (Box::new(device), Self::Scripted)
            }
            1 => {
                let [left, right] = state.input.tip_in_world;
                let start = MouseTarget { center_in_world: (left + right) / 2.0, aperture_m: (right - left).norm() };
                let (handle, device) = mouse(start, world.hand.workspace);
                (Box::new(device), Self::Mouse(handle))
            }
            _ => {
                let (device, key) = crate::udp::device(world);
                let client = Client::new(device.monitor().address(), key);
                (Box::new(device), Self::Remote(Box::new(client)))
            }
        }
    }

    /// How its ticks with a force are counted.
    fn force(&self) -> &'static str {
        match self {
            Self::Scripted => FORCES[0],
            Self::Mouse(_) => FORCES[1],
            Self::Remote(_) => FORCES[2],
        }
    }

    fn move_on(&mut self, rng: &mut StdRng) {
        match self {
            Self::Scripted => {}
            Self::Mouse(_) if rng.random_range(0..40) != 0 => {}
            // Onto the table and off it.
            Self::Mouse(handle) => {
                let center_in_world = Vec2::new(rng.random_range(-0.1..0.1), rng.random_range(-0.16..0.0));
                handle.set(MouseTarget { center_in_world, aperture_m: rng.random_range(0.0..0.06) });
            }
            Self::Remote(client) => {
                client.listen();
                let packet = client.motion();
                client.send(&packet);
            }
        }
    }
}

/// The servo and what was seen of it.
struct Training {
    servo: Servo,
    hand: Hand,
    said: Arc<std::sync::Mutex<Said>>,
    world: World,
    ticks: Vec<TickRecord>,
    rng: StdRng,
    counts: Counts,
}

pub fn trained(recordings: &Path, number: u64, seed: u64, over: &AtomicBool) -> Counts {
    let mut rng = StdRng::seed_from_u64(seed);
    let world = presets::stacking();
    let (device, hand) = Hand::of(number, &world, &mut rng);
    let limits = Limits { ramp_s: 0.05, ..Limits::default() };
    let most_n = limits.max_force_n.min(device.spec().max_force_n);
    let said = Said::new(Some(Vec::new()));
    let failing = Failing { hand: device, said: Arc::clone(&said), rng: StdRng::seed_from_u64(rng.random()) };
    // Without real time: it would keep every page of this process in memory, whose growth is looked at.
    let config = ServoConfig { limits, real_time: false, ..ServoConfig::at(1.0 / DT_S) };
    let servo = Servo::start(Swap::new(world.clone()), Box::new(failing), config).expect("a thread");
    let mut training = Training { servo, hand, said, world, ticks: Vec::new(), rng, counts: Counts::new() };
    let spoiled = recordings.with_extension("spoiled.json");
    let worlds = documents::documents("worlds");
    // Nothing disturbs the hand until it presses: it has something to lose then.
    let begun = Instant::now();
    while training.ticks.iter().all(|tick| tick.sent_force_n == [Vec2::zeros(); 2]) {
        assert!(begun.elapsed() < PATIENCE, "{} hold nothing", training.hand.force());
        training.recorded(recordings, &[Fault::None], 500);
    }
    while !over.load(Ordering::Relaxed) {
        let lasts_ms = training.rng.random_range(400..900);
        training.recorded(recordings, &FAULTS, lasts_ms);
        training.swap(&worlds, &spoiled);
    }
    training.ended(limits, most_n)
}

impl Training {
    fn count(&mut self, what: &'static str, by: u64) {
        *self.counts.entry(what).or_default() += by;
    }

    /// As a window does, at its own pace: a servo tells nobody anything, it may not wake a thread.
    fn look(&mut self) {
        self.servo.drain(&mut self.ticks);
        std::thread::sleep(Duration::from_millis(1));
    }

    fn now_s(&mut self) -> f64 {
        self.servo.newest().tick.time_s
    }

    /// Records for a while; all of it is in the file.
    fn recorded(&mut self, folder: &Path, faults: &[Fault], lasts_ms: u64) {
        let order = Order { world: Arc::new(self.world.clone()), ..child::order(folder) };
        let recorder = Recorder::start(self.servo.tap(), order).expect("begins");
        let first_s = self.now_s();
        let (begun, lasts) = (Instant::now(), Duration::from_millis(lasts_ms));
        let mut next_fault = begun;
        while begun.elapsed() < lasts {
            if Instant::now() >= next_fault {
                open(&self.said).fault = faults[self.rng.random_range(0..faults.len())];
                next_fault += Duration::from_millis(self.rng.random_range(1..200));
            }
            match self.rng.random_range(0..100) {
                0 => self.servo.test_force(Some([Vec2::new(2.0, -1.0), Vec2::new(f64::NAN, 0.0)])),
                1..5 => self.servo.test_force(None),
                _ => {}
            }
            self.hand.move_on(&mut self.rng);
            self.look();
        }
        // The tick that was under way at the start may have passed the closed tap before it was published.
        let least = (((self.now_s() - first_s) / DT_S).round() as u64).saturating_sub(1);
        self.check(recorder.stop(), least);
    }

    fn check(&mut self, stopping: Stopping, least: u64) {
        let finished = stopping.wait().expect("no disk refused it");
        let status = &finished.status;
        assert_eq!(status.dropped, 0, "{status:?}");
        assert!(status.ticks + status.left_out >= least, "{least} ticks were made: {status:?}");
        let found = log::load(&finished.path, None).unwrap_or_else(|error| panic!("{error}")).remove(0);
        assert_eq!(found.len() as u64, status.ticks, "{status:?}");
        let steps = found.time_s.as_deref().unwrap_or(&[]).windows(2).map(|w| w[1] - w[0]);
        let whole = steps.into_iter().all(|step| (step - DT_S).abs() < 1e-9);
        assert!(whole || status.left_out > 0, "a tick is missing: {status:?}");
        self.count("together: whole recordings", u64::from(whole));
    }

    /// Another world: one that comes with the program, or one that was read from a spoiled file.
    fn swap(&mut self, worlds: &[PathBuf], spoiled: &Path) {
        let presets = presets::all();
        let mut next = presets[self.rng.random_range(0..presets.len())].clone();
        if self.rng.random_range(0..3) == 0 {
            std::fs::write(spoiled, documents::spoiled_one(worlds, &mut self.rng)).expect("writes");
            match World::load(spoiled) {
                Ok(world) => next = world,
                Err(error) => crate::must_be_a_sentence(&error.to_string(), spoiled),
            }
        }
        let generation = self.servo.newest().generation + 1;
        self.servo.swap(Swap::new(next.clone())).expect("no other one waits");
        let begun = Instant::now();
        while self.servo.newest().generation < generation {
            assert!(begun.elapsed() < PATIENCE, "the servo takes no world: {:?}", self.servo.newest().fault);
            self.look();
        }
        self.world = next;
        self.count("together: worlds swapped", 1);
    }

    /// The servo lives, and what it has made is judged.
    fn ended(mut self, limits: Limits, most_n: f64) -> Counts {
        open(&self.said).fault = Fault::None;
        let (begun, made) = (Instant::now(), self.ticks.len());
        while self.ticks.len() < made + 50 {
            assert!(begun.elapsed() < PATIENCE && self.servo.is_running(), "{:?}", self.servo.newest().fault);
            self.look();
        }
        let force = self.hand.force();
        drop(self.servo);
        let exchanges = open(&self.said).exchanges.take().unwrap_or_default();
        let seen = judge(&self.ticks, &exchanges, limits, most_n);
        self.counts.extend([(force, seen.0), (STALE, seen.1)]);
        self.counts
    }
}

/// Tick by tick: the record, and what the device knows of the same moment. Ticks with a force, and such without fresh data.
fn judge(ticks: &[TickRecord], exchanges: &[Exchange], limits: Limits, most_n: f64) -> (u64, u64) {
    assert!(ticks.len() <= exchanges.len(), "{} ticks of {} exchanges", ticks.len(), exchanges.len());
    let (mut with_force, mut stale, mut before) = (0, 0, [Vec2::zeros(); 2]);
    for (k, (tick, exchange)) in ticks.iter().zip(exchanges).enumerate() {
        let sent_n = tick.sent_force_n;
        if exchange.age_s == 0.0 {
            assert_eq!(tick.device_in_world, exchange.tip_in_world, "tick {k} is another one's");
        }
        if let Some(next) = exchanges.get(k + 1) {
            assert_eq!(next.told_n, sent_n, "the device was told in tick {} what tick {k} says", k + 1);
        }
        let is_zero = sent_n == [Vec2::zeros(); 2];
        if exchange.age_s > limits.watchdog_s {
            assert!(is_zero, "{sent_n:?} N in tick {k} on a sample of {} s", exchange.age_s);
            stale += 1;
        }
        with_force += u64::from(!is_zero);
        for (now, last) in sent_n.iter().zip(before) {
            assert!(now.norm() <= most_n + 1e-9, "{now} N in tick {k}");
            let allowed = limits.max_slew_n_s * DT_S + 1e-9;
            assert!(is_zero || (now - last).norm() <= allowed, "a jump from {last} to {now} N in tick {k}");
        }
        before = sent_n;
    }
    (with_force, stale)
}
