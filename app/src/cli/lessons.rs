//! `touchstone lessons`: what there is to learn, a lesson as it is written, what its experts need.

use super::Output;
use clap::Args;
use estimator::training::lesson::{Lesson, expert};
use serde_json::json;
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

impl Lessons {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let Some(name) = &self.lesson else { return Ok(list()) };
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
            std::fs::write(path, serde_json::to_string_pretty(&lesson)? + "\n")?;
        }
        Ok(one(&lesson)?)
    }
}

fn list() -> Output {
    let (all, problems) = crate::lessons::all(crate::lessons::own_folder().as_deref());
    let mut text = String::new();
    for lesson in &all {
        let _ = writeln!(text, "{:<16} {}", lesson.id, lesson.goal);
    }
    for problem in &problems {
        let _ = writeln!(text, "not read: {problem}");
    }
    let lessons: Vec<_> =
        all.iter().map(|l| json!({ "id": l.id, "title": l.title, "goal": l.goal, "place": l.place })).collect();
    Output { text, json: json!({ "lessons": lessons, "problems": problems }) }
}

fn one(lesson: &Lesson) -> serde_json::Result<Output> {
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
    let mut json = serde_json::to_value(lesson)?;
    json["text"] = json!(lesson.text);
    Ok(Output { text, json })
}
