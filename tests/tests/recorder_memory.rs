//! A long recording takes no more memory than a short one. One test in a process of its own: it counts every allocation.

use app::recorder::{FILE_BYTES, Order, Recorder, ServoFacts};
use haptics::device::{ScriptedOperator, Skill};
use haptics::recording::Meta;
use haptics::servo::recorder::SensorModel;
use haptics::servo::safety::Limits;
use haptics::servo::tap::tap;
use haptics::servo::{Loop, Swap, TickRecord};
use haptics::world::{State, presets};
use peak_alloc::PeakAlloc;
use std::sync::Arc;
use std::time::{Duration, Instant};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// A scripted performance, ticks at 1 kHz.
fn performance() -> Vec<TickRecord> {
    let world = presets::stacking();
    let operator = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 1);
    let mut servo = Loop::new(Swap::new(world), Box::new(operator), Limits::default());
    let mut ticks = Vec::new();
    while !servo.finished() {
        ticks.push(servo.tick(1e-3));
    }
    ticks
}

#[test]
fn memory_stays_flat_however_long_it_records() {
    /// Twenty minutes at 1 kHz.
    const TICKS: u32 = 1_200_000;
    let performed = performance();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (mut filler, source) = tap(8_192);
    let order = Order {
        folder: folder.path().to_path_buf(),
        world: Arc::new(presets::stacking()),
        device: None,
        sensors: SensorModel::TYPICAL,
        seed: 1,
        file_bytes: FILE_BYTES,
        servo: ServoFacts::default(),
        stated: Meta::default(),
    };
    let recorder = Recorder::start(&source, order).expect("begins");
    let begun = Instant::now();
    let mut early = 0;
    for i in 0..TICKS {
        while filler.must_wait() {
            std::thread::sleep(Duration::from_micros(200));
        }
        let template = &performed[i as usize % performed.len()];
        filler.offer(TickRecord { time_s: f64::from(i) * 1e-3, ..*template });
        if i == TICKS / 20 {
            // One minute: every buffer has its size.
            early = MEMORY.peak_usage();
            MEMORY.reset_peak_usage();
        }
    }
    let peak = MEMORY.peak_usage();
    let finished = recorder.stop().wait().expect("written");
    let took_s = begun.elapsed().as_secs_f64();
    assert_eq!((finished.status.ticks, finished.status.dropped), (u64::from(TICKS), 0));
    let (mb, hours) = (|bytes: usize| bytes as f64 * 1e-6, f64::from(TICKS) / 3.6e6);
    println!(
        "{TICKS} ticks in {took_s:.1} s; {:.0} MB an hour at 1 kHz; peak {:.2} MB in the first minute, {:.2} MB in the other 19",
        finished.status.bytes as f64 * 1e-6 / hours,
        mb(early),
        mb(peak)
    );
    // A hundred bytes for each block that was written, and nothing for the ticks: those would be 300 MB.
    assert!(peak <= early + (2 << 20), "{early} bytes in the first minute, {peak} later");
}
