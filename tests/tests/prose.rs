//! Lengths and references of the pages that developers read first: ARCHITECTURE.md, `CODE_STYLE.md`, README.md; and
//! sentences of `docs/*.md`.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use tests::workspace;

/// Most words of a page, code blocks included.
const MOST_WORDS: [(&str, usize); 2] = [("ARCHITECTURE.md", 1200), ("CODE_STYLE.md", 800)];
/// Largest mean length of a sentence, words.
const MEAN_SENTENCE: f64 = 17.0;
/// Most words of a single sentence.
const LONGEST_SENTENCE: usize = 30;
/// Largest share of longer sentences in `docs/*.md`.
const MOST_LONG: f64 = 0.03;
/// Fewer words are a heading or a label, not a sentence.
const SHORTEST_SENTENCE: usize = 3;
/// Pages whose paths must exist.
const PAGES_WITH_PATHS: [&str; 3] = ["ARCHITECTURE.md", "CODE_STYLE.md", "README.md"];
/// Invariants of ARCHITECTURE.md, each with at least one test.
const INVARIANTS: usize = 10;

fn page(name: &str) -> String {
    std::fs::read_to_string(workspace().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// The page without its fenced blocks, and those blocks with the word after their fence.
fn fences(page: &str) -> (String, Vec<(String, Vec<&str>)>) {
    let (mut text, mut blocks, mut is_open) = (String::new(), Vec::<(String, Vec<&str>)>::new(), false);
    for line in page.lines() {
        if let Some(language) = line.trim().strip_prefix("```") {
            is_open = !is_open;
            if is_open {
                blocks.push((language.to_owned(), Vec::new()));
            }
        } else if let Some((_, lines)) = blocks.last_mut().filter(|_| is_open) {
            lines.push(line);
        } else {
            text.push_str(line);
            text.push('\n');
        }
    }
    (text, blocks)
}

/// Markdown links as (text, target), with the rest of the page between them as (text, "").
fn links(text: &str) -> Vec<(&str, &str)> {
    let (mut parts, mut rest) = (Vec::new(), text);
    while let Some(middle) = rest.find("](") {
        let open = rest[..middle].rfind('[');
        let close = rest[middle..].find(')').map(|at| middle + at);
        let (Some(open), Some(close)) = (open, close) else { break };
        parts.push((&rest[..open], ""));
        parts.push((&rest[open + 1..middle], &rest[middle + 2..close]));
        rest = &rest[close + 1..];
    }
    parts.push((rest, ""));
    parts
}

/// Code spans of a text without fenced blocks.
fn code_spans(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// A list item's text without its marker; `None` for other lines.
fn list_item(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let numbered = line.trim_start_matches(|c: char| c.is_ascii_digit());
    if numbered.len() < line.len() {
        return numbered.strip_prefix(". ");
    }
    line.strip_prefix("- ").or_else(|| line.strip_prefix("* "))
}

/// Sentences of the running text: no code blocks, tables, headings, or pictures; a code span counts as one word.
fn sentences(page: &str) -> Vec<String> {
    let (text, _) = fences(page);
    let text: String = links(&text).into_iter().map(|(text, _)| text).collect();
    let text: Vec<&str> = text.split('`').enumerate().map(|(i, part)| if i % 2 == 0 { part } else { "code" }).collect();
    let text = text.concat();
    let mut paragraphs = vec![Vec::<&str>::new()];
    for line in text.lines().filter(|line| !line.trim_start().starts_with(['|', '#', '!'])) {
        let item = list_item(line);
        if item.is_some() || line.trim().is_empty() {
            paragraphs.push(Vec::new());
        }
        let words = item.unwrap_or(line).split_whitespace();
        paragraphs.last_mut().expect("one paragraph at least").extend(words);
    }
    let begins = |word: &str| word.starts_with(|c: char| c.is_ascii_uppercase() || "*([".contains(c));
    let mut found = Vec::new();
    for paragraph in paragraphs {
        for sentence in paragraph.chunk_by(|word, next| !(word.ends_with(['.', '!', '?']) && begins(next))) {
            found.push(sentence.join(" "));
        }
    }
    found.retain(|sentence| words(sentence) >= SHORTEST_SENTENCE);
    found
}

/// Number of words: runs of letters, digits, and the marks that belong to them.
fn words(sentence: &str) -> usize {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "µ%’'-.".contains(c);
    sentence.split(|c| !is_part(c)).filter(|word| !word.is_empty()).count()
}

/// Rust sources of the workspace.
fn sources() -> Vec<String> {
    let mut folders: Vec<PathBuf> =
        ["haptics", "estimator", "render", "app", "tests"].iter().map(|folder| workspace().join(folder)).collect();
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.push(std::fs::read_to_string(path).expect("a source"));
            }
        }
    }
    found
}

