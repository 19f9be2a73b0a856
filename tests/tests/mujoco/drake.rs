//! Exported worlds in a third program, which has a reader of SDF: Drake.

use super::exports::{away, stepped};
use super::table::{Row, Table};
use app::export::{Format, export};
use haptics::law::{CoulombFriction, Law as _, LoadFriction};
use haptics::world::{State, World, presets};
use serde_json::{Value, json};

/// How long the crank swings, s, and how often it is looked at, s.
const SECONDS: f64 = 1.5;
const EVERY_S: f64 = 0.01;
/// How far the angles may be apart: Drake steps by 0.2 ms, ours by 0.125 ms.
const APART_RAD: f64 = 5e-3;

/// What Drake sees in an exported world; `None` where it is missing.
fn seen(world: &World, format: Format, seconds: f64) -> Option<Value> {
    let folder = tempfile::tempdir().expect("a folder");
    let ending = if format == Format::Sdf { "sdf" } else { "urdf" };
    let (model, job) = (folder.path().join("world").with_extension(ending), folder.path().join("job.json"));
    std::fs::write(&model, export(world, format, false).text).expect("the model is written");
    std::fs::write(&job, json!({ "model": model, "seconds": seconds, "every_s": EVERY_S }).to_string())
        .expect("written");
    let said = tests::python::output_of("tests/mujoco/drake_play.py", &[job.to_str().expect("a plain path")])?;
    Some(serde_json::from_str(&said).expect("one JSON object"))
}

/// Every built-in world that goes there is read, and every block has its mass; `None` where Drake is missing. (A crank's mass is that of its
/// weight: how it swings tells that and its inertia.)
pub fn everything_is_there() -> Option<()> {
    for world in [presets::stacking(), presets::crank(), presets::switch(), presets::barrel(), presets::needle()] {
        for format in [Format::Sdf, Format::Urdf] {
            let said = seen(&world, format, 0.0)?;
            assert!(said["bodies"].as_object().is_some_and(|bodies| !bodies.is_empty()), "{}: {said}", world.name);
            let masses: Vec<f64> =
                said["bodies"].as_object().expect("bodies").values().filter_map(Value::as_f64).collect();
            for mass_kg in world.blocks.iter().map(|block| block.mass_kg) {
                let is_it = |found: &f64| (found / mass_kg - 1.0).abs() < 1e-9;
                assert!(masses.iter().any(is_it), "{}, {format:?}: {mass_kg} kg in {said}", world.name);
            }
        }
    }
    Some(())
}

/// A crank without dry friction, which Drake's joints do not have, falls from a little above the horizontal and swings.
pub fn compared() -> Option<Table> {
    let mut world = presets::crank();
    let crank = world.crank.as_mut().expect("a crank");
    crank.effects.retain(|effect| ![LoadFriction.id(), CoulombFriction.id()].contains(&effect.law().id()));
    crank.start_rad = 0.3;
    let start_rad = crank.start_rad;
    let mut ours = vec![start_rad];
    let (mut state, mut ticks) = (State::new(&world, away(0.0)), 0);
    let every = (EVERY_S / super::exports::STEP_S).round() as u32;
    stepped(&world, &mut state, SECONDS, &away, |state| {
        ticks += 1;
        if ticks % every == 0 {
            ours.push(state.crank.angle_rad);
        }
    });
    let mut rows = Vec::new();
    for format in [Format::Sdf, Format::Urdf] {
        let said = seen(&world, format, SECONDS)?;
        let theirs: Vec<f64> = serde_json::from_value(said["angles"].clone()).expect("angles");
        assert_eq!(theirs.len(), ours.len());
        // There a joint is zero where the world starts.
        let apart = ours.iter().zip(&theirs).map(|(a, b)| (a - b - start_rad).abs()).fold(0.0, f64::max);
        let way = ours.iter().fold(0.0_f64, |most, a| most.max((a - start_rad).abs()));
        rows.push(Row {
            labels: vec![format!("crank without dry friction, let go, as {format:?}"), "angle".to_owned()],
            shown: [way, apart, APART_RAD].map(|value| format!("{:.3} mrad", 1e3 * value)).to_vec(),
            found: apart,
            wanted: 0.0,
            tolerance: APART_RAD,
            per: 1.0,
            places: 3,
        });
    }
    Some(Table { head: vec!["world and input", "coordinate", "way", "largest difference", "may be"], rows })
}
