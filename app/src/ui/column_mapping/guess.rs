//! Probable meaning of the columns of a foreign table, guessed from names, units and ranges. It is always only a
//! proposal.

use crate::ui::column_mapping::facts::ColumnFacts;
use crate::ui::column_mapping::file_units::{FileUnit, spelled, spelled_for, unit_in};
use crate::ui::column_mapping::names::{Form, dimension, find};
use crate::ui::column_mapping::words::{Axis, Joint, Kind, Reading, read, words};
use estimator::log::units::{self, Dimension};
use estimator::log::written_units::{self, Written};
use estimator::log::{PAIRS, is_tick};

/// Proposal for one column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Guess {
    /// Program's name, in SI units; `None` for an extra channel.
    pub name: Option<String>,
    /// Unit of the file; `None` where there is none to choose.
    pub unit: Option<&'static FileUnit>,
    /// True if the name states the unit, false if it was inferred from the range.
    pub stated: bool,
    /// Another column that may have the same meaning.
    pub rival: Option<String>,
}

/// Whole numbers beyond this are counts rather than millimeters, degrees, or newtons.
const COUNTS: f64 = 1_000.0;
/// Whole numbers from which an index holds stamps since 1970, and no count of rows.
const EPOCHS: f64 = 1e9;
/// Points that a column loses if only the user can convert its unit.
const UNCONVERTED: i32 = 4;
/// Points of a column that has the program's own name.
const OWN_NAME: i32 = 1_000;

/// Possible name of a column, with points for its match.
#[derive(Clone, Debug)]
struct Candidate {
    column: usize,
    name: String,
    points: i32,
    words: Vec<String>,
}

/// Proposes a name and a unit for every column.
pub fn guess(columns: &[ColumnFacts]) -> Vec<Guess> {
    let readings: Vec<Reading> = columns.iter().map(|c| read(&c.with_unit())).collect();
    let mut candidates: Vec<Candidate> =
        columns.iter().enumerate().filter_map(|(at, facts)| candidate(at, facts, &readings[at])).collect();
    name_one_coordinate(&mut candidates, columns);
    prefer_pairs(&mut candidates);
    let mut chosen = best_of_each(&candidates);
    settle_forms(&mut chosen);
    // Columns of one dimension without units have the same one.
    let alike = |facts: &ColumnFacts, name: Option<&str>| {
        let wanted = name.and_then(dimension).filter(|wanted| *wanted != Dimension::Time);
        let is_alike = |c: &&Candidate| dimension(&c.name) == wanted && !unit_of(&columns[c.column], Some(&c.name)).1;
        let ranges = chosen.iter().filter(|_| wanted.is_some()).filter(is_alike);
        let ranges = ranges.filter_map(|c| columns[c.column].range).chain(facts.range);
        let range = ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        ColumnFacts { range, ..facts.clone() }
    };
    columns
        .iter()
        .enumerate()
        .map(|(at, facts)| {
            let name = chosen.iter().find(|c| c.column == at).map(|c| c.name.clone());
            let (unit, stated) = unit_of(&alike(facts, name.as_deref()), name.as_deref());
            let is_rival = |c: &&Candidate| c.column != at && name.as_ref() == Some(&c.name) && c.points < OWN_NAME;
            let rival = candidates.iter().find(is_rival).map(|c| columns[c.column].header.clone());
            Guess { name, unit, stated, rival }
        })
        .collect()
}

/// Unit of a column in the dimension of `name`, and true if the header states it. Otherwise it is inferred from the range.
pub fn unit_of(facts: &ColumnFacts, name: Option<&str>) -> (Option<&'static FileUnit>, bool) {
    let Some(dimension) = name.and_then(dimension) else {
        let stated = unit_in(&facts.header).1;
        return (stated, stated.is_some());
    };
    let text = facts.unit_text(dimension);
    match written_units::parse(text, &[dimension]) {
        // A unit that is not offered is the reader's to convert.
        Written::Known(found, _) if found == dimension => {
            (spelled_for(text, &[dimension]).filter(|unit| unit.dimension == dimension), true)
        }
        _ if text.is_empty() => (by_range(facts, dimension), false),
        // Only the user knows the factor of another unit.
        _ => (None, false),
    }
}

