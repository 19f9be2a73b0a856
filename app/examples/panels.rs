//! Draws every panel of the window into a folder: `cargo run -p app --example panels -- FOLDER LOG…`.

use app::ui::screenshot::{Panel, PanelInput, panel};
use std::path::PathBuf;

/// Panels with the size they are drawn in.
const PLATES: [(&str, Panel, [u32; 2]); 8] = [
    ("log", Panel::Log, [1000, 640]),
    ("segments", Panel::Segments, [900, 520]),
    ("parameters", Panel::Parameters, [380, 460]),
    ("results", Panel::Results, [380, 900]),
    ("scene", Panel::Scene, [900, 520]),
    ("trainer", Panel::Trainer, [1000, 700]),
    ("workbench", Panel::Workbench, [1480, 920]),
    ("train", Panel::Train, [1480, 920]),
];

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| ".".to_owned()));
    std::fs::create_dir_all(&folder)?;
    let logs: Vec<Option<PathBuf>> = arguments.map(|a| Some(a.into())).collect();
    for log in if logs.is_empty() { vec![None] } else { logs } {
        let stem = log.as_ref().and_then(|l| l.file_stem()).map_or("empty".into(), |s| s.to_string_lossy());
        let input = PanelInput { log: log.clone(), ..PanelInput::default() };
        for (name, which, size) in PLATES {
            for dark in [false, true] {
                let theme = if dark { "dark" } else { "light" };
                panel(&input, which, size, dark)?.save(folder.join(format!("{stem}-{name}-{theme}.png")))?;
            }
        }
    }
    Ok(())
}
