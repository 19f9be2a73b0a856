//! Texts of a panel stand in one table of their own, and not in the drawing code.

use std::path::Path;
use syn::visit::{self, Visit};

/// Collects the texts that a file hands to something outside of its tables.
#[derive(Default)]
struct Texts(Vec<String>);

/// Calls whose text nobody reads in the window: panics, and names by which egui tells things apart.
const UNSEEN: [&str; 5] = ["expect", "id_salt", "from_id_salt", "push_id", "with"];

impl<'ast> Visit<'ast> for Texts {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        let is_test = item.attrs.iter().any(|a| a.path().is_ident("cfg"));
        if item.ident != "words" && !is_test {
            visit::visit_item_mod(self, item);
        }
    }

    /// A constant or a registration at the top is a table.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}

    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}

    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}

    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        self.visit_expr(&call.receiver);
        if UNSEEN.iter().all(|name| call.method != name) {
            call.args.iter().for_each(|argument| self.visit_expr(argument));
        }
    }

    fn visit_expr_call(&mut self, call: &'ast syn::ExprCall) {
        let named = |path: &syn::Path| path.segments.iter().any(|s| s.ident == "Id" || s.ident == "from_id_salt");
        if !matches!(&*call.func, syn::Expr::Path(function) if named(&function.path)) {
            visit::visit_expr_call(self, call);
        }
    }

    fn visit_lit_str(&mut self, text: &'ast syn::LitStr) {
        if is_said(&text.value()) {
            self.0.push(text.value());
        }
    }
}

/// True if a text is for people: it begins like a heading, or has two words.
fn is_said(text: &str) -> bool {
    let mut letters = text.chars();
    // Longer than a unit, such as Nm.
    let is_heading = letters.next().is_some_and(char::is_uppercase)
        && letters.next().is_some_and(char::is_lowercase)
        && letters.next().is_some();
    let is_word = |word: &&str| word.chars().filter(|c| c.is_alphabetic()).count() > 1;
    is_heading || text.split_whitespace().filter(is_word).count() > 1
}

/// Texts outside of the tables of a file. Macros are not looked into: a sentence with numbers in it stands where the numbers are.
fn scattered(source: &str) -> Vec<String> {
    let mut texts = Texts::default();
    texts.visit_file(&syn::parse_file(source).expect("Rust"));
    texts.0
}

#[test]
fn every_panel_keeps_what_it_says_in_its_table() {
    let folder = |feature: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("src/ui").join(feature).join("panels");
    let entries = ["calibrate", "devices", "diagnose", "train"]
        .iter()
        .flat_map(|feature| std::fs::read_dir(folder(feature)).expect("the panels").flatten());
    let (mut found, mut files) = (Vec::new(), 0);
    for entry in entries {
        let source = std::fs::read_to_string(entry.path()).expect("text");
        files += 1;
        let name = entry.file_name().to_string_lossy().into_owned();
        found.extend(scattered(&source).into_iter().map(|text| format!("{name}: “{text}”")));
    }
    assert!(files > 30, "{files} files are not all the panels");
    assert!(found.is_empty(), "move these into the table `words` of their file:\n{}", found.join("\n"));
}

#[test]
fn a_scattered_text_is_noticed() {
    let panel = r#"
        mod words { pub const OPEN: &str = "Open a log"; }
        const SHOWN: [(&str, &str); 1] = [("Path", "Where it went")];
        fn draw(ui: &mut Ui) {
            ui.label(words::OPEN);
            ui.label(format!("{} of {} settled", 1, 2));
            ui.button("Cancel").on_hover_text("gives it up");
            egui::Grid::new("two words").show(ui, |ui| ui.label("mm"));
            ui.push_id("one row", |_| {});
        }
    "#;
    assert_eq!(scattered(panel), ["Cancel", "gives it up", "two words"]);
}
