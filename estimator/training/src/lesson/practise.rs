//! Lessons from measured worlds: tasks with the things that stand in them.

use super::format::{Base, Judged, Lesson, SCHEMA, Step};
use super::goal::{self, Goal, Rule};
use foundation::estimate::EstimateError;
use haptics::device::Act;
use haptics::world::{Block, Shape, World};

/// The id of such lessons.
pub const ID: &str = "practise-on-this";
/// A force of a finger above this is too large, N.
const LIMIT_N: f64 = 4.0;
/// Longest attempt, s.
const AT_MOST_S: f64 = 120.0;
/// A block that is nearer to the middle than this is carried to the right, m.
const MIDDLE_M: f64 = 0.008;
/// Position to which it is then carried, m to the right.
const ASIDE_M: f64 = 0.016;
/// Most that blocks may be beside their places, m.
const WITHIN_M: f64 = 0.005;
/// Height of a usual pad's face, m.
const FACE_M: f64 = 0.016;

/// A lesson in a world; its experts are still to be measured ([`super::expert::measure`]).
///
/// # Errors
/// No lesson is known for the things in the world.
pub fn on(mut world: World) -> Result<Lesson, EstimateError> {
    let (what, goals, demonstration, judged) = task_of(&world).ok_or_else(|| {
        super::format::wrong(
            "no lesson is known for what stands in this world; train in it without one, or write a lesson of your own",
        )
    })?;
    if world.pad.face_m == 0.0 && !world.blocks.is_empty() {
        // The measurement says nothing of the face, and no hand holds anything between two points.
        world.pad.face_m = FACE_M;
    }
    let rules = world.blocks.iter().filter(|b| b.wall.is_some_and(|w| w.strength_n.is_some())).map(whole).collect();
    let text = format!(
        "Your own object, as it was measured. {what}\n\nIt weighs, slides and gives as the recording says; what a recording cannot say is as usual.\n\n\
         *Experts are the scripted operator's: their figures were found in this very world.*"
    );
    let lesson = Lesson {
        schema: SCHEMA,
        id: ID.to_owned(),
        title: format!("Practise: {}", world.name),
        place: 0,
        goal: what,
        world: Base::Whole(Box::new(world)),
        changes: json_patch::Patch::default(),
        variants: Vec::new(),
        limit_n: LIMIT_N,
        at_most_s: AT_MOST_S,
        goals,
        rules,
        question: None,
        demonstration,
        judged,
        expert: None,
        expert_over: Vec::new(),
        text,
    };
    lesson.check()?;
    Ok(lesson)
}

type Parts = (String, Vec<Goal>, Vec<Step>, Vec<Judged>);

fn task_of(world: &World) -> Option<Parts> {
    if world.crank.is_some() {
        return Some(turned());
    }
    if world.membrane.is_some() && world.blocks.iter().any(|b| b.shape == Shape::Needle) {
        return Some(pierced());
    }
    if world.switch.is_some() {
        return Some(thrown());
    }
    let carried: Vec<&Block> = world.blocks.iter().filter(|b| b.shape.is_carried() && b.guide.is_none()).collect();
    match carried.as_slice() {
        [] => world.blocks.iter().find(|b| b.shape == Shape::Barrel).map(barrel_held_up),
        [one] => Some(block_held_up(one)),
        several => Some(moved(several)),
    }
}

fn goal_of(says: &str, kind: goal::Kind) -> Goal {
    Goal { says: says.to_owned(), kind }
}

fn step(says: &str, act: Act) -> Step {
    Step { says: says.to_owned(), act }
}

fn let_go() -> Goal {
    goal_of("Let go and take the fingers away", goal::Kind::LetGo)
}

/// The usual measures with more of them.
fn judged_with(more: &[(&str, f64)]) -> Vec<Judged> {
    let usual = [("completed_s", 3.0), ("rms_force_n", 2.0), ("path_length_m", 1.0)];
    let all = usual.iter().chain(more);
    all.map(|(measure, weight)| Judged { measure: (*measure).to_owned(), weight: *weight }).collect()
}

fn turned() -> Parts {
    let says = "Turn the crank three times counter-clockwise, at an even speed.";
    let turned = goal_of("Three turns counter-clockwise", goal::Kind::Turned { turns: 3.0 });
    let turn = step("Take the handle and turn it evenly", Act::Turn { turns: 3.15, turn_s: 2.0 });
    let judged = judged_with(&[("speed_variation", 2.0), ("off_tangent_j", 1.0)]);
    (says.into(), vec![turned, let_go()], vec![turn], judged)
}

fn pierced() -> Parts {
    let pierced = goal_of("Pierce the sheet", goal::Kind::Pierced { times: 1 });
    let act = step("Take the needle and push it through slowly", Act::Pierce { along_m: 0.0, beyond_m: 0.0005 });
    let judged = judged_with(&[("punctures.overshoot_m", 2.0), ("punctures.along_m", 1.0)]);
    ("Pierce the sheet in the middle and stop at once.".into(), vec![pierced], vec![act], judged)
}

