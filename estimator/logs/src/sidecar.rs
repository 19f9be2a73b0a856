//! The sidecar `<stem>.meta.json`: reading, checking, writing.

use super::errors::LogError;
use super::facts;
use foundation::tasks::definition::SIDECAR_KEY;
use foundation::tasks::library;
use haptics::recording::{Meta, Recording, Task};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Path of the sidecar of a log.
pub fn path_for(log: &Path) -> PathBuf {
    log.with_extension("meta.json")
}

/// Reads the sidecar `given`, else the one beside `log`, else an empty one.
pub fn load(log: &Path, given: Option<&Path>) -> Result<Meta, LogError> {
    let path = given.map_or_else(|| path_for(log), Path::to_path_buf);
    let text = match haptics::text_file::read(&path) {
        Ok(text) => text,
        Err(error) if given.is_none() && error.kind() == std::io::ErrorKind::NotFound => return Ok(Meta::default()),
        Err(error) if error.kind() == std::io::ErrorKind::InvalidData => {
            return Err(LogError::Sidecar { why: "it is not text".to_owned(), path });
        }
        Err(error) => return Err(LogError::Io { reason: error.to_string(), path }),
    };
    parse(&text, &path)
}

/// Reads the text of a sidecar, which stands in `path`.
pub fn parse(text: &str, path: &Path) -> Result<Meta, LogError> {
    let malformed = |why: String| LogError::Sidecar { why, path: path.to_path_buf() };
    let mut value: Value =
        serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(|error| malformed(error.to_string()))?;
    own_task(&mut value, library::folder()).map_err(malformed)?;
    if let Some(why) = facts::wrong_type(&value) {
        return Err(malformed(why));
    }
    // A name without a column.
    if let Some(columns) = value.get_mut("columns").and_then(Value::as_object_mut) {
        columns.values_mut().filter(|source| source.is_null()).for_each(|source| *source = "".into());
    }
    let meta: Meta = serde_json::from_value(value).map_err(|error| malformed(error.to_string()))?;
    facts::complaint(&meta).map_or(Ok(meta), |why| Err(malformed(why)))
}

/// A task of the user's that a sidecar names is read from `folder` and goes along with the recording from then on.
fn own_task(value: &mut Value, folder: Option<&Path>) -> Result<(), String> {
    let Some(entries) = value.as_object_mut() else { return Ok(()) };
    let name = entries.get("task").and_then(Value::as_str).map(str::to_owned);
    if name.as_ref().is_some_and(|name| Task::from_name(name).is_some()) {
        return Ok(());
    }
    // A definition that travels with the recording comes first: the file may have changed since.
    let of = |definition: &Value, key: &str| definition.get(key).and_then(Value::as_str).map(str::to_owned);
    let carried = entries.get(SIDECAR_KEY).filter(|d| name.is_none() || of(d, "name") == name);
    if let Some(like) = carried.and_then(|definition| of(definition, "like")) {
        entries.insert("task".to_owned(), like.into());
        return Ok(());
    }
    let read = name.zip(folder).and_then(|(name, folder)| library::read(folder, &name));
    if let Some(task) = read.transpose().map_err(|error| error.to_string())? {
        entries.insert("task".to_owned(), task.like.name().into());
        entries.insert(SIDECAR_KEY.to_owned(), serde_json::to_value(&task).map_err(|error| error.to_string())?);
    }
    Ok(())
}

/// Writes the sidecar of `recording` beside `log` and returns its path.
///
/// A written table is in the program's names and SI units already: statements about the old file's columns are left
/// out, everything else is kept.
pub fn write(recording: &Recording, log: &Path) -> Result<PathBuf, LogError> {
    let path = path_for(log);
    write_as_is(&written_meta(recording), &path)?;
    Ok(path)
}

