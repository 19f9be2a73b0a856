//! Text that is not UTF-8, and blanks instead of a delimiter.

use super::cells::{Notation, number};
use super::decimal::Decimal;

/// Encoding of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Utf8,
    /// With the low byte first, or the high one.
    Utf16(bool),
    Latin1,
}

/// Encoding by the first bytes of a file. A character that they cut off is none of another encoding.
pub fn of(start: &[u8]) -> Encoding {
    match start {
        [0xff, 0xfe, ..] => Encoding::Utf16(true),
        [0xfe, 0xff, ..] => Encoding::Utf16(false),
        _ if is_utf16(start, true) => Encoding::Utf16(true),
        _ if is_utf16(start, false) => Encoding::Utf16(false),
        _ if std::str::from_utf8(start).is_err_and(|error| error.error_len().is_some()) => Encoding::Latin1,
        _ => Encoding::Utf8,
    }
}

/// True for text in units of two bytes without a mark before it: most of them are printed signs of ASCII, and none is zero.
fn is_utf16(start: &[u8], low_first: bool) -> bool {
    let units = start.as_chunks::<2>().0;
    let parts = units.iter().map(|[a, b]| if low_first { (*a, *b) } else { (*b, *a) });
    let is_text = |(low, high): (u8, u8)| high > 0 || low >= 0x20 || matches!(low, b'\t' | b'\n' | b'\r');
    let signs = parts.clone().filter(|(low, high)| *high == 0 && low.is_ascii()).count();
    !units.is_empty() && 4 * signs >= 3 * units.len() && parts.clone().all(is_text)
}

/// The text as UTF-8.
pub fn decoded(bytes: Vec<u8>, encoding: Encoding) -> Vec<u8> {
    match encoding {
        Encoding::Utf8 => bytes,
        Encoding::Latin1 => bytes.into_iter().map(char::from).collect::<String>().into_bytes(),
        Encoding::Utf16(low_first) => {
            let unit = |pair: &[u8; 2]| if low_first { u16::from_le_bytes(*pair) } else { u16::from_be_bytes(*pair) };
            let units = bytes.as_chunks::<2>().0.iter().map(unit);
            char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect::<String>().into_bytes()
        }
    }
}

/// Lines at the start of a file that are looked at.
const LINES: usize = 40;

/// Number of cells in the rows of a text whose cells only blanks divide; none for other texts. `is_cut`: true if the last line may
/// lack its end.
pub fn blank_width(start: &[u8], is_cut: bool) -> Option<usize> {
    let lines = start.split(|b| *b == b'\n').filter(|line| !line.trim_ascii().is_empty() && !is_comment(line));
    let mut lines: Vec<&[u8]> = lines.take(LINES).collect();
    if is_cut && lines.len() < LINES {
        lines.pop();
    }
    let rows = &lines[lines.len() / 2..];
    let width = words(rows.last()?).len();
    let is_number = |word: &&[u8]| number(word, Notation { delimiter: b'\t', decimal: Decimal::Either }).is_some();
    let is_row = |line: &&[u8]| {
        let words = words(line);
        let is_divided_otherwise = line.iter().any(|b| matches!(b, b'\t' | b';' | b'|'));
        // A comma behind a word divides cells, one within a number is its decimal mark.
        let has_delimiter = words.iter().any(|word| word.contains(&b',') && !is_number(word));
        let numbers = words.iter().filter(|word| is_number(word)).count();
        words.len() == width && !is_divided_otherwise && !has_delimiter && 2 * numbers >= width
    };
    (width > 1 && rows.iter().all(is_row)).then_some(width)
}

fn is_comment(line: &[u8]) -> bool {
    line.starts_with(b"#")
}

/// The text with tabs between its cells, and no blanks around a line.
pub fn tabbed(text: &[u8], width: usize) -> Vec<u8> {
    let mut out = Vec::with_capacity(text.len());
    for line in text.split_inclusive(|b| *b == b'\n') {
        if is_comment(line) {
            out.extend_from_slice(line.trim_ascii_end());
        } else {
            for (k, cell) in cells(line, width).into_iter().enumerate() {
                out.extend_from_slice(if k > 0 { b"\t" } else { b"" });
                out.extend_from_slice(cell);
            }
        }
        if line.ends_with(b"\n") {
            out.push(b'\n');
        }
    }
    out
}

/// The words of a line. Blanks in quotes divide none.
fn words(line: &[u8]) -> Vec<&[u8]> {
    let mut quoted = false;
    let words = line.split(|b| {
        quoted ^= *b == b'"';
        !quoted && b.is_ascii_whitespace()
    });
    words.filter(|word| !word.is_empty()).collect()
}

/// The cells of a line of a table without a visible delimiter. Names may hold blanks: then tabs divide them, or several blanks.
pub fn cells(line: &[u8], width: usize) -> Vec<&[u8]> {
    let line = line.trim_ascii();
    let words = words(line);
    if words.len() == width {
        return words;
    }
    let by_tabs = || line.split(|b| *b == b'\t').map(<[u8]>::trim_ascii).collect::<Vec<_>>();
    let by_blanks = || {
        let (mut cells, mut rest) = (Vec::new(), line);
        while let Some(at) = memchr::memmem::find(rest, b"  ") {
            cells.push(&rest[..at]);
            rest = rest[at..].trim_ascii_start();
        }
        cells.push(rest);
        cells
    };
    let fits = |cells: &Vec<&[u8]>| cells.len() == width || cells.len() + 1 == width;
    Some(by_tabs()).filter(fits).or_else(|| Some(by_blanks()).filter(fits)).unwrap_or(words)
}
