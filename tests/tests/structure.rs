//! Bounds on the structure of the sources: import circles, flat files, lengths of functions, constants, cause ids, comments.
//!
//! An import circle is a set of modules of which each imports every other, directly or through others. Modules import by
//! `use` and by paths that begin with `crate`, `super` or `self`. Code of tests is left out.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};
use tests::workspace;

/// Folders of the crates whose structure is held.
const CRATES: [&str; 8] = [
    "haptics",
    "estimator/foundation",
    "estimator/logs",
    "estimator/estimation",
    "estimator/training",
    "estimator",
    "render",
    "app",
];
/// Most modules of an import circle, by crate.
const MOST_IN_A_CIRCLE: usize = 5;
/// Most files of the diagnosis outside its rooms.
const MOST_FLAT_FILES: usize = 8;
/// Files of the window outside its folders: its root and its session.
const FLAT_FILES_OF_THE_WINDOW: usize = 2;
/// Most lines of a function, arms of a table (one match, one line an arm) not counted.
const LONGEST_FUNCTION: usize = 60;
/// Most literals of cause ids in the diagnosis outside the files of the hypotheses.
const MOST_ID_LITERALS: usize = 5;
/// Most numeric constants, by folder.
const MOST_CONSTANTS: [(&str, usize); 2] =
    [("estimator/src/diagnose", 220), ("estimator/estimation/src/identify", 218)];
/// Most fields of the window's session.
const MOST_SESSION_FIELDS: usize = 12;
/// Most places of the window that take the whole session to change it, apart from the one of every panel.
const MOST_TAKE_THE_SESSION: usize = 45;
/// Largest share of comments that begin with a relative clause or an ellipsis.
const MOST_RIDDLES: f64 = 0.03;
/// Comments of types that the command line and JSON print belong to the texts of the program, not to its structure.
const PRINTED: [&str; 4] = ["JsonSchema", "Args", "Subcommand", "ValueEnum"];

/// Path of a module within its crate; the crate itself is the empty path.
type Module = Vec<String>;

/// Sources below a folder of the workspace, without files of tests.
fn sources(folder: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![workspace().join(folder)];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())).flatten() {
            let path = entry.path();
            let name = entry.file_name().to_string_lossy().into_owned();
            if path.is_dir() && name != "tests" {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") && !name.ends_with("tests.rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Text of a source up to its tests.
fn product(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let end = text.find("#[cfg(test)]\nmod tests {").unwrap_or(text.len());
    text[..end].to_owned()
}

fn shown(path: &Path) -> String {
    path.strip_prefix(workspace()).unwrap_or(path).display().to_string()
}

/// Modules of a crate with their files.
fn modules(name: &str) -> BTreeMap<Module, PathBuf> {
    let root = workspace().join(name).join("src");
    let of = |path: PathBuf| {
        let inside = path.strip_prefix(&root).expect("below the crate").with_extension("");
        let mut module: Module = inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        if module.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
            module.pop();
        }
        (module, path)
    };
    sources(&format!("{name}/src")).into_iter().map(of).collect()
}

/// Paths that a file names.
#[derive(Default)]
struct Named {
    paths: Vec<Vec<String>>,
}

impl<'ast> Visit<'ast> for Named {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let attributes: &[syn::Attribute] = match item {
            syn::Item::Mod(of) => &of.attrs,
            syn::Item::Use(of) => &of.attrs,
            syn::Item::Fn(of) => &of.attrs,
            _ => &[],
        };
        let is_test =
            |a: &syn::Attribute| a.path().is_ident("cfg") && a.parse_args::<syn::Ident>().is_ok_and(|i| i == "test");
        if !attributes.iter().any(is_test) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.add_tree(&mut Vec::new(), &item.tree);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let segments: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        if ["crate", "super", "self"].contains(&segments[0].as_str()) && segments.len() > 1 {
            self.paths.push(segments);
        }
        visit::visit_path(self, path);
    }
}

