//! Generators and helpers of the end-to-end tests.
//!
//! A generator shares no formula with the estimator: it steps the world finely and looks at it through a sensor model. Truth
//! travels apart from the recording; only an assertion opens it.

pub mod captured;
pub mod coverage;
pub mod drawer;
pub mod free_motion;
pub mod fumble;
pub mod generate;
pub mod handling;
pub mod held_evenly;
pub mod mechanisms;
pub mod python;
pub mod reaching;
pub mod real;
pub mod rescaled;
pub mod schema;
pub mod spoiled;
pub mod tasks;

use estimator::log;
use haptics::recording::{Meta, Recording};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The `touchstone` program, built once in the profile of the tests.
pub fn touchstone() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        // …/target/<profile>/deps/<test> → …/target/<profile>
        let test = std::env::current_exe().expect("a test knows its own path");
        let folder = test.ancestors().nth(2).expect("tests lie in target/<profile>/deps").to_owned();
        let release = folder.ends_with("release");
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
        let mut build = std::process::Command::new(cargo);
        build.args(["build", "--quiet", "-p", "app", "--bin", "touchstone"]).current_dir(workspace());
        build.arg("--target-dir").arg(folder.parent().expect("a profile folder has a parent"));
        if release {
            build.arg("--release");
        }
        assert!(build.status().expect("cargo runs").success(), "the program could not be built");
        folder.join(format!("touchstone{}", std::env::consts::EXE_SUFFIX))
    })
}

/// The workspace's root.
pub fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the workspace")
}

/// A file of the measured data beside the checkout, or `None` with a visible word that it was skipped.
pub fn shared_data(file: &str) -> Option<PathBuf> {
    let path = workspace().join("../shared/data").join(file);
    if path.is_file() {
        return Some(path);
    }
    skipped(&format!("{file} is not here (../shared/data)"));
    None
}

/// Says what a test does not do here, and why. Not by `println!`, which the harness keeps to itself when a test passes.
pub fn skipped(why: &str) {
    let _ = writeln!(std::io::stderr(), "skipped: {why}");
}

/// Measured recordings beside the checkout, with a sidecar written as JSON; `None` as in [`shared_data`].
pub fn shared_recordings(file: &str, sidecar: &str) -> Option<Vec<Recording>> {
    let meta: Meta = serde_json::from_str(sidecar).expect("a sidecar");
    Some(log::load_with_meta(&shared_data(file)?, &meta).expect("real data load"))
}
