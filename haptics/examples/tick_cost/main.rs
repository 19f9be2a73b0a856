//! How long a tick takes, in nanoseconds: `cargo run --release -p haptics --example tick_cost`. Compare figures of one machine
//! and one hour only.
//!
//! * `--json` prints the same as JSON, with what happened in every scene.
//! * `--batches N` runs every scene's path N times (at least 20 by default); the best and the median of them are printed.
//! * `--grip-seconds S` measures the creep of a held block over S simulated seconds instead.
//! * `--describe` prints the scenes themselves, worlds and fingers' paths, for other simulators (`benches/peers.py`).

mod scenes;

use haptics::world::{State, step, substeps};
use scenes::Scene;
use serde_json::{Value, json};
use std::process::ExitCode;
use std::time::Instant;

/// What the command line asks for.
struct Wish {
    json: bool,
    describe: bool,
    batches: usize,
    grip_seconds: Option<f64>,
}

impl Wish {
    fn read(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut wish = Self { json: false, describe: false, batches: 20, grip_seconds: None };
        while let Some(word) = words.next() {
            match word.as_str() {
                "--json" => wish.json = true,
                "--describe" => wish.describe = true,
                "--batches" => wish.batches = number(&word, words.next().as_deref(), 1.0)? as usize,
                "--grip-seconds" => wish.grip_seconds = Some(number(&word, words.next().as_deref(), 2.0)?),
                _ => {
                    return Err(format!(
                        "{word} is not an option here; use --json, --describe, --batches N or --grip-seconds S"
                    ));
                }
            }
        }
        Ok(wish)
    }
}

fn number(option: &str, word: Option<&str>, least: f64) -> Result<f64, String> {
    let value = word.and_then(|w| w.parse::<f64>().ok()).filter(|v| v.is_finite() && *v >= least);
    value.ok_or_else(|| format!("{option} needs a number of at least {least} after it"))
}

/// Nanoseconds a tick of every batch, least first. A batch is the scene's whole path from the same state.
fn nanoseconds(scene: &Scene, start: &State, batches: usize) -> Vec<f64> {
    let mut state = start.clone();
    let mut costs: Vec<f64> = (0..batches)
        .map(|_| {
            state.copy_from(start);
            let begin = Instant::now();
            for input in &scene.path {
                step(&scene.world, &mut state, input, scene.dt_s);
            }
            begin.elapsed().as_secs_f64() * 1e9 / scene.path.len() as f64
        })
        .collect();
    costs.sort_by(f64::total_cmp);
    costs
}

/// What happens in a scene: without it nobody knows that the timed work was the work meant.
fn outcome(scene: &Scene, start: &State) -> Value {
    let mut state = start.clone();
    let (mut least, mut most, mut sum) = (usize::MAX, 0, 0);
    let (mut rise_m, mut force_n) = (0.0_f64, 0.0_f64);
    for input in &scene.path {
        step(&scene.world, &mut state, input, scene.dt_s);
        let count = state.contacts.len();
        (least, most, sum) = (least.min(count), most.max(count), sum + count);
        for (now, then) in state.bodies.iter().zip(&start.bodies) {
            rise_m = rise_m.max(now.center_m.y - then.center_m.y);
        }
        force_n = force_n.max(state.tip_force_n[0].x);
    }
    let blocks: Vec<[f64; 3]> = state.bodies.iter().map(|b| [b.center_m.x, b.center_m.y, b.angle_rad]).collect();
    json!({
        "contacts": { "least": least, "mean": sum as f64 / scene.path.len() as f64, "most": most },
        "highest_rise_m": rise_m,
        "most_finger_force_n": force_n,
        "crank_turned_rad": state.crank.angle_rad - start.crank.angle_rad,
        "blocks_at_the_end_m_m_rad": blocks,
    })
}

fn measured(scene: &Scene, batches: usize) -> Value {
    let start = scene.start();
    let costs = nanoseconds(scene, &start, batches);
    json!({
        "name": scene.name,
        "timed": scene.timed,
        "dt_s": scene.dt_s,
        "parts_per_tick": substeps(&scene.world, scene.dt_s),
        "ticks": scene.path.len() * batches,
        "best_ns": costs[0],
        "median_ns": costs[costs.len() / 2],
        "outcome": outcome(scene, &start),
    })
}

fn described(scene: &Scene) -> Value {
    let tips: Vec<[f64; 4]> = scene
        .path
        .iter()
        .map(|input| {
            let [left, right] = input.tip_in_world;
            [left.x, left.y, right.x, right.y]
        })
        .collect();
    json!({
        "name": scene.name,
        "timed": scene.timed,
        "dt_s": scene.dt_s,
        "warm_up_periods": scene.warm_up_periods,
        "world": scene.world,
        "tips_left_right_m": tips,
    })
}

/// How far the held block sinks from one second after the start until `seconds`, m.
fn creep(dt_s: f64, seconds: f64) -> Value {
    let scene = scenes::grip(dt_s);
    let mut state = scene.start();
    let mut run = |seconds: f64| {
        for _ in 0..(seconds / dt_s).round() as u64 {
            step(&scene.world, &mut state, &scene.path[0], dt_s);
        }
        (state.bodies[0].center_m.y, state.tip_force_n[0].x)
    };
    let (settled_m, _) = run(1.0);
    let (end_m, pinch_n) = run(seconds - 1.0);
    json!({ "dt_s": dt_s, "seconds": seconds, "creep_m": settled_m - end_m, "pinch_n": pinch_n })
}

fn main() -> ExitCode {
    let wish = match Wish::read(std::env::args().skip(1)) {
        Ok(wish) => wish,
        Err(why) => {
            eprintln!("{why}");
            return ExitCode::FAILURE;
        }
    };
    if wish.describe {
        let mut scenes = scenes::all();
        scenes.push(scenes::grip(1e-3));
        println!("{}", json!({ "scenes": scenes.iter().map(described).collect::<Vec<_>>() }));
    } else if let Some(seconds) = wish.grip_seconds {
        let grips = [1e-3, 1e-4].map(|dt_s| creep(dt_s, seconds));
        if wish.json {
            println!("{}", json!({ "grip": grips }));
        } else {
            for grip in &grips {
                println!("{grip}");
            }
        }
    } else {
        let scenes: Vec<Value> = scenes::all().iter().map(|scene| measured(scene, wish.batches)).collect();
        if wish.json {
            println!("{}", json!({ "scenes": scenes }));
        } else {
            println!("{:<12}{:>9}{:>9}  contacts  what", "scene", "best ns", "median");
            for s in &scenes {
                let name = s["name"].as_str().unwrap_or_default();
                let (best, median) =
                    (s["best_ns"].as_f64().unwrap_or_default(), s["median_ns"].as_f64().unwrap_or_default());
                let contacts = s["outcome"]["contacts"]["mean"].as_f64().unwrap_or_default();
                let what = s["timed"].as_str().unwrap_or_default();
                println!("{name:<12}{best:>9.0}{median:>9.0}{contacts:>10.1}  {what}");
            }
        }
    }
    ExitCode::SUCCESS
}
