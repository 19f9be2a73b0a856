//! The history on a disk of its own: versions, other programs, damage, several trainees.

use super::store::{Query, Store};
use super::{aside, table};
use crate::history::attempt::{Attempt, Conditions};
use crate::history::keeper::{Answer, History};
use jiff::Timestamp;
use rusqlite::Connection;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// File of version 1 as it was written then: this text never changes.
const VERSION_1: &str = "
    CREATE TABLE trainees (id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, created TEXT NOT NULL) STRICT;
    CREATE TABLE attempts (
        id INTEGER PRIMARY KEY, trainee INTEGER NOT NULL REFERENCES trainees (id), lesson TEXT NOT NULL, conditions TEXT NOT NULL,
        began TEXT NOT NULL, duration_s REAL NOT NULL, completed INTEGER NOT NULL, score REAL, meets_criterion INTEGER NOT NULL,
        proficient INTEGER NOT NULL, measures TEXT NOT NULL, measures_version INTEGER NOT NULL, grade_version INTEGER NOT NULL,
        recording TEXT
    ) STRICT;
    INSERT INTO trainees VALUES (1, 'Ada', '2026-03-01T08:00:00Z'), (2, 'Grace', '2026-03-02T08:00:00Z');
    INSERT INTO attempts VALUES
        (1, 1, 'pinch', '{\"delay_ms\":0.0,\"predicted\":false}', '2026-03-01T08:05:00Z', 31.5, 1, 61.25, 0, 0,
            '{\"hand\":{\"path_m\":0.75}}', 1, 1, 'a/one.mcap'),
        (2, 1, 'pinch', '{\"delay_ms\":150.0,\"predicted\":true}', '2026-03-01T08:06:00.5Z', 22.0, 0, NULL, 0, 0, '{}', 1, 1, NULL),
        (3, 1, 'pinch', '{\"delay_ms\":150.0,\"predicted\":true}', '2026-03-01T08:06:00.5Z', 22.0, 0, NULL, 0, 0, '{}', 1, 1, NULL),
        (4, 2, 'stack', '{\"delay_ms\":0.0,\"predicted\":false}', '2026-03-02T08:05:00Z', 44.0, 1, 80.0, 1, 1, '{}', 1, 1, NULL);
    PRAGMA user_version = 1;";

fn at(text: &str) -> Timestamp {
    text.parse().expect("a time")
}

fn attempt(trainee: &str, lesson: &str, began: &str) -> Attempt {
    Attempt {
        trainee: trainee.to_owned(),
        lesson: lesson.to_owned(),
        conditions: Conditions { delay_ms: 150.0, predicted: true },
        began: at(began),
        duration_s: 12.625,
        completed: true,
        score: Some(73.1),
        meets_criterion: true,
        proficient: false,
        measures: json!({ "hand": { "path_m": 0.1 + 0.2, "jerks": [1, 2] }, "version": 1 }),
        measures_version: 1,
        grade_version: 3,
        recording: Some(PathBuf::from("recordings/one, two.mcap")),
    }
}

fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("deep").join("history.sqlite");
    (folder, path)
}

fn of(trainee: &str) -> Query {
    Query { trainee: Some(trainee.to_owned()), lesson: None }
}

#[test]
fn what_is_kept_is_found_again_to_the_bit_by_trainee_and_lesson() {
    let (_folder, path) = folder();
    let all = [
        attempt("Ada", "pinch", "2026-11-22T19:00:00.25Z"),
        attempt("Ada", "stack", "2026-11-22T19:10:00Z"),
        Attempt { score: None, recording: None, ..attempt("Grace", "pinch", "2026-11-22T19:00:00Z") },
    ];
    let mut store = Store::open(&path).expect("made");
    for attempt in &all {
        assert_eq!(store.add(attempt), Ok(true));
    }
    assert_eq!(store.add(&all[1]), Ok(false), "the same once more is the same");
    store.add_trainee(" Edsger ", at("2026-11-22T19:00:00Z")).expect("added");
    assert!(store.add_trainee("  ", at("2026-11-22T19:00:00Z")).is_err());
    drop(store);
    let store = Store::open(&path).expect("opened again");
    assert_eq!(store.trainees().expect("names"), ["Ada", "Edsger", "Grace"]);
    let everything = store.attempts(&Query::default()).expect("rows");
    assert_eq!(everything, [all[2].clone(), all[0].clone(), all[1].clone()], "by the moment, not by the letters");
    assert_eq!(store.attempts(&of("Ada")).expect("rows"), all[..2]);
    let pinched = Query { trainee: Some("Ada".to_owned()), lesson: Some("pinch".to_owned()) };
    assert_eq!(store.attempts(&pinched).expect("rows"), all[..1]);
    assert!(store.attempts(&of("Edsger")).expect("rows").is_empty());
}

