//! One real window under Xvfb, driven by a pointer and a keyboard that it does not know from a person's: a log is dropped on it, a boundary
//! dragged and put back, a diagnosis asked for by its name, the model extended, felt before and after, and reported; the program is killed
//! and goes on where it was.

mod drop;
mod lessons;
mod mapping;
mod screen;
mod starts;

use app::ui::kit::theme;
use drop::drop_file;
use estimator::segment::SystemState;
use screen::{Screen, always_choose, command, drawn, kept, start, try_command, until};
use std::path::Path;
use std::process::Command;
use std::time::Instant;
use tests::touchstone;

/// True once a state was set by hand.
fn by_hand(home: &Path) -> bool {
    kept(home)["project"]["choice"]["segments"].as_object().is_some_and(|s| !s.is_empty())
}

/// Drags the right boundary of a bar a third of its length to the left.
fn drag(screen: &Screen, home: &Path, (left, right, y): (usize, usize, usize)) {
    // A boundary is dragged as a hand does it: down, on its way, up.
    let at = |x: usize| [x.to_string(), (y + 8).to_string()];
    let move_to = |x: usize| screen.xdotool(&["mousemove", &at(x)[0], &at(x)[1]]);
    // The grip's line stands out above the band, where no pointer covers it.
    let grip = |screen: &Screen| screen.picture()[y - 2][right - 3..right + 4].to_vec();
    let free = grip(screen);
    move_to(right);
    until("the grip", screen, || (grip(screen) != free).then_some(()));
    let offered = grip(screen);
    screen.xdotool(&["mousedown", "1"]);
    until("the grip in the hand", screen, || (grip(screen) != offered).then_some(()));
    let goal = right - (right - left) / 3;
    for part in 1..=10 {
        move_to(right - (right - goal) * part / 10);
    }
    // The colour of the next state has come where the first one was.
    let behind = |screen: &Screen| screen.picture()[y + 2][goal + 20];
    let was = behind(screen);
    let follows = || (behind(screen) != was || by_hand(home)).then_some(());
    until("the boundary under the pointer", screen, follows);
    screen.xdotool(&["mouseup", "1"]);
    until("the boundary", screen, || by_hand(home).then_some(()));
}

/// Extends the model once its causes are named, and takes the hand into what it is now and was before.
fn extend_and_feel(screen: &Screen, home: &Path) {
    until("the worlds before and after", screen, || {
        screen.xdotool(&["key", "ctrl+e"]);
        try_command(screen, "feel before and after").then_some(())
    });
    until("the trainer", screen, || (kept(home)["project"]["workspace"] == "train").then_some(()));
    screen.keep("5-feel-after");
    // What stands beside the workspaces says which world it is.
    let named = |screen: &Screen| screen.picture()[14..36].iter().map(|row| row[520..900].to_vec()).collect::<Vec<_>>();
    let after = named(screen);
    screen.xdotool(&["key", "b"]);
    until("the world before", screen, || (named(screen) != after).then_some(()));
    screen.keep("5-feel-before");
}

/// Writes the report by its name in the list of commands.
fn report(screen: &Screen, home: &Path) {
    let page = home.join("report.html");
    always_choose(home, &page);
    command(screen, "write report");
    // It is there before its last line is.
    let whole = || std::fs::read_to_string(&page).ok().filter(|text| text.contains("</html>"));
    let text = until("the report", screen, whole);
    assert!(text.contains("blocks"), "{} letters", text.len());
    screen.keep("5-report");
}

#[test]
fn a_person_drops_drags_takes_back_diagnoses_extends_feels_reports_and_survives_a_kill() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let Some(screen) = Screen::or_skip(folder.path()) else { return };
    let home = folder.path().join("home");
    let log = folder.path().join("blocks.csv");
    let recorded = Command::new(touchstone())
        .args(["record", "--task", "block-stack", "--every", "5", "--out"])
        .arg(&log)
        .output()
        .expect("the program starts");
    assert!(recorded.status.success(), "{}", String::from_utf8_lossy(&recorded.stderr));

    let begun = Instant::now();
    let program = start(&screen, &home);
    until("the first picture", &screen, || drawn(&screen).then_some(()));
    println!("first picture after {:.2} s (software driver, this build)", begun.elapsed().as_secs_f64());
    // The first start shows around.
    until("the tour", &screen, || kept(&home).get("toured").cloned());
    screen.keep("1-tour");
    screen.xdotool(&["key", "Escape"]);
    until("the end of the tour", &screen, || (kept(&home)["toured"] == true).then_some(()));
    screen.xdotool(&["key", "ctrl+2"]);
    until("Calibrate", &screen, || (kept(&home)["project"]["workspace"] == "calibrate").then_some(()));

    drop_file(&screen, &log, [700, 500]);
    let recordings = |home: &Path| kept(home)["project"]["recordings"].as_array().map_or(0, Vec::len);
    until("the recording", &screen, || (recordings(&home) == 1).then_some(()));
    let states = until("the states", &screen, || screen.run_of(SystemState::HoldAboveGround));
    screen.keep("2-states");

    drag(&screen, &home, states);
    screen.keep("3-boundary");
    screen.xdotool(&["key", "ctrl+z"]);
    until("the way back", &screen, || (!by_hand(&home)).then_some(()));

    command(&screen, "diagnose");
    until("Diagnose", &screen, || (kept(&home)["project"]["workspace"] == "diagnose").then_some(()));
    screen.keep("5-diagnose");
    extend_and_feel(&screen, &home);
    report(&screen, &home);

    // `kill` sends SIGKILL: nothing is told, nothing can be tidied.
    drop(program);
    assert_eq!(kept(&home)["ended"], false);
    let _program = start(&screen, &home);
    // Its frame is of the colour of what is fine.
    let fine = [false, true].map(|dark| theme::Palette::of(dark).good.to_array());
    let is_fine = |p: &[u8; 3]| fine.iter().any(|w| p.iter().zip(w).all(|(a, b)| a.abs_diff(*b) <= 3));
    let framed =
        |screen: &Screen| screen.picture()[..120].iter().any(|row| row.iter().filter(|p| is_fine(p)).count() > 600);
    until("the offer", &screen, || framed(&screen).then_some(()));
    screen.keep("6-offer");
    screen.xdotool(&["mousemove", "1368", "79", "click", "1"]);
    // It goes on in Diagnose as soon as the recording is there; a person then looks at Calibrate.
    until("the states again", &screen, || {
        screen.xdotool(&["key", "ctrl+2"]);
        screen.run_of(SystemState::HoldAboveGround)
    });
    screen.keep("7-again");
}
