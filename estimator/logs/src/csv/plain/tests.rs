//! The quick way against the standard library and against the careful way.

use super::*;
use crate::csv::cells::number;
use memchr::memchr;
use proptest::prelude::*;

/// Notation of a file that shows no decimal mark.
fn either(delimiter: u8) -> Notation {
    Notation { delimiter, decimal: if delimiter == b',' { Decimal::Point } else { Decimal::Either } }
}

const READ: Use = Use::Number { required: true, factor: 1.0 };

/// Rows, and where the next one starts.
type Taken = (usize, usize);

/// Rows taken by the quick way, then by both ways, and the columns.
fn read(text: &[u8], delimiter: u8, uses: &[Use]) -> (Taken, Taken, Vec<Vec<f64>>) {
    let mut columns = vec![Vec::new(); uses.len()];
    let mut ends = Vec::new();
    find_ends(text, delimiter, &mut ends);
    let mut plain = Plain::new(either(delimiter), uses, &mut columns, &ends);
    // The first row has too little before it for the quick way.
    let second = plain.row(text, 0);
    let first = usize::from(second.is_some());
    let quick = plain.quick_rows(text, second.unwrap_or(0));
    let rest = plain.rows(text, quick.1);
    ((first + quick.0, quick.1), (first + quick.0 + rest.0, rest.1), columns)
}

/// A first row that is long enough for the window, and the cells as rows of `width`.
fn table(cells: &[String], width: usize, delimiter: &str, line_end: &str) -> String {
    let mut text = vec!["0".repeat(40); width].join(delimiter) + line_end;
    for row in cells.chunks_exact(width) {
        text += &row.join(delimiter);
        text += line_end;
    }
    text
}

fn bits(column: &[f64]) -> Vec<u64> {
    column.iter().map(|v| v.to_bits()).collect()
}

/// Every cell by the standard library.
fn check(cells: &[String], width: usize, line_end: &str) -> Result<(), TestCaseError> {
    let text = table(cells, width, ",", line_end);
    let (_, (rows, at), columns) = read(text.as_bytes(), b',', &vec![READ; width]);
    prop_assert_eq!((rows, at), (1 + cells.len() / width, text.len()), "{}", text);
    for (k, column) in columns.iter().enumerate() {
        let expected: Vec<f64> = cells.chunks_exact(width).map(|row| row[k].parse().expect("a number")).collect();
        prop_assert_eq!(bits(&column[1..]), bits(&expected));
    }
    Ok(())
}

/// Decimal numbers as instruments and programs write them, and some that none does.
fn written() -> impl Strategy<Value = String> {
    prop_oneof![
        (any::<i32>(), 0..9_i32).prop_map(|(v, k)| format!("{:.*}", k as usize, f64::from(v) / 10_f64.powi(k))),
        (-1e3..1e3_f64).prop_map(|v| format!("{v:?}")),
        (-1.0..1.0_f64).prop_map(|v| format!("{v:.17}")),
        (-1.0..1.0_f64).prop_map(|v| format!("{:e}", v * 1e-7)),
        any::<u64>().prop_map(|v| v.to_string()),
        // Halfway between two doubles, and just beside.
        (1_u64 << 52..1 << 53, 0..3_u32).prop_map(|(v, k)| format!("{v}.{}", ["5", "49", "51"][k as usize])),
        (1_u64 << 53..1 << 60).prop_map(|v| (v | 1).to_string()),
        (1_u64 << 51..1 << 52, 0..4_u32).prop_map(|(v, k)| format!("{v}.{}", ["25", "75", "125", "375"][k as usize])),
        "[+-]?0{0,12}[0-9]{1,20}(\\.[0-9]{0,20})?",
        "-?[0-9]{0,3}\\.[0-9]{1,19}",
        "-?0{0,3}\\.0{0,24}[1-9][0-9]{0,9}",
        "[0-9]{1,19}([eE][+-]?[0-9]{1,2})?",
    ]
}

