//! A foreign table in a real window: dropped, its columns mapped with the pointer, a boundary dragged, and fitted again by the button.

use crate::screen::{SCREEN, Screen, drawn, kept, start, until, within};
use crate::{by_hand, drag, drop::drop_file};
use app::ui::headless::gallery::by_pointer::{Places, places};
use app::ui::kit::theme::Palette;
use egui::{Color32, Pos2, Rect};
use estimator::segment::SystemState;
use serde_json::Value;
use std::time::Duration;

type Picture = Vec<Vec<[u8; 3]>>;

/// A list that opens or closes changes so many pixels, and more than a button does under the pointer.
const LIST: usize = 1500;
/// A tick that comes or goes changes more pixels than this.
const TICK: usize = 8;

fn at(place: Pos2) -> [String; 2] {
    [format!("{:.0}", place.x), format!("{:.0}", place.y)]
}

fn differs(a: &Picture, b: &Picture) -> usize {
    a.iter().flatten().zip(b.iter().flatten()).filter(|(a, b)| a != b).count()
}

/// Waits until the picture stands still, and returns it.
fn rest(screen: &Screen, what: &str) -> Picture {
    let mut before = screen.picture();
    until(what, screen, || {
        let now = screen.picture();
        let still = differs(&now, &before) == 0;
        before.clone_from(&now);
        still.then_some(now)
    })
}

/// Clicks where a list opens or closes, as a person does: goes there, looks, clicks, and sees it happen.
fn click(screen: &Screen, place: Pos2, what: &str) {
    let [x, y] = at(place);
    screen.xdotool(&["mousemove", &x, &y]);
    let before = rest(screen, what);
    screen.xdotool(&["click", "1"]);
    until(what, screen, || (differs(&screen.picture(), &before) > LIST).then_some(()));
    rest(screen, what);
}

/// Clicks a tick until it is another one: what is opened may still move it while it is fitted.
fn untick(screen: &Screen, place: Pos2) {
    let [x, y] = at(place);
    screen.xdotool(&["mousemove", &x, &y]);
    let part = |picture: &Picture| -> Picture {
        let [column, row] = [place.x as usize - 6, place.y as usize - 6];
        picture[row..row + 12].iter().map(|line| line[column..column + 12].to_vec()).collect()
    };
    until("the tick taken away", screen, || {
        let before = part(&rest(screen, "the pointer at the tick"));
        screen.xdotool(&["click", "1"]);
        // A frame takes its time: without one in five seconds the click went elsewhere.
        within(Duration::from_secs(5), || (differs(&part(&screen.picture()), &before) > TICK).then_some(()))
    });
}

/// Pixels of a colour of the palette in a part of the screen.
fn count(screen: &Screen, part: Rect, color: impl Fn(&Palette) -> Color32) -> usize {
    let wanted = [false, true].map(|dark| color(Palette::of(dark)).to_array());
    let near = |p: &[u8; 3]| wanted.iter().any(|w| p.iter().zip(w).all(|(a, b)| a.abs_diff(*b) <= 6));
    let rows = screen.picture();
    let [left, right] = [part.left(), part.right()].map(|x| (x.max(0.0) as usize).min(SCREEN[0]));
    let [top, bottom] = [part.top(), part.bottom()].map(|y| (y.max(0.0) as usize).min(SCREEN[1]));
    rows[top..bottom].iter().map(|row| row[left..right].iter().filter(|p| near(p)).count()).sum()
}

/// Says what the columns mean, and opens the table.
fn map(screen: &Screen, places: &Places) {
    // The button to save is of the accent's colour once the preview is there.
    let ready = || (count(screen, places.save, |p| p.accent) > 200).then_some(());
    until("the dialog that maps columns", screen, ready);
    for [list, entry] in &places.chosen {
        click(screen, *list, "the list");
        click(screen, *entry, "its entry");
    }
    screen.keep("8-mapped");
    until("the preview", screen, ready);
    let [x, y] = at(places.save.center());
    screen.xdotool(&["mousemove", &x, &y, "click", "1"]);
    until("the sidecar", screen, || places.sidecar.exists().then_some(()));
}

#[test]
fn a_person_maps_a_foreign_table_and_fits_again() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let Some(screen) = Screen::or_skip(folder.path()) else { return };
    let home = folder.path().join("home");
    let places = places(folder.path(), SCREEN.map(|n| n as u32)).expect("the way was gone before");
    assert!(!places.chosen.is_empty() && !places.sidecar.exists());

    let _program = start(&screen, &home);
    until("the first picture", &screen, || drawn(&screen).then_some(()));
    until("the tour", &screen, || kept(&home).get("toured").cloned());
    screen.xdotool(&["key", "Escape"]);
    until("the end of the tour", &screen, || (kept(&home)["toured"] == true).then_some(()));
    screen.xdotool(&["key", "ctrl+2"]);
    until("Calibrate", &screen, || (kept(&home)["project"]["workspace"] == "calibrate").then_some(()));
    drop_file(&screen, &places.table, [700, 500]);
    map(&screen, &places);

    let recordings = |home: &std::path::Path| kept(home)["project"]["recordings"].as_array().map_or(0, Vec::len);
    until("the recording", &screen, || (recordings(&home) == 1).then_some(()));
    let written = std::fs::read_to_string(&places.sidecar).expect("it can be read");
    let sidecar: Value = serde_json::from_str(&written).expect("it is JSON");
    assert_eq!(sidecar["task"], "crank", "{written}");
    let told = sidecar["columns"].to_string();
    assert!(told.contains("Griff X (mm)") && told.contains("x_m"), "{written}");
    let states = until("the states", &screen, || screen.run_of(SystemState::Turning));
    screen.keep("8-opened");

    untick(&screen, places.follow);
    drag(&screen, &home, states);
    assert!(by_hand(&home));
    // Beside the button stands in the colour of doubts that the settings changed, until it is pressed.
    let beside = Rect::from_min_max(places.refit.right_top(), places.refit.right_bottom() + egui::vec2(110.0, 0.0));
    let told = || count(&screen, beside, |p| p.caution);
    until("the word that the settings changed", &screen, || (told() > 5).then_some(()));
    screen.keep("9-changed");
    let [x, y] = at(places.refit.center());
    screen.xdotool(&["mousemove", &x, &y, "click", "1"]);
    until("the new fit", &screen, || (told() == 0).then_some(()));
    rest(&screen, "the window after the fit");
    screen.keep("9-refitted");
    // The word is gone because it was fitted, not because the boundary was put back.
    assert!(by_hand(&home) && told() == 0);
}