#[test]
fn a_file_of_the_first_version_becomes_one_of_today_with_everything_in_it() {
    let (_folder, path) = folder();
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
    Connection::open(&path).expect("made").execute_batch(VERSION_1).expect("written");
    let mut store = Store::open(&path).expect("brought up to date");
    assert_eq!(store.trainees().expect("names"), ["Ada", "Grace"]);
    let ada = store.attempts(&of("Ada")).expect("rows");
    assert_eq!(ada.len(), 2, "the one that was kept twice is there once");
    assert_eq!((ada[0].score, ada[0].duration_s, ada[0].completed), (Some(61.25), 31.5, true));
    assert_eq!(ada[0].measures, json!({ "hand": { "path_m": 0.75 } }));
    assert_eq!(ada[0].recording.as_deref(), Some(Path::new("a/one.mcap")));
    assert_eq!(ada[1].conditions, Conditions { delay_ms: 150.0, predicted: true });
    assert_eq!((ada[1].score, ada[1].began), (None, at("2026-03-01T08:06:00.5Z")));
    let grace = store.attempts(&of("Grace")).expect("rows");
    assert!(grace.len() == 1 && grace[0].proficient && grace[0].meets_criterion);
    assert_eq!(store.add(&ada[0]), Ok(false), "and it stays one of today");
    let version = |path: &Path| -> u32 {
        let file = Connection::open(path).expect("opened");
        file.query_row("PRAGMA user_version", [], |row| row.get(0)).expect("a version")
    };
    assert_eq!(version(&path), super::schema::VERSION);
    // Later attempts come after them all, even if the clock was set back meanwhile.
    let next = attempt("Ada", "pinch", "2026-02-01T08:00:00Z");
    store.keep(&next).expect("kept");
    assert_eq!(store.attempts(&of("Ada")).expect("rows"), [ada[0].clone(), ada[1].clone(), next]);
}

#[test]
fn a_file_of_the_second_version_loses_nothing() {
    let (_folder, path) = folder();
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
    let file = Connection::open(&path).expect("made");
    file.execute_batch(VERSION_1).expect("written");
    // The second step, word for word.
    file.execute_batch(
        "DELETE FROM attempts WHERE id NOT IN (SELECT min(id) FROM attempts GROUP BY trainee, lesson, began);
        CREATE UNIQUE INDEX attempts_once ON attempts (trainee, lesson, began);
        INSERT INTO attempts SELECT 9, 2, 'pinch', conditions, '2026-03-01T08:04:59.75Z', 9.5, 1, 7.5, 0, 0, '{}', 1, 1, NULL
            FROM attempts WHERE id = 1;
        PRAGMA user_version = 2;",
    )
    .expect("written");
    drop(file);
    let mut store = Store::open(&path).expect("brought up to date");
    let read = |store: &Store| store.attempts(&Query::default()).expect("rows");
    let scores = |all: &[Attempt]| all.iter().map(|a| a.score).collect::<Vec<_>>();
    assert_eq!(scores(&read(&store)), [Some(7.5), Some(61.25), None, Some(80.0)], "by the date");
    for known in read(&store) {
        assert_eq!(store.add(&known), Ok(false), "it is known");
    }
    store.keep(&attempt("Ada", "pinch", "2026-01-01T00:00:00Z")).expect("kept");
    assert_eq!(scores(&read(&store)), [Some(7.5), Some(61.25), None, Some(80.0), Some(73.1)], "the newest");
}

/// Attempts of one person whose clock is set back by a day, by seconds and not at all; numbered by their scores.
fn by_a_bad_clock() -> Vec<Attempt> {
    let moments = [
        "2026-11-22T19:00:00Z",
        "2026-11-21T19:01:00Z",
        "2026-11-21T19:00:57Z",
        "2026-11-21T19:00:57Z",
        "2026-11-21T19:03:00Z",
        "2026-11-22T19:05:00.5Z",
        "2026-11-22T19:05:00Z",
    ];
    let made = |(number, began): (usize, &&str)| Attempt {
        score: Some(number as f64),
        ..attempt(if number % 3 == 2 { "Grace" } else { "Ada" }, "pinch", began)
    };
    moments.iter().enumerate().map(made).collect()
}

