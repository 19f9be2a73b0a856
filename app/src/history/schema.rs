//! The database schema, and the migration of older files.
//!
//! Each step is frozen once released: files of every version exist. A new version is a new step.

use rusqlite::Connection;

/// Migration steps in order; a file of version n has had the first n.
const STEPS: [&str; 3] = [
    // 1: trainees and their attempts.
    "CREATE TABLE trainees (
        id INTEGER PRIMARY KEY,
        name TEXT NOT NULL UNIQUE,
        created TEXT NOT NULL
    ) STRICT;
    CREATE TABLE attempts (
        id INTEGER PRIMARY KEY,
        trainee INTEGER NOT NULL REFERENCES trainees (id),
        lesson TEXT NOT NULL,
        conditions TEXT NOT NULL,
        began TEXT NOT NULL,
        duration_s REAL NOT NULL,
        completed INTEGER NOT NULL,
        score REAL,
        meets_criterion INTEGER NOT NULL,
        proficient INTEGER NOT NULL,
        measures TEXT NOT NULL,
        measures_version INTEGER NOT NULL,
        grade_version INTEGER NOT NULL,
        recording TEXT
    ) STRICT;",
    // 2: the same attempt is stored once, however often it is imported; and it is found by trainee and lesson.
    "DELETE FROM attempts WHERE id NOT IN (SELECT min(id) FROM attempts GROUP BY trainee, lesson, began);
    CREATE UNIQUE INDEX attempts_once ON attempts (trainee, lesson, began);",
    // 3: the order is independent of the clock (see the module `store`), and two attempts may start at the same moment.
    // Attempts made here and imported ones can no longer be distinguished: all are placed at their start, and later
    // ones come after them all.
    "ALTER TABLE attempts ADD COLUMN placed TEXT NOT NULL DEFAULT '';
    UPDATE attempts SET placed = began;
    ALTER TABLE attempts ADD COLUMN live INTEGER NOT NULL DEFAULT 0;
    UPDATE attempts SET live = 1 WHERE id = (SELECT id FROM attempts ORDER BY julianday(began) DESC, id DESC LIMIT 1);
    DROP INDEX attempts_once;
    CREATE INDEX attempts_of ON attempts (trainee, lesson, began);
    CREATE INDEX attempts_live ON attempts (id) WHERE live;",
];

/// Version of today's files.
pub const VERSION: u32 = STEPS.len() as u32;

/// Migrates a file to the current version, all or nothing. An error is a sentence.
pub fn migrate(connection: &mut Connection) -> Result<(), String> {
    let said = |error: rusqlite::Error| format!("its tables cannot be brought up to date ({error})");
    let version: u32 = connection.query_row("PRAGMA user_version", [], |row| row.get(0)).map_err(said)?;
    if version == VERSION {
        return Ok(());
    }
    if version > VERSION {
        return Err(format!(
            "it was written by a newer touchstone (version {version}; this one knows {VERSION}); update the program"
        ));
    }
    // Another process may be doing the same: the version is read once nobody else writes.
    let whole = connection.transaction_with_behavior(rusqlite::TransactionBehavior::Immediate).map_err(said)?;
    let version: u32 = whole.query_row("PRAGMA user_version", [], |row| row.get(0)).map_err(said)?;
    for step in STEPS.iter().skip(version as usize) {
        whole.execute_batch(step).map_err(said)?;
    }
    whole.pragma_update(None, "user_version", VERSION).map_err(said)?;
    whole.commit().map_err(said)
}