/// Unit that makes the values plausible for a hand and the objects it moves.
fn by_range(facts: &ColumnFacts, dimension: Dimension) -> Option<&'static FileUnit> {
    let reach = facts.range.map_or(0.0, |(low, high)| low.abs().max(high.abs()));
    let symbol = match dimension {
        Dimension::Time if counts_rows(facts) => return None,
        Dimension::Time => return Some(clock_unit(facts, reach)),
        // Whole numbers of no unit are counts.
        Dimension::Length | Dimension::Angle | Dimension::Force | Dimension::Torque
            if facts.whole && reach > COUNTS =>
        {
            return None;
        }
        // A workspace is at most a metre; values above 5000 are micrometres.
        Dimension::Length if reach > 5_000.0 => "um",
        Dimension::Length if reach > 5.0 => "mm",
        // A joint makes less than two turns.
        Dimension::Angle if reach > 4.0 * std::f64::consts::PI => "deg",
        Dimension::AngularVelocity if reach > 100.0 => "deg_s",
        Dimension::Velocity if reach > 20.0 => "mm_s",
        Dimension::Force if reach > 5_000.0 => "mN",
        Dimension::Torque if reach > 1_000.0 => "mNm",
        _ => return FileUnit::si(dimension),
    };
    FileUnit::of_symbol(symbol)
}

/// True for a clock that counts rows, or periods of an unknown length.
fn counts_rows(facts: &ColumnFacts) -> bool {
    facts.whole && facts.step == Some(1.0) && facts.range.is_some_and(|(low, _)| low == 0.0 || low == 1.0)
}

/// Unit of a clock: epochs by their magnitude in our century, counters by their steps.
fn clock_unit(facts: &ColumnFacts, reach: f64) -> &'static FileUnit {
    let step = facts.step.unwrap_or(0.0);
    let shown = match () {
        // The reader converts ticks of 100 ns itself.
        () if is_tick(reach) => "s",
        () if reach > 1e17 => "ns",
        () if reach > 1e14 => "µs",
        () if reach > 1e11 => "ms",
        () if reach > 1e9 && step < 1e3 => "s",
        () if facts.whole && step >= 1e5 => "ns",
        () if facts.whole && step >= 100.0 => "µs",
        () if facts.whole && step >= 1.0 => "ms",
        () => "s",
    };
    spelled(shown).unwrap_or(&crate::ui::column_mapping::file_units::FILE_UNITS[11])
}

fn candidate(column: usize, facts: &ColumnFacts, reading: &Reading) -> Option<Candidate> {
    let made = |name: String, points: i32| Some(Candidate { column, name, points, words: reading.words.clone() });
    // The program's own names, in any unit.
    if let Some((quantity, unit)) = units::split(&facts.header)
        && units::quantity_dimensions(quantity).is_some_and(|d| d.contains(&unit.dimension))
        && facts.numeric
    {
        return made(format!("{quantity}_{}", unit.si), OWN_NAME);
    }
    if facts.header == "trial" || facts.header == "label" {
        return made(facts.header.clone(), OWN_NAME);
    }
    if reading.kind == Some(Kind::Trial) && (facts.whole || !facts.numeric) && facts.distinct.is_some() {
        // A number that changes with every row is a sample counter.
        return (facts.changes < facts.distinct.as_ref().map_or(0, Vec::len).max(1))
            .then(|| made("trial".to_owned(), 5))
            .flatten();
    }
    if reading.kind == Some(Kind::Label) && !facts.numeric {
        return made("label".to_owned(), 5);
    }
    if !facts.numeric {
        return None;
    }
    // Whole numbers may count rows, but for stamps.
    let counts = facts.whole && facts.range.is_some_and(|(_, high)| high < EPOCHS);
    if reading.kind.is_none() && is_index(facts) && !counts {
        return facts.increasing.then(|| made("t_s".to_owned(), 0)).flatten();
    }
    let kind = reading.kind?;
    if kind == Kind::Time {
        return (facts.increasing && !is_fraction(facts)).then(|| made("t_s".to_owned(), reading.points)).flatten();
    }
    let name = name_of(kind, reading)?;
    find(&name)?;
    match stated_otherwise(facts, kind) {
        None => made(name, reading.points),
        // A sensor of force may state volts, which only the user can convert.
        Some(Dimension::Other) if kind == Kind::Force => made(name, reading.points - UNCONVERTED),
        Some(_) => None,
    }
}

