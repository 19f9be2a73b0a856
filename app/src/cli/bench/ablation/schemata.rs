//! Sources whose numeric constants can vary at run time.
//!
//! Every `const NAME: f64 = 0.5;` of a folder becomes `fn NAME() -> f64 { value(index, 0.5) }`, and every use of it a
//! call. The compiler says which constants must stay constants (lengths of arrays, patterns): these are left alone.

use anyhow::{Context, bail};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Folders below the workspace whose constants vary.
pub(super) const FOLDERS: [&str; 2] = ["estimator/src/diagnose", "estimator/estimation/src/identify"];
/// Numeric types of constants that can be multiplied.
const TYPES: [&str; 10] = ["Axis", "f64", "usize", "u64", "u32", "u16", "u8", "isize", "i64", "i32"];
/// Text in front of the unit tests of a file.
const TESTS: &str = "#[cfg(test)]\nmod tests {";

/// A constant that varies.
#[derive(Clone, Debug)]
pub(super) struct Constant {
    pub name: String,
    /// Its file, below the workspace.
    pub file: PathBuf,
    pub line: usize,
    /// Its value as written.
    pub value: String,
}

/// A token with its place in the file.
struct Token {
    text: String,
    at: Range<usize>,
    line: usize,
    is_ident: bool,
}

/// A file of the folders, cut into tokens.
struct Source {
    /// Path below the workspace.
    file: PathBuf,
    text: String,
    tokens: Vec<Token>,
}

/// The sources of all folders of a workspace.
pub(super) struct Sources {
    files: Vec<Source>,
    /// Names that must stay constants.
    fixed: BTreeSet<String>,
}

/// A declaration: tokens from `const` to `;`.
struct Declaration {
    name: usize,
    colon: usize,
    equals: usize,
    end: usize,
}

impl Sources {
    /// Reads every file of the folders; unit tests are left out.
    pub(super) fn read(workspace: &Path) -> anyhow::Result<Self> {
        let mut files = Vec::new();
        for folder in FOLDERS {
            let mut paths = Vec::new();
            list(&workspace.join(folder), &mut paths)?;
            for path in paths {
                let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
                let product = text.find(TESTS).map_or(text.as_str(), |cut| &text[..cut]);
                let stream: TokenStream = product.parse().map_err(|e| anyhow::anyhow!("{}: {e}", path.display()))?;
                let mut tokens = Vec::new();
                flatten(stream, &mut tokens);
                let file = path.strip_prefix(workspace).unwrap_or(&path).to_owned();
                files.push(Source { file, text, tokens });
            }
        }
        let mut sources = Self { files, fixed: BTreeSet::new() };
        let lengths: Vec<String> = sources.files.iter().flat_map(Source::lengths).collect();
        sources.fixed.extend(lengths);
        Ok(sources)
    }

    /// Writes the files of a copy of the workspace with every constant that varies as a function. Returns these
    /// constants; the index of a constant is its place in the list.
    pub(super) fn write(&self, copy: &Path) -> anyhow::Result<Vec<Constant>> {
        let names: BTreeSet<&str> = self
            .files
            .iter()
            .flat_map(|f| f.declarations().into_iter().map(|d| f.tokens[d.name].text.as_str()))
            .filter(|name| !self.fixed.contains(*name))
            .collect();
        let mut constants = Vec::new();
        for source in &self.files {
            let path = copy.join(&source.file);
            fs::write(&path, source.varied(&names, &mut constants)).with_context(|| path.display().to_string())?;
        }
        Ok(constants)
    }