impl Named {
    fn add_tree(&mut self, prefix: &mut Vec<String>, tree: &syn::UseTree) {
        match tree {
            syn::UseTree::Path(path) => {
                prefix.push(path.ident.to_string());
                self.add_tree(prefix, &path.tree);
                prefix.pop();
            }
            syn::UseTree::Group(group) => group.items.iter().for_each(|tree| self.add_tree(prefix, tree)),
            syn::UseTree::Name(name) => self.add(prefix, &name.ident),
            syn::UseTree::Rename(name) => self.add(prefix, &name.ident),
            syn::UseTree::Glob(_) => self.paths.push(prefix.clone()),
        }
    }

    fn add(&mut self, prefix: &[String], name: &syn::Ident) {
        self.paths.push(prefix.iter().cloned().chain([name.to_string()]).collect());
    }
}

/// The module that a path names, seen from `here`; nothing for other crates.
fn resolve(modules: &BTreeMap<Module, PathBuf>, here: &Module, path: &[String]) -> Option<Module> {
    let mut base = here.clone();
    let mut rest = path;
    match path.first()?.as_str() {
        "crate" => (base, rest) = (Vec::new(), &path[1..]),
        "self" | "super" => {
            while let Some(first) = rest.first().filter(|first| ["self", "super"].contains(&first.as_str())) {
                if first == "super" {
                    base.pop();
                }
                rest = &rest[1..];
            }
        }
        child => {
            let of: Module = here.iter().cloned().chain([child.to_owned()]).collect();
            modules.get(&of)?;
        }
    }
    let whole: Module = base.iter().cloned().chain(rest.iter().cloned()).collect();
    (0..=whole.len()).rev().map(|end| whole[..end].to_vec()).find(|module| modules.contains_key(module))
}

/// Imports of every module of a crate.
fn imports(name: &str) -> BTreeMap<Module, BTreeSet<Module>> {
    let modules = modules(name);
    let of = |(here, path): (&Module, &PathBuf)| {
        let mut named = Named::default();
        named.visit_file(&syn::parse_file(&product(path)).unwrap_or_else(|e| panic!("{}: {e}", path.display())));
        let targets = named.paths.iter().filter_map(|path| resolve(&modules, here, path));
        (here.clone(), targets.filter(|target| target != here).collect())
    };
    modules.iter().map(of).collect()
}

/// Modules that can be reached from one.
fn reached<'a>(imports: &'a BTreeMap<Module, BTreeSet<Module>>, from: &'a Module) -> BTreeSet<&'a Module> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(module) = open.pop() {
        let next = imports[module].iter().filter(|next| found.insert(*next));
        open.extend(next.collect::<Vec<_>>());
    }
    found
}

#[test]
fn import_circles_are_small_and_stay_in_their_folder() {
    for name in CRATES {
        let imports = imports(name);
        assert!(imports.len() > 20, "{name}: {} modules were looked at", imports.len());
        let reached: BTreeMap<&Module, BTreeSet<&Module>> = imports.keys().map(|m| (m, reached(&imports, m))).collect();
        for module in imports.keys() {
            let back = |other: &&&Module| **other == module || reached[**other].contains(module);
            let circle: Vec<&&Module> = reached[module].iter().filter(back).collect();
            let words: Vec<String> = circle.iter().map(|m| m.join("::")).collect();
            assert!(
                circle.len() <= MOST_IN_A_CIRCLE,
                "{name}: an import circle of {} modules: {words:?}",
                circle.len()
            );
            // The root of a folder stands in it, and in the folder above.
            let parent = |m: &Module| m[..m.len().saturating_sub(1)].to_vec();
            let lies_in = |folder: &Module| circle.iter().all(|m| **m == folder || parent(m) == *folder);
            let in_one = circle.iter().any(|m| lies_in(m) || lies_in(&parent(m)));
            assert!(circle.is_empty() || in_one, "{name}: an import circle across folders: {words:?}");
        }
    }
}

#[test]
fn files_of_the_diagnosis_stand_in_rooms() {
    let root = workspace().join("estimator/src/diagnose");
    let flat = sources("estimator/src/diagnose").into_iter().filter(|path| path.parent() == Some(&root)).count();
    assert!((1..=MOST_FLAT_FILES).contains(&flat), "{flat} files lie flat in estimator/src/diagnose");
}

