//! Facts in lines above the names: units in a comment are used, and factors are told.

use super::cells::{Notation, number};
use crate::written_units::{Written, in_header, parse};

/// Words of a line with a factor for each column.
const FACTORS: [&str; 7] = ["scale", "scaling", "factor", "gain", "multiplier", "faktor", "skalierung"];

/// Texts of the units that a comment states for columns whose names state none, and the comment: `# Units: s, mm, kN`, or
/// `# position in mm, force in lbf`.
pub fn units(comments: &[u8], headers: &[String], delimiter: u8) -> Option<(Vec<String>, String)> {
    let text = String::from_utf8_lossy(comments);
    let comments = text.lines().filter_map(|line| Some(line.trim().strip_prefix('#')?.trim()));
    comments.filter(|comment| !comment.is_empty()).find_map(|comment| {
        let parts = |text: &str| {
            let parts = text.split([char::from(delimiter), ',', ';']).map(|part| part.trim().to_owned());
            parts.collect::<Vec<String>>()
        };
        let in_turn = parts(comment.rsplit(':').next().unwrap_or(comment));
        let is_row = in_turn.len() == headers.len() && in_turn.iter().all(|unit| parse(unit, &[]) != Written::Unknown);
        let found: Vec<String> = if is_row { in_turn } else { named(&parts(comment), headers) };
        let of_name = |header: &String| !in_header(header, &[]).1.is_empty();
        let found =
            found.into_iter().zip(headers).map(|(unit, header)| if of_name(header) { String::new() } else { unit });
        let found: Vec<String> = found.collect();
        found.iter().any(|unit| !unit.is_empty()).then(|| (found, comment.to_owned()))
    })
}

/// Units of the columns whose names the parts of a sentence state with one.
fn named(parts: &[String], headers: &[String]) -> Vec<String> {
    let stated = parts.iter().filter_map(|part| {
        let (name, unit) = part.split_once([':', '=']).unwrap_or_else(|| in_header(part, &[]));
        matches!(parse(unit, &[]), Written::Known(..)).then(|| (name.trim(), unit.trim()))
    });
    let stated: Vec<(&str, &str)> = stated.collect();
    let of = |header: &String| stated.iter().find(|(name, _)| name.eq_ignore_ascii_case(header));
    headers.iter().map(|header| of(header).map_or_else(String::new, |(_, unit)| (*unit).to_owned())).collect()
}

/// Words for a unit in the name of a fact.
const UNIT_WORDS: [&str; 4] = ["units", "unit", "einheiten", "einheit"];
/// Words for a conversion of counts.
const COUNTS: [&str; 6] = ["counts per", "count per", "per count", "1 count ", "1 lsb", "per lsb"];

/// Units that lines such as `Load units: kN` state for columns by their names, and sentences about them, about units of other
/// quantities, and about conversions of counts. `lines`: those above the names; `units`: texts that are known already; `has_scale`: the
/// user has stated factors.
pub fn facts<'a>(
    lines: impl Iterator<Item = &'a str>,
    headers: &[String],
    units: &mut Vec<String>,
    (delimiter, has_scale): (u8, bool),
) -> Vec<String> {
    let mut said = Vec::new();
    // Spreadsheets pad lines with delimiters.
    let trimmed =
        |line: &'a str| line.trim_start_matches(['#', ' ']).trim_end_matches(['\r', char::from(delimiter)]).trim();
    for line in lines.map(trimmed) {
        let mut parts = line.splitn(2, [':', '=', char::from(delimiter)]).map(|part| part.trim().trim_matches('"'));
        let (Some(key), Some(value)) = (parts.next(), parts.next()) else { continue };
        let of = of_unit(&key.to_lowercase());
        if let (Some(of), Written::Known(_, factor)) = (of, parse(value, &[])) {
            units.resize(headers.len(), String::new());
            let is_open = |k: &usize| units[*k].is_empty() && in_header(&headers[*k], &[]).1.is_empty();
            let open: Vec<usize> = (0..headers.len()).filter(is_open).collect();
            if let Some(&column) = open.iter().find(|k| headers[**k].eq_ignore_ascii_case(&of)) {
                value.clone_into(&mut units[column]);
                said.push(format!("the unit of `{}` is that of the line `{line}` above the names", headers[column]));
            } else if !open.is_empty() && factor != 1.0 && !has_scale {
                said.push(format!(
                    "the line `{line}` above the names states a unit, and no column without a unit has that name: if a mapped \
                     column is in it, state its factor to SI units with \"scale\" in the sidecar"
                ));
            }
        } else if !has_scale
            && COUNTS.iter().any(|words| line.to_lowercase().contains(words))
            && line.contains(|c: char| c.is_ascii_digit())
        {
            said.push(format!(
                "the line `{line}` above the names states a conversion of counts, and the values are taken as they stand: if \
                 they are counts, state their factor to SI units with \"scale\" in the sidecar"
            ));
        }
    }
    said
}

