//! Tells a release build which revision of the sources it is made of, where nobody said so (`TOUCHSTONE_REVISION`, as `./run` does).
//! Other builds are not told: they would be made anew after every commit.

#[path = "build/revision.rs"]
mod revision;

use std::path::Path;

/// What the program is made of, from the workspace's top: a change there may make the checkout differ from its revision.
const SOURCES: [&str; 13] = [
    "Cargo.toml",
    "Cargo.lock",
    "app/Cargo.toml",
    "app/src",
    "estimator/src",
    "estimator/foundation/src",
    "estimator/logs/src",
    "estimator/estimation/src",
    "estimator/training/src",
    "haptics/src",
    "render/src",
    "assets",
    "tests/blind/src",
];

fn main() {
    println!("cargo::rerun-if-env-changed=TOUCHSTONE_REVISION");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=build/revision.rs");
    let is_told = std::env::var_os("TOUCHSTONE_REVISION").is_some_and(|told| !told.is_empty());
    let is_release = std::env::var("PROFILE").is_ok_and(|profile| profile == "release");
    let Some(workspace) = Path::new(env!("CARGO_MANIFEST_DIR")).parent().filter(|_| is_release && !is_told) else {
        return;
    };
    let Some(found) = revision::of(workspace) else { return };
    println!("cargo::rustc-env=TOUCHSTONE_REVISION={}", found.name);
    let sources = SOURCES.iter().map(|source| workspace.join(source)).filter(|source| source.exists());
    for file in sources.chain(found.noted_in) {
        println!("cargo::rerun-if-changed={}", file.display());
    }
}
