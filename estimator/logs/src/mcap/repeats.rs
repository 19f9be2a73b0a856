//! Messages of a topic that are there more than once, and publishers that talk at the same time.

use super::stamps;
use super::topic::Topic;
use crate::raw::Cells;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Leaves out every message that was there before with the same time and content; a sentence if there are any.
///
/// The time is the one in the message, or the log time where it has none. `clock` is the field that the sidecar takes
/// the time from.
pub fn count_once(topic: &mut Topic, clock: Option<&str>) -> Option<String> {
    let time = time(topic, clock)?;
    let mut first: HashMap<(u64, u64), usize> = HashMap::new();
    let mut keep = Vec::with_capacity(time.len());
    for (row, &at) in time.iter().enumerate() {
        let before = first.entry((at, content(topic, row))).or_insert(row);
        if *before == row || !are_equal(topic, *before, row) {
            keep.push(row);
        }
    }
    let (all, more) = (time.len(), time.len() - keep.len());
    if more == 0 {
        return None;
    }
    topic.keep(&keep);
    Some(format!("{more} of {all} messages are stored twice, with the same time and content, and count once"))
}

/// The time of every message, to the bit; none if no two messages can be equal in it, or if it does not tell them apart.
fn time(topic: &Topic, clock: Option<&str>) -> Option<Vec<u64>> {
    let column = clock.and_then(|field| topic.find(field)).or_else(|| stamps::time_column(topic));
    let own: Option<Vec<u64>> = match column {
        // Before anything is copied: most files are in order.
        Some(Cells::Numbers(values)) if stamps::is_increasing(values) => return None,
        Some(Cells::Numbers(values)) => Some(values.iter().map(|v| v.to_bits()).collect()),
        _ => stamps::raw(topic).map(|stamps| stamps.iter().map(|s| s.cast_unsigned()).collect()),
    };
    let tells = |time: &[u64]| time.iter().any(|t| Some(t) != time.first());
    match own.filter(|time| tells(time)) {
        Some(time) => (!stamps::is_increasing(&time)).then_some(time),
        None => (tells(&topic.log_ns) && !stamps::is_increasing(&topic.log_ns)).then(|| topic.log_ns.clone()),
    }
}

fn content(topic: &Topic, row: usize) -> u64 {
    let mut hasher = DefaultHasher::new();
    for cells in &topic.columns {
        match cells {
            Cells::Numbers(values) => values[row].to_bits().hash(&mut hasher),
            Cells::Text(texts) => texts[row].hash(&mut hasher),
        }
    }
    hasher.finish()
}

fn are_equal(topic: &Topic, one: usize, other: usize) -> bool {
    topic.columns.iter().all(|cells| match cells {
        Cells::Numbers(values) => values[one].to_bits() == values[other].to_bits(),
        Cells::Text(texts) => texts[one] == texts[other],
    })
}

/// Keeps one publisher where several talk at the same time: the one with the most messages. Publishers that follow each
/// other, as after a restart, are one recording. The sentence says what was left out.
pub fn one_publisher(topic: &mut Topic) -> Option<String> {
    let mut counts: Vec<(u16, usize)> = Vec::new();
    let mut turns = 0;
    for (row, channel) in topic.channels.iter().enumerate() {
        match counts.iter_mut().find(|(known, _)| known == channel) {
            Some((_, count)) => *count += 1,
            None => counts.push((*channel, 1)),
        }
        turns += usize::from(row > 0 && topic.channels[row - 1] != *channel);
    }
    // At a handover the last messages of one may come after the first of the next.
    if counts.len() < 2 || turns <= 2 * counts.len() {
        return None;
    }
    let most = counts.iter().map(|(_, count)| *count).max()?;
    let (kept, _) = *counts.iter().find(|(_, count)| *count == most)?;
    let keep: Vec<usize> = (0..topic.channels.len()).filter(|&row| topic.channels[row] == kept).collect();
    let (publishers, all) = (counts.len(), topic.channels.len());
    topic.keep(&keep);
    Some(format!(
        "it has {publishers} publishers that talk at the same time; the one with most messages is read, and {} of {all} messages are left out",
        all - keep.len()
    ))
}

#[cfg(test)]
mod tests {
    use super::super::topic::tests::topic;
    use super::*;

    #[test]
    fn equal_messages_count_once_and_held_values_stay() {
        let row = |t: &'static str, q: &'static str| [("t_s", t), ("q_m", q)];
        let rows = [row("0", "1"), row("0", "1"), row("1", "1"), row("2", "1"), row("1", "1"), row("2", "5")];
        let rows: Vec<&[(&str, &str)]> = rows.iter().map(<[_; 2]>::as_slice).collect();
        let mut twice = topic(&rows);
        let said = count_once(&mut twice, None).expect("two are there again");
        assert!(said.contains("2 of 6 messages"), "{said}");
        assert_eq!(twice.log_ns, [0, 2, 3, 5]);
        // The same values at other times, and without any clock at all.
        let held: &[(&str, &str)] = &[("q_m", "1")];
        let mut steady = topic(&[held, held, held]);
        assert_eq!(count_once(&mut steady, None), None);
        steady.log_ns = vec![7; 3];
        assert_eq!(count_once(&mut steady, None), None);
    }

    #[test]
    fn publishers_that_follow_each_other_are_joined_and_those_at_the_same_time_are_not() {
        let row: &[(&str, &str)] = &[("q_m", "1")];
        let mut follow = topic(&[row; 9]);
        follow.channels = vec![1, 1, 1, 1, 2, 1, 2, 2, 2];
        assert_eq!(one_publisher(&mut follow), None);
        let mut mixed = topic(&[row; 9]);
        mixed.channels = vec![1, 2, 1, 2, 1, 2, 1, 2, 2];
        let said = one_publisher(&mut mixed).expect("they are mixed");
        assert!(said.contains("2 publishers") && said.contains("4 of 9"), "{said}");
        assert_eq!(mixed.log_ns, [1, 3, 5, 7, 8]);
    }
}