/// The quantity in the name of a fact about its unit: `load` of `Load units` and of `LOAD_UNIT`.
fn of_unit(key: &str) -> Option<String> {
    let words = key.split([' ', '_', '-', '.']).filter(|word| !word.is_empty());
    let (units, of): (Vec<&str>, Vec<&str>) = words.partition(|word| UNIT_WORDS.contains(word));
    (!units.is_empty() && !of.is_empty()).then(|| of.join(" "))
}

/// A sentence about a line with a factor for each column: nobody knows if they have been applied.
pub fn factors(cells: &[String], width: usize, notation: Notation) -> Option<String> {
    let (label, values) = cells.split_at_checked(cells.len().saturating_sub(width).max(1))?;
    let values: Vec<f64> = values.iter().filter_map(|cell| number(cell.as_bytes(), notation)).collect();
    let label = label.join(" ").to_lowercase();
    let is_stated = FACTORS.iter().any(|word| label.contains(word)) && values.len() + 1 >= width;
    let text = cells.join(char::from(notation.delimiter).encode_utf8(&mut [0; 4]));
    (is_stated && values.iter().any(|value| *value != 1.0)).then(|| {
        format!(
            "the line `{text}` above the names states factors, and the values are taken as they stand: if they are raw, state \
             their factors to SI units with \"scale\" in the sidecar"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::super::decimal::Decimal;
    use super::*;

    #[test]
    fn a_comment_states_units_in_turn_or_by_names() {
        let headers = ["Time", "Position", "Force"].map(str::to_owned);
        for (comment, stated) in [
            ("# Units: s, mm, kN\n", Some(["s", "mm", "kN"])),
            ("#s,mm,kN\n", Some(["s", "mm", "kN"])),
            ("# rig 7\n# Position in mm, force in lbf\n", Some(["", "mm", "lbf"])),
            ("# Position: mm; Force: N\n", Some(["", "mm", "N"])),
            ("# Speed in mm/s, rig 7\n", None),
            ("# a, b, c\n", None),
        ] {
            let found = units(comment.as_bytes(), &headers, b',').map(|(found, _)| found);
            assert_eq!(found, stated.map(|units| units.map(str::to_owned).to_vec()), "{comment}");
        }
        // The unit in a name is nearer.
        let headers = ["t (s)", "q (m)", "f"].map(str::to_owned);
        let found = units(b"# ms, mm, kN\n", &headers, b',').map(|(found, _)| found);
        assert_eq!(found, Some(["", "", "kN"].map(str::to_owned).to_vec()));
    }

    #[test]
    fn facts_above_the_names_state_units_and_conversions() {
        let headers = ["Time (s)", "Extension (mm)", "Load"].map(str::to_owned);
        for (line, unit, word) in [
            ("Load units: kN", "kN", "is that of the line"),
            ("#LOAD_UNIT=kgf", "kgf", "is that of the line"),
            ("Load Unit,lbf", "lbf", "is that of the line"),
            ("Force Units: kN", "", "states a unit"),
            ("Force Units: N", "", ""),
            ("Counts per Unit Force: 320.0", "", "conversion of counts"),
            ("# load cell: 1 count = 0.005 N", "", "conversion of counts"),
            ("Load units: kN,,", "kN", "is that of the line"),
            ("# Operator: Elsbeth, rig 2", "", ""),
            ("Sample count: 2000", "", ""),
            ("Operator: N", "", ""),
        ] {
            let mut units = Vec::new();
            let said = facts(std::iter::once(line), &headers, &mut units, (b',', false));
            assert_eq!(units.get(2).map_or("", String::as_str), unit, "{line}");
            assert!(
                said.len() == usize::from(!word.is_empty()) && said.iter().all(|text| text.contains(word)),
                "{said:?}"
            );
        }
    }

    #[test]
    fn factors_above_the_names_are_told() {
        let told = |line: &str| {
            let cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            factors(&cells, 3, Notation { delimiter: b',', decimal: Decimal::Point })
        };
        for line in ["Scale factor,1,0.01,0.1", "Gain,0.01,0.1"] {
            assert!(told(line).is_some_and(|text| text.contains(line) && text.contains("\"scale\"")), "{line}");
        }
        for line in ["Scale factor,1,1,1", "Full scale,500,N", "Operator,1,0.01,0.1", "Gain"] {
            assert_eq!(told(line), None, "{line}");
        }
    }
}
