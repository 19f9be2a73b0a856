//! Pictures of panels, looked at pixel by pixel.

use super::thresholds::{COLORS, DARK, INK, LIGHT, MARGIN, SURFACE};
use super::{STACK, count_near, empty, no_driver, session};
use crate::ui::headless::gallery::plates;
use crate::ui::headless::screenshot;
use crate::ui::kit::theme;
use crate::ui::tests::picture;
use crate::video::tests::no_reader;
use estimator::segment::SystemState;
use std::collections::HashSet;

#[test]
fn the_picture_of_the_log_has_a_band_in_the_states_colours() {
    if no_driver() {
        return;
    }
    for dark in [false, true] {
        let picture = screenshot::draw(session(STACK.clone()), picture("log"), [900, 560], dark).expect("drawn");
        for state in [SystemState::FreeMotion, SystemState::HoldOnGround, SystemState::HoldAboveGround] {
            let found = count_near(&picture, theme::state_color(dark, state));
            assert!(found > 500, "{state:?}, dark {dark}: {found} pixels");
        }
    }
}

#[test]
fn the_scene_stands_in_the_picture_of_the_workbench() {
    if no_driver() {
        return;
    }
    let with = screenshot::draw(session(STACK.clone()), picture("scene"), [600, 400], true).expect("drawn");
    let block = theme::role(true, render::ColorRole::Block(0));
    let [r, g, b, _] = block.to_array().map(i32::from);
    let like_the_block = |p: &&image::Rgba<u8>| {
        let [pr, pg, pb, _] = p.0.map(i32::from);
        (pr - r).abs() + (pg - g).abs() + (pb - b).abs() < 60
    };
    let found = with.pixels().filter(like_the_block).count();
    assert!(found > 300, "{found} pixels of block 1");
}

#[test]
fn a_whole_workspace_is_drawn_without_anything() {
    if no_driver() {
        return;
    }
    for panel in [picture("workbench"), picture("train")] {
        let picture = screenshot::draw(empty(), panel, [1000, 700], false).expect("drawn");
        assert_eq!(picture.dimensions(), (1000, 700));
    }
}

/// Draws one plate of the gallery in both themes and looks at what every picture must have.
fn look_at(plate: &plates::Plate, studio: &mut plates::Studio) {
    for dark in [false, true] {
        let name = format!("{}, dark {dark}", plate.name);
        let picture = studio.draw(plate, dark).expect("drawn");
        assert_eq!(picture.dimensions(), (plate.size[0], plate.size[1]), "{name}");
        let colors: HashSet<_> = picture.pixels().map(|p| p.0).collect();
        assert!(colors.len() > COLORS, "{name} is nearly blank: {} colours", colors.len());
        let p = theme::Palette::of(dark);
        let pixels = f64::from(picture.width() * picture.height());
        let surface: usize = [p.window, p.card, p.sunken].iter().map(|c| count_near(&picture, *c)).sum();
        assert!(surface as f64 / pixels > SURFACE, "{name}: {surface} pixels of surfaces");
        let ink: usize = [p.text, p.secondary].iter().map(|c| count_near(&picture, *c)).sum();
        assert!(ink > INK, "{name}: {ink} pixels of words");
        let mean = picture.pixels().map(|p| f64::from(p[1])).sum::<f64>() / pixels;
        assert!(if dark { mean < DARK } else { mean > LIGHT }, "{name}: mean brightness {mean:.0}");
        if plate.is_framed() {
            nothing_outside(&picture, p.window, &name);
        }
    }
}

/// Checks that a panel draws nothing in its margin.
fn nothing_outside(picture: &image::RgbaImage, window: egui::Color32, name: &str) {
    let (width, height) = picture.dimensions();
    let outside = |x: u32, y: u32| x.min(y).min(width - 1 - x).min(height - 1 - y) < MARGIN;
    let near = |p: &image::Rgba<u8>| p.0.iter().zip(window.to_array()).all(|(a, b)| a.abs_diff(b) <= 2);
    let stray = picture.enumerate_pixels().find(|(x, y, p)| outside(*x, *y) && !near(p));
    assert!(stray.is_none(), "{name}: something is drawn outside, at {stray:?}");
}

fn look_at_all(wanted: impl Fn(&plates::Plate) -> bool) {
    if no_driver() {
        return;
    }
    let mut studio = plates::Studio::default();
    // Without the program that reads videos there is no picture of one.
    let without = no_reader();
    let there = |plate: &plates::Plate| !without || plate.picture.name != "video";
    let plates: Vec<_> = plates::plates().into_iter().filter(wanted).filter(there).collect();
    assert!(!plates.is_empty());
    for plate in plates {
        look_at(&plate, &mut studio);
    }
}

// In parts, so that they run beside each other.
#[test]
fn every_panel_is_drawn_in_light_and_dark() {
    look_at_all(|plate| plate.is_framed() && plate.picture.name != "trainer" && !plate.is_view());
}

#[test]
fn every_page_is_drawn_in_light_and_dark() {
    look_at_all(|plate| !plate.is_framed());
}

#[test]
fn every_view_of_a_recording_is_drawn_in_light_and_dark() {
    look_at_all(plates::Plate::is_view);
}

#[test]
fn every_world_is_drawn_in_light_and_dark() {
    look_at_all(|plate| plate.picture.name == "trainer");
}