#[test]
fn files_of_the_window_stand_in_folders() {
    let root = workspace().join("app/src/ui");
    let flat = sources("app/src/ui").into_iter().filter(|path| path.parent() == Some(&root)).count();
    assert_eq!(flat, FLAT_FILES_OF_THE_WINDOW, "files lie flat in app/src/ui");
}

#[test]
fn functions_fit_a_screen() {
    let mut looked_at = 0;
    for path in CRATES.iter().flat_map(|name| sources(&format!("{name}/src"))) {
        let text = product(&path);
        let lines: Vec<&str> = text.lines().collect();
        for (first, line) in lines.iter().enumerate() {
            let indent = line.len() - line.trim_start().len();
            let words: Vec<&str> = line.split_whitespace().take_while(|word| !word.contains('"')).collect();
            let before_fn = words.iter().take_while(|word| **word != "fn");
            let is_qualifier =
                |word: &&str| word.starts_with("pub") || ["const", "async", "unsafe", "crate)"].contains(word);
            if !words.contains(&"fn") || !before_fn.clone().all(is_qualifier) {
                continue;
            }
            let close = format!("{}}}", " ".repeat(indent));
            let last = (first..lines.len()).find(|k| lines[*k].starts_with(&close)).unwrap_or(first);
            // A table: one match with an arm a line.
            let arms = lines[first..=last].iter().filter(|l| l.contains(" => ") && l.ends_with(',')).count();
            let length = last - first + 1 - if lines[first + 1].trim() == "match self {" { arms } else { 0 };
            looked_at += 1;
            assert!(length <= LONGEST_FUNCTION, "{}:{}: {length} lines of a function", shown(&path), first + 1);
        }
    }
    assert!(looked_at > 3000, "{looked_at} functions were looked at");
}

/// Comments of one file: the first line of each, unless the command line or JSON prints them.
fn first_lines(text: &str) -> Vec<&str> {
    let (mut found, mut is_printed, mut derive) = (Vec::new(), false, "");
    let mut before = "";
    let lines: Vec<&str> = text.lines().collect();
    for (k, line) in lines.iter().enumerate() {
        if line.starts_with("///") && !before.starts_with("///") {
            // The attributes of the item that is documented here.
            derive = lines[k..].iter().find(|l| !l.starts_with("///")).copied().unwrap_or_default();
        }
        if line.starts_with("#[derive") || line.starts_with("///") {
            is_printed = PRINTED.iter().any(|name| line.contains(name) || derive.contains(name));
        } else if line.starts_with('}') {
            (is_printed, derive) = (false, "");
        }
        let comment = line.trim_start();
        let is_comment = |line: &str| line.starts_with("///") || line.starts_with("//!");
        if is_comment(comment) && !is_comment(before.trim_start()) && !is_printed {
            found.push(comment);
        }
        before = line;
    }
    found
}

#[test]
fn comments_say_first_what_a_thing_is() {
    let openings =
        ["What ", "Whatever ", "How ", "Where ", "Whether ", "Which ", "When ", "So ", "Those ", "That ", "…"];
    for name in CRATES {
        let (mut all, mut riddles) = (0_usize, Vec::new());
        for path in sources(&format!("{name}/src")) {
            for line in first_lines(&product(&path)) {
                all += 1;
                let words = line.trim_start_matches(['/', '!']).trim_start();
                if openings.iter().any(|opening| words.starts_with(opening)) {
                    riddles.push(format!("{}: {line}", shown(&path)));
                }
            }
        }
        assert!(all > 200, "{name}: {all} comments were looked at");
        let share = riddles.len() as f64 / all as f64;
        assert!(
            share <= MOST_RIDDLES,
            "{name}: {} of {all} comments are riddles:\n{}",
            riddles.len(),
            riddles.join("\n")
        );
    }
}

#[test]
fn a_cause_id_is_written_once() {
    let ids: Vec<&str> = haptics::law::causes().map(|entry| entry.id).collect();
    assert!(ids.len() > 20, "{} causes are known", ids.len());
    let (mut own, mut elsewhere) = (0, Vec::new());
    for path in sources("estimator/src/diagnose") {
        let text = product(&path);
        let count: usize = ids.iter().map(|id| text.matches(&format!("\"{id}\"")).count()).sum();
        if path.parent().is_some_and(|folder| folder.ends_with("hypotheses")) {
            own += count;
        } else if count > 0 {
            elsewhere.push((shown(&path), count));
        }
    }
    assert!(own >= ids.len(), "{own} ids stand with the hypotheses");
    let sum: usize = elsewhere.iter().map(|(_, count)| count).sum();
    assert!(sum <= MOST_ID_LITERALS, "{sum} literals of cause ids outside the hypotheses: {elsewhere:?}");
}

