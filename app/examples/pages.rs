//! Draws the Train and Devices pages in both themes and two sizes into a folder: `cargo run -p app --example pages -- FOLDER`.

use app::ui::screenshot::{Panel, PanelInput, panel};
use app::worlds::BUILT_IN;
use std::path::PathBuf;

fn main() -> anyhow::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".to_owned()));
    std::fs::create_dir_all(&folder)?;
    for size in [[1000, 620], [1600, 1000]] {
        for dark in [false, true] {
            let name = |what: &str| {
                let theme = if dark { "dark" } else { "light" };
                folder.join(format!("{what}-{}-{theme}.png", size[0]))
            };
            for by_hand in [true, false] {
                let input = PanelInput { by_hand, ..PanelInput::default() };
                let who = if by_hand { "you" } else { "scripted" };
                panel(&input, Panel::Devices, size, dark)?.save(name(&format!("devices-{who}")))?;
                for (world, make) in BUILT_IN {
                    let input = PanelInput { world: Some(make()), ..input.clone() };
                    panel(&input, Panel::Train, size, dark)?.save(name(&format!("{world}-{who}")))?;
                }
            }
        }
    }
    Ok(())
}
