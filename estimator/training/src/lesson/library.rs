//! The lessons that the program brings along, and those in a folder of the user's.

use super::format::Lesson;
use foundation::estimate::EstimateError;
use std::path::Path;

macro_rules! built_in {
    ($($name:literal),* $(,)?) => {
        [$((
            include_str!(concat!("../../../../assets/lessons/", $name, ".json")),
            include_str!(concat!("../../../../assets/lessons/", $name, ".md")),
        )),*]
    };
}

/// JSON and text of every built-in lesson.
const BUILT_IN: [(&str, &str); 11] = built_in![
    "first-touch",
    "pinch",
    "lift-and-hold",
    "stack-two",
    "stack-three",
    "restack",
    "crank-even",
    "crank-bind",
    "needle",
    "barrel",
    "switch",
];

/// The built-in lessons, in their order.
///
/// # Errors
/// Never for a program whose tests passed.
pub fn built_in() -> Result<Vec<Lesson>, EstimateError> {
    let lessons: Result<Vec<Lesson>, EstimateError> =
        BUILT_IN.iter().map(|(json, text)| Lesson::from_json(json, text)).collect();
    lessons.map(in_order)
}

/// The lessons of a folder, and the faults of the files that are none. A folder that is not there has none.
pub fn of_folder(folder: &Path) -> (Vec<Lesson>, Vec<String>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return (Vec::new(), Vec::new()) };
    let mut paths: Vec<_> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json")) && path.is_file())
        .collect();
    paths.sort();
    let (mut lessons, mut problems) = (Vec::new(), Vec::new());
    for path in paths {
        match Lesson::load(&path) {
            Ok(lesson) => lessons.push(lesson),
            Err(error) => problems.push(error.to_string()),
        }
    }
    (in_order(lessons), problems)
}

/// By their places, then by their titles.
pub fn in_order(mut lessons: Vec<Lesson>) -> Vec<Lesson> {
    lessons.sort_by(|a, b| a.place.cmp(&b.place).then_with(|| a.title.cmp(&b.title)));
    lessons
}
