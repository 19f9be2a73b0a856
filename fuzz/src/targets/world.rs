//! Any bytes as a world: refused in one line, or a world that can be touched.

use haptics::device::{ScriptedOperator, Skill};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, World};

const TICKS: usize = 50;

pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match World::from_json(text) {
        Err(error) => assert!(!error.to_string().contains('\n')),
        Ok(world) => {
            let operator = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 1);
            let mut body = Loop::new(Swap::new(world), Box::new(operator), Limits::default());
            for _ in 0..TICKS {
                let tick = body.tick(1e-3);
                assert!(tick.sent_force_n.iter().all(|force| force.norm() <= Limits::default().max_force_n + 1e-9));
            }
        }
    }
}
