//! Exports of Beckhoff's `TwinCAT` Scope: facts about the file, facts about each signal in pairs of cells, and pairs of time and
//! value. Layout: the package `pytcs`, which reads them.

use super::labview::Measurement;

/// Cells of a line.
fn cells(line: &str, delimiter: char) -> Vec<&str> {
    line.trim_end_matches('\r').split(delimiter).map(str::trim).collect()
}

/// The delimiter of such an export; none for another text.
fn delimiter(text: &str) -> Option<char> {
    let fact = text.lines().find_map(|line| line.strip_prefix("SampleTime[ms]"))?;
    fact.chars().next().filter(|_| text.starts_with("Name"))
}

/// True for the start of such an export.
pub fn is_scope(start: &[u8]) -> bool {
    start.starts_with(b"Name") && delimiter(&String::from_utf8_lossy(start)).is_some()
}

/// The signals as a table with tabs, a header, and a row of units. A clock that repeats the first one is left out. `None` for an
/// export without signals.
pub fn table(text: &[u8]) -> Option<Measurement> {
    let text = String::from_utf8_lossy(text);
    let delimiter = delimiter(&text)?;
    let lines: Vec<Vec<&str>> = text.lines().map(|line| cells(line, delimiter)).collect();
    let facts = lines.iter().position(|line| line[0] == "SampleTime[ms]")?;
    let header = lines[..facts].iter().rposition(|line| line[0] == "Name")?;
    let begins = facts + lines[facts..].iter().position(|line| line.iter().all(|cell| cell.is_empty()))?;
    let rows: Vec<&Vec<&str>> = lines[begins..].iter().filter(|line| line.len() > 1).collect();
    let of_signal = |name: &str, signal: usize| {
        let line = lines[header..begins].iter().find(|line| line[0] == name);
        line.and_then(|line| line.get(2 * signal + 1)).copied().unwrap_or_default()
    };
    let signals = lines[header].len() / 2;
    let has_own_clock = |signal: &usize| rows.iter().any(|row| row.get(2 * signal) != row.first());
    let (mut names, mut units, mut sources) = (vec!["time".to_owned()], vec!["(ms)".to_owned()], vec![0]);
    let mut clocks = Vec::new();
    for signal in 0..signals {
        let name = of_signal("Name", signal);
        if has_own_clock(&signal) {
            clocks.push((names.len() + 1, names.len()));
            names.push(format!("time_{name}"));
            units.push("(ms)".to_owned());
            sources.push(2 * signal);
        }
        // `mm (Length)`
        let unit = of_signal("Unit", signal).split(" (").next().filter(|unit| !["", "None"].contains(unit));
        names.push(name.to_owned());
        units.push(unit.map_or_else(String::new, |unit| format!("({unit})")));
        sources.push(2 * signal + 1);
    }
    let rows =
        rows.iter().map(|row| sources.iter().map(|k| row.get(*k).copied().unwrap_or_default()).collect::<Vec<_>>());
    let head = [names.join("\t"), units.join("\t")];
    let lines: Vec<String> = head.into_iter().chain(rows.map(|row| row.join("\t"))).collect();
    (signals > 0).then(|| Measurement { text: (lines.join("\n") + "\n").into_bytes(), clocks })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACTS: &str = "Name\tslide\nFile\tC:\\slide.csv\nStarttime of export\t132959733843760000\tMontag, 2. Mai 2022\n\n\
        Name\tPos\tName\tForce\nData-Type\tLREAL\tData-Type\tREAL32\nSampleTime[ms]\t5\tSampleTime[ms]\t20\n\
        Unit\tmm (Length)\tUnit\tNone\n\n";

    #[test]
    fn signals_share_a_clock_or_have_their_own() {
        let shared = format!("{FACTS}0\t-2,5\t0\t1\n5\t-2,4\t5\t2\n");
        assert!(is_scope(shared.as_bytes()) && !is_scope(b"Name\tslide\n1\t2\n"));
        let made = table(shared.as_bytes()).expect("signals");
        assert_eq!(String::from_utf8_lossy(&made.text), "time\tPos\tForce\n(ms)\t(mm)\t\n0\t-2,5\t1\n5\t-2,4\t2\n");
        assert!(made.clocks.is_empty());
        let made = table(format!("{FACTS}0\t-2,5\t0\t1\n5\t-2,4\t20\t2\n").as_bytes()).expect("signals");
        assert!(made.text.starts_with(b"time\tPos\ttime_Force\tForce\n(ms)\t(mm)\t(ms)\t\n"));
        assert_eq!(made.clocks, [(3, 2)]);
    }
}
