//! Pictures of panels, looked at pixel by pixel.

use super::{STACK, count_near, empty, no_driver, session};
use crate::ui::{screenshot, theme};
use estimator::segment::SystemState;

#[test]
fn the_picture_of_the_log_has_a_band_in_the_states_colours() {
    if no_driver() {
        return;
    }
    for dark in [false, true] {
        let picture =
            screenshot::draw(session(STACK.clone()), screenshot::Panel::Log, [900, 560], dark).expect("drawn");
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
    let with = screenshot::draw(session(STACK.clone()), screenshot::Panel::Scene, [600, 400], true).expect("drawn");
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
    for panel in [screenshot::Panel::Workbench, screenshot::Panel::Train] {
        let picture = screenshot::draw(empty(), panel, [1000, 700], false).expect("drawn");
        assert_eq!(picture.dimensions(), (1000, 700));
    }
}
