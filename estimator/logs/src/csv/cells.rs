//! Cells and records: their ends, and the number in a cell.

use super::decimal::Decimal;
use memchr::{memchr, memchr2};

/// Rows that are read before they are distributed to the columns.
pub const BATCH: usize = 64;

/// Marks between and within the numbers of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Notation {
    /// Between cells.
    pub delimiter: u8,
    /// Before decimals.
    pub decimal: Decimal,
}

impl Default for Notation {
    fn default() -> Self {
        Self { delimiter: b',', decimal: Decimal::Point }
    }
}

/// A number from the bytes of a cell. NaN and infinities come back as such. Correctly rounded.
pub fn number(cell: &[u8], notation: Notation) -> Option<f64> {
    let cell = cell.trim_ascii();
    plain_number(cell, notation).or_else(|| plain_number(&respelled(cell)?, notation))
}

fn plain_number(cell: &[u8], notation: Notation) -> Option<f64> {
    if notation.decimal == Decimal::Comma && cell.contains(&b'.') {
        return grouped(cell, b'.', b',');
    }
    if let Ok(value) = fast_float2::parse::<f64, _>(cell) {
        return Some(value);
    }
    if notation.decimal == Decimal::Point {
        return grouped(cell, b',', b'.');
    }
    if cell.contains(&b'.') {
        return None;
    }
    let comma = memchr(b',', cell)?;
    let mut point = cell.to_vec();
    point[comma] = b'.';
    fast_float2::parse(&point).ok()
}

/// A number in the spelling of Rust, from those of other programs: a minus sign of typography or behind the number, brackets
/// of accountants around a negative number, an exponent of Fortran, blanks or apostrophes between thousands, an infinity as a sign, a formula of a spreadsheet.
fn respelled(cell: &[u8]) -> Option<Vec<u8>> {
    let text = std::str::from_utf8(cell).ok()?;
    let text = text.strip_prefix("=\"").and_then(|text| text.strip_suffix('"')).unwrap_or(text);
    let in_brackets = text.strip_prefix('(').and_then(|text| text.strip_suffix(')'));
    let negative = text.strip_suffix('-').or_else(|| text.strip_prefix(['-', '\u{2212}', '\u{2013}'])).or(in_brackets);
    let (minus, digits) = negative.map_or(("", text.strip_prefix('+').unwrap_or(text)), |digits| ("-", digits));
    // Loggers put blanks between a sign and its number.
    let digits = digits.trim_start();
    let is_digit = |c: char| c.is_ascii_digit();
    if digits == "\u{221e}" {
        return Some([minus, "inf"].concat().into_bytes());
    }
    let is_between = |c: char| matches!(c, '\'' | '\u{2019}') || c.is_whitespace();
    // Three digits stand between two marks, and before a decimal mark.
    let is_group = |group: &str| {
        let behind = group.get(3..).filter(|behind| !behind.starts_with(is_digit));
        behind.is_some() && group[..3].chars().all(is_digit)
    };
    let mut groups = digits.split(is_between);
    if !groups.next()?.starts_with(|c| is_digit(c) || c == '.' || c == ',') || !groups.all(is_group) {
        return None;
    }
    let plain: String = digits.chars().filter(|c| !is_between(*c)).collect();
    // Fortran writes the sign of an exponent, hexadecimal numbers have none.
    let plain = ["D+", "D-", "d+", "d-"]
        .iter()
        .fold(plain, |plain, mark| plain.replacen(mark, &mark.replace(['D', 'd'], "e"), 1));
    let spelled = [minus, &plain].concat();
    (spelled.as_bytes() != cell).then(|| spelled.into_bytes())
}

/// A number with marks between its thousands.
fn grouped(cell: &[u8], between: u8, decimal: u8) -> Option<f64> {
    let (whole, decimals) = match memchr(decimal, cell) {
        Some(at) => (&cell[..at], &cell[at + 1..]),
        None => (cell, &[][..]),
    };
    let digits = whole.strip_prefix(b"-").or_else(|| whole.strip_prefix(b"+")).unwrap_or(whole);
    let mut groups = digits.split(|b| *b == between);
    let is_digits = |text: &[u8]| text.iter().all(u8::is_ascii_digit);
    let is_first = groups.next().is_some_and(|first| (1..=3).contains(&first.len()) && is_digits(first));
    if !is_first || !groups.all(|group| group.len() == 3 && is_digits(group)) || !is_digits(decimals) {
        return None;
    }
    let mut plain: Vec<u8> = whole.iter().copied().filter(|b| *b != between).collect();
    plain.push(b'.');
    plain.extend_from_slice(decimals);
    fast_float2::parse(&plain).ok()
}