#[test]
fn a_clock_that_was_set_back_changes_no_order_and_loses_nothing() {
    let (_folder, path) = folder();
    let all = by_a_bad_clock();
    let mut store = Store::open(&path).expect("made");
    for (number, attempt) in all.iter().enumerate() {
        store.keep(attempt).expect("kept");
        // Between any two, the program may have been closed.
        if number % 2 == 1 {
            store = Store::open(&path).expect("opened again");
        }
    }
    assert_eq!(store.attempts(&Query::default()).expect("rows"), all);
    let hers: Vec<Attempt> = all.iter().filter(|a| a.trainee == "Grace").cloned().collect();
    assert_eq!(store.attempts(&of("Grace")).expect("rows"), hers);
    // An import is placed by its date, among the old ones, and later attempts are still the newest.
    let old = attempt("Ada", "pinch", "2026-11-20T08:00:00Z");
    let late = attempt("Ada", "pinch", "2027-01-01T00:00:00Z");
    assert_eq!((store.add(&old), store.add(&late), store.add(&old)), (Ok(true), Ok(true), Ok(false)));
    let next = Attempt { score: Some(99.0), ..attempt("Ada", "pinch", "2026-11-22T19:06:00Z") };
    store.keep(&next).expect("kept");
    let meant: Vec<Attempt> = [old].into_iter().chain(all.clone()).chain([next, late]).collect();
    assert_eq!(store.attempts(&Query::default()).expect("rows"), meant);
    // In another history all of it is imported, by the date, and nothing twice.
    let (_other, path) = folder();
    let mut other = Store::open(&path).expect("made");
    assert!(meant.iter().all(|attempt| other.add(attempt) == Ok(true)), "two of one moment are two");
    assert!(meant.iter().all(|attempt| other.add(attempt) == Ok(false)));
    let dates: Vec<Timestamp> = other.attempts(&Query::default()).expect("rows").iter().map(|a| a.began).collect();
    assert!(dates.len() == meant.len() && dates.is_sorted(), "{dates:?}");
}

#[test]
fn what_waits_is_taken_in_in_the_order_in_which_it_was_made() {
    let (_folder, path) = folder();
    let all = by_a_bad_clock();
    for attempt in &all {
        aside::keep(&path, attempt).expect("kept beside");
    }
    let mut store = Store::open(&path).expect("made");
    assert_eq!(aside::take_in(&path, &mut store), (all.len(), Vec::new(), Ok(())));
    assert_eq!(store.attempts(&Query::default()).expect("rows"), all);
    // A file that could not be removed is recognized at the next start.
    aside::keep(&path, &all[3]).expect("kept beside");
    assert_eq!(aside::take_in(&path, &mut store), (1, Vec::new(), Ok(())));
    assert_eq!(store.attempts(&Query::default()).expect("rows").len(), all.len());
}

#[test]
fn a_newer_file_is_refused_and_left_as_it_is() {
    let (_folder, path) = folder();
    drop(Store::open(&path).expect("made"));
    Connection::open(&path).expect("opened").pragma_update(None, "user_version", 999).expect("written");
    let refused = Store::open(&path).expect_err("it is newer");
    assert!(refused.contains("newer touchstone") && refused.contains("999"), "{refused}");
    let still: i64 = Connection::open(&path)
        .expect("opened")
        .query_row("PRAGMA user_version", [], |row| row.get(0))
        .expect("a version");
    assert_eq!(still, 999);
}

#[test]
fn a_damaged_table_of_several_lines_is_told_in_one_sentence() {
    let (_folder, path) = folder();
    drop(Store::open(&path).expect("made"));
    let file = Connection::open(&path).expect("opened");
    file.execute_batch(
        "PRAGMA writable_schema = ON;
        UPDATE sqlite_schema SET sql = replace(sql, 'created TEXT', 'created [TEXT') WHERE name = 'trainees';",
    )
    .expect("written");
    drop(file);
    let refused =
        Store::open(&path).err().or_else(|| Store::open(&path).ok()?.trainees().err()).expect("it is damaged");
    assert!(refused.contains("trainees") && !refused.contains('\n'), "{refused:?}");
}

/// History, and a channel that signals each answer of the thread.
fn started(path: &Path) -> (History, Receiver<()>) {
    let (woken, wakes) = channel();
    let history = History::start(path.to_path_buf(), move || {
        let _ = woken.send(());
    })
    .expect("a thread");
    (history, wakes)
}

/// Answers up to the first one wanted.
fn until(history: &History, wakes: &Receiver<()>, wanted: impl Fn(&Answer) -> bool) -> Vec<Answer> {
    let mut all = Vec::new();
    while !all.iter().any(&wanted) {
        wakes.recv_timeout(Duration::from_mins(1)).expect("it answers");
        all.extend(history.poll());
    }
    all
}

