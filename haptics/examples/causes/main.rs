//! Writes the pages of all causes: `cargo run -p haptics --example causes`.

mod pages;

use std::process::ExitCode;

fn main() -> ExitCode {
    let folder = pages::folder();
    let written = std::fs::create_dir_all(&folder)
        .and_then(|()| pages::pages().iter().try_for_each(|(name, text)| std::fs::write(folder.join(name), text)));
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("the pages could not be written to {}: {error}; may this folder be written?", folder.display());
            ExitCode::FAILURE
        }
    }
}