    /// Takes every constant that an error of the compiler points at for one that must stay as it is. False if an error
    /// points at none.
    pub(super) fn keep_fixed(&mut self, copy: &Path, messages: &str) -> bool {
        let known: BTreeSet<String> = self
            .files
            .iter()
            .flat_map(|f| f.declarations().into_iter().map(|d| f.tokens[d.name].text.clone()))
            .collect();
        let before = self.fixed.len();
        for message in messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok()) {
            if message["message"]["level"] != "error" {
                continue;
            }
            let mut lines = BTreeMap::new();
            spans(&message["message"], &mut lines);
            for (file, numbers) in lines {
                let Ok(text) = fs::read_to_string(copy.join(&file)) else { continue };
                let pointed = text.lines().enumerate().filter(|(k, _)| numbers.contains(&(*k as u64 + 1)));
                let words = pointed.flat_map(|(_, line)| line.split(|c: char| !(c.is_alphanumeric() || c == '_')));
                self.fixed.extend(words.filter(|word| known.contains(*word)).map(str::to_owned));
            }
        }
        self.fixed.len() > before
    }

    /// Number of constants that stay as they are.
    pub(super) fn fixed(&self) -> usize {
        self.fixed.len()
    }
}

/// Lines that a message and its notes point at, by file.
fn spans(message: &Value, lines: &mut BTreeMap<String, BTreeSet<u64>>) {
    for span in message["spans"].as_array().into_iter().flatten() {
        let (Some(file), Some(from), Some(to)) =
            (span["file_name"].as_str(), span["line_start"].as_u64(), span["line_end"].as_u64())
        else {
            continue;
        };
        // A span over a whole item points at nothing in particular.
        if to - from < 3 {
            lines.entry(file.to_owned()).or_default().extend(from..=to);
        }
    }
    for child in message["children"].as_array().into_iter().flatten() {
        spans(child, lines);
    }
}

/// Rust files below a folder, without files of tests.
fn list(folder: &Path, paths: &mut Vec<PathBuf>) -> anyhow::Result<()> {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder)
        .with_context(|| format!("{}: the sources are not here; give --source", folder.display()))?
        .map(|entry| entry.map(|e| e.path()))
        .collect::<Result<_, _>>()?;
    entries.sort();
    for path in entries {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && name != "tests" {
            list(&path, paths)?;
        } else if path.extension().is_some_and(|e| e == "rs") && !name.ends_with("tests.rs") {
            paths.push(path);
        }
    }
    Ok(())
}

fn flatten(stream: TokenStream, tokens: &mut Vec<Token>) {
    for tree in stream {
        let (at, line) = (tree.span().byte_range(), tree.span().start().line);
        match tree {
            TokenTree::Group(group) => {
                let [open, close] = match group.delimiter() {
                    Delimiter::Parenthesis => ["(", ")"],
                    Delimiter::Brace => ["{", "}"],
                    Delimiter::Bracket => ["[", "]"],
                    Delimiter::None => ["", ""],
                };
                let [first, last] = [group.span_open().byte_range(), group.span_close().byte_range()];
                tokens.push(Token { text: open.to_owned(), at: first, line, is_ident: false });
                flatten(group.stream(), tokens);
                tokens.push(Token { text: close.to_owned(), at: last, line, is_ident: false });
            }
            TokenTree::Ident(ident) => tokens.push(Token { text: ident.to_string(), at, line, is_ident: true }),
            other => tokens.push(Token { text: other.to_string(), at, line, is_ident: false }),
        }
    }
}

impl Source {
    /// Index of the first token with a text on the level of the token `from`.
    fn next_on_level(&self, from: usize, text: &str) -> Option<usize> {
        let mut depth = 0;
        for (k, token) in self.tokens.iter().enumerate().skip(from) {
            match token.text.as_str() {
                t if t == text && depth == 0 => return Some(k),
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth -= 1,
                _ => {}
            }
            if depth < 0 {
                return None;
            }
        }
        None
    }

    /// Declarations of numeric constants.
    fn declarations(&self) -> Vec<Declaration> {
        let text = |k: usize| self.tokens.get(k).map_or("", |t| t.text.as_str());
        let starts = (0..self.tokens.len()).filter(|&k| text(k) == "const" && text(k + 2) == ":");
        starts
            .filter_map(|k| {
                let equals = self.next_on_level(k + 3, "=")?;
                let end = self.next_on_level(equals, ";")?;
                let kind: String = self.tokens[k + 3..equals].iter().map(|t| t.text.as_str()).collect();
                let array = kind.strip_prefix('[').and_then(|k| k.strip_suffix(']'));
                let item = array.and_then(|k| k.split(';').next()).unwrap_or(&kind);
                let item = item.strip_prefix("RangeInclusive<").and_then(|k| k.strip_suffix('>')).unwrap_or(item);
                TYPES.contains(&item).then_some(Declaration { name: k + 1, colon: k + 2, equals, end })
            })
            .collect()
    }