/// Place of a character of a record relative to its quotes.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    /// At the start of a cell: only here does a quote open.
    Start,
    /// In a cell without quotes, or behind the closing quote.
    Plain,
    /// Between quotes.
    Quoted,
    /// At a quote between quotes: it closes, or is the first of two that stand for one.
    Closing,
}

impl Place {
    fn after(self, byte: u8, delimiter: u8) -> Self {
        match (self, byte) {
            (Self::Quoted, b'"') => Self::Closing,
            (Self::Quoted, _) | (Self::Closing | Self::Start, b'"') => Self::Quoted,
            (_, b) if b == delimiter => Self::Start,
            // Blanks before an opening quote do not hide it.
            (Self::Start, b' ') => Self::Start,
            _ => Self::Plain,
        }
    }
}

/// Index of the line end that ends the record starting at `from`; `None` if it extends beyond `bytes`.
pub fn record_end(bytes: &[u8], from: usize, delimiter: u8) -> Option<usize> {
    let line_end = memchr(b'\n', &bytes[from..]).map(|at| from + at);
    let line = &bytes[from..line_end.unwrap_or(bytes.len())];
    if line.first() == Some(&b'#') || memchr(b'"', line).is_none() {
        return line_end;
    }
    let mut place = Place::Start;
    for (i, &byte) in bytes[from..].iter().enumerate() {
        if byte == b'\n' && place != Place::Quoted {
            return Some(from + i);
        }
        place = place.after(byte, delimiter);
    }
    None
}

/// The cells of one record. Cells of a record without quotes lie in the record itself, others are copied.
#[derive(Debug, Default)]
pub struct Cells {
    ranges: Vec<(usize, usize)>,
    unquoted: Vec<u8>,
    copied: bool,
}

impl Cells {
    /// Splits `record`, which has no line end.
    pub fn split(&mut self, record: &[u8], delimiter: u8) {
        self.ranges.clear();
        self.copied = memchr(b'"', record).is_some();
        if self.copied {
            return self.split_quoted(record, delimiter);
        }
        let mut first = 0;
        while let Some(at) = memchr(delimiter, &record[first..]) {
            self.ranges.push((first, first + at));
            first += at + 1;
        }
        self.ranges.push((first, record.len()));
    }

    fn split_quoted(&mut self, record: &[u8], delimiter: u8) {
        self.unquoted.clear();
        let mut place = Place::Start;
        let mut first = 0;
        for &byte in record {
            let next = place.after(byte, delimiter);
            match (place, next) {
                _ if next == Place::Start && byte == delimiter => {
                    self.ranges.push((first, self.unquoted.len()));
                    first = self.unquoted.len();
                }
                // The opening quote, and the closing one.
                (Place::Start, Place::Quoted) | (_, Place::Closing) => {}
                _ => self.unquoted.push(byte),
            }
            place = next;
        }
        self.ranges.push((first, self.unquoted.len()));
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.ranges.len()
    }

    /// One of them, without blanks around it; `record` as it was split.
    pub fn get<'a>(&'a self, record: &'a [u8], index: usize) -> &'a [u8] {
        let (first, end) = self.ranges[index];
        let source = if self.copied { &self.unquoted } else { record };
        source[first..end].trim_ascii()
    }
}

/// The number at `bytes[at..]`, when nothing but its delimiter, a line end or the end of the bytes follows it, and the index
/// behind it. `None` for whatever needs a closer look.
#[inline]
pub fn number_ahead(bytes: &[u8], at: usize, notation: Notation) -> Option<(f64, usize)> {
    let clean = |end: usize| bytes.get(end).is_none_or(|&b| b == notation.delimiter || b == b'\n' || b == b'\r');
    let (value, length) = fast_float2::parse_partial::<f64, _>(bytes.get(at..)?).ok()?;
    let is_grouped = notation.decimal == Decimal::Comma && memchr(b'.', &bytes[at..at + length]).is_some();
    (clean(at + length) && value.is_finite() && !is_grouped).then_some((value, at + length))
}

/// Length of the cell at the start of `bytes`, in a record without quotes.
#[inline]
pub fn length_ahead(bytes: &[u8], delimiter: u8) -> usize {
    memchr2(delimiter, b'\n', bytes).unwrap_or(bytes.len())
}

