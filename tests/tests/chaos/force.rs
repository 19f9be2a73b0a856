//! Hands that vanish, come back and say nonsense, clocks that jump, worlds that change under the fingers: the force of every tick is
//! looked at.

use crate::Chaos;
use haptics::Vec2;
use haptics::device::{Command, Device, DeviceSpec, Sample, ScriptedOperator, Skill};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, World, presets};
use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

const DT: f64 = 1e-3;
/// Ticks of a turn, of which there are some a lap.
const TICKS: usize = 6_000;
const TURNS: usize = 6;

/// What is wrong with a device for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    None,
    Vanished,
    /// Only one finger is seen.
    Half(usize),
    Lossy,
    NotANumber,
    Infinite,
    FarAway,
}

pub const FAULTS: [Fault; 9] = [
    Fault::None,
    Fault::None,
    Fault::Vanished,
    Fault::Half(0),
    Fault::Half(1),
    Fault::Lossy,
    Fault::NotANumber,
    Fault::Infinite,
    Fault::FarAway,
];

/// What the device itself knows of what it has said.
pub struct Said {
    pub fault: Fault,
    /// Time since a good sample of each finger, s.
    pub age_s: [f64; 2],
    /// Every exchange, for who looks at them later; not noted where that is nothing.
    pub exchanges: Option<Vec<Exchange>>,
}

impl Said {
    pub fn new(exchanges: Option<Vec<Exchange>>) -> Arc<Mutex<Self>> {
        Arc::new(Mutex::new(Self { fault: Fault::None, age_s: [0.0; 2], exchanges }))
    }
}

/// One tick as the device has seen it.
#[derive(Clone, Copy, Debug)]
pub struct Exchange {
    /// What it was told, N.
    pub told_n: [Vec2; 2],
    /// What it said, m.
    pub tip_in_world: [Vec2; 2],
    /// Time since a good sample of the finger that was not seen for longer, s.
    pub age_s: f64,
}

/// A hand behind a cable that fails.
pub struct Failing {
    pub hand: Box<dyn Device>,
    pub said: Arc<Mutex<Said>>,
    pub rng: StdRng,
}

pub fn open(said: &Mutex<Said>) -> MutexGuard<'_, Said> {
    said.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Device for Failing {
    fn spec(&self) -> &DeviceSpec {
        self.hand.spec()
    }

    fn see(&mut self, world: &World, state: &State) {
        self.hand.see(world, state);
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        let mut said = open(&self.said);
        let mut sample = self.hand.exchange(command, dt_s);
        let mut possible = true;
        match said.fault {
            Fault::Vanished => sample.fresh = [false; 2],
            Fault::Half(finger) => sample.fresh[1 - finger] = false,
            Fault::Lossy if self.rng.random_bool(0.9) => sample.fresh = [false; 2],
            Fault::None | Fault::Lossy => {}
            Fault::NotANumber => {
                (sample.tip_in_world[self.rng.random_range(0..2)].x, possible) = (f64::NAN, false);
            }
            Fault::Infinite => (sample.tip_velocity[0].y, possible) = (f64::NEG_INFINITY, false),
            Fault::FarAway => (sample.tip_in_world[1].x, possible) = (1e200, false),
        }
        for finger in 0..2 {
            let good = possible && sample.fresh[finger];
            said.age_s[finger] = if good { 0.0 } else { said.age_s[finger] + dt_s };
        }
        let exchange = Exchange {
            told_n: command.force_n,
            tip_in_world: sample.tip_in_world,
            age_s: said.age_s[0].max(said.age_s[1]),
        };
        if let Some(exchanges) = &mut said.exchanges {
            exchanges.push(exchange);
        }
        sample
    }

    fn make_safe(&mut self) {
        self.hand.make_safe();
    }
}

pub fn vanishing_and_jumping(chaos: &mut Chaos) {
    for _ in 0..TURNS {
        turn(chaos);
    }
}

/// A duration that no clock should say, or an ordinary one.
fn step_s(rng: &mut StdRng) -> f64 {
    match rng.random_range(0..400) {
        0 => 0.0,
        1 => -1.0,
        2 => f64::NAN,
        3 => f64::INFINITY,
        4 => f64::NEG_INFINITY,
        5 => 1e-9,
        6 => 0.05,
        _ => DT,
    }
}

fn turn(chaos: &mut Chaos) {
    let worlds = presets::all();
    let world = worlds[chaos.rng.random_range(0..worlds.len())].clone();
    let said = Said::new(None);
    let hand = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), chaos.rng.random());
    let device =
        Failing { hand: Box::new(hand), said: Arc::clone(&said), rng: StdRng::seed_from_u64(chaos.rng.random()) };
    let limits = Limits { ramp_s: 0.05, ..Limits::default() };
    let mut body = Loop::new(Swap::new(world), Box::new(device), limits);
    let (mut left, mut before) = (0_u32, [Vec2::zeros(); 2]);
    for _ in 0..TICKS {
        if left == 0 {
            left = chaos.rng.random_range(1..300);
            open(&said).fault = FAULTS[chaos.rng.random_range(0..FAULTS.len())];
        }
        left -= 1;
        meddle(&mut body, &worlds, &mut chaos.rng);
        let dt_s = step_s(&mut chaos.rng);
        let tick = body.tick(dt_s);
        let age_s = open(&said).age_s.iter().copied().fold(0.0, f64::max);
        let clock_runs = dt_s > 0.0 && dt_s.is_finite();
        let is_zero = tick.sent_force_n == [Vec2::zeros(); 2];
        // A held world hears no simulated hand; it sends nothing that it did not send before.
        if !clock_runs || (age_s > limits.watchdog_s && !body.is_held()) {
            assert!(is_zero, "a force of {:?} N on a sample of {age_s} s, dt {dt_s}", tick.sent_force_n);
            chaos.count("ticks without fresh data", 1);
        }
        chaos.count("ticks with force", u64::from(!is_zero));
        for (now, last) in tick.sent_force_n.iter().zip(before) {
            assert!(now.norm() <= limits.max_force_n + 1e-9, "{now} N");
            let allowed = limits.max_slew_n_s * dt_s + 1e-9;
            assert!(is_zero || body.is_held() || (now - last).norm() <= allowed, "a jump from {last} to {now} N");
        }
        before = tick.sent_force_n;
    }
}

/// Now and then another world, a pause, a push to try the device, or a standstill of the machine.
fn meddle(body: &mut Loop, worlds: &[World], rng: &mut StdRng) {
    match rng.random_range(0..600) {
        0 => drop(body.swap(Swap::new(worlds[rng.random_range(0..worlds.len())].clone()))),
        1 => body.hold(true),
        2..8 => body.hold(false),
        8 => body.interrupted(),
        9 => body.test_force(Some([Vec2::new(2.0, -1.0), Vec2::new(f64::NAN, 0.0)])),
        10..14 => body.test_force(None),
        _ => {}
    }
}
