//! Cases of the battery at which the diagnosis once went wrong, and why. Each fails when what mended it is taken out.

use blind::{Counts, battery, score};
use estimator::diagnose::diagnose;

/// What is named in a case of the whole battery; its seed begins with the battery's.
fn named(case: u64) -> Vec<String> {
    let jobs = battery(Counts::WHOLE, case / 1_000_000);
    let job = jobs.iter().find(|j| j.seed == case).unwrap_or_else(|| panic!("the battery has no case {case}"));
    let (case, _) = job.make();
    let found = diagnose(&case.recordings, &score::options(&case)).expect("it can be diagnosed");
    found.causes.into_iter().map(|c| c.id).filter(|id| !id.starts_with("other:")).collect()
}

/// Where a handle sticks, the noise of its speed builds a bend of its own length up and takes it back: friction that is smaller there.
#[test]
fn a_bend_as_short_as_the_noise_of_the_way_is_not_felt() {
    for case in [2222007167, 2424007693, 2323007200] {
        assert!(named(case).is_empty(), "{case}: {:?}", named(case));
    }
}

/// A spring or an eccentric mass keeps the plain model from telling which of two angles is wrong; the other one then turns all forces.
#[test]
fn a_wrong_angle_of_one_link_is_no_turned_sensor() {
    assert_eq!(named(2424008204), ["joint-offset", "return-spring"]);
    assert_eq!(named(2424008218), ["joint-offset", "eccentric-mass"]);
}

/// A drift of the sensor and a weight that is lost, or a bias and friction by direction, each as large as one likes, take each other back.
#[test]
fn two_causes_that_take_each_other_back_are_not_named() {
    for case in [2424007559, 2525007692] {
        assert!(named(case).is_empty(), "{case}: {:?}", named(case));
    }
    assert_eq!(named(2424008105), ["inertia"]);
    assert_eq!(named(2424008295), ["coulomb-friction", "return-spring"]);
}

/// What is weak must show where it was not fitted, too (`gain::confirmed`).
#[test]
fn what_is_weak_and_shows_nowhere_else_is_not_named() {
    for case in [2424007340, 2424007782] {
        assert!(named(case).is_empty(), "{case}: {:?}", named(case));
    }
}

/// Its searched value was found beside a cause that is pruned, and is impossible without that one; a neighbour on the grid is not.
#[test]
fn a_cause_that_was_searched_for_beside_a_pruned_one_is_searched_for_again() {
    assert_eq!(named(2222007313), ["hysteresis"]);
}