fn thrown() -> Parts {
    let thrown = goal_of("Throw the switch four times", goal::Kind::Thrown { times: 4 });
    let act = step("Push until it snaps, then give way", Act::Throw { times: 4 });
    let parts = judged_with(&[("stop_force_n", 1.0), ("fell_back", 1.0)]);
    let judged = parts.into_iter().filter(|j| j.measure != "rms_force_n").collect();
    ("Throw the switch four times.".into(), vec![thrown, let_go()], vec![act], judged)
}

fn barrel_held_up(barrel: &Block) -> Parts {
    let kind = goal::Kind::HoldUp { block: barrel.name.clone(), above_m: 0.004, for_s: 2.0 };
    let act = Act::Lift { block: barrel.name.clone(), height_m: 0.010, seconds: 2.3 };
    let goals = vec![goal_of("Hold it up for 2 s", kind), let_go()];
    ("Lift it, hold it still, and put it back.".into(), goals, vec![step("Lift it and hold it", act)], judged_with(&[]))
}

fn block_held_up(block: &Block) -> Parts {
    let kind = goal::Kind::HoldUp { block: block.name.clone(), above_m: 0.010, for_s: 2.0 };
    let act = Act::Lift { block: block.name.clone(), height_m: 0.015, seconds: 2.3 };
    let goals = vec![goal_of("Hold it 10 mm up for 2 s", kind), let_go()];
    let says = "Lift the block, hold it still, and put it back.";
    (says.into(), goals, vec![step("Lift it and hold it", act)], judged_with(&[("drops", 2.0)]))
}

/// A tower goes to the other side, block by block; blocks that stand apart are put on each other.
fn moved(blocks: &[&Block]) -> Parts {
    let mut order = blocks.to_vec();
    order.sort_by(|a, b| b.start.center_m.y.total_cmp(&a.start.center_m.y));
    let base = |b: &Block| b.start.center_m.y - 0.5 * b.height_m;
    let lowest = order.iter().map(|b| base(b)).fold(f64::INFINITY, f64::min);
    let are_apart = order.iter().all(|b| base(b) < lowest + 0.5 * b.height_m);
    let (mut steps, mut names) = (Vec::new(), Vec::new());
    let aside_m = if are_apart {
        // The widest carries the others.
        order.sort_by(|a, b| b.width_m.total_cmp(&a.width_m));
        order[0].start.center_m.x
    } else {
        let from_m = order[0].start.center_m.x;
        if from_m.abs() < MIDDLE_M { ASIDE_M } else { -from_m }
    };
    for (place, block) in order.iter().enumerate() {
        let on: Option<String> = names.last().cloned();
        if !(are_apart && place == 0) {
            let act = Act::Carry { block: block.name.clone(), x_m: aside_m, on: on.clone() };
            let where_to = on.map_or("to the other side".to_owned(), |on| format!("on {on}"));
            steps.push(Step { says: format!("{} {where_to}", block.name), act });
        }
        names.push(block.name.clone());
    }
    let mut goals = Vec::new();
    if !are_apart {
        let kind = goal::Kind::At { block: names[0].clone(), x_m: aside_m, within_m: WITHIN_M };
        let side = if aside_m > 0.0 { "right" } else { "left" };
        goals.push(Goal {
            says: format!("{} stands {:.0} mm {side} of the middle", names[0], 1e3 * aside_m.abs()),
            kind,
        });
    }
    let tower = names.join(", then ");
    let kind = goal::Kind::Stacked { order: names, within_m: WITHIN_M };
    goals.push(Goal { says: format!("A tower from below: {tower}"), kind });
    goals.push(let_go());
    let what = if are_apart { "Stack the blocks." } else { "Move the tower to the other side, block by block." };
    (what.to_owned(), goals, steps, judged_with(&[("drops", 2.0), ("stacks.offset_m", 1.0)]))
}

fn whole(block: &Block) -> Rule {
    let says = format!("Do not break {}", block.name);
    Rule { says, kind: goal::Forbidden::Break { block: block.name.clone() } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lesson::expert;
    use haptics::world::presets;

    #[test]
    fn every_world_that_can_be_touched_becomes_a_lesson_that_an_expert_completes() {
        for world in [presets::stacking(), presets::crank(), presets::needle(), presets::switch(), presets::barrel()] {
            let name = world.name.clone();
            let lesson = on(world).unwrap_or_else(|e| panic!("{name}: {e}"));
            let expert = expert::measure(&lesson).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert!(expert.completed[0] + 2 >= expert.completed[1], "{name}: {:?}", expert.completed);
            assert!(lesson.title.contains(&name));
        }
        let why = on(presets::table()).expect_err("nothing stands there").to_string();
        assert!(why.contains("no lesson is known"), "{why}");
    }

    #[test]
    fn blocks_that_stand_apart_are_stacked_on_the_widest() {
        let mut world = presets::table();
        world.blocks = vec![
            Block::upright("small", 0.02, 0.012, 0.012, -0.018, -0.125),
            Block::upright("wide", 0.04, 0.024, 0.012, 0.012, -0.125),
        ];
        let lesson = on(world).expect("a lesson");
        let kind = lesson.goals.first().map(|g| g.kind.clone());
        let order = vec!["wide".to_owned(), "small".to_owned()];
        assert_eq!(kind, Some(goal::Kind::Stacked { order, within_m: WITHIN_M }));
        assert!(expert::measure(&lesson).is_ok());
    }
}
