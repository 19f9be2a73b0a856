//! The database: everything that it confirms has reached the disk.
//!
//! **The order of attempts.** A clock can be set back between two attempts, or be on a wrong day for a while. Every
//! attempt therefore has a place, which is a time stamp assigned on insertion. Attempts are ordered by place and, at
//! the same place, by insertion:
//! - one stored as it is made ([`Store::keep`]) is placed at its start, but never before one that was stored earlier in
//!   this database;
//! - one that is imported ([`Store::add`]) is placed at its start: an older one goes among the old ones, and does not
//!   affect later ones.
//!
//! `began` is always the reading of the clock. An attempt dated by a clock set *forward* by mistake stays there, and
//! later ones come behind it; only imports can then be on the wrong side.
//!
//! **Duplicates.** Two attempts may start at the same moment, by a clock that was set back. An imported one is a
//! duplicate if the database has one of the same trainee, lesson, conditions, start, duration, completion and score.
//! One stored as it is made is never a duplicate.

use super::schema;
use crate::history::attempt::{Attempt, Conditions};
use jiff::Timestamp;
use rusqlite::{Connection, OptionalExtension as _, Row, Transaction, TransactionBehavior, params};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Time to wait for another process that locks the file.
const PATIENCE: Duration = Duration::from_secs(5);

/// Filter of attempts; `None` stands for all.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Query {
    /// Name of the trainee.
    pub trainee: Option<String>,
    /// Id of the lesson.
    pub lesson: Option<String>,
}

/// Open database. Errors are sentences.
#[derive(Debug)]
pub struct Store {
    connection: Connection,
    path: PathBuf,
    /// True once everything in it was read.
    is_readable: bool,
}