#[test]
fn an_attempt_that_a_broken_file_refuses_waits_beside_it_and_is_taken_in_later() {
    let (_folder, path) = folder();
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
    std::fs::write(&path, "This is no database, and long enough to be looked at as one. ".repeat(40)).expect("written");
    let done = attempt("Ada", "pinch", "2026-11-22T19:00:00Z");
    let (history, wakes) = started(&path);
    history.add(done.clone());
    let answers = until(&history, &wakes, |a| matches!(a, Answer::Kept(_)));
    let problems: Vec<&String> =
        answers.iter().filter_map(|a| if let Answer::Problem(p) = a { Some(p) } else { None }).collect();
    assert!(problems.iter().any(|p| p.contains("no database")), "{problems:?}");
    assert!(problems.iter().all(|p| p.ends_with('.')), "{problems:?}");
    drop(history);
    assert!(std::fs::read_to_string(&path).expect("still there").starts_with("This is no"), "nobody overwrote it");
    std::fs::remove_file(&path).expect("moved away");
    let (history, wakes) = started(&path);
    history.read(Query::default());
    let answers = until(&history, &wakes, |a| matches!(a, Answer::Attempts(..)));
    assert_eq!(answers, [Answer::TakenIn(1), Answer::Attempts(Query::default(), vec![done.clone()])]);
    drop(history);
    // It no longer waits.
    let mut store = Store::open(&path).expect("opened");
    assert_eq!(aside::take_in(&path, &mut store), (0, Vec::new(), Ok(())));
}

#[test]
fn an_attempt_that_a_held_file_refuses_waits_beside_it_and_is_taken_in_later() {
    let (_folder, path) = folder();
    drop(Store::open(&path).expect("made"));
    let holder = Connection::open(&path).expect("opened");
    holder.execute_batch("BEGIN IMMEDIATE").expect("held");
    let done = attempt("Ada", "pinch", "2026-11-22T19:00:00Z");
    let (history, wakes) = started(&path);
    history.add(done.clone());
    let answers = until(&history, &wakes, |a| matches!(a, Answer::Kept(_)));
    let held = |a: &Answer| matches!(a, Answer::Problem(p) if p.contains("another program holds it") && p.contains("taken in"));
    assert!(answers.iter().any(held), "{answers:?}");
    holder.execute_batch("COMMIT").expect("let go");
    history.read(Query::default());
    let answers = until(&history, &wakes, |a| matches!(a, Answer::Attempts(..)));
    assert!(answers.contains(&Answer::Attempts(Query::default(), vec![done])), "{answers:?}");
}

#[test]
fn what_waits_and_cannot_be_read_stays_and_keeps_nobody_else_waiting() {
    let (_folder, path) = folder();
    let kept = [
        attempt("Ada", "pinch", "2026-11-22T19:00:00Z"),
        attempt("Grace", "pinch", "2026-11-22T19:00:00Z"),
        attempt("Ada", "stack", "2026-11-22T19:00:05Z"),
    ];
    let files: Vec<PathBuf> = kept.iter().map(|a| aside::keep(&path, a).expect("kept")).collect();
    assert_ne!(files[0], files[1], "two of one moment are two files");
    std::fs::write(&files[0], "{ half").expect("damaged");
    let mut store = Store::open(&path).expect("made");
    let (taken, problems, all) = aside::take_in(&path, &mut store);
    assert_eq!(all, Ok(()), "nothing was refused");
    assert!(taken == 2 && problems.len() == 1 && problems[0].contains("cannot be read"), "{taken} {problems:?}");
    assert!(files[0].exists() && !files[1].exists() && !files[2].exists());
    assert_eq!(store.attempts(&Query::default()).expect("rows"), kept[1..]);
}

#[test]
fn what_was_asked_for_is_done_before_the_thread_ends_and_a_table_has_every_measure() {
    let (folder, path) = folder();
    let table = folder.path().join("table.csv");
    let (history, _wakes) = started(&path);
    let first = attempt("Ada, countess", "pinch", "2026-11-22T19:00:00Z");
    history.add(first.clone());
    history.add(Attempt {
        measures: json!({ "drops": 2 }),
        score: None,
        ..attempt("Grace", "pinch", "2026-11-22T19:00:01Z")
    });
    history.export(table.clone(), Query::default());
    drop(history);
    let text = std::fs::read_to_string(&table).expect("written");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let names = reader.headers().expect("names").clone();
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("a row")).collect();
    let cell = |row: usize, name: &str| {
        let place = names.iter().position(|own| own == name).unwrap_or_else(|| panic!("{name} in {names:?}"));
        rows[row].get(place).expect("a cell").to_owned()
    };
    assert_eq!((rows.len(), cell(0, "trainee").as_str()), (2, "Ada, countess"));
    assert_eq!(cell(0, "hand.path_m").parse::<f64>().expect("a number"), 0.1 + 0.2);
    assert_eq!((cell(0, "delay_ms"), cell(0, "predicted")), ("150".to_owned(), "true".to_owned()));
    assert_eq!((cell(1, "score"), cell(1, "drops"), cell(0, "drops")), (String::new(), "2".to_owned(), String::new()));
    assert_eq!(table::csv(&[]).expect("only names").lines().count(), 1);
}