proptest! {
    #[test]
    fn numbers_are_those_of_the_standard_library(
        cells in proptest::collection::vec(written(), 0..900),
        width in 1..6_usize,
        carriage_return in any::<bool>(),
    ) {
        check(&cells, width, if carriage_return { "\r\n" } else { "\n" })?;
    }

    #[test]
    fn whatever_the_bytes_both_ways_see_the_same(
        lines in proptest::collection::vec("[-+0-9.,;eE\"# \t\r\nx]{0,60}|[0-9]{1,4}[.,][0-9]{1,9};-[0-9]{1,9}", 0..80),
        skip in any::<bool>(),
        delimiter in prop_oneof![Just(b','), Just(b';'), Just(b'\t')],
    ) {
        let uses = [READ, if skip { Use::Ignore } else { READ }];
        let text = lines.join("\n") + "\n";
        let mut at = 0;
        // From every row on, also from behind those that neither way takes.
        while at < text.len() {
            let bytes = &text.as_bytes()[at..];
            let mut ends = Vec::new();
            find_ends(bytes, delimiter, &mut ends);
            let mut quick = vec![Vec::new(); 2];
            let (rows, next) = Plain::new(either(delimiter), &uses, &mut quick, &ends).rows(bytes, 0);
            // Row by row: a row taken by the quick way must be the one that the most careful parser finds in the cells.
            let taken: Vec<&[u8]> = bytes[..next].split_inclusive(|&b| b == b'\n').collect();
            prop_assert_eq!(taken.len(), rows);
            for (i, row) in taken.iter().enumerate() {
                let cells: Vec<&[u8]> = row.split(|&b| b == delimiter).collect();
                prop_assert_eq!(cells.len(), 2);
                for (k, cell) in cells.iter().enumerate().filter(|&(k, _)| uses[k] == READ) {
                    prop_assert_eq!(number(cell, either(delimiter)).map(f64::to_bits), Some(quick[k][i].to_bits()));
                }
            }
            let slow = Plain::new(either(delimiter), &uses, &mut [Vec::new(), Vec::new()], &[]).rows(bytes, 0);
            // Decimal commas are for the quick way and the most careful one.
            prop_assert!(slow == (rows, next) || delimiter != b',' && slow.0 < rows, "{:?} {:?}", slow, (rows, next));
            at += next + memchr(b'\n', &bytes[next..]).map_or(bytes.len() - next, |end| end + 1);
        }
    }
}

#[test]
fn the_quick_way_takes_plain_numbers() {
    let cells: Vec<String> =
        (0..4000).map(|i| format!("{}{}.{:017}", if i % 3 == 0 { "-" } else { "" }, i % 7, i * i)).collect();
    for (delimiter, line_end, comma) in [(",", "\n", false), (";", "\r\n", true), ("\t", "\n", true)] {
        let cells: Vec<String> = cells.iter().map(|c| if comma { c.replace('.', ",") } else { c.clone() }).collect();
        let text = table(&cells, 4, delimiter, line_end);
        let quick = read(text.as_bytes(), delimiter.as_bytes()[0], &[READ; 4]).0;
        #[cfg(target_arch = "x86_64")]
        if simd::is_at_home() {
            assert_eq!(quick, (1001, text.len()));
            continue;
        }
        assert_eq!(quick.0, 1);
    }
}

#[test]
fn units_and_skipped_columns_keep_their_places() {
    let cells: Vec<String> =
        (0..600).map(|i| if i % 3 == 1 { format!("word {i}") } else { format!("{i}.5") }).collect();
    let text = table(&cells, 3, ",", "\n");
    let uses = [Use::Number { required: true, factor: -1e-3 }, Use::Ignore, READ];
    let (_, (rows, at), columns) = read(text.as_bytes(), b',', &uses);
    assert_eq!((rows, at, columns[1].len()), (201, text.len(), 0));
    assert_eq!((columns[0][1], columns[0][200], columns[2][200]), (0.5 * -1e-3, 597.5 * -1e-3, 599.5));
}
