//! Lines in the comments of constants that say which answers change with them.

use super::{Counts, Row};
use anyhow::Context;
use std::fs;
use std::path::Path;

/// Beginning of such a line.
const CHOICE: &str = "Choice:";
/// Beginnings of lines that make it superfluous.
const KNOWN: [&str; 2] = ["Source:", "Derived:"];

/// Writes how many answers change with a constant as the last line of its comment, for every constant that names no
/// source and no derivation. Returns the number of lines.
pub(super) fn annotate(workspace: &Path, rows: &[Row], factors: &[f64]) -> anyhow::Result<usize> {
    let mut files: Vec<&str> = rows.iter().map(|row| row.file.as_str()).collect();
    files.sort_unstable();
    files.dedup();
    let mut written = 0;
    for file in files {
        let path = workspace.join(file);
        // The file of an earlier run may be gone.
        if !path.exists() {
            continue;
        }
        let mut text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        for row in rows.iter().filter(|row| row.file == file) {
            if let Some(more) = annotated(&text, &row.name, &choice(&row.counts, factors)) {
                text = more;
                written += 1;
            }
        }
        fs::write(&path, text).with_context(|| path.display().to_string())?;
    }
    Ok(written)
}

/// The text with a line at the end of the comment of a constant, in place of an earlier one. `None` if the constant is
/// not declared here, or says where it comes from.
fn annotated(text: &str, name: &str, line: &str) -> Option<String> {
    let mut lines: Vec<&str> = text.lines().collect();
    let declares =
        |line: &str| line.split_once("const ").is_some_and(|(_, rest)| rest.starts_with(&format!("{name}:")));
    let at = lines.iter().position(|line| declares(line))?;
    let comment = |line: &str| line.trim_start().strip_prefix("///").map(|text| text.trim().to_owned());
    let first = lines[..at].iter().rposition(|line| comment(line).is_none()).map_or(0, |k| k + 1);
    let begins = |line: &str, with: &str| comment(line).is_some_and(|text| text.starts_with(with));
    if lines[first..at].iter().any(|line| KNOWN.iter().any(|known| begins(line, known))) {
        return None;
    }
    let end = lines[first..at].iter().position(|line| begins(line, CHOICE)).map_or(at, |k| first + k);
    let indent = &lines[at][..lines[at].len() - lines[at].trim_start().len()];
    let whole = format!("{indent}/// {CHOICE} {line}");
    lines.splice(end..at, [whole.as_str()]);
    Some(lines.join("\n") + "\n")
}

/// How many answers change, by factor.
fn choice(counts: &[Counts], factors: &[f64]) -> String {
    if counts.iter().all(|of| of.asked == 0) {
        return "no case of the ablation reads it.".to_owned();
    }
    if let [first, ..] = counts
        && counts.iter().all(|of| changed(of) == 0 && of.asked == first.asked)
    {
        let names: Vec<String> = factors.iter().map(|factor| name(*factor)).collect();
        return format!("{}, none of {} answers changes.", names.join(" or "), first.asked);
    }
    let parts: Vec<String> = factors.iter().zip(counts).map(|(factor, of)| part(*factor, of)).collect();
    format!("{}.", parts.join("; "))
}

fn name(factor: f64) -> String {
    match factor {
        0.5 => "halved".to_owned(),
        2.0 => "doubled".to_owned(),
        other => format!("times {other}"),
    }
}

/// Number of answers that change by more than digits.
fn changed(counts: &Counts) -> usize {
    counts.moved + counts.words + counts.worse + counts.better
}

fn part(factor: f64, counts: &Counts) -> String {
    let turns: Vec<String> = [(counts.worse, "wrong"), (counts.better, "right")]
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, how)| format!("{count} to {how}"))
        .collect();
    let turns = if turns.is_empty() { String::new() } else { format!(" ({})", turns.join(", ")) };
    format!("{}, {} of {} answers change{turns}", name(factor), changed(counts), counts.asked)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: Counts = Counts { asked: 41, digits: 9, moved: 1, words: 1, worse: 1, better: 0 };

    #[test]
    fn a_line_says_what_halving_and_doubling_change() {
        let none = Counts { asked: 41, ..Counts::default() };
        let line = "halved, 3 of 41 answers change (1 to wrong); doubled, 0 of 41 answers change.";
        assert_eq!(choice(&[ONE, none], &[0.5, 2.0]), line);
        assert_eq!(choice(&[none; 2], &[0.5, 2.0]), "halved or doubled, none of 41 answers changes.");
        assert_eq!(choice(&[Counts::default(); 2], &[0.5, 2.0]), "no case of the ablation reads it.");
    }

    #[test]
    fn the_line_replaces_an_earlier_one_at_the_end_of_the_comment() {
        let source =
            "fn f() {\n    /// Distance, m.\n    /// Choice: old,\n    /// and long.\n    const FAR: f64 = 2.0;\n}\n";
        let once = annotated(source, "FAR", "new.").expect("it is declared");
        assert_eq!(once, "fn f() {\n    /// Distance, m.\n    /// Choice: new.\n    const FAR: f64 = 2.0;\n}\n");
        assert_eq!(annotated(&once, "FAR", "new.").as_deref(), Some(once.as_str()), "again, nothing changes");
        assert_eq!(
            annotated("const FAR: f64 = 2.0;\n", "FAR", "new.").as_deref(),
            Some("/// Choice: new.\nconst FAR: f64 = 2.0;\n")
        );
    }

    #[test]
    fn a_constant_with_a_source_or_of_another_name_stays() {
        assert_eq!(annotated("/// Derived: 1/2.\nconst FAR: f64 = 0.5;\n", "FAR", "new."), None);
        assert_eq!(annotated("const FAR_AWAY: f64 = 0.5;\n", "FAR", "new."), None);
    }
}
