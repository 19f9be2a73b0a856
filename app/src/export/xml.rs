//! Elements with attributes, and a document of them.

use quick_xml::events::{BytesEnd, BytesStart, BytesText, Event};
use quick_xml::writer::Writer;

/// An element of a document.
#[derive(Clone, Debug)]
pub struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Element>,
    text: Option<String>,
}

impl Element {
    /// Empty element.
    pub fn new(name: &'static str) -> Self {
        Self { name, attributes: Vec::new(), children: Vec::new(), text: None }
    }

    /// Element that contains only text.
    pub fn text(name: &'static str, text: impl std::fmt::Display) -> Self {
        Self { text: Some(plain(&text.to_string())), ..Self::new(name) }
    }

    /// Adds an attribute.
    pub fn with(mut self, name: &'static str, value: impl std::fmt::Display) -> Self {
        self.attributes.push((name, plain(&value.to_string())));
        self
    }

    /// Adds a child element.
    pub fn containing(mut self, child: Self) -> Self {
        self.children.push(child);
        self
    }

    /// Adds child elements.
    pub fn containing_all(mut self, children: impl IntoIterator<Item = Self>) -> Self {
        self.children.extend(children);
        self
    }

    fn write(&self, to: &mut Writer<Vec<u8>>) -> std::io::Result<()> {
        let mut start = BytesStart::new(self.name);
        for (name, value) in &self.attributes {
            start.push_attribute((*name, value.as_str()));
        }
        if self.children.is_empty() && self.text.is_none() {
            return to.write_event(Event::Empty(start));
        }
        to.write_event(Event::Start(start))?;
        if let Some(text) = &self.text {
            to.write_event(Event::Text(BytesText::new(text)))?;
        }
        for child in &self.children {
            child.write(to)?;
        }
        to.write_event(Event::End(BytesEnd::new(self.name)))
    }
}

/// Numbers for a file: short, with an exact round trip.
pub fn numbers(values: &[f64]) -> String {
    // Minus zero is confusing and has no meaning here.
    values.iter().map(|value| (value + 0.0).to_string()).collect::<Vec<_>>().join(" ")
}

/// Text without characters that XML forbids.
fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') { ' ' } else { c }).collect()
}

/// A document with a comment at its top.
pub fn document(root: &Element, heading: &[String]) -> String {
    let lines: Vec<String> = heading.iter().map(|line| plain(line).replace("--", "\u{2013}")).collect();
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    // Writing into memory cannot fail.
    let _ = writer.write_event(Event::Comment(BytesText::from_escaped(format!("\n  {}\n", lines.join("\n  ")))));
    let _ = root.write(&mut writer);
    let mut text = String::from_utf8_lossy(&writer.into_inner()).into_owned();
    text.push('\n');
    text
}

/// Name valid in every program and unique among the bodies: letters, digits, `-` and `_`.
pub fn name(wanted: &str, taken: &[String]) -> String {
    let tame: String =
        wanted.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '_' }).collect();
    let tame = if tame.is_empty() { "body".to_owned() } else { tame };
    let is_free = |name: &str| !taken.iter().any(|other| other == name) && !RESERVED.contains(&name);
    if is_free(&tame) {
        return tame;
    }
    // One more candidate than taken names: one of them is free.
    let most = taken.len() + RESERVED.len() + 2;
    (2..=most).map(|n| format!("{tame}_{n}")).find(|name| is_free(name)).unwrap_or(tame)
}

/// Names that the writers use for other things.
const RESERVED: [&str; 5] = ["world", "floor", "plane", "finger-1", "finger-2"];
