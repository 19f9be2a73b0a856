//! Recordings that travel with the program.

use anyhow::Context as _;
use haptics::recording::Recording;
use std::path::Path;

/// Recording bundled with the program: made by the scripted operator in a world unknown to the fit.
pub struct BuiltInRecording {
    /// Name on the command line.
    pub name: &'static str,
    /// Title in the demonstration.
    pub title: &'static str,
    /// The log.
    pub csv: &'static str,
    /// Its sidecar.
    pub meta: &'static str,
    /// World of the recording: opened only for the final comparison.
    pub truth: &'static str,
}

/// All of them.
pub const RECORDINGS: [BuiltInRecording; 2] = [
    BuiltInRecording {
        name: "stack",
        title: "Two blocks, unstacked and restacked",
        csv: include_str!("../../assets/recordings/stack.csv"),
        meta: include_str!("../../assets/recordings/stack.meta.json"),
        truth: include_str!("../../assets/worlds/demo-blocks.json"),
    },
    BuiltInRecording {
        name: "crank",
        title: "A crank, turned forwards and back",
        csv: include_str!("../../assets/recordings/crank.csv"),
        meta: include_str!("../../assets/recordings/crank.meta.json"),
        truth: include_str!("../../assets/worlds/demo-crank.json"),
    },
];

/// Bundled recording of a name, loaded by way of `folder`.
pub fn built_in(name: &str, folder: &Path) -> anyhow::Result<Vec<Recording>> {
    let found = RECORDINGS.iter().find(|built_in| built_in.name == name);
    let built_in = found.with_context(|| format!("there is no built-in recording `{name}`"))?;
    let log = folder.join(format!("{name}.csv"));
    write(&log, built_in.csv)?;
    write(&folder.join(format!("{name}.meta.json")), built_in.meta)?;
    Ok(estimator::log::load(&log, None)?)
}

/// Writes a text file; the error names it.
pub fn write(path: &Path, text: &str) -> anyhow::Result<()> {
    haptics::text_file::write(path, text).with_context(|| format!("the file could not be written: {}", path.display()))
}
