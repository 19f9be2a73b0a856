//! Any bytes as a lesson, a task and a line of a history: what is read is whole.

use estimator::segment::definition::Definition;
use estimator::training::lesson::Lesson;

pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(lesson) = Lesson::from_json(text, "") {
        for variant in 0..lesson.variant_count() {
            lesson.world(variant).expect("a lesson that opens has its worlds");
        }
    }
    if let Ok(task) = Definition::parse(text, "task.json") {
        let again = serde_json::to_string(&task).expect("a task can be written");
        Definition::parse(&again, "again.json").expect("what was written is read");
    }
}