/// True for a cell that need not be read: no quote hides a delimiter, and it starts no comment.
pub fn is_skippable(cell: &[u8]) -> bool {
    cell.first() != Some(&b'#') && memchr(b'"', cell).is_none()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cells(record: &str, delimiter: u8) -> Vec<String> {
        let mut cells = Cells::default();
        cells.split(record.as_bytes(), delimiter);
        (0..cells.len()).map(|i| String::from_utf8_lossy(cells.get(record.as_bytes(), i)).into_owned()).collect()
    }

    #[test]
    fn quotes_are_taken_off_where_they_open_a_cell() {
        assert_eq!(cells(r#"a,"b,""c""" , "d" ,5" pipe,"#, b','), ["a", "b,\"c\"", "d", "5\" pipe", ""]);
        assert_eq!(cells("1;2,5;", b';'), ["1", "2,5", ""]);
    }

    #[test]
    fn a_record_ends_at_the_first_line_end_outside_quotes() {
        let text = b"a,\"b\nc\",d\ne\n";
        assert_eq!(record_end(text, 0, b','), Some(9));
        assert_eq!(record_end(text, 10, b','), Some(11));
        assert_eq!(record_end(b"a,\"b\n", 0, b','), None);
        assert_eq!(record_end(b"# an \"open quote\nx", 0, b','), Some(16));
    }

    #[test]
    fn decimal_commas_count_where_the_comma_is_free() {
        let of = |delimiter, decimal| Notation { delimiter, decimal };
        let [point, comma, either] = [of(b';', Decimal::Point), of(b';', Decimal::Comma), of(b';', Decimal::Either)];
        assert_eq!(number(b" 1,5 ", either), Some(1.5));
        assert_eq!((number(b"1,5", point), number(b"1.234,5", either)), (None, None));
        assert_eq!((number(b"-   2.5", point), number(b"+  0.5", point)), (Some(-2.5), Some(0.5)));
        assert_eq!((number(b"+2e0", point), number(b"1,5e3", comma)), (Some(2.0), Some(1500.0)));
        assert_eq!((number(b"-1.372", comma), number(b"51.262,5", comma)), (Some(-1372.0), Some(51262.5)));
        assert_eq!((number(b"11,683", point), number(b"11,6835", point)), (Some(11683.0), None));
        assert_eq!(
            (number(b"1.5", comma), number(b"12.3456", comma), number(b"1,234.5", point)),
            (None, None, Some(1234.5))
        );
    }

    #[test]
    fn other_programs_spell_numbers_otherwise() {
        let of = |cell: &str, decimal| number(cell.as_bytes(), Notation { delimiter: b'\t', decimal });
        let point = |cell: &str| of(cell, Decimal::Point);
        for (cell, value) in [
            ("\u{2212}0.0167", -0.0167),
            ("\u{2212}1.5e-3", -1.5e-3),
            ("1.00D+02", 100.0),
            ("-0.5d-1", -0.05),
            ("+5.7D+02", 570.0),
            ("0.0167-", -0.0167),
            ("11'682.6", 11_682.6),
            ("1\u{2019}234\u{2019}567", 1_234_567.0),
            ("11 682.6", 11_682.6),
            ("=\"11.6826\"", 11.6826),
            ("\u{221e}", f64::INFINITY),
        ] {
            assert_eq!(point(cell), Some(value), "{cell}");
        }
        assert_eq!(of("-11\u{a0}682,6", Decimal::Comma), Some(-11_682.6));
        for text in [
            "1 2",
            "11 6826",
            "12:30",
            "D",
            "1D",
            "1-2",
            "11'68",
            "=\"a\"",
            "",
            "-",
            "2026-10-25",
            "1 234 5",
            "0x1D",
            "1D2",
            "1.2.3",
            "++1D+02",
            "+-1",
        ] {
            assert_eq!(point(text), None, "{text}");
        }
    }

    proptest! {
        /// The library's parser accepts the same texts as the standard library, to the bit.
        #[test]
        fn numbers_are_those_of_the_standard_library(bits in any::<u64>(), digits in "[+-]?[0-9]{0,25}\\.?[0-9]{0,25}([eE][+-]?[0-9]{1,3})?") {
            let value = f64::from_bits(bits);
            for text in [format!("{value:?}"), format!("{value}"), format!("{value:e}"), format!("{value:.3}"), digits] {
                let own = number(text.as_bytes(), Notation::default()).map(f64::to_bits);
                let reference = text.parse::<f64>().ok().map(f64::to_bits);
                prop_assert!(own == reference || value.is_nan(), "{text}: {own:?} {reference:?}");
            }
        }
    }
}
