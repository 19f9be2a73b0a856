//! Worlds, lessons, tasks, projects and what a window has kept, spoiled by hand or by a disk: what is read runs, what is not read is
//! refused in a sentence.

use crate::{Chaos, must_be_a_sentence, mutate};
use app::history::attempt::{Attempt, Conditions};
use app::history::keeper::History;
use app::history::store::{Query, Store};
use app::ui::document::autosave::State as Kept;
use app::ui::document::project::Project;
use estimator::segment::definition::Definition;
use estimator::training::lesson::Lesson;
use haptics::device::{ScriptedOperator, Skill};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, World};
use rand::RngExt as _;
use rand::rngs::StdRng;
use serde_json::Value;
use std::path::{Path, PathBuf};
use tests::workspace;

/// Spoiled documents of each kind a lap.
const EACH: usize = 60;
/// Ticks in a world that was read from a spoiled file.
const TICKS: usize = 120;

/// The documents of a folder that come with the program.
pub fn documents(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(workspace().join("assets").join(folder)).expect("it comes with the program");
    let mut found: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    found.retain(|path| path.extension().is_some_and(|e| e == "json"));
    found.sort();
    found
}

/// One of them, with its tree or its bytes spoiled.
pub fn spoiled_one(found: &[PathBuf], rng: &mut StdRng) -> Vec<u8> {
    let text = std::fs::read(&found[rng.random_range(0..found.len())]).expect("there");
    spoiled_text(&text, rng)
}

fn spoiled_text(text: &[u8], rng: &mut StdRng) -> Vec<u8> {
    let value: Value = serde_json::from_slice(text).expect("JSON");
    match rng.random_range(0..4) {
        0 => tests::spoiled::bytes(text, rng),
        1 => mutate::numbers(&value, rng).to_string().into_bytes(),
        _ => mutate::json(&value, rng).to_string().into_bytes(),
    }
}

pub fn spoiled(chaos: &mut Chaos) {
    let folder = chaos.scratch();
    let path = folder.path().join("spoiled.json");
    let (worlds, lessons, tasks) = (documents("worlds"), documents("lessons"), documents("tasks"));
    for _ in 0..EACH {
        std::fs::write(&path, spoiled_one(&worlds, &mut chaos.rng)).expect("writes");
        match World::load(&path) {
            Err(error) => must_be_a_sentence(&error.to_string(), &path),
            Ok(world) => {
                chaos.count("spoiled worlds that run", 1);
                run(&world, chaos.rng.random());
            }
        }
        std::fs::write(&path, spoiled_one(&lessons, &mut chaos.rng)).expect("writes");
        match Lesson::load(&path) {
            Err(error) => must_be_a_sentence(&error.to_string(), &path),
            Ok(lesson) => {
                chaos.count("spoiled lessons that open", 1);
                for variant in 0..lesson.variant_count() {
                    lesson.world(variant).expect("a lesson that opens has its worlds");
                }
            }
        }
        std::fs::write(&path, spoiled_one(&tasks, &mut chaos.rng)).expect("writes");
        if let Err(error) = Definition::read(&path) {
            must_be_a_sentence(&error.to_string(), &path);
        }
    }
    spoiled_windows(chaos, &path);
    chaos.count("spoiled documents", 5 * EACH as u64);
}

/// Projects, and what a window keeps of itself.
fn spoiled_windows(chaos: &mut Chaos, path: &Path) {
    let source =
        app::ui::document::project::Source { log: PathBuf::from("a.csv"), meta: Some(PathBuf::from("b.json")) };
    let project = Project { touchstone_project: 1, recordings: vec![source], ..Project::default() };
    let kept = Kept { project: project.clone(), toured: true, ..Kept::default() };
    let project = serde_json::to_vec(&project).expect("JSON");
    let kept = serde_json::to_vec(&kept).expect("JSON");
    for _ in 0..EACH {
        std::fs::write(path, spoiled_text(&project, &mut chaos.rng)).expect("writes");
        if let Err(problem) = Project::read(path) {
            must_be_a_sentence(&problem, path);
        }
        // What cannot be read is as good as nothing kept; `autosave` puts it aside.
        let _ = serde_json::from_slice::<Kept>(&spoiled_text(&kept, &mut chaos.rng));
    }
}

/// A world that was taken in can be touched: what reaches the operator stays a force.
fn run(world: &World, seed: u64) {
    let state = State::resting(world);
    let operator = ScriptedOperator::new(world, &state, Skill::default(), seed);
    let limits = Limits { ramp_s: 1e-3, ..Limits::default() };
    let mut body = Loop::new(Swap::new(world.clone()), Box::new(operator), limits);
    for _ in 0..TICKS {
        for force in body.tick(1e-3).sent_force_n {
            assert!(force.norm() <= limits.max_force_n + 1e-9, "{force} in {}", world.to_json());
        }
    }
}

/// An attempt with this number.
pub fn attempt(number: u64) -> Attempt {
    Attempt {
        trainee: if number.is_multiple_of(3) { "Ada".to_owned() } else { "O'Brien; DROP TABLE".to_owned() },
        lesson: "pinch".to_owned(),
        conditions: Conditions::default(),
        began: jiff::Timestamp::from_microsecond(1_700_000_000_000_000 + number.cast_signed()).expect("a moment"),
        duration_s: 20.0,
        completed: true,
        score: Some(number as f64),
        meets_criterion: false,
        proficient: false,
        measures: serde_json::json!({ "hand": { "path_m": 0.1 } }),
        measures_version: 1,
        grade_version: 1,
        recording: None,
    }
}

/// A database of twenty attempts, as bytes.
pub fn history(path: &Path) -> Vec<u8> {
    let mut store = Store::open(path).expect("made");
    for number in 0..20 {
        store.add(&attempt(number)).expect("kept");
    }
    drop(store);
    std::fs::read(path).expect("there")
}

pub fn spoiled_history(chaos: &mut Chaos) {
    let folder = chaos.scratch();
    let path = folder.path().join("history.sqlite");
    let whole = history(&path);
    for round in 0..6 {
        keep_in_a_spoiled_one(&path, &whole, &attempt(1_000 + round), &mut chaos.rng);
        chaos.count("spoiled histories", 1);
    }
}

/// A database that a disk has spoiled is refused in a sentence, and what is done meanwhile is kept beside it. It has its folder to itself.
pub fn keep_in_a_spoiled_one(path: &Path, whole: &[u8], late: &Attempt, rng: &mut StdRng) {
    for file in std::fs::read_dir(path.parent().expect("a folder")).expect("there").flatten() {
        // Journals of before belong to another file.
        let _ = std::fs::remove_file(file.path());
    }
    std::fs::write(path, tests::spoiled::bytes(whole, rng)).expect("writes");
    let history = History::start(path.to_path_buf(), || {}).expect("a thread");
    history.add(late.clone());
    drop(history);
    let kept = Store::open(path).and_then(|store| store.attempts(&Query::default()));
    let in_base = kept.as_ref().is_ok_and(|all| all.contains(late));
    if let Err(problem) = &kept {
        must_be_a_sentence(problem, path);
    }
    let beside = std::fs::read_dir(path.with_extension("waiting")).map_or(0, |entries| entries.flatten().count());
    assert!(in_base || beside > 0, "an attempt is neither in the damaged database nor beside it: {kept:?}");
    let _ = std::fs::remove_dir_all(path.with_extension("waiting"));
}
