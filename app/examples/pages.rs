//! Draws the Train and Devices pages in both themes and two sizes into a folder: `cargo run -p app --example pages -- FOLDER`.

use app::ui::headless::picture_input::PictureInput;
use app::ui::headless::screenshot::{DEVICES, TRAIN, picture};
use haptics::world::presets::BUILT_IN;
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
                let input = PictureInput { by_hand, ..PictureInput::default() };
                let who = if by_hand { "you" } else { "scripted" };
                picture(&input, &DEVICES, size, dark)?.save(name(&format!("devices-{who}")))?;
                for (world, make) in BUILT_IN {
                    let input = PictureInput { world: Some(make()), ..input.clone() };
                    picture(&input, &TRAIN, size, dark)?.save(name(&format!("{world}-{who}")))?;
                }
            }
        }
    }
    Ok(())
}
