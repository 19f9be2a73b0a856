//! The arrows between the crates point one way: haptics ← foundation ← logs, estimation ← training, estimator ← app,
//! haptics ← render ← app.

use cargo_metadata::MetadataCommand;
use std::collections::BTreeSet;

/// Workspace members that `package` may depend on in its normal build.
const ALLOWED: [(&str, &[&str]); 11] = [
    ("haptics", &[]),
    ("foundation", &["haptics"]),
    ("logs", &["haptics", "foundation"]),
    ("estimation", &["haptics", "foundation"]),
    ("training", &["haptics", "foundation", "logs", "estimation"]),
    ("estimator", &["haptics", "foundation", "logs", "estimation", "training"]),
    ("render", &["haptics"]),
    ("blind", &["haptics", "estimator"]),
    ("app", &["haptics", "estimator", "render", "blind"]),
    ("tests", &["haptics", "estimator", "render", "blind", "app"]),
    ("golden", &["haptics", "estimator", "blind", "tests"]),
];

/// What must never come into a crate, directly or through others: the lower half has no window.
const FORBIDDEN_BELOW: [(&str, &[&str]); 3] = [
    ("haptics", &["egui", "eframe", "wgpu", "glam", "clap"]),
    ("estimator", &["egui", "eframe", "wgpu", "glam", "clap"]),
    ("render", &["egui", "eframe", "clap"]),
];

#[test]
fn arrows_point_one_way() {
    let metadata = MetadataCommand::new().no_deps().exec().expect("cargo describes the workspace");
    let members: BTreeSet<String> = metadata.packages.iter().map(|p| p.name.to_string()).collect();
    let known: BTreeSet<String> = ALLOWED.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(members, known, "a new crate needs its place in this test and in ARCHITECTURE.md");
    for package in &metadata.packages {
        let (_, allowed) = ALLOWED.iter().find(|(name, _)| package.name.as_str() == *name).expect("checked above");
        for dependency in package.dependencies.iter().filter(|d| members.contains(&d.name)) {
            assert!(
                allowed.contains(&dependency.name.as_str()),
                "{} must not depend on {}",
                package.name,
                dependency.name
            );
        }
    }
}

#[test]
fn nothing_graphical_below_the_app() {
    for (root, forbidden) in FORBIDDEN_BELOW {
        // `cargo tree` and not the metadata: the latter lists optional dependencies that no feature switches on.
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
        let output = std::process::Command::new(cargo)
            .args(["tree", "--package", root, "--edges", "normal", "--prefix", "none", "--format", "{p}"])
            .current_dir(tests::workspace())
            .output()
            .expect("cargo lists the dependencies");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let listed = String::from_utf8_lossy(&output.stdout).into_owned();
        let below: BTreeSet<&str> = listed.lines().filter_map(|line| line.split_whitespace().next()).collect();
        assert!(below.len() > 10, "{root} has dependencies: {below:?}");
        for crate_name in forbidden {
            assert!(!below.contains(crate_name), "{root} reaches {crate_name}");
        }
    }
}

/// The generator of the blind battery takes recordings and types of answers from the crates that it tests, no function.
#[test]
fn the_blind_generator_uses_no_law_no_world_and_no_estimate() {
    let folder = tests::workspace().join("tests/blind/src");
    let read = |path: &std::path::Path| std::fs::read_to_string(path).expect("text");
    let list = read(&folder.join("lib.rs"));
    let only_tests: BTreeSet<&str> =
        list.split("#[cfg(test)]\nmod ").skip(1).filter_map(|m| m.split(';').next()).collect();
    let mut used = 0;
    for entry in std::fs::read_dir(folder).expect("the blind battery").flatten() {
        let path = entry.path();
        let name = path.file_stem().and_then(std::ffi::OsStr::to_str).unwrap_or_default();
        if only_tests.contains(name) {
            continue;
        }
        let text = read(&path);
        let product = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        let code: Vec<&str> = product.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        let code = code.join("\n");
        for after in code.split("haptics::").skip(1) {
            assert!(after.starts_with("recording::"), "{}: uses haptics::{}", path.display(), start(after));
            used += 1;
        }
        for after in code.split("estimator::").skip(1) {
            let types = after.strip_prefix("diagnose::").map(|names| names.trim_start_matches('{'));
            let is_type = types.is_some_and(|names| names.starts_with(|c: char| c.is_ascii_uppercase()));
            assert!(is_type, "{}: uses estimator::{}", path.display(), start(after));
            used += 1;
        }
    }
    assert!(used > 5, "{used} uses were looked at");
}

/// Start of a path, for a message.
fn start(path: &str) -> &str {
    path.lines().next().unwrap_or_default()
}

/// Scripts that time our programs beside others' build them as examples: what they name must be there.
#[test]
fn what_the_benches_build_is_there() {
    let folder = tests::workspace().join("benches");
    let mut named = 0;
    for script in std::fs::read_dir(folder)
        .expect("benches")
        .flatten()
        .filter(|e| e.path().extension().is_some_and(|e| e == "py"))
    {
        let text = std::fs::read_to_string(script.path()).expect("text");
        for after in text.split("\"--example\", \"").skip(1) {
            let name = after.split('"').next().unwrap_or_default();
            let found = ["haptics", "estimator", "app"].iter().any(|krate| {
                let examples = tests::workspace().join(krate).join("examples");
                examples.join(name).with_extension("rs").is_file() || examples.join(name).join("main.rs").is_file()
            });
            assert!(found, "{}: there is no example {name}", script.path().display());
            named += 1;
        }
    }
    assert!(named > 2, "{named} examples are named");
}
