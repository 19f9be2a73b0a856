//! Names that nobody should choose: of files, columns, states, trainees, worlds. They are kept as they are, and stay where they belong.

use crate::{Chaos, logs};
use app::history::store::{Query, Store};
use app::ui::document::project::{Project, Source};
use estimator::log;
use haptics::recording::{Channel, Recording};
use rand::RngExt as _;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Texts that break lines, tables, pages, terminals and shells.
fn texts() -> Vec<String> {
    let mut texts: Vec<String> = [
        "two\nlines",
        "carriage\rreturn",
        "\u{1b}[31mred\u{1b}[0m",
        "<script>alert(1)</script>",
        "\"quotes\" 'and' commas, ; \t",
        "../../up",
        "-rf",
        "%s%n",
        "\u{202e}right to left",
        "e\u{301}\u{1f9e4}\u{200b}",
        "=1+1",
        "null\u{0}byte",
        "'; DROP TABLE attempts; --",
    ]
    .map(str::to_owned)
    .to_vec();
    texts.push("long".repeat(5_000));
    texts
}

/// The same as names of files, as far as a file can have them.
fn file_names() -> Vec<OsString> {
    let mut names: Vec<OsString> = texts()
        .into_iter()
        .filter(|text| !text.contains(['/', '\0']))
        .map(|text| OsString::from(text.chars().take(60).collect::<String>()))
        .collect();
    names.push("x".repeat(240).into());
    names.push("..".into());
    #[cfg(unix)]
    names.push(std::os::unix::ffi::OsStringExt::from_vec(vec![b'a', 0xff, 0xfe, b'b']));
    names
}

pub fn hostile(chaos: &mut Chaos) {
    let folder = chaos.scratch();
    for name in file_names() {
        let mut file = name.clone();
        file.push(".csv");
        of_a_file(&folder.path().join(file));
        chaos.count("hostile names", 1);
    }
    of_columns_and_states(chaos, folder.path());
    of_trainees(chaos, folder.path());
    of_a_world(chaos, folder.path());
    let name = file_names()[chaos.rng.random_range(0..file_names().len())].clone();
    let mut file = name.clone();
    file.push(".csv");
    in_a_report(&folder.path().join(file));
}

fn of_a_file(path: &Path) {
    let recording = logs::recording("crank").slice(haptics::recording::Span { first: 0, end: 40 });
    log::write(std::slice::from_ref(&recording), path, &[]).expect("a file can have this name");
    let _ = log::write_meta(&recording, path);
    let again = log::load(path, None).unwrap_or_else(|error| panic!("{path:?}: {error}"));
    assert_eq!(again[0].channels, recording.channels, "{path:?}");
    std::fs::write(path, "t_s,q_m\n0,nothing\n").expect("writes");
    assert!(log::load(path, None).is_err(), "{path:?}");
    // A project finds it again, whatever it is called.
    let source = Source { log: path.to_path_buf(), meta: Some(path.with_extension("json")) };
    let project = Project { touchstone_project: 1, recordings: vec![source], ..Project::default() };
    let kept = path.with_file_name("work.touchstone.json");
    project.write(&kept).unwrap_or_else(|problem| panic!("{path:?}: {problem}"));
    assert_eq!(Project::read(&kept).expect("what was written").recordings, project.recordings);
}

fn of_columns_and_states(chaos: &mut Chaos, folder: &Path) {
    let channel = |name: &String| Channel { name: name.clone(), unit: String::new(), values: vec![1.0, 2.0, 3.0] };
    // A table has no place for a column's byte of zero, and a person would not see it.
    let names: Vec<String> = texts().into_iter().filter(|text| !text.contains('\0')).collect();
    let recording = Recording {
        name: "<hostile>".to_owned(),
        time_s: Some(vec![0.0, 1.0, 2.0]),
        channels: names.iter().map(channel).collect(),
        labels: Some((0..3).map(|_| names[chaos.rng.random_range(0..names.len())].clone()).collect()),
        ..Recording::default()
    };
    for ending in ["csv", "mcap", "parquet"] {
        let path = folder.join("columns").with_extension(ending);
        if let Err(error) = log::write(std::slice::from_ref(&recording), &path, &[]) {
            assert!(error.to_string().contains("cannot be written"), "{error}");
            continue;
        }
        let again = log::load(&path, None).unwrap_or_else(|error| panic!("{error}")).remove(0);
        for (found, meant) in again.channels.iter().zip(&recording.channels) {
            assert_eq!(found.values, meant.values, "{ending}: {:?}", meant.name);
            assert_eq!(found.name.trim(), meant.name.trim(), "{ending}");
        }
        assert_eq!(again.channels.len(), recording.channels.len(), "{ending}");
        assert!(again.labels.is_some(), "{ending}: states are kept");
    }
}

fn of_trainees(chaos: &mut Chaos, folder: &Path) {
    let path = folder.join("history.sqlite");
    let mut store = Store::open(&path).expect("made");
    let mut meant = Vec::new();
    for (number, text) in texts().into_iter().enumerate() {
        let mut attempt = crate::documents::attempt(number as u64);
        (attempt.trainee, attempt.lesson) = (text.trim().to_owned(), text);
        assert!(store.add(&attempt).expect("kept"), "{attempt:?}");
        meant.push(attempt);
    }
    assert_eq!(store.attempts(&Query::default()).expect("readable"), meant);
    let one = &meant[chaos.rng.random_range(0..meant.len())];
    let query = Query { trainee: Some(one.trainee.clone()), lesson: Some(one.lesson.clone()) };
    assert_eq!(store.attempts(&query).expect("readable"), std::slice::from_ref(one));
    app::history::table::csv(&meant).expect("a table");
}

/// A recording is called after its world, and stays in its folder.
fn of_a_world(chaos: &mut Chaos, folder: &Path) {
    let place = folder.join("recordings");
    for text in texts() {
        let (path, marker) = app::recorder::folder::reserve(&place, &text).expect("any name will do");
        marker.remove();
        assert_eq!(path.parent(), Some(place.as_path()), "{text:?}");
        chaos.count("hostile names", 1);
    }
}

fn in_a_report(log: &Path) {
    of_a_file(log);
    let recording = logs::recording("crank");
    log::write(&[recording], log, &[]).expect("writes");
    let files: [(PathBuf, Option<PathBuf>); 1] = [(log.to_path_buf(), None)];
    let page = log.with_file_name("page.html");
    app::report::of_files::of_files(&files, &page, |_, recording| recording).expect("a page");
    let text = std::fs::read_to_string(&page).expect("text");
    assert!(!text.contains("<script>alert"), "a name became part of the page");
}
