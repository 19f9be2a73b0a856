//! `touchstone lessons`: the available lessons, the definition of a lesson, the results of its experts.

use super::Output;
use clap::Args;
use estimator::training::lesson::{Lesson, expert};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;

/// Arguments of `lessons`.
#[derive(Args)]
pub struct Lessons {
    /// A lesson to look at: its name, or a file that ends in .json; all of them when not given
    lesson: Option<String>,
    /// Let the scripted expert do the lesson and write what experts need into its file
    #[arg(long, requires = "lesson")]
    measure_expert: bool,
}

/// What `lessons --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// Every lesson, in its place.
    lessons: Vec<Entry>,
    /// What could not be read, in sentences.
    problems: Vec<String>,
}

/// A lesson in the list.
#[derive(JsonSchema, Serialize)]
struct Entry {
    /// Its name in files and in the history.
    id: String,
    /// Its name for people.
    title: String,
    /// What it is about, in one sentence.
    goal: String,
    /// Where it stands in the list; equal places go by title.
    place: u32,
}

/// What `lessons LESSON --json` prints: its file, and the text beside it.
#[derive(JsonSchema, Serialize)]
pub(crate) struct One {
    /// As its file says.
    #[serde(flatten)]
    lesson: Lesson,
    /// The text for people, Markdown.
    text: String,
}

impl Lessons {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let Some(name) = &self.lesson else { return list() };
        let mut lesson = crate::lessons::find(name)?;
        if self.measure_expert {
            let path = Path::new(name);
            anyhow::ensure!(
                path.is_file(),
                "only a file can be written into; copy the lesson `{name}` to a file that ends in .json and name that"
            );
            let measured = super::progress::during("watching the expert", |_| expert::measure(&lesson))?;
            lesson.expert = Some(measured);
            lesson.expert_over =
                super::progress::during("watching the expert over slow lines", |_| expert::over_lines(&lesson));
            haptics::text_file::write(path, serde_json::to_string_pretty(&lesson)? + "\n")?;
        }
        one(&lesson)
    }
}

fn list() -> anyhow::Result<Output> {
    let (all, problems) = crate::lessons::all(crate::lessons::own_folder().as_deref());
    let mut text = String::new();
    for lesson in &all {
        let _ = writeln!(text, "{:<16} {}", lesson.id, lesson.goal);
    }
    for problem in &problems {
        let _ = writeln!(text, "not read: {problem}");
    }
    let lessons = all.into_iter().map(|l| Entry { id: l.id, title: l.title, goal: l.goal, place: l.place }).collect();
    Ok(Output { text, json: serde_json::to_value(Said { lessons, problems })? })
}

fn one(lesson: &Lesson) -> anyhow::Result<Output> {
    let mut text = format!("{}\n\n{}\n\n", lesson.title, lesson.text);
    for goal in &lesson.goals {
        let _ = writeln!(text, "goal: {}", goal.says);
    }
    for rule in &lesson.rules {
        let _ = writeln!(text, "rule: {}", rule.says);
    }
    match &lesson.expert {
        Some(expert) => {
            for (measure, spread) in &expert.measures {
                let _ = writeln!(text, "experts: {measure} {:.4} ± {:.4}", spread.mean, spread.sd);
            }
        }
        None => text.push_str("Its experts were not measured yet: --measure-expert does that.\n"),
    }
    for over in &lesson.expert_over {
        let model = if over.predicted { "with a model" } else { "without a model" };
        let seconds = over.expert.measures.get("completed_s").map_or(f64::NAN, |s| s.mean);
        let _ = writeln!(text, "experts over {:.0} ms {model}: {seconds:.1} s", over.delay_ms);
    }
    let one = One { lesson: lesson.clone(), text: lesson.text.clone() };
    Ok(Output { text, json: serde_json::to_value(&one)? })
}