impl Store {
    /// Opens the file, or creates it.
    pub fn open(path: &Path) -> Result<Self, String> {
        // A damaged schema is quoted as it is, with line breaks.
        let refused = |why: &str| {
            format!("The history cannot be opened: {}. File: {}.", haptics::text_file::one_line(why), path.display())
        };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|error| refused(&error.to_string()))?;
        }
        let mut connection = Connection::open(path).map_err(|error| refused(&error.to_string()))?;
        set_up(&mut connection).map_err(|why| refused(&why))?;
        Ok(Self { connection, path: path.to_path_buf(), is_readable: false })
    }

    fn said(&self, error: &rusqlite::Error) -> String {
        let busy = error.sqlite_error_code() == Some(rusqlite::ErrorCode::DatabaseBusy);
        let why =
            if busy { "another program holds it".to_owned() } else { haptics::text_file::one_line(&error.to_string()) };
        format!("The history could not be written or read: {why}. File: {}.", self.path.display())
    }

    /// Adds a trainee; one of that name stays as it is.
    pub fn add_trainee(&mut self, name: &str, created: Timestamp) -> Result<(), String> {
        let name = name.trim();
        if name.is_empty() {
            return Err("A trainee needs a name.".to_owned());
        }
        let made = self.connection.execute(
            "INSERT INTO trainees (name, created) VALUES (?1, ?2) ON CONFLICT (name) DO NOTHING",
            params![name, created.to_string()],
        );
        made.map(|_| ()).map_err(|error| self.said(&error))
    }

    /// Names of all trainees, in alphabetical order.
    pub fn trainees(&self) -> Result<Vec<String>, String> {
        let names = || -> rusqlite::Result<Vec<String>> {
            let mut asked = self.connection.prepare("SELECT name FROM trainees ORDER BY name COLLATE NOCASE")?;
            asked.query_map([], |row| row.get(0))?.collect()
        };
        names().map_err(|error| self.said(&error))
    }

    /// Stores an attempt that was made just now: after everything stored before it, whatever the clock says.
    pub fn keep(&mut self, attempt: &Attempt) -> Result<(), String> {
        self.insert(attempt, true, false).map(drop)
    }

    /// Stores an attempt that was made just now and waited beside the database; false if it is a duplicate.
    pub(super) fn keep_waiting(&mut self, attempt: &Attempt) -> Result<bool, String> {
        self.insert(attempt, true, true)
    }

    /// Imports an attempt of another history, at its date. A duplicate is skipped: false then.
    pub fn add(&mut self, attempt: &Attempt) -> Result<bool, String> {
        self.insert(attempt, false, true)
    }

    /// Inserts an attempt. `live`: made just now. `once`: skip a duplicate.
    fn insert(&mut self, attempt: &Attempt, live: bool, once: bool) -> Result<bool, String> {
        if !self.is_readable {
            // A damaged file may accept a row and never return it: then it must not accept any.
            self.attempts_and_problems(&Query::default())?;
            self.is_readable = true;
        }
        self.add_trainee(&attempt.trainee, attempt.began)?;
        let mut added = || -> rusqlite::Result<usize> {
            // Nobody else inserts one between the query of the last place and the new one.
            let whole = self.connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
            let placed = if live { place(&whole, attempt.began)? } else { attempt.began };
            // One that was just added; a damaged table may still lack it, which must not pass for a duplicate.
            let find = "SELECT id FROM trainees WHERE name = ?1";
            let trainee: i64 = whole.query_row(find, [attempt.trainee.trim()], |row| row.get(0))?;
            let rows = insert(&whole, (attempt, trainee), placed, live, once)?;
            if rows > 0 {
                // As it will be queried: it is stored under the trainee's name.
                let again = "SELECT 1 FROM attempts JOIN trainees ON trainees.id = attempts.trainee
                    WHERE attempts.id = last_insert_rowid() AND trainees.name = ?1";
                whole.query_row(again, [attempt.trainee.trim()], |_| Ok(()))?;
            }
            whole.commit()?;
            Ok(rows)
        };
        added().map(|rows| rows > 0).map_err(|error| self.said(&error))
    }

    /// Attempts in order, the oldest first. An unreadable one is skipped; [`Store::attempts_and_problems`] reports it.
    pub fn attempts(&self, query: &Query) -> Result<Vec<Attempt>, String> {
        self.attempts_and_problems(query).map(|(attempts, _)| attempts)
    }

    /// Attempts, the oldest first, and a sentence if a damaged one had to be skipped.
    pub fn attempts_and_problems(&self, query: &Query) -> Result<(Vec<Attempt>, Option<String>), String> {
        let rows = || -> rusqlite::Result<(Vec<Placed>, Option<String>)> {
            let mut asked = self.connection.prepare(
                "SELECT trainees.name, lesson, conditions, began, duration_s, completed, score, meets_criterion, proficient, measures,
                    measures_version, grade_version, recording, placed, attempts.id
                 FROM attempts JOIN trainees ON trainees.id = attempts.trainee
                 WHERE (?1 IS NULL OR trainees.name = ?1) AND (?2 IS NULL OR lesson = ?2)",
            )?;
            let mut rows = asked.query(params![query.trainee, query.lesson])?;
            let (mut read, mut damaged) = (Vec::new(), Vec::new());
            while let Some(row) = rows.next()? {
                match placed(row) {
                    Ok(one) => read.push(one),
                    Err(error) => damaged.push(error),
                }
            }
            let problem = damaged.first().map(|first| {
                let (count, why) = (damaged.len(), haptics::text_file::one_line(&first.to_string()));
                let path = self.path.display();
                format!("Of the history {count} attempts are damaged and left out ({why}); a copy may have them whole. File: {path}.")
            });
            Ok((read, problem))
        };
        let (mut read, problem) = rows().map_err(|error| self.said(&error))?;
        // By the moment: as text, fractions of a second would come before whole ones.
        read.sort_by_key(|(placed, id, _)| (*placed, *id));
        Ok((read.into_iter().map(|(_, _, attempt)| attempt).collect(), problem))
    }
}

/// Place of an attempt, its row number, and the attempt.
type Placed = (Timestamp, i64, Attempt);