/// A numeric constant, or a grid or a set of limits made of numbers.
struct Constant {
    file: String,
    name: String,
    comment: String,
    is_number: bool,
}

/// Constants of a folder. An id, a text or a flag is no tuning constant.
fn constants(folder: &str) -> Vec<Constant> {
    let mut found = Vec::new();
    for path in sources(folder) {
        let mut comment = String::new();
        for line in product(&path).lines().map(str::trim) {
            if let Some(text) = line.strip_prefix("///") {
                comment.push_str(text);
                comment.push('\n');
                continue;
            }
            let words: Vec<&str> = line.split_whitespace().take_while(|word| *word != "=").collect();
            let name = words.iter().position(|word| *word == "const").and_then(|at| words.get(at + 1));
            let numbers = ["f64", "f32", "usize", "isize", "u32", "i32", "u64", "i64"];
            let is_number = numbers.iter().any(|kind| line.contains(kind));
            let counts = is_number || line.contains("Axis") || line.contains("Demands");
            if let Some(name) = name
                .and_then(|name| name.strip_suffix(':'))
                .filter(|_| counts && !words.iter().any(|word| word.contains("str")))
            {
                found.push(Constant { file: shown(&path), name: name.to_owned(), comment: comment.clone(), is_number });
            }
            comment.clear();
        }
    }
    assert!(found.len() > 100, "{} constants of {folder} were looked at", found.len());
    found
}

#[test]
fn a_constant_says_where_it_comes_from_or_what_changes_with_it() {
    let begins = |line: &str| ["Source: ", "Derived: ", "Choice: "].iter().any(|with| line.trim().starts_with(with));
    for (folder, _) in MOST_CONSTANTS {
        let silent = constants(folder).into_iter().filter(|c| !c.comment.lines().any(begins));
        let silent: Vec<String> = silent.map(|c| format!("{} in {}", c.name, c.file)).collect();
        assert!(silent.is_empty(), "no Source, Derived or Choice: {silent:?}");
    }
}

#[test]
fn constants_are_few_and_a_name_stands_in_one_file() {
    for (folder, most) in MOST_CONSTANTS {
        let numbers: Vec<Constant> = constants(folder).into_iter().filter(|c| c.is_number).collect();
        assert!(numbers.len() <= most, "{} constants in {folder}", numbers.len());
        let mut files: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for constant in &numbers {
            files.entry(&constant.name).or_default().insert(&constant.file);
        }
        let several: Vec<_> = files.iter().filter(|(_, files)| files.len() > 1).collect();
        assert!(several.is_empty(), "{several:?}");
    }
}

#[test]
fn the_session_of_the_window_holds_few_things() {
    let session = product(&workspace().join("app/src/ui/session.rs"));
    let fields =
        session.split("pub struct Session {").nth(1).and_then(|rest| rest.split("\n}").next()).expect("a struct");
    let count = fields.lines().filter(|line| line.starts_with("    pub")).count();
    assert!((1..=MOST_SESSION_FIELDS).contains(&count), "{count} fields of the session");
    let blocks =
        sources("app/src/ui").iter().map(|path| product(path).matches("\nimpl Session").count()).sum::<usize>();
    assert_eq!(blocks, 1, "`impl Session`");
}

#[test]
fn few_functions_of_the_window_take_the_whole_session() {
    let takes = |path: &PathBuf| {
        let text = product(path);
        (shown(path), text.matches("&mut Session").count() - text.matches("impl Panel for").count())
    };
    let found: Vec<(String, usize)> = sources("app/src/ui").iter().map(takes).filter(|(_, count)| *count > 0).collect();
    let sum: usize = found.iter().map(|(_, count)| count).sum();
    assert!((1..=MOST_TAKE_THE_SESSION).contains(&sum), "{sum} places take the session: {found:?}");
}
