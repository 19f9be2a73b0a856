//! Messages of one topic that fill different columns: two publishers of joint states, for instance, one of the arm and
//! one of the gripper. They share a topic and no row, so each kind is a source of its own.

use super::names;
use super::stamps::is_stamp;
use super::topic::Topic;
use crate::raw::{Cells, is_missing};
use std::collections::HashMap;

/// More kinds than this are no publishers.
const MAX_KINDS: usize = 16;

/// The topic as it is, or one topic for every kind of its messages. Kinds share no column but stamps and headers.
pub fn split(topic: Topic) -> Vec<Topic> {
    let gaps: Vec<usize> = (0..topic.columns.len()).filter(|&at| has_gap(&topic.columns[at])).collect();
    let shared = topic.fields.iter().enumerate().filter(|(at, _)| !gaps.contains(at));
    if gaps.is_empty() || !shared.clone().all(|(at, field)| is_common(field, &topic.columns[at])) {
        return vec![topic];
    }
    let Some(kinds) = kinds(&topic, &gaps) else { return vec![topic] };
    if kinds.len() < 2 || kinds.iter().any(|rows| rows.len() < 2) {
        return vec![topic];
    }
    kinds.iter().map(|rows| topic.part(rows)).collect()
}

fn has_gap(cells: &Cells) -> bool {
    match cells {
        Cells::Numbers(values) => values.iter().any(|&v| is_missing(v)),
        Cells::Text(texts) => texts.iter().any(str::is_empty) && texts.constant().is_none(),
    }
}

/// True for a column that says nothing about the kind of a message.
fn is_common(field: &str, cells: &Cells) -> bool {
    let constant = matches!(cells, Cells::Text(texts) if texts.constant().is_some());
    constant || is_stamp(field) || field.starts_with("header.") || names::time_factor(field).is_some()
}

/// Rows by kind: rows are of one kind if they fill a column in common, directly or through others. None where a row
/// fills no column, or where there are too many kinds.
fn kinds(topic: &Topic, gaps: &[usize]) -> Option<Vec<Vec<usize>>> {
    let mut masks: HashMap<Vec<u64>, usize> = HashMap::new();
    let mut of_row = Vec::with_capacity(topic.log_ns.len());
    for row in 0..topic.log_ns.len() {
        let mut mask = vec![0_u64; gaps.len().div_ceil(64)];
        for (bit, &at) in gaps.iter().enumerate() {
            let filled = match &topic.columns[at] {
                Cells::Numbers(values) => !is_missing(values[row]),
                Cells::Text(texts) => !texts[row].is_empty(),
            };
            mask[bit / 64] |= u64::from(filled) << (bit % 64);
        }
        if mask.iter().all(|&part| part == 0) {
            return None;
        }
        let next = masks.len();
        if next > MAX_KINDS * MAX_KINDS {
            return None;
        }
        of_row.push(*masks.entry(mask).or_insert(next));
    }
    let kind_of = joined(&masks);
    let count = kind_of.iter().max().map_or(0, |&last| last + 1);
    let mut kinds = vec![Vec::new(); count];
    for (row, mask) in of_row.into_iter().enumerate() {
        kinds[kind_of[mask]].push(row);
    }
    (count <= MAX_KINDS).then_some(kinds)
}

/// Number of the kind of every mask: masks with a bit in common are of one kind.
fn joined(masks: &HashMap<Vec<u64>, usize>) -> Vec<usize> {
    let mut by_number: Vec<(&Vec<u64>, usize)> = masks.iter().map(|(mask, &number)| (mask, number)).collect();
    by_number.sort_by_key(|(_, number)| *number);
    let mut kinds: Vec<(Vec<u64>, Vec<usize>)> = Vec::new();
    for (mask, number) in by_number {
        let meets = |kind: &Vec<u64>| kind.iter().zip(mask).any(|(a, b)| a & b != 0);
        let (met, others): (Vec<_>, Vec<_>) = kinds.into_iter().partition(|(kind, _)| meets(kind));
        let mut union = (mask.clone(), vec![number]);
        for (kind, members) in met {
            union.0.iter_mut().zip(&kind).for_each(|(a, b)| *a |= b);
            union.1.extend(members);
        }
        kinds = others;
        kinds.push(union);
    }
    kinds.sort_by_key(|(_, members)| members.iter().min().copied());
    let mut of = vec![0; masks.len()];
    for (kind, (_, members)) in kinds.iter().enumerate() {
        for &mask in members {
            of[mask] = kind;
        }
    }
    of
}

#[cfg(test)]
mod tests {
    use super::super::topic::tests::topic;
    use super::*;

    const ARM: &[(&str, &str)] = &[("header.frame_id", "base"), ("position[elbow]", "1"), ("velocity[elbow]", "2")];
    const ARM_AT_REST: &[(&str, &str)] = &[("header.frame_id", "base"), ("position[elbow]", "1")];
    const GRIPPER: &[(&str, &str)] = &[("header.frame_id", "base"), ("position[jaw]", "3")];

    #[test]
    fn messages_without_a_column_in_common_are_told_apart() {
        let parts = split(topic(&[ARM, GRIPPER, ARM_AT_REST, GRIPPER, ARM]));
        assert_eq!(parts.len(), 2);
        assert_eq!(parts[0].fields, ["header.frame_id", "position[elbow]", "velocity[elbow]"]);
        assert_eq!((&parts[0].log_ns, &parts[1].log_ns), (&vec![0, 2, 4], &vec![1, 3]));
    }

    #[test]
    fn rows_with_a_gap_stay_one_topic() {
        let both: &[(&str, &str)] = &[("position[elbow]", "1"), ("position[jaw]", "3")];
        assert_eq!(split(topic(&[ARM, GRIPPER, both, GRIPPER, ARM])).len(), 1);
        let number: &[(&str, &str)] = &[("q_m", "1"), ("oil_degC", "3")];
        let other: &[(&str, &str)] = &[("q_m", "1"), ("note", "a")];
        assert_eq!(split(topic(&[number, other, number, other])).len(), 1, "q_m is in both");
        let nothing: &[(&str, &str)] = &[("t_s", "1")];
        assert_eq!(split(topic(&[nothing, &[("t_s", "2"), ("q_m", "1")], nothing])).len(), 1);
    }
}