    /// Limits that are literals of fields, in a file of rules: function and field, place, line.
    fn limits(&self) -> Vec<(String, Range<usize>, usize)> {
        let mut function = String::new();
        let mut found = Vec::new();
        if !self.file.ends_with("rules.rs") {
            return found;
        }
        for w in self.tokens.windows(4) {
            if w[0].text == "fn" {
                function.clone_from(&w[1].text);
            }
            let is_field = w[0].is_ident && w[1].text == ":" && matches!(w[3].text.as_str(), "," | "}");
            if is_field && w[2].text.parse::<f64>().is_ok() {
                found.push((format!("{function}.{}", w[0].text), w[2].at.clone(), w[2].line));
            }
        }
        found
    }

    /// Identifiers that are lengths of arrays.
    fn lengths(&self) -> Vec<String> {
        let pairs = self.tokens.windows(3).filter(|w| w[0].text == ";" && w[1].is_ident && w[2].text == "]");
        pairs.map(|w| w[1].text.clone()).collect()
    }

    /// The text with every constant of `names` as a function, and its uses as calls.
    fn varied(&self, names: &BTreeSet<&str>, constants: &mut Vec<Constant>) -> String {
        let mut edits: Vec<(Range<usize>, String)> = Vec::new();
        let mut declared = BTreeSet::new();
        for d in self.declarations() {
            let name = &self.tokens[d.name];
            declared.insert(d.name);
            if !names.contains(name.text.as_str()) {
                continue;
            }
            let [keyword, colon, equals, end] =
                [d.name - 1, d.colon, d.equals, d.end].map(|k| self.tokens[k].at.clone());
            let value = self.text[equals.end..end.start].trim().to_owned();
            edits.push((keyword, "fn".to_owned()));
            edits.push((colon, "() -> ".to_owned()));
            edits.push((equals, format!("{{ foundation::ablation::value({}, ", constants.len())));
            edits.push((end, ") }".to_owned()));
            constants.push(Constant { name: name.text.clone(), file: self.file.clone(), line: name.line, value });
        }
        for (name, literal, line) in self.limits() {
            let value = self.text[literal.clone()].to_owned();
            edits.push((literal, format!("foundation::ablation::value({}, {value})", constants.len())));
            constants.push(Constant { name, file: self.file.clone(), line, value });
        }
        let mut imports_until = 0;
        for (k, token) in self.tokens.iter().enumerate() {
            if token.text == "use" && token.is_ident {
                imports_until = self.next_on_level(k, ";").unwrap_or(k);
            }
            if k >= imports_until && token.is_ident && names.contains(token.text.as_str()) && !declared.contains(&k) {
                edits.push((token.at.end..token.at.end, "()".to_owned()));
            }
        }
        edits.sort_by_key(|(range, _)| (range.start, range.end));
        let (mut text, mut from) = (String::with_capacity(self.text.len()), 0);
        for (range, replacement) in edits {
            text.push_str(&self.text[from..range.start]);
            text.push_str(&replacement);
            from = range.end;
        }
        text.push_str(&self.text[from..]);
        text
    }
}

