//! Any bytes as the database of a history, with an attempt that waits beside it: a history that is read and added to, or one sentence.
//! Seeds are databases that `touchstone history --import … --database …` made.

use app::history::attempt::Attempt;
use app::history::store::{Query, Store};

const LINE: &str = r#"{"trainee": "Ada", "lesson": "pinch", "began": "2026-11-22T10:00:00Z", "duration_s": 20.0, "completed": true,
    "score": 81.0, "meets_criterion": false, "proficient": false, "measures": {}, "measures_version": 1, "grade_version": 1}"#;

pub fn run(bytes: &[u8]) {
    let path = crate::targets::file("history.sqlite");
    // What the database before left beside it is not this one's.
    for left in ["history.sqlite-journal", "history.sqlite-wal", "history.sqlite-shm"] {
        let _ = std::fs::remove_file(path.with_file_name(left));
    }
    std::fs::write(&path, bytes).expect("the temporary folder is writable");
    if let Err(problem) = use_it(&path) {
        assert!(!problem.is_empty() && !problem.contains('\n'), "{problem:?}");
    }
}

fn use_it(path: &std::path::Path) -> Result<(), String> {
    let mut store = Store::open(path)?;
    let (_, problem) = store.attempts_and_problems(&Query::default())?;
    if let Some(problem) = problem {
        assert!(!problem.contains('\n'), "{problem:?}");
    }
    let attempt: Attempt = serde_json::from_str(LINE).expect("an attempt");
    store.add(&attempt)?;
    store.keep(&attempt)?;
    store.attempts(&Query::default())?;
    store.trainees().map(drop)
}
