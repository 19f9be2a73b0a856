//! The servo for as long as one likes: neither memory nor the age of the force may grow.
//!
//! Twenty seconds by default; `TOUCHSTONE_SOAK_SECONDS=3600` makes it an hour.

use haptics::device::{ScriptedOperator, Skill};
use haptics::servo::{Servo, ServoConfig, Swap, TickRecord};
use haptics::world::{State, World, presets};
use std::time::{Duration, Instant};

/// One operator's turn at the least, s.
const TURN_S: f64 = 2.5;
/// So many turns make a long soak: each is then one servo that runs for minutes.
const LONG_TURNS: f64 = 8.0;
/// A swap this often, s.
const SWAP_S: f64 = 0.3;
/// Turns before memory counts: the allocator's own pools fill up at first.
const WARM_UP: usize = 2;

fn seconds() -> f64 {
    let wanted = std::env::var("TOUCHSTONE_SOAK_SECONDS").ok().and_then(|text| text.parse().ok());
    wanted.unwrap_or(20.0)
}

/// Resident memory, bytes; `None` where the system does not say.
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kib| kib * 1024)
}

/// What a turn left behind.
struct Turn {
    force_age_p50_s: f64,
    force_age_p99_s: f64,
    resident: Option<u64>,
    ticks: u64,
}

/// The scripted operator at work while worlds are exchanged under its fingers, ticks fetched, snapshots looked at.
fn turn(world: &World, others: &[World], seed: u64, turn_s: f64, ticks: &mut Vec<TickRecord>) -> Turn {
    let operator = ScriptedOperator::new(world, &State::resting(world), Skill::default(), seed);
    // Fixed: the turns are to be compared with each other.
    let config = ServoConfig::at(1000.0);
    let mut servo = Servo::start(Swap::new(world.clone()), Box::new(operator), config).expect("a thread");
    let (begun, mut swaps, mut fetched) = (Instant::now(), 0_u32, 0_u64);
    while begun.elapsed().as_secs_f64() < turn_s {
        // As a window does: sixty times a second.
        std::thread::sleep(Duration::from_millis(16));
        ticks.clear();
        servo.drain(ticks);
        fetched += ticks.len() as u64;
        let snapshot = servo.newest();
        assert!(snapshot.fault.is_none(), "{:?}", snapshot.fault);
        assert!(snapshot.tick.sent_force_n.iter().all(|f| f.norm() <= config.limits.max_force_n + 1e-9));
        if begun.elapsed().as_secs_f64() > SWAP_S * f64::from(swaps + 1) {
            let next = &others[swaps as usize % others.len()];
            swaps += u32::from(servo.swap(Swap::new(next.clone())).is_ok());
        }
    }
    let generation = servo.newest().generation;
    assert!(u64::from(swaps) >= 3 && generation + 2 >= u64::from(swaps), "{swaps} swaps, {generation} taken");
    let timing = servo.newest().timing;
    Turn {
        force_age_p50_s: timing.force_age.p50_s,
        force_age_p99_s: timing.force_age.p99_s,
        resident: resident(),
        ticks: fetched,
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn neither_memory_nor_the_age_of_the_force_grows() {
    let worlds = presets::all();
    let mut ticks = Vec::with_capacity(20_000);
    let begun = Instant::now();
    let turn_s = TURN_S.max(seconds() / LONG_TURNS);
    let mut turns = Vec::new();
    while begun.elapsed().as_secs_f64() < seconds() || turns.len() < WARM_UP + 6 {
        let world = &worlds[turns.len() % worlds.len()];
        turns.push(turn(world, &worlds, turns.len() as u64, turn_s, &mut ticks));
    }
    assert!(turns.iter().map(|t| t.ticks).sum::<u64>() as f64 > 300.0 * turn_s * turns.len() as f64, "it ran");

    let settled = &turns[WARM_UP..];
    let half = settled.len() / 2;
    let (early, late) = settled.split_at(half);
    let of = |turns: &[Turn], value: fn(&Turn) -> f64| median(turns.iter().map(value).collect());
    let (before, after) = (of(early, |t| t.force_age_p50_s), of(late, |t| t.force_age_p50_s));
    assert!(after < 1.5 * before + 5e-4, "median force age {before} s, then {after} s");
    let (before, after) = (of(early, |t| t.force_age_p99_s), of(late, |t| t.force_age_p99_s));
    println!("force age p99 {before} s, then {after} s");
    // A busy machine makes single ticks late; growth would be without bound.
    assert!(after < 3.0 * before + 5e-3, "p99 of the force age {before} s, then {after} s");

    let memory = |turns: &[Turn]| turns.iter().filter_map(|t| t.resident).max();
    if let (Some(before), Some(after)) = (memory(early), memory(late)) {
        println!("memory {before} B, then {after} B after {} turns", turns.len());
        assert!(after < before + 4 * 1024 * 1024, "memory {before} B, then {after} B");
    }
}
