//! The task of a world, in one line.

use haptics::world::{Shape, World};

/// One sentence about the first of crank, membrane, switch, barrel and blocks in the world.
pub fn task_hint(world: &World) -> &'static str {
    let has = |shape: Shape| world.blocks.iter().any(|block| block.shape == shape);
    if world.crank.is_some() {
        "Pinch the handle and turn the crank."
    } else if world.membrane.is_some() {
        "Pinch the needle, push it slowly through the cup, then pull it out."
    } else if world.switch.is_some() {
        "Push the knob over until it snaps, then back."
    } else if world.blocks.iter().any(|block| block.guide.is_some()) {
        "Pinch the slider and follow the slot to its ends."
    } else if has(Shape::Barrel) {
        "Pinch the barrel and lift it against its cable; too hard, and it breaks and leaks."
    } else {
        match world.blocks.len() {
            0 => "Nothing to do here: try the fingers on the table.",
            1 => "Pinch the block, lift it, and put it somewhere else.",
            _ => "Put the upper block on the table, then the lower one on top of it.",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::world::presets;

    #[test]
    fn every_built_in_world_has_a_line_of_its_own() {
        let lines: std::collections::BTreeSet<&str> = presets::all().iter().map(task_hint).collect();
        assert_eq!(lines.len(), presets::all().len());
        assert!(lines.iter().all(|line| line.ends_with('.') && line.len() < 90));
    }
}