/// True for the fraction of a second beside whole seconds: `nanosec`, `ms`.
fn is_fraction(facts: &ColumnFacts) -> bool {
    let text = facts.unit_text(Dimension::Time);
    let text = if text.is_empty() { &facts.header } else { text };
    let unit_s = match written_units::parse(text, &[Dimension::Time]) {
        Written::Known(Dimension::Time, unit_s) => unit_s,
        _ => 1.0,
    };
    facts.falls > 0 && facts.range.is_some_and(|(low, high)| low >= 0.0 && high * unit_s < 1.0)
}

/// True for a name that stands for the index of a data frame: `index`, `Unnamed: 0`, `column 1`.
fn is_index(facts: &ColumnFacts) -> bool {
    let is_place = |word: &String| word.bytes().all(|b| b.is_ascii_digit());
    words(&facts.header).iter().all(|word| is_place(word) || ["index", "unnamed", "column"].contains(&word.as_str()))
}

/// Dimension of the unit in the header if it measures something else.
fn stated_otherwise(facts: &ColumnFacts, kind: Kind) -> Option<Dimension> {
    let text = kind.dimensions().first().map_or("", |dimension| facts.unit_text(*dimension));
    match written_units::parse(text, kind.dimensions()) {
        Written::Known(dimension, _) => Some(dimension).filter(|found| !kind.dimensions().contains(found)),
        Written::Counts | Written::Unknown => None,
    }
}

/// Program's name for the reading of a header.
fn name_of(kind: Kind, reading: &Reading) -> Option<String> {
    let finger = match reading.finger {
        Some(1) => "1",
        Some(2) => "2",
        Some(_) => return None,
        None => "",
    };
    let axis = reading.axis.map(|axis| match axis {
        Axis::X => "x",
        Axis::Y => "y",
        Axis::Z => "z",
    });
    let joint = reading.joint.map(|joint| if joint == Joint::Bottom { "b" } else { "t" });
    let name = match (kind, axis, joint) {
        (Kind::Position, Some(axis), _) => format!("{axis}{finger}_m"),
        (Kind::Velocity, Some(axis), _) => format!("v{axis}{finger}_m_s"),
        (Kind::Force, Some(axis), _) => format!("f{axis}{finger}_N"),
        (Kind::Angle, None, Some(joint)) => format!("q{joint}{finger}_rad"),
        (Kind::AngularVelocity, None, Some(joint)) => format!("dq{joint}{finger}_rad_s"),
        _ if !finger.is_empty() => return None,
        (Kind::Position, None, _) => "q_m".to_owned(),
        (Kind::Velocity, None, _) => "dq_m_s".to_owned(),
        (Kind::Angle, None, None) => "q_rad".to_owned(),
        (Kind::AngularVelocity, None, None) => "dq_rad_s".to_owned(),
        (Kind::Force, None, _) => "f_N".to_owned(),
        (Kind::Torque, None, _) => "tau_Nm".to_owned(),
        _ => return None,
    };
    Some(name)
}

