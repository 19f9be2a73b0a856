//! Draws one picture of everything that the renderer can show:
//! `cargo run -p render --example gallery -- FOLDER [NAME]`.

mod plates;

use render::{Headless, SceneView, Theme, ViewOptions};
use std::path::PathBuf;
use std::time::Instant;

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Frames that are timed.
const FRAMES: u16 = 20;

fn main() -> Outcome {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("name the folder to write to")?);
    std::fs::create_dir_all(&folder)?;
    let mut headless = Headless::new()?;
    println!("drawn by {}", headless.adapter());
    let only = std::env::args().nth(2);
    for plate in plates::plates().into_iter().filter(|plate| only.as_ref().is_none_or(|name| name == plate.name)) {
        for (theme, theme_name) in [(Theme::Light, "light"), (Theme::Dark, "dark")] {
            let options = ViewOptions { theme, ..plate.options.clone() };
            let view = SceneView { world: &plate.world, state: &plate.state, options: &options };
            for (width, height) in [(1280, 720), (640, 360)] {
                let picture = headless.render(&view, width, height)?;
                picture.save(folder.join(format!("{}-{theme_name}-{width}.png", plate.name)))?;
                let start = Instant::now();
                for _ in 0..FRAMES {
                    headless.draw(&view, width, height)?;
                }
                let milliseconds = start.elapsed().as_secs_f64() * 1e3 / f64::from(FRAMES);
                println!("{:>12} {theme_name:>5} {width:>4} x {height}: {milliseconds:.1} ms a frame", plate.name);
            }
        }
    }
    Ok(())
}
