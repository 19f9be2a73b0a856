//! What the guide says that a command prints is what it prints.
//!
//! In `docs/guide` a fenced block `console` holds commands after `$ ` and under each what it prints. Every page runs in a folder of its own, from top to
//! bottom, with the recordings and worlds of `assets` in it. A line with nothing but `…` stands for any lines, `…` within a line for any characters: numbers
//! that another machine may give otherwise. `TOUCHSTONE_WRITE_GUIDE=1 cargo test -p tests --test guide` writes anew what no longer agrees.

use std::path::{Path, PathBuf};
use std::process::Command;
use tests::{touchstone, workspace};

/// Stands for what may differ.
const ANY: char = '…';

fn pages() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(workspace().join("docs/guide")).expect("the guide");
    let mut pages: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    pages.retain(|path| path.extension().is_some_and(|e| e == "md"));
    pages.sort();
    pages
}

/// A folder with what the commands of a page read.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for from in ["recordings", "worlds"] {
        for file in std::fs::read_dir(workspace().join("assets").join(from)).expect("assets").flatten() {
            std::fs::copy(file.path(), folder.path().join(file.file_name())).expect("copied");
        }
    }
    folder
}

/// What a command says, on both of its outputs, without trailing blanks and without how far it got: that shows only where it takes over a second.
fn said(command: &str, folder: &Path) -> String {
    let words: Vec<&str> = command.split_whitespace().collect();
    let [program, arguments @ ..] = &words[..] else { panic!("an empty command") };
    assert_eq!(*program, "touchstone", "only our own commands are run: {command}");
    let output = Command::new(touchstone()).args(arguments).current_dir(folder).output().expect("the program starts");
    let [text, aside] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    let aside = aside.lines().filter(|line| !line.starts_with("… "));
    text.lines().chain(aside).map(str::trim_end).collect::<Vec<_>>().join("\n")
}

/// Whether a line is what the guide says, with whatever for `…`.
fn line_is(wanted: &str, found: &str) -> bool {
    let mut parts = wanted.split(ANY);
    let first = parts.next().unwrap_or_default();
    let Some(mut rest) = found.strip_prefix(first) else { return false };
    let parts: Vec<&str> = parts.collect();
    let Some((last, middle)) = parts.split_last() else { return rest.is_empty() };
    for part in middle {
        let Some(at) = rest.find(part) else { return false };
        rest = &rest[at + part.len()..];
    }
    rest.ends_with(last)
}

/// The same of several lines.
fn agrees(wanted: &[&str], found: &[&str]) -> bool {
    match wanted.split_first() {
        None => found.is_empty(),
        Some((first, rest)) if first.trim() == ANY.to_string() => {
            (0..=found.len()).any(|skip| agrees(rest, &found[skip..]))
        }
        Some((first, rest)) => {
            found.split_first().is_some_and(|(line, others)| line_is(first, line) && agrees(rest, others))
        }
    }
}

/// The page as it should be, and how many commands it has.
fn rewritten(page: &str, folder: &Path) -> (String, usize) {
    let (mut text, mut commands) = (String::new(), 0);
    let mut lines = page.lines().peekable();
    while let Some(line) = lines.next() {
        text += line;
        text.push('\n');
        if line.trim() != "```console" {
            continue;
        }
        while let Some(line) = lines.next_if(|line| line.trim() != "```") {
            let command = line.strip_prefix("$ ").unwrap_or_else(|| panic!("no command: {line}"));
            text += line;
            text.push('\n');
            let mut wanted = Vec::new();
            while let Some(line) = lines.next_if(|line| line.trim() != "```" && !line.starts_with("$ ")) {
                wanted.push(line);
            }
            let found = said(command, folder);
            let found: Vec<&str> = found.lines().collect();
            let kept = if agrees(&wanted, &found) { &wanted } else { &found };
            for line in kept {
                text += line;
                text.push('\n');
            }
            commands += 1;
        }
    }
    (text, commands)
}

#[test]
fn every_commands_output_in_the_guide_is_what_it_prints() {
    let mut all = 0;
    for path in pages() {
        let page = std::fs::read_to_string(&path).expect("a page");
        let folder = folder();
        let (text, commands) = rewritten(&page, folder.path());
        all += commands;
        if std::env::var_os("TOUCHSTONE_WRITE_GUIDE").is_some() {
            std::fs::write(&path, &text).expect("docs can be written");
            continue;
        }
        let differs = page.lines().zip(text.lines()).find(|(stands, is)| stands != is);
        assert!(
            page == text,
            "{}: write it anew, see the head of this test; the first line that differs: {differs:?}",
            path.display()
        );
    }
    assert!(all > 8, "the guide has {all} commands");
}

#[test]
fn every_page_and_every_file_that_the_guide_names_is_there() {
    for path in pages() {
        let page = std::fs::read_to_string(&path).expect("a page");
        for link in page.split("](").skip(1).filter_map(|after| after.split(')').next()) {
            let file = link.split('#').next().unwrap_or_default();
            if file.is_empty() || file.contains("://") {
                continue;
            }
            assert!(path.parent().expect("a folder").join(file).exists(), "{}: {link}", path.display());
        }
    }
}

/// Files of the causes' laws, and the names of their types.
macro_rules! causes {
    (causes { $($file:ident: $law:ident,)* } models { $($model_file:ident: $model:ident,)* }) => {
        [$((stringify!($file), stringify!($law))),*]
    };
}

/// Share of the laws from which on a file that names so many is a list of them. A new law would need a line there.
///
/// Choice: the list names all, the next file two thirds.
const IS_A_LIST: f64 = 0.75;

#[test]
fn a_new_law_is_two_files_and_a_line_in_one_list() {
    let laws = haptics::laws!(causes);
    for (file, _) in laws {
        for folder in ["haptics/src/law", "estimator/src/diagnose/hypotheses"] {
            assert!(workspace().join(folder).join(file).with_extension("rs").is_file(), "{folder}/{file}.rs");
        }
    }
    let mut folders: Vec<PathBuf> =
        ["haptics", "estimator", "render", "app", "tests"].map(|folder| workspace().join(folder)).to_vec();
    let mut lists = Vec::new();
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.path()) {
            // The blind battery writes every law a second time, on purpose.
            if path.is_dir() && !path.ends_with("tests/blind") {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = std::fs::read_to_string(&path).expect("a source");
                let is_named = |(file, law): &&(&str, &str)| {
                    text.contains(file) || text.contains(law) || text.contains(&file.replace('_', "-"))
                };
                let share = laws.iter().filter(is_named).count() as f64 / laws.len() as f64;
                lists.extend((share > IS_A_LIST).then_some(path));
            }
        }
    }
    lists.sort();
    // The first says which causes are tried first: a new law is not among them.
    let known =
        ["estimator/src/diagnose/hypotheses/all.rs", "haptics/src/law/list.rs"].map(|file| workspace().join(file));
    assert_eq!(lists, known, "a new law would need a line in each");
}

#[test]
fn an_ellipsis_stands_for_what_differs_and_nothing_else_does() {
    assert!(line_is("took … ms", "took 12 ms") && line_is("a…b…c", "a1b2c") && line_is("same", "same"));
    assert!(!line_is("took … ms", "took 12 s") && !line_is("same", "same.") && !line_is("a…b", "b"));
    assert!(agrees(&["a", "…", "d"], &["a", "b", "c", "d"]) && agrees(&["…"], &[]));
    assert!(!agrees(&["a"], &["a", "b"]) && !agrees(&["a", "…", "d"], &["a", "b"]));
}
