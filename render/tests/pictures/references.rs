//! Every scene in light and dark beside its reference picture. `TOUCHSTONE_UPDATE_PICTURES=1 cargo test -p render` draws the
//! references anew; look at them before they are kept.

use super::plates::plates;
use super::thresholds::{COLORS, MEAN, PIXEL, REFERENCE, SHARE};
use image::imageops::{FilterType, resize};
use image::{Rgb, RgbImage, RgbaImage};
use render::{Headless, RenderError, SceneView, Theme, ViewOptions};
use std::collections::HashSet;
use std::path::PathBuf;

fn software() -> Option<Headless> {
    match Headless::software() {
        Ok(headless) => Some(headless),
        Err(RenderError::NoDriver | RenderError::NoDevice { .. }) => super::headless(),
        Err(error) => panic!("{error}"),
    }
}

fn reference(name: &str, theme: Theme) -> PathBuf {
    let theme = if theme == Theme::Dark { "dark" } else { "light" };
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/pictures/references/{name}-{theme}.png"))
}

fn small(picture: &RgbaImage) -> RgbImage {
    let small = resize(picture, REFERENCE[0], REFERENCE[1], FilterType::Triangle);
    RgbImage::from_fn(REFERENCE[0], REFERENCE[1], |x, y| {
        let [r, g, b, _] = small.get_pixel(x, y).0;
        Rgb([r, g, b])
    })
}

/// Mean difference of a channel and share of the pixels that differ.
fn difference(a: &RgbImage, b: &RgbImage) -> (f64, f64) {
    assert_eq!(a.dimensions(), b.dimensions());
    let off = |p: &Rgb<u8>, q: &Rgb<u8>| [0, 1, 2].map(|i| p[i].abs_diff(q[i]));
    let pixels = f64::from(a.width() * a.height());
    let pairs = || a.pixels().zip(b.pixels()).map(|(p, q)| off(p, q));
    let sum: f64 = pairs().flatten().map(f64::from).sum();
    let differ = pairs().filter(|off| off.iter().any(|o| *o > PIXEL)).count();
    (sum / (3.0 * pixels), differ as f64 / pixels)
}

#[test]
fn every_scene_looks_as_it_did_in_light_and_dark() {
    let Some(mut headless) = software() else { return };
    let update = std::env::var_os("TOUCHSTONE_UPDATE_PICTURES").is_some();
    let mut problems = Vec::new();
    for plate in plates() {
        for theme in [Theme::Light, Theme::Dark] {
            let options = ViewOptions { theme, ..plate.options.clone() };
            let view = SceneView { world: &plate.world, state: &plate.state, options: &options };
            let picture = headless.render(&view, 4 * REFERENCE[0], 4 * REFERENCE[1]).expect("drawn");
            let colors: HashSet<_> = picture.pixels().map(|p| p.0).collect();
            assert!(colors.len() > COLORS, "{} is nearly blank: {} colours", plate.name, colors.len());
            let (path, now) = (reference(plate.name, theme), small(&picture));
            if update {
                now.save(&path).expect("the reference can be written");
                continue;
            }
            match image::open(&path) {
                Ok(kept) => {
                    let (mean, share) = difference(&now, &kept.into_rgb8());
                    if mean > MEAN || share > SHARE {
                        problems.push(format!("{} {theme:?}: mean {mean:.2}, share {share:.4}", plate.name));
                    }
                }
                Err(error) => problems.push(format!("{}: {error}", path.display())),
            }
        }
    }
    assert!(problems.is_empty(), "{problems:#?}");
}

/// The thresholds are no rubber: a block that moved by three millimetres, or a shadow that is missing, is noticed.
#[test]
fn a_small_change_of_a_scene_is_noticed() {
    let Some(mut headless) = software() else { return };
    let plate = plates().into_iter().find(|plate| plate.name == "close").expect("there is one");
    let mut moved = plate.state.clone();
    moved.bodies[2].center_m.x += 0.003;
    let [before, after] = [&plate.state, &moved].map(|state| {
        let view = SceneView { world: &plate.world, state, options: &plate.options };
        small(&headless.render(&view, 4 * REFERENCE[0], 4 * REFERENCE[1]).expect("drawn"))
    });
    let (mean, share) = difference(&before, &after);
    assert!(mean > MEAN || share > SHARE, "mean {mean:.2}, share {share:.4}");
    assert_eq!(difference(&before, &before), (0.0, 0.0));
}