/// Beside a force without a direction, `q` is a length, and so is `x` without `y`. Beside a length without a direction, the only
/// component of a force is all of it.
fn name_one_coordinate(candidates: &mut [Candidate], columns: &[ColumnFacts]) {
    let is_component = |c: &Candidate| ["fx_N", "fy_N", "fz_N"].contains(&c.name.as_str()) && c.points < OWN_NAME;
    let has_any = |name: &str| candidates.iter().any(|c| c.name == name);
    if has_any("q_m") && !has_any("f_N") && candidates.iter().filter(|c| is_component(c)).count() == 1 {
        candidates.iter_mut().filter(|c| is_component(c)).for_each(|c| c.name = "f_N".into());
    }
    let has = |name: &str| candidates.iter().any(|c| c.name == name);
    if !has("f_N") || has("tau_Nm") || has("q_m") {
        return;
    }
    let is_one = |c: &Candidate| match c.name.as_str() {
        // These words stand for coordinates of either kind.
        "q_rad" => {
            let words = words(&columns[c.column].header);
            words.iter().all(|word| ["q", "encoder", "position", "pos", "count", "counts"].contains(&word.as_str()))
        }
        "x_m" => !has("y_m") && c.points < OWN_NAME,
        _ => false,
    };
    if let Some(at) = candidates.iter().position(is_one) {
        candidates[at].name = "q_m".into();
    }
}

/// Prefers pairs of coordinate and force of one place: `jaw_angle` with `jaw_torque`.
fn prefer_pairs(candidates: &mut [Candidate]) {
    let mates = [("q_m", "f_N"), ("q_rad", "tau_Nm")];
    let shared = |a: &Candidate, b: &Candidate| a.words.iter().filter(|w| b.words.contains(w)).count();
    for (motion, drive) in mates {
        let places =
            |name: &str| -> Vec<usize> { (0..candidates.len()).filter(|&i| candidates[i].name == name).collect() };
        let pairs = places(motion).into_iter().flat_map(|a| places(drive).into_iter().map(move |b| (a, b)));
        let mut best: Option<(usize, usize, usize)> = None;
        for (a, b) in pairs {
            let n = shared(&candidates[a], &candidates[b]);
            if n > best.map_or(0, |(n, ..)| n) {
                best = Some((n, a, b));
            }
        }
        if let Some((_, a, b)) = best {
            candidates[a].points += 1;
            candidates[b].points += 1;
        }
    }
}

/// One column per name: the one with the most points, the first of equals.
fn best_of_each(candidates: &[Candidate]) -> Vec<Candidate> {
    let mut chosen: Vec<Candidate> = Vec::new();
    for candidate in candidates.iter().cloned() {
        match chosen.iter_mut().find(|c| c.name == candidate.name) {
            Some(other) if candidate.points > other.points => *other = candidate,
            Some(_) => {}
            None => chosen.push(candidate),
        }
    }
    chosen
}

/// Reduces the choice to one complete form of recording, the richest present: tips, joints, tool, or coordinate.
fn settle_forms(chosen: &mut Vec<Candidate>) {
    // Half a vector is useless; columns that depended on it are dropped, too.
    loop {
        let has = |name: &str| chosen.iter().any(|c| c.name == name);
        let half: Vec<&str> = PAIRS
            .iter()
            .flat_map(|&(a, b)| [(a, b), (b, a)])
            .filter(|&(there, absent)| has(there) && !has(absent))
            .map(|(there, _)| there)
            .collect();
        if half.is_empty() {
            break;
        }
        chosen.retain(|c| !half.contains(&c.name.as_str()));
    }
    let has = |name: &str| chosen.iter().any(|c| c.name == name);
    let form = match () {
        () if has("x1_m") => Form::Tips,
        () if has("qb1_rad") => Form::Joints,
        () if has("x_m") || has("qb_rad") => Form::Tool,
        () => Form::Coordinate,
    };
    // One coordinate: the one whose force is present, otherwise the length.
    let turns = has("q_rad") || has("dq_rad_s");
    let angle = turns && (!(has("q_m") || has("dq_m_s")) || (has("tau_Nm") && !has("f_N")));
    let dropped: &[&str] = if angle { &["q_m", "dq_m_s", "f_N"] } else { &["q_rad", "dq_rad_s", "tau_Nm"] };
    chosen.retain(|c| {
        let of = find(&c.name).map_or(form, |n| n.form);
        // Joints of two fingers can have forces at the fingertips.
        let force = form == Form::Joints && of == Form::Tips && c.name.starts_with('f');
        let fits = of == Form::Any || of == form || force;
        // A column that has the program's own name stays as it is.
        c.points >= OWN_NAME || (fits && !dropped.contains(&c.name.as_str()))
    });
}
