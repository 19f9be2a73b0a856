//! Probable meaning of the columns of a foreign table, guessed from names, units and ranges. It is always only a
//! proposal.

use crate::ui::column_mapping::facts::ColumnFacts;
use crate::ui::column_mapping::file_units::{FileUnit, spelled, spelled_for, unit_in};
use crate::ui::column_mapping::names::{Form, find};
use crate::ui::column_mapping::words::{Axis, Joint, Kind, Reading, read};
use estimator::log::PAIRS;
use estimator::log::units::{self, Dimension};
use estimator::log::written_units::{self, Written};

/// Proposal for one column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Guess {
    /// Program's name, in SI units; `None` for an extra channel.
    pub name: Option<String>,
    /// Unit of the file; `None` where there is none to choose.
    pub unit: Option<&'static FileUnit>,
    /// True if the name states the unit, false if it was inferred from the range.
    pub stated: bool,
}

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
    prefer_pairs(&mut candidates);
    let mut chosen = best_of_each(candidates);
    settle_forms(&mut chosen);
    columns
        .iter()
        .enumerate()
        .map(|(at, facts)| {
            let name = chosen.iter().find(|c| c.column == at).map(|c| c.name.clone());
            let (unit, stated) = unit_of(facts, name.as_deref());
            Guess { name, unit, stated }
        })
        .collect()
}

/// Unit of a column in the dimension of `name`, and true if the header states it. Otherwise it is inferred from the range.
pub fn unit_of(facts: &ColumnFacts, name: Option<&str>) -> (Option<&'static FileUnit>, bool) {
    let Some(dimension) = name.and_then(crate::ui::column_mapping::names::dimension) else {
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
        Dimension::Time => return Some(clock_unit(facts, reach)),
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

/// Unit of a clock: epochs by their magnitude in our century, counters by their steps.
fn clock_unit(facts: &ColumnFacts, reach: f64) -> &'static FileUnit {
    let step = facts.step.unwrap_or(0.0);
    let shown = match () {
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
    let kind = reading.kind?;
    if kind == Kind::Time {
        return facts.increasing.then(|| made("t_s".to_owned(), reading.points)).flatten();
    }
    if stated_otherwise(facts, kind) {
        return None;
    }
    let name = name_of(kind, reading)?;
    find(&name)?;
    made(name, reading.points)
}

/// True if the unit in the header measures something else.
fn stated_otherwise(facts: &ColumnFacts, kind: Kind) -> bool {
    let outside = spelled(&facts.stated_unit);
    outside.or_else(|| unit_in(&facts.header).1).is_some_and(|unit| !kind.dimensions().contains(&unit.dimension))
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
fn best_of_each(candidates: Vec<Candidate>) -> Vec<Candidate> {
    let mut chosen: Vec<Candidate> = Vec::new();
    for candidate in candidates {
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
    let angle = has("q_rad") && (!has("q_m") || (has("tau_Nm") && !has("f_N")));
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
