//! Histories while everything else goes on: one that two programs use, one on a disk that spoils files and refuses them.

use super::Counts;
use crate::documents;
use app::history::attempt::Attempt;
use app::history::keeper::{Answer, History};
use app::history::store::{Query, Store};
use rand::SeedableRng as _;
use rand::rngs::StdRng;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::time::Duration;

/// Who practises at the workbench, and at the other program.
pub const HERE: &str = "Grace";
const THERE: &str = "Edsger";
/// What the other program keeps.
const MOST: u64 = 200;

/// An attempt of somebody with a number, by a clock that is set back now and then.
pub fn attempt(trainee: &str, number: u64) -> Attempt {
    Attempt { trainee: trainee.to_owned(), ..crate::child::by_a_bad_clock(number) }
}

/// Keeps attempts in the workbench's database.
pub fn of_another_program(database: &Path, over: &AtomicBool) -> Counts {
    let history = History::start(database.to_path_buf(), || {}).expect("a thread");
    for number in 0..MOST {
        history.add(attempt(THERE, number));
        if over.load(Ordering::Relaxed) {
            break;
        }
        // A pace, so that it goes on for as long as the rest; nothing is waited for.
        std::thread::sleep(Duration::from_millis(5));
    }
    drop(history);
    Counts::new()
}

/// Every attempt is there in its order, after what waited was taken in; how many.
pub fn must_be_whole(database: &Path, here: u64) -> u64 {
    drop(History::start(database.to_path_buf(), || {}).expect("a thread"));
    let store = Store::open(database).expect("opens");
    let of = |trainee: &str| {
        let query = Query { trainee: Some(trainee.to_owned()), lesson: None };
        let all = store.attempts(&query).expect("readable");
        for (number, kept) in all.iter().enumerate() {
            assert_eq!(*kept, attempt(trainee, number as u64), "attempt {number} of {trainee}");
        }
        all.len() as u64
    };
    assert_eq!(of(HERE), here, "all attempts that were made at the workbench");
    here + of(THERE)
}

/// Databases that are spoiled, and one whose place is taken by something else for a while.
pub fn on_a_bad_disk(folder: &Path, seed: u64, over: &AtomicBool) -> Counts {
    let (mut rng, mut counts) = (StdRng::seed_from_u64(seed), Counts::new());
    std::fs::create_dir_all(folder).expect("a folder");
    let path = folder.join("history.sqlite");
    let whole = documents::history(&path);
    let mut round = 0;
    while round == 0 || !over.load(Ordering::Relaxed) {
        documents::keep_in_a_spoiled_one(&path, &whole, &attempt(HERE, 1_000 + round), &mut rng);
        *counts.entry("together: spoiled histories").or_default() += 1;
        refused_for_a_while(&folder.join(format!("taken-{round}")), round);
        *counts.entry("together: histories that could not be opened").or_default() += 1;
        round += 1;
    }
    counts
}

/// Where the database should be there is a folder; then there is none. All attempts get there, in their order.
fn refused_for_a_while(folder: &Path, round: u64) {
    let path = folder.join("history.sqlite");
    std::fs::create_dir_all(&path).expect("a folder");
    let (told, telling) = std::sync::mpsc::channel();
    let history = History::start(path.clone(), move || {
        let _ = told.send(());
    })
    .expect("a thread");
    let numbers = 20 * round..20 * round + 20;
    for number in numbers.clone() {
        if number == numbers.start + 12 {
            // After the twelve attempts of before: an answer says that they were kept.
            wait_for(&history, &telling, 12);
            std::fs::remove_dir(&path).expect("empty");
        }
        history.add(attempt(HERE, number));
    }
    drop(history);
    let all = Store::open(&path).and_then(|store| store.attempts(&Query::default())).expect("it is a database now");
    let meant: Vec<Attempt> = numbers.map(|number| attempt(HERE, number)).collect();
    assert_eq!(all, meant);
}

fn wait_for(history: &History, telling: &Receiver<()>, mut kept: usize) {
    while kept > 0 {
        telling.recv_timeout(Duration::from_mins(1)).unwrap_or_else(|_| panic!("{kept} attempts are not kept"));
        for answer in history.poll() {
            match answer {
                Answer::Kept(_) => kept -= 1,
                Answer::Problem(problem) => assert!(!problem.contains(['\n', '\r']), "{problem:?}"),
                _ => {}
            }
        }
    }
}
