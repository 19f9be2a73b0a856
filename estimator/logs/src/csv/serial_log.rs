//! Lines of serial monitors: names beside each number (`q:0.5 f:2.1`), or a time before each line (`[12:00:05.125] 0.5,2.1` and
//! `12:00:05.125 -> 0.5,2.1`). Both are written as a table.

use super::calendar;
use super::cells::{Notation, number};

/// Lines at the start that are looked at.
const LINES: usize = 40;

/// Kind of the lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Labelled,
    Stamped,
}

/// Kind that all of the later lines at the start of a text have; none for other texts.
pub fn kind(start: &[u8], is_cut: bool) -> Option<Kind> {
    let lines = start.split(|b| *b == b'\n').filter(|line| !line.trim_ascii().is_empty());
    let mut lines: Vec<&str> = lines.take(LINES).map(|line| std::str::from_utf8(line).unwrap_or_default()).collect();
    if is_cut && lines.len() < LINES {
        lines.pop();
    }
    let later = &lines[lines.len() / 2..];
    let names = |line: &str| Some(labelled(line)?.into_iter().map(|(name, _)| name.to_owned()).collect::<Vec<_>>());
    let first = names(later.first()?);
    if first.is_some() && later.iter().all(|line| names(line) == first) {
        return Some(Kind::Labelled);
    }
    let is_row = |line: &&str| stamped(line).is_some_and(|(_, rest)| cells(rest).iter().all(|cell| is_number(cell)));
    later.iter().all(is_row).then_some(Kind::Stamped)
}

/// The text as a table with tabs, from the first line on that fits. A line stays on its place where another stands before it.
pub fn tabbed(text: &[u8], kind: Kind) -> Vec<u8> {
    let text = String::from_utf8_lossy(text);
    let lines = text.lines().map(str::trim);
    let rows: Vec<String> = match kind {
        Kind::Labelled => {
            let before = lines.clone().take_while(|line| labelled(line).is_none()).count();
            let blank = std::iter::repeat_n(String::new(), before.saturating_sub(1));
            let mut lines = lines.skip(before).peekable();
            let of = |line: &str, part: fn((&str, &str)) -> String| match labelled(line) {
                Some(pairs) => pairs.into_iter().map(part).collect::<Vec<_>>().join("\t"),
                None => line.to_owned(),
            };
            let header = lines.peek().map(|line| of(line, |(name, _)| name.to_owned()));
            blank.chain(header).chain(lines.map(|line| of(line, |(_, value)| value.to_owned()))).collect()
        }
        Kind::Stamped => {
            let of = |line: &str| match stamped(line) {
                Some((stamp, rest)) => {
                    let cells = cells(rest);
                    let first = if cells.iter().any(|cell| is_number(cell)) { stamp } else { "Time" };
                    std::iter::once(first).chain(cells).collect::<Vec<_>>().join("\t")
                }
                None => line.to_owned(),
            };
            lines.map(of).collect()
        }
    };
    (rows.join("\n") + "\n").into_bytes()
}

/// Names and numbers of a line with at least two of them, each behind its name and a colon or an equals sign.
fn labelled(line: &str) -> Option<Vec<(&str, &str)>> {
    let pair = |cell| {
        let (name, value) = str::split_once(cell, [':', '='])?;
        (name.starts_with(char::is_alphabetic) && is_number(value.trim())).then_some((name, value.trim()))
    };
    let pairs: Option<Vec<_>> = cells(line).into_iter().map(pair).collect();
    pairs.filter(|pairs| pairs.len() > 1)
}

/// Time before a line, and the rest of it.
fn stamped(line: &str) -> Option<(&str, &str)> {
    let line = line.trim();
    let (stamp, rest) = match line.strip_prefix('[') {
        Some(inside) => inside.split_once(']')?,
        None => line.split_once(" -> ")?,
    };
    calendar::parse(stamp).map(|_| (stamp.trim(), rest.trim()))
}

fn cells(line: &str) -> Vec<&str> {
    let mark = ['\t', ';', ','].into_iter().find(|mark| line.contains(*mark)).unwrap_or(' ');
    line.trim().split(mark).map(str::trim).filter(|cell| !cell.is_empty()).collect()
}

fn is_number(cell: &str) -> bool {
    number(cell.as_bytes(), Notation::default()).is_some()
}