/// Place of an attempt that is stored now.
fn place(whole: &Transaction<'_>, began: Timestamp) -> rusqlite::Result<Timestamp> {
    let newest = "SELECT placed FROM attempts WHERE live ORDER BY id DESC LIMIT 1";
    let last = whole.query_row(newest, [], |row| Ok(row.get::<_, String>(0).ok())).optional()?.flatten();
    // A damaged place is ignored.
    let last: Option<Timestamp> = last.and_then(|text| text.parse().ok());
    Ok(last.map_or(began, |last| began.max(last)))
}

/// Number of inserted rows.
fn insert(
    whole: &Transaction<'_>,
    (attempt, trainee): (&Attempt, i64),
    placed: Timestamp,
    live: bool,
    once: bool,
) -> rusqlite::Result<usize> {
    let Attempt { lesson, began, duration_s, completed, score, meets_criterion, proficient, .. } = attempt;
    let conditions = serde_json::to_string(&attempt.conditions).unwrap_or_default();
    let recording = attempt.recording.as_ref().map(|path| path.display().to_string());
    whole.execute(
        "INSERT INTO attempts (trainee, lesson, conditions, began, duration_s, completed, score, meets_criterion, proficient, measures,
            measures_version, grade_version, recording, placed, live)
         SELECT ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15
         WHERE NOT (?16 AND EXISTS (
            SELECT 1 FROM attempts
            WHERE trainee = ?1 AND lesson = ?2 AND conditions = ?3 AND began = ?4 AND duration_s = ?5 AND completed = ?6
                AND score IS ?7))",
        params![
            trainee,
            lesson,
            conditions,
            began.to_string(),
            duration_s,
            completed,
            score,
            meets_criterion,
            proficient,
            attempt.measures.to_string(),
            attempt.measures_version,
            attempt.grade_version,
            recording,
            placed.to_string(),
            live,
            once,
        ],
    )
}

fn set_up(connection: &mut Connection) -> Result<(), String> {
    let said = |error: rusqlite::Error| match error.sqlite_error_code() {
        Some(rusqlite::ErrorCode::NotADatabase) => {
            "the file is no database, or is damaged; move it away, and a new one is made".to_owned()
        }
        Some(rusqlite::ErrorCode::DatabaseBusy) => "another program holds it".to_owned(),
        _ => error.to_string(),
    };
    connection.busy_timeout(PATIENCE).map_err(said)?;
    // Readers and one writer at a time; a commit is on the disk before it counts.
    let _mode: Option<String> =
        connection.query_row("PRAGMA journal_mode = WAL", [], |row| row.get(0)).optional().map_err(said)?;
    connection.pragma_update(None, "synchronous", "FULL").map_err(said)?;
    connection.pragma_update(None, "foreign_keys", true).map_err(said)?;
    schema::migrate(connection)
}

/// Row of [`Store::attempts`]. If its place is damaged, it is placed at its start.
fn placed(row: &Row<'_>) -> rusqlite::Result<Placed> {
    let attempt = attempt(row)?;
    let place = row.get::<_, String>(13).ok().and_then(|text| text.parse().ok());
    Ok((place.unwrap_or(attempt.began), row.get(14)?, attempt))
}

/// Attempt of a row.
fn attempt(row: &Row<'_>) -> rusqlite::Result<Attempt> {
    let text = |place: usize| row.get::<_, String>(place);
    let wrong = |place: usize, error: Box<dyn std::error::Error + Send + Sync>| {
        rusqlite::Error::FromSqlConversionFailure(place, rusqlite::types::Type::Text, error)
    };
    let conditions: Conditions = serde_json::from_str(&text(2)?).map_err(|e| wrong(2, e.into()))?;
    Ok(Attempt {
        trainee: text(0)?,
        lesson: text(1)?,
        conditions,
        began: text(3)?.parse().map_err(|e: jiff::Error| wrong(3, e.into()))?,
        duration_s: row.get(4)?,
        completed: row.get(5)?,
        score: row.get(6)?,
        meets_criterion: row.get(7)?,
        proficient: row.get(8)?,
        measures: serde_json::from_str(&text(9)?).map_err(|e| wrong(9, e.into()))?,
        measures_version: row.get(10)?,
        grade_version: row.get(11)?,
        recording: row.get::<_, Option<String>>(12)?.map(PathBuf::from),
    })
}
