//! Scripts in Python that the tests run, where there is one.

use crate::workspace;
use std::path::PathBuf;
use std::process::Command;

/// The Python to use: what `TOUCHSTONE_PYTHON` names, that of the environment which `./test` makes, or `python3`.
fn program() -> PathBuf {
    if let Some(named) = std::env::var_os("TOUCHSTONE_PYTHON") {
        return named.into();
    }
    // A relative folder is meant from where `./test` stands.
    let target = workspace().join(std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into()));
    let own = target.join(if cfg!(windows) { "python/Scripts/python.exe" } else { "python/bin/python" });
    if own.is_file() { own } else { "python3".into() }
}

/// What a script of the workspace prints; `None` when it has to be skipped, with a visible word: there is no Python, or the script
/// itself says `skipped: …` because a package is missing.
pub fn output_of(script: &str, arguments: &[&str]) -> Option<String> {
    output_with(script, arguments, &[])
}

/// The same with variables of the environment.
pub fn output_with(script: &str, arguments: &[&str], variables: &[(&str, String)]) -> Option<String> {
    let program = program();
    let path = workspace().join(script);
    let mut command = Command::new(&program);
    command.arg(&path).args(arguments).envs(variables.iter().map(|(name, value)| (name, value)));
    let Ok(output) = command.output() else {
        crate::skipped(&format!("{} cannot be started", program.display()));
        return None;
    };
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    if said.starts_with("skipped:") {
        crate::skipped(said.trim_start_matches("skipped:").trim());
        return None;
    }
    assert!(output.status.success(), "{script}: {}", String::from_utf8_lossy(&output.stderr));
    Some(said)
}
