//! Object of a grasp, if the order alone cannot tell: one that was lost, left lying and fetched after another.

use super::grasps::Grasp;
use foundation::tasks::definition::Subtask;
use std::collections::BTreeMap;

/// The subtask of every run; none for attempts that failed. An object that was left and fetched later keeps its number, and those
/// after it move up.
pub(super) fn named(
    grasps: &[Grasp],
    steps: &[usize],
    order: &[Subtask],
    mut failed: Vec<bool>,
    warnings: &mut Vec<String>,
) -> Vec<Option<String>> {
    let holders: Vec<(usize, &Grasp)> =
        grasps.iter().map(|grasp| (order[steps[grasp.runs.end - 1]].object, grasp)).collect();
    let mut owner: BTreeMap<usize, usize> = BTreeMap::new();
    let mut taken: Vec<usize> = Vec::new();
    for (later, (object, grasp)) in holders.iter().enumerate() {
        let is_first = holders[..later].iter().all(|(other, _)| other != object);
        let left = holders[..later].iter().enumerate().rev().skip(1).find(|(at, (other, lost))| {
            let is_last = holders[at + 1..].iter().all(|(o, _)| o != other);
            other < object && *other > 0 && is_last && !taken.contains(other) && lost.left_for(grasp)
        });
        if let (true, Some((_, (lost, _)))) = (is_first, left) {
            taken.push(*lost);
            owner.insert(*object, *lost);
            warnings.push(format!(
                "object {lost} was lost, left lying and fetched after others, as its place and width say; only the last attempt counts"
            ));
            for (failed, step) in failed.iter_mut().zip(steps) {
                *failed |= order[*step].object == *lost;
            }
        }
        let again = holders[..later].iter().rev().find(|(_, put)| put.is_where_it_was_put(grasp));
        if let (true, Some((before, _))) = (is_first, again) {
            warnings.push(format!(
                "object {object} was taken from where object {before} had been put: it may be the same one"
            ));
        }
    }
    let number = |object: usize| match owner.get(&object) {
        Some(lost) => *lost,
        None => object - owner.keys().filter(|moved| **moved < object).count(),
    };
    steps.iter().zip(failed).map(|(step, failed)| (!failed).then(|| name(order, *step, &number)).flatten()).collect()
}

/// The name of a step when its object has another number.
fn name(order: &[Subtask], step: usize, number: &impl Fn(usize) -> usize) -> Option<String> {
    let left = |at: usize| order[at..].iter().take_while(|s| s.object == order[at].object).count();
    let object = number(order[step].object);
    let same = (0..order.len()).find(|at| order[*at].object == object && left(*at) == left(step));
    same.map(|at| order[at].name.clone())
}
