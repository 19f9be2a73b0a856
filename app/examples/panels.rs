//! Draws every panel of the window into a folder: `cargo run -p app --example panels -- FOLDER LOG…`.

use anyhow::Context as _;
use app::ui::headless::picture_input::PictureInput;
use app::ui::headless::screenshot::{picture, pictures};
use std::path::PathBuf;

/// Panels with the size they are drawn in.
const PLATES: [(&str, [u32; 2]); 8] = [
    ("log", [1000, 640]),
    ("segments", [900, 520]),
    ("parameters", [380, 460]),
    ("results", [380, 900]),
    ("scene", [900, 520]),
    ("trainer", [1000, 700]),
    ("workbench", [1480, 920]),
    ("train", [1480, 920]),
];

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| ".".to_owned()));
    std::fs::create_dir_all(&folder)?;
    let logs: Vec<Option<PathBuf>> = arguments.map(|a| Some(a.into())).collect();
    for log in if logs.is_empty() { vec![None] } else { logs } {
        let stem = log.as_ref().and_then(|l| l.file_stem()).map_or("empty".into(), |s| s.to_string_lossy());
        let input = PictureInput { log: log.clone(), ..PictureInput::default() };
        for (name, size) in PLATES {
            let which = pictures().find(|picture| picture.name == name).context("there is no such picture")?;
            for dark in [false, true] {
                let theme = if dark { "dark" } else { "light" };
                picture(&input, which, size, dark)?.save(folder.join(format!("{stem}-{name}-{theme}.png")))?;
            }
        }
    }
    Ok(())
}