/// Writes a sidecar exactly as it is (the app's mapping dialog).
pub fn write_as_is(meta: &Meta, path: &Path) -> Result<(), LogError> {
    let failed = |reason: String| LogError::Write { reason, path: path.to_path_buf() };
    let text = serde_json::to_string_pretty(meta).map_err(|e| failed(e.to_string()))?;
    haptics::text_file::write(path, text + "\n").map_err(|e| failed(e.to_string()))
}

/// Facts of the sidecar without the old file's columns and the files joined to it: a written table is in the program's names
/// and SI units already.
pub(super) fn portable_meta(meta: &Meta) -> Meta {
    let mut meta = meta.clone();
    meta.columns.clear();
    meta.scale.clear();
    meta.sign.clear();
    meta.select.clear();
    (meta.from_s, meta.to_s) = (None, None);
    meta.windows.clear();
    meta.clocks.clear();
    meta.join.clear();
    meta
}

/// The sidecar of a written table: it has one clock, and the sidecar tells if there were several.
pub(super) fn written_meta(recording: &Recording) -> Meta {
    Meta { several_clocks: recording.has_several_clocks(), ..portable_meta(&recording.meta) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foundation::tasks::definition::Definition;

    #[test]
    fn a_sidecar_may_name_a_task_of_the_users() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut task = Definition::built_in(Task::BlockStack).expect("the built-in task");
        "my-lifts".clone_into(&mut task.name);
        library::save(folder.path(), &task).expect("saved");
        let named = |text: &str, folder: Option<&Path>| {
            let mut value: Value = serde_json::from_str(text).expect("JSON");
            own_task(&mut value, folder).map(|()| value)
        };
        let found = named(r#"{"task": "my-lifts"}"#, Some(folder.path())).expect("found");
        assert_eq!((&found["task"], &found[SIDECAR_KEY]["name"]), (&"block-stack".into(), &"my-lifts".into()));
        // It goes along: the file is not needed any more.
        let mut again = found.clone();
        again["task"] = "my-lifts".into();
        assert_eq!(named(&again.to_string(), None).expect("carried"), found);
        // An unknown name stays as it is and is refused by the next step; a broken file is reported at once.
        assert_eq!(named(r#"{"task": "juggling"}"#, Some(folder.path())).expect("unchanged")["task"], "juggling");
        std::fs::write(folder.path().join("broken.json"), "{").expect("written");
        let error = named(r#"{"task": "broken"}"#, Some(folder.path())).expect_err("no task");
        assert!(error.contains("broken.json"), "{error}");
    }

    fn read(text: &str) -> Result<Meta, LogError> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.meta.json");
        std::fs::write(&path, text).expect("writable");
        load(&folder.path().join("a.csv"), None)
    }

    #[test]
    fn a_malformed_sidecar_is_one_sentence_with_its_place() {
        let error = read("{\n  \"rate_hz\": 10,,\n}").expect_err("not JSON").to_string();
        assert!(error.contains("line 2 column") && error.ends_with("a.meta.json"), "{error}");
        assert!(read(r#"{"rate_hz": "fast"}"#).is_err());
        assert!(read(r#"{"rate_hz": -1}"#).expect_err("negative").to_string().contains("must be positive"));
        assert!(read(r#"{"sign": {"f_N": 2}}"#).is_err() && read(r#"{"scale": {"f_N": 0}}"#).is_err());
    }

    #[test]
    fn a_missing_sidecar_is_fine_unless_it_was_named() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let log = folder.path().join("a.csv");
        assert_eq!(load(&log, None).expect("optional"), Meta::default());
        assert!(load(&log, Some(&folder.path().join("b.json"))).is_err());
        assert!(load(&log, Some(folder.path())).is_err());
    }

    #[test]
    fn unknown_keys_and_a_byte_order_mark_survive() {
        let meta = read("\u{feff}{\"operator\": \"K\", \"known\": {\"mass_kg\": 0.1}}").expect("reads");
        assert_eq!(meta.other["operator"], "K");
        assert_eq!(meta.known["mass_kg"], 0.1);
    }
}
