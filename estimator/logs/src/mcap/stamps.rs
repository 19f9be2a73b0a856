//! Times in the messages, and rows whose time does not run on.

use super::names;
use super::topic::Topic;
use crate::origin::since_1970_ns;
use crate::plan::is_like_a_clock;
use crate::raw::Cells;

/// Fields of a stamp in a message: seconds and nanoseconds (ROS, Foxglove's schemas in JSON and in protobuf).
const STAMPS: [(&str, &str); 8] = [
    ("header.stamp.sec", "header.stamp.nanosec"),
    ("header.stamp.sec", "header.stamp.nsec"),
    ("header.stamp.secs", "header.stamp.nsecs"),
    ("timestamp.sec", "timestamp.nsec"),
    ("timestamp.seconds", "timestamp.nanos"),
    ("stamp.sec", "stamp.nanosec"),
    ("stamp.sec", "stamp.nsec"),
    ("stamp.secs", "stamp.nsecs"),
];
/// Share of the messages that may be left out because their time does not run on; a clock that is off more often is none.
const MAX_STRAY: f64 = 0.02;
/// Stray messages that are named.
const SHOWN: usize = 3;

/// True for a field of a stamp.
pub fn is_stamp(field: &str) -> bool {
    STAMPS.iter().any(|(seconds, nanos)| field == *seconds || field == *nanos)
}

/// The stamps of the messages, ns, if every message has one.
pub fn raw(topic: &Topic) -> Option<Vec<i64>> {
    let (seconds, nanos) = fields(topic)?;
    let (Some(Cells::Numbers(s)), Some(Cells::Numbers(n))) = (topic.find(seconds), topic.find(nanos)) else {
        return None;
    };
    // Whole numbers below 2^53 are exact.
    let both = s.iter().zip(n).map(|(s, n)| {
        let whole = s.fract() == 0.0 && n.fract() == 0.0 && s.abs() < 9e9 && (0.0..1e9).contains(n);
        whole.then(|| *s as i64 * 1_000_000_000 + *n as i64)
    });
    both.collect()
}

fn fields(topic: &Topic) -> Option<(&'static str, &'static str)> {
    let numbers = |field: &str| matches!(topic.find(field), Some(Cells::Numbers(_)));
    STAMPS.into_iter().find(|(seconds, nanos)| numbers(seconds) && numbers(nanos))
}

/// The stamps; their fields are taken out of the columns. `is_asked`: true for a field that the sidecar names.
pub fn take(topic: &mut Topic, is_asked: &dyn Fn(&str) -> bool) -> Option<Vec<i64>> {
    let stamps = raw(topic);
    if let Some((seconds, nanos)) = fields(topic) {
        topic.forget(|field| field == seconds || field == nanos);
        return stamps;
    }
    let (field, stamps) = in_one_field(topic).filter(|(field, _)| time_column(topic).is_none() && !is_asked(field))?;
    topic.forget(|other| other == field);
    Some(stamps)
}

/// A field that is called a time and counts since 1970 in every message, and its stamps, ns.
fn in_one_field(topic: &Topic) -> Option<(String, Vec<i64>)> {
    let is_called_a_time = |field: &str| {
        let name = field.rsplit('.').next().unwrap_or(field);
        // These are clocks of the log format.
        let is_known = names::time_factor(field).is_some() || matches!(field, "time_s" | "timestamp_s");
        !is_known && (is_like_a_clock(name) || name == "stamp")
    };
    topic.fields.iter().zip(&topic.columns).filter(|(field, _)| is_called_a_time(field)).find_map(|(field, cells)| {
        let Cells::Numbers(values) = cells else { return None };
        Some((field.clone(), since_1970_ns(values)?))
    })
}

/// The column that is a time of the program.
pub fn time_column(topic: &Topic) -> Option<&Cells> {
    let at = topic.fields.iter().position(|f| names::time_factor(f).is_some())?;
    Some(&topic.columns[at])
}

/// True if every value is above the one before.
pub fn is_increasing<T: PartialOrd>(values: &[T]) -> bool {
    values.windows(2).all(|w| w[0] < w[1])
}

/// A look at times that should run on.
pub enum Course {
    /// They do, in all rows.
    RunsOn,
    /// They do without a few rows: the ones to keep, and a sentence about the others.
    AllBut(Vec<usize>, String),
    /// They do not, and why.
    Stalls(String),
}

/// Looks at the times of rows, in ns.
pub fn course(times: &[i64], of: &str) -> Course {
    if is_increasing(times) {
        return Course::RunsOn;
    }
    let keep = longest_increasing(times);
    let stray = times.len() - keep.len();
    if keep.len() < 2 {
        return Course::Stalls(format!("{of} stands still"));
    }
    if stray as f64 > (MAX_STRAY * times.len() as f64).max(1.0) {
        return Course::Stalls(format!("{of} stands still or goes backwards in {stray} of {} messages", times.len()));
    }
    let mut kept = keep.iter().copied().peekable();
    let left: Vec<usize> = (0..times.len()).filter(|&row| kept.next_if_eq(&row).is_none()).collect();
    let shown: Vec<String> = left.iter().take(SHOWN).map(|row| (row + 1).to_string()).collect();
    let more = if left.len() > SHOWN { ", …" } else { "" };
    let is = if stray == 1 { "is" } else { "are" };
    let why = format!(
        "{stray} of {} messages {is} left out, because {of} repeats or goes back there: message {}{more}",
        times.len(),
        shown.join(", ")
    );
    Course::AllBut(keep, why)
}

/// Rows of the longest sequence that increases (Schensted 1961); of equal times the first one.
fn longest_increasing(times: &[i64]) -> Vec<usize> {
    // Last row of the best sequence of every length, and the row before each.
    let (mut ends, mut before): (Vec<usize>, Vec<Option<usize>>) = (Vec::new(), Vec::with_capacity(times.len()));
    for (row, &time) in times.iter().enumerate() {
        let length = ends.partition_point(|&end| times[end] < time);
        before.push(length.checked_sub(1).map(|l| ends[l]));
        match ends.get_mut(length) {
            None => ends.push(row),
            Some(end) if time < times[*end] => *end = row,
            Some(_) => {}
        }
    }
    let mut keep = Vec::with_capacity(ends.len());
    let mut next = ends.last().copied();
    while let Some(row) = next {
        keep.push(row);
        next = before[row];
    }
    keep.reverse();
    keep
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fewest_rows_are_left_out() {
        assert_eq!(longest_increasing(&[0, 10, 10, 20]), [0, 1, 3], "of equal times the first");
        assert_eq!(longest_increasing(&[0, 10, 900, 20, 30]), [0, 1, 3, 4], "one far ahead");
        assert_eq!(longest_increasing(&[5, 6, 0, 7]), [0, 1, 3], "one that goes back");
        assert_eq!(longest_increasing(&[3, 3, 3]), [0]);
        assert!(longest_increasing(&[]).is_empty());
    }

    #[test]
    fn a_clock_that_is_off_too_often_is_none() {
        let mut times: Vec<i64> = (0..100).collect();
        times[40] = times[39];
        assert!(
            matches!(course(&times, "the stamp"), Course::AllBut(keep, why) if keep.len() == 99 && why.contains("message 41"))
        );
        times[60..70].fill(0);
        assert!(matches!(course(&times, "the stamp"), Course::Stalls(why) if why.contains("11 of 100")));
        assert!(matches!(course(&[0; 5], "the stamp"), Course::Stalls(why) if why == "the stamp stands still"));
        assert!(matches!(course(&[1], "the stamp"), Course::RunsOn));
    }
}
