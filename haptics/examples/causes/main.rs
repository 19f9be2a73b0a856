//! Writes the pages of all causes: `cargo run -p haptics --example causes`.

mod pages;

use haptics::law::causes;
use std::io::{Error, ErrorKind};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let folder = pages::folder();
    match write(&folder) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("the pages could not be written to {}: {error}; may this folder be written?", folder.display());
            ExitCode::FAILURE
        }
    }
}

fn write(folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    for (name, text) in pages::pages() {
        std::fs::write(folder.join(name), text)?;
    }
    // Ids are only added: one that no cause has any more stays in the file, and a test finds it.
    let mut vocabulary = match std::fs::read_to_string(pages::vocabulary_file()) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok::<_, Error>(String::new()),
        other => other,
    }?;
    for line in causes().map(pages::vocabulary_line) {
        if vocabulary.lines().all(|stands| stands != line) {
            vocabulary += &line;
            vocabulary.push('\n');
        }
    }
    std::fs::write(pages::vocabulary_file(), vocabulary)
}