/// Names of all tests of the workspace.
fn tests_of(sources: &[String]) -> BTreeSet<&str> {
    let mut names = BTreeSet::new();
    for source in sources {
        let mut is_test = false;
        for line in source.lines().map(str::trim) {
            if line == "#[test]" {
                is_test = true;
            } else if let Some(rest) = line.strip_prefix("fn ").filter(|_| is_test) {
                names.insert(rest.split('(').next().unwrap_or_default());
                is_test = false;
            }
        }
    }
    names
}

#[test]
fn pages_are_short() {
    for (name, most) in MOST_WORDS {
        let words = page(name).split_whitespace().count();
        assert!(words <= most, "{name} has {words} words, more than {most}");
    }
}

#[test]
fn sentences_are_short() {
    for (name, _) in MOST_WORDS {
        let sentences = sentences(&page(name));
        let lengths: Vec<usize> = sentences.iter().map(|sentence| words(sentence)).collect();
        let mean = lengths.iter().sum::<usize>() as f64 / lengths.len() as f64;
        assert!(lengths.len() > 20, "{name} has {} sentences", lengths.len());
        assert!(mean <= MEAN_SENTENCE, "{name}: a sentence has {mean:.1} words on average, more than {MEAN_SENTENCE}");
        let long = sentences.iter().zip(lengths).find(|(_, length)| *length > LONGEST_SENTENCE);
        assert!(long.is_none(), "{name}: a sentence has more than {LONGEST_SENTENCE} words: {long:?}");
    }
}

#[test]
fn sentences_of_the_documents_are_short() {
    let folder = std::fs::read_dir(workspace().join("docs")).expect("docs").flatten().map(|entry| entry.path());
    let pages = folder.filter(|path| path.extension().is_some_and(|e| e == "md"));
    let texts: Vec<String> = pages.map(|path| std::fs::read_to_string(path).expect("a page")).collect();
    let lengths: Vec<usize> = texts.iter().flat_map(|text| sentences(text)).map(|sentence| words(&sentence)).collect();
    let mean = lengths.iter().sum::<usize>() as f64 / lengths.len() as f64;
    let long = lengths.iter().filter(|length| **length > LONGEST_SENTENCE).count() as f64 / lengths.len() as f64;
    assert!(mean <= MEAN_SENTENCE, "docs/*.md: a sentence has {mean:.1} words on average, more than {MEAN_SENTENCE}");
    assert!(long <= MOST_LONG, "docs/*.md: a share of {long:.3} has more than {LONGEST_SENTENCE} words");
}

#[test]
fn every_invariant_names_a_test_that_exists() {
    let (text, _) = fences(&page("ARCHITECTURE.md"));
    let (sources, mut held) = (sources(), 0);
    let tests = tests_of(&sources);
    for line in text.lines() {
        let Some((_, holders)) = line.split_once("Held by ").or_else(|| line.split_once(" held by ")) else { continue };
        let names: Vec<&str> = code_spans(holders).into_iter().filter(|name| !name.contains('/')).collect();
        let absent: Vec<&&str> = names.iter().filter(|name| !tests.contains(**name)).collect();
        assert!(absent.is_empty(), "ARCHITECTURE.md names tests that do not exist: {absent:?}");
        assert!(!names.is_empty(), "ARCHITECTURE.md names no test: {line}");
        held += usize::from(list_item(line).is_some());
    }
    assert_eq!(held, INVARIANTS, "each invariant of ARCHITECTURE.md names its test after *Held by*");
}

#[test]
fn every_path_that_is_named_exists() {
    for name in PAGES_WITH_PATHS {
        let (text, _) = fences(&page(name));
        let targets = links(&text).into_iter().map(|(_, target)| target.split('#').next().unwrap_or_default());
        let targets = targets.filter(|target| !target.is_empty() && !target.contains("://"));
        let spans = code_spans(&text).into_iter().filter(|span| is_path(span));
        let named: Vec<&str> = targets.chain(spans).collect();
        assert!(named.len() > 5, "{name} names {} paths", named.len());
        let absent: Vec<&&str> = named.iter().filter(|path| !workspace().join(path).exists()).collect();
        assert!(absent.is_empty(), "{name} names paths that do not exist: {absent:?}");
    }
}

/// True for a code span that can only be a path of the repository: it has a slash, or the ending of a source or page.
fn is_path(span: &str) -> bool {
    let is_plain = span.chars().all(|c| c.is_ascii_alphanumeric() || "._-/".contains(c));
    let has_ending = Path::new(span).extension().is_some_and(|e| e == "rs" || e == "md" || e == "toml");
    is_plain && (span.contains('/') || has_ending)
}

#[test]
fn quoted_code_is_in_the_code() {
    let page = page("CODE_STYLE.md");
    let sources = sources();
    let lines: BTreeSet<&str> = sources.iter().flat_map(|source| source.lines()).map(str::trim).collect();
    let (_, blocks) = fences(&page);
    let quoted = blocks.iter().filter(|(language, _)| language == "rust").flat_map(|(_, lines)| lines);
    let absent: Vec<&&str> = quoted.filter(|line| !lines.contains(line.trim())).collect();
    assert!(absent.is_empty(), "CODE_STYLE.md quotes lines that are not in the code: {absent:?}");
}