/// Copies the files of a workspace that git knows.
pub(super) fn copy(workspace: &Path, copy: &Path) -> anyhow::Result<()> {
    let listed = std::process::Command::new("git").arg("ls-files").current_dir(workspace).output();
    let listed = listed.context("git lists the files of the sources")?;
    if !listed.status.success() {
        bail!("{} is no checkout of the sources; give --source", workspace.display());
    }
    // A module that was moved would stand twice.
    for folder in FOLDERS.map(|folder| copy.join(folder)).iter().filter(|folder| folder.exists()) {
        fs::remove_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    for file in String::from_utf8_lossy(&listed.stdout).lines() {
        let (from, to) = (workspace.join(file), copy.join(file));
        if from.is_file() {
            fs::create_dir_all(to.parent().unwrap_or(copy))?;
            // An unchanged file keeps its time, and Cargo does not compile it again.
            if fs::read(&from)? != fs::read(&to).unwrap_or_default() || !to.exists() {
                fs::copy(&from, &to).with_context(|| from.display().to_string())?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A workspace with one file in `diagnose` and one in `identify`, copied to another folder.
    fn workspace(diagnose: &str) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().expect("a folder");
        for (place, text) in FOLDERS.iter().zip([diagnose, "const ALONE: f64 = 3.0;\n"]) {
            for root in ["", "copy"] {
                let path = folder.path().join(root).join(place);
                fs::create_dir_all(&path).expect("a folder");
                fs::write(path.join("a.rs"), text).expect("a file");
            }
        }
        let copy = folder.path().join("copy");
        (folder, copy)
    }

    fn written(diagnose: &str) -> (Vec<Constant>, String) {
        let (folder, copy) = workspace(diagnose);
        let sources = Sources::read(folder.path()).expect("they are read");
        let constants = sources.write(&copy).expect("they are written");
        (constants, fs::read_to_string(copy.join(FOLDERS[0]).join("a.rs")).expect("the file"))
    }

    #[test]
    fn a_constant_becomes_a_function_and_its_uses_calls() {
        let (constants, text) = written(
            "use super::b::{FAR, other};\n/// Near, m.\npub(crate) const NEAR: f64 = 0.5;\nconst FAR: [f64; 2] = [NEAR, 2.0 * NEAR];\n\
             fn f(x: f64) -> bool {\n    assert!(x > NEAR, \"NEAR\");\n    x < NEAR\n}\n",
        );
        assert_eq!(constants.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["NEAR", "FAR", "ALONE"]);
        assert_eq!((constants[0].line, constants[0].value.as_str()), (3, "0.5"));
        assert!(text.contains("use super::b::{FAR, other};"), "an import stays: {text}");
        assert!(text.contains("pub(crate) fn NEAR() ->  f64 { foundation::ablation::value(0,  0.5) }"), "{text}");
        assert!(text.contains("value(1,  [NEAR(), 2.0 * NEAR()]) }"), "{text}");
        assert!(text.contains("assert!(x > NEAR(), \"NEAR\");\n    x < NEAR()\n"), "{text}");
    }

    #[test]
    fn texts_lengths_of_arrays_and_tests_stay() {
        let source = "const NAME: &str = \"a\";\nconst COUNT: usize = 3;\nstatic ALL: [u8; COUNT] = [0; COUNT];\n\
                      #[cfg(test)]\nmod tests {\n    const OWN: f64 = 1.0;\n}\n";
        let (constants, text) = written(source);
        assert_eq!(constants.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["ALONE"]);
        assert_eq!(text, source);
    }

    #[test]
    fn a_constant_that_an_error_points_at_stays_from_then_on() {
        let (folder, copy) = workspace("const NEAR: f64 = 0.5;\nconst FAR: f64 = 2.0;\n");
        let mut sources = Sources::read(folder.path()).expect("they are read");
        let error = serde_json::json!({"message": {
            "level": "error", "children": [],
            "spans": [{"file_name": format!("{}/a.rs", FOLDERS[0]), "line_start": 2, "line_end": 2}],
        }});
        assert_eq!(sources.write(&copy).expect("they are written").len(), 3);
        assert!(sources.keep_fixed(&copy, &error.to_string()));
        let names: Vec<String> = sources.write(&copy).expect("they are written").into_iter().map(|c| c.name).collect();
        assert_eq!((names, sources.fixed()), (vec!["NEAR".to_owned(), "ALONE".to_owned()], 1));
        assert!(!sources.keep_fixed(&copy, "{}"), "an error that points at none ends the search");
    }
}
