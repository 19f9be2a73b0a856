//! What the fuzz targets do, over the seeds that fuzzing starts from and over spoiled ones, with any compiler: a target that does not
//! build any more, or a seed that fails, is seen here. `fuzz/` itself needs a nightly one and cargo-fuzz.

#[path = "../../fuzz/src/targets/mod.rs"]
mod targets;
#[path = "../../fuzz/src/window/mod.rs"]
mod window;

use rand::SeedableRng as _;
use rand::rngs::StdRng;
use std::path::{Path, PathBuf};
use tests::workspace;

/// A target, its seeds, and how often each is spoiled.
struct Target {
    name: &'static str,
    run: fn(&[u8]),
    seeds: Vec<Vec<u8>>,
    spoiled: usize,
}

fn files(folder: &Path) -> Vec<Vec<u8>> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    paths.sort();
    paths.into_iter().map(|path| std::fs::read(path).expect("readable")).collect()
}

fn corpus(name: &str) -> Vec<Vec<u8>> {
    files(&workspace().join("tests/corpus").join(name))
}

fn assets(name: &str) -> Vec<Vec<u8>> {
    files(&workspace().join("assets").join(name))
}

/// A database with attempts in it.
fn history() -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("history.sqlite");
    let mut store = app::history::store::Store::open(&path).expect("made");
    for number in 0..6 {
        let attempt = serde_json::json!({
            "trainee": "Ada", "lesson": "pinch", "began": format!("2026-11-22T10:0{number}:00Z"), "duration_s": 20.0,
            "completed": true, "score": 80.0, "meets_criterion": false, "proficient": false, "measures": { "a": 1 },
            "measures_version": 1, "grade_version": 1,
        });
        store.keep(&serde_json::from_value(attempt).expect("an attempt")).expect("kept");
    }
    drop(store);
    std::fs::read(&path).expect("there")
}

/// What a window keeps of itself, and a project.
fn sessions() -> Vec<Vec<u8>> {
    let kept = app::ui::document::autosave::State { toured: true, ..Default::default() };
    let project = app::ui::document::project::Project { touchstone_project: 1, ..Default::default() };
    vec![serde_json::to_vec(&kept).expect("JSON"), serde_json::to_vec(&project).expect("JSON"), b"{}".to_vec()]
}

fn all() -> Vec<Target> {
    let of = |name, run, seeds, spoiled| Target { name, run, seeds, spoiled };
    vec![
        of("log", targets::log::run, corpus("log"), 60),
        of("mat", targets::mat::run, corpus("mat"), 60),
        of("mcap", targets::mcap::run, corpus("mcap"), 60),
        of("parquet", targets::parquet::run, corpus("parquet"), 60),
        of("sidecar", targets::sidecar::run, corpus("sidecar"), 60),
        of("udp", targets::udp::run, corpus("udp"), 200),
        of("serial", targets::serial::run, corpus("serial"), 10),
        of("world", targets::world::run, assets("worlds"), 10),
        of("documents", targets::documents::run, [assets("lessons"), assets("tasks")].concat(), 10),
        of("history", window::history::run, vec![history(), Vec::new()], 20),
        of("session", window::session::run, sessions(), 40),
    ]
}

#[test]
fn every_target_takes_its_seeds_and_spoiled_ones() {
    let mut rng = StdRng::seed_from_u64(1);
    // One after another: the readers of logs are watched for the memory that they take.
    for Target { name, run, seeds, spoiled } in all() {
        assert!(!seeds.is_empty(), "{name} has no seeds");
        let begun = std::time::Instant::now();
        for seed in &seeds {
            run(seed);
            (0..spoiled).for_each(|_| run(&tests::spoiled::bytes(seed, &mut rng)));
        }
        println!("{name}: {} seeds, {:.2} s", seeds.len(), begun.elapsed().as_secs_f64());
    }
    let _ = std::fs::remove_dir_all(targets::file("log.csv").parent().expect("it stands in a folder"));
}

/// What only a fuzzer's build sees: the targets themselves, which hand over their bytes.
#[test]
fn every_target_is_run_here_and_hands_over_its_bytes() {
    let folder = workspace().join("fuzz");
    let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).expect("readable");
    let mut names: Vec<&str> = all().into_iter().map(|target| target.name).collect();
    for name in &names {
        let text =
            std::fs::read_to_string(folder.join(format!("fuzz_targets/{name}.rs"))).expect("a target of this name");
        let module = if folder.join(format!("src/window/{name}.rs")).exists() { "window" } else { "targets" };
        let whole =
            format!("#![no_main]\n\nlibfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::{module}::{name}::run(bytes));\n");
        assert!(text.starts_with("//! ") && text.ends_with(&whole), "{name}: {text}");
        let (_, entry) = manifest.split_once(&format!("name = \"{name}\"\n")).expect("it is in the manifest");
        let entry = entry.split("[[bin]]").next().unwrap_or_default();
        assert!(entry.contains(&format!("path = \"fuzz_targets/{name}.rs\"")), "{entry}");
        assert_eq!(entry.contains("required-features = [\"window\"]"), module == "window", "{entry}");
    }
    names.sort_unstable();
    let there = std::fs::read_dir(folder.join("fuzz_targets")).expect("readable").flatten();
    let mut there: Vec<String> = there.filter_map(|e| Some(e.path().file_stem()?.to_str()?.to_owned())).collect();
    there.sort();
    assert_eq!(there, names, "a target that is not run here");
}
