//! Tables of figures with what they may be off by, and where they stand in `docs/validation.md`.

use std::fmt::Write as _;

/// One comparison.
pub struct Row {
    /// What it is of.
    pub labels: Vec<String>,
    /// Figures as they are shown.
    pub shown: Vec<String>,
    /// What came out.
    pub found: f64,
    /// What should have.
    pub wanted: f64,
    /// How far it may be off.
    pub tolerance: f64,
    /// What a difference is told in: a standard error, or 1.
    pub per: f64,
    /// Decimal places of that.
    pub places: usize,
}

/// Comparisons under one head.
pub struct Table {
    /// Titles of the columns.
    pub head: Vec<&'static str>,
    /// The comparisons.
    pub rows: Vec<Row>,
}

impl Row {
    fn is_met(&self) -> bool {
        (self.found - self.wanted).abs() <= self.tolerance
    }

    fn line(&self) -> String {
        format!("| {} |", self.cells().join(" | "))
    }

    fn cells(&self) -> Vec<String> {
        [self.labels.as_slice(), self.shown.as_slice()].concat()
    }
}

impl Table {
    /// Lines of what is off.
    pub fn off(&self) -> Vec<String> {
        self.rows.iter().filter(|row| !row.is_met()).map(Row::line).collect()
    }

    /// Prints all, and fails when something is off.
    pub fn demand(&self) {
        println!("{}", self.text());
        assert!(!self.rows.is_empty() && self.off().is_empty(), "off:\n{}", self.off().join("\n"));
    }

    fn text(&self) -> String {
        self.text_with(None)
    }

    /// With one more column: what other seeds show.
    fn text_with(&self, others: Option<&[String]>) -> String {
        let mut head: Vec<&str> = self.head.clone();
        head.extend(others.map(|_| "eight other seeds"));
        let mut text = format!("| {} |\n|{}\n", head.join(" | "), "---|".repeat(head.len()));
        for (k, row) in self.rows.iter().enumerate() {
            let mut cells = row.cells();
            cells.extend(others.and_then(|all| all.get(k)).cloned());
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        }
        text
    }
}

/// Four digits of a number, with as many places as its error needs.
pub fn figure(value: f64, error: f64) -> String {
    let places = if error > 0.0 { (1.0 - error.log10().floor()).clamp(0.0, 9.0) } else { 4.0 };
    format!("{value:.*}", places as usize)
}

/// Writes a table into the document, with what other seeds show, or sees to it that what stands there has the same rows.
pub fn keep(name: &str, table: &Table, others: Option<&[String]>) {
    let path = tests::workspace().join("docs/validation.md");
    let document = std::fs::read_to_string(&path).expect("docs/validation.md is there");
    let (begin, end) = (format!("<!-- {name} -->\n"), format!("<!-- end of {name} -->"));
    let (before, rest) = document.split_once(&begin).expect("the document has a place for the table");
    let (stands, after) = rest.split_once(&end).expect("the table ends");
    if std::env::var_os("TOUCHSTONE_WRITE_VALIDATION").is_some() {
        std::fs::write(&path, format!("{before}{begin}{}{end}{after}", table.text_with(others)))
            .expect("the document can be written");
        return;
    }
    // Figures depend a little on MuJoCo's version and the processor, labels do not.
    let labels = |text: &str| -> Vec<String> {
        let columns = table.rows.first().map_or(0, |row| row.labels.len());
        let rows = text.lines().skip(2);
        rows.map(|line| line.split(" | ").take(columns).collect::<Vec<_>>().join(" | ")).collect()
    };
    assert_eq!(labels(stands), labels(&table.text()), "write docs/validation.md anew: see tests/tests/mujoco/main.rs");
}
