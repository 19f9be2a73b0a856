//! Worlds by name or file: what stands after `--world`.

use anyhow::Context;
use haptics::recording::Task;
use haptics::world::presets::BUILT_IN;
use haptics::world::{Shape, World};
use std::path::Path;

/// The world of a file, or the built-in one of that name. A file that is there comes first.
pub fn find(name: &Path) -> anyhow::Result<World> {
    let built_in = name.to_str().and_then(|text| BUILT_IN.iter().find(|(known, _)| *known == text));
    match built_in {
        Some((_, make)) if !name.is_file() => Ok(make()),
        _ if name.exists() => World::load(name).with_context(|| name.display().to_string()),
        _ => {
            let names = BUILT_IN.map(|(known, _)| known).join(", ");
            anyhow::bail!("there is no world `{}`; name a world file, or one of {names}", name.display())
        }
    }
}

/// What a task needs and a world lacks, for people; `None` when it is there.
pub fn lacks(world: &World, task: Task) -> Option<&'static str> {
    let has_shape = |shape: Shape| world.blocks.iter().any(|block| block.shape == shape);
    let (there, what) = match task {
        Task::BlockStack => (world.blocks.iter().any(|b| b.shape.is_carried() && b.guide.is_none()), "blocks"),
        Task::Crank => (world.crank.is_some(), "crank"),
        Task::Needle => (world.membrane.is_some() && has_shape(Shape::Needle), "needle with a sheet to pierce"),
        Task::Barrel => (has_shape(Shape::Barrel), "barrel"),
        Task::Switch => (world.switch.is_some(), "switch"),
        Task::Mechanism => (world.mechanism.is_some(), "mechanism"),
        // A payload is measured, not practised.
        Task::Payload => (false, "sensor with a load; measure one and fit it"),
    };
    (!there).then_some(what)
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::world::presets;
    use std::path::PathBuf;

    fn file_of(name: &str) -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/worlds").join(format!("{name}.json"))
    }

    /// `TOUCHSTONE_WRITE_WORLDS=1 cargo test -p app worlds` writes the files anew after a preset was changed.
    #[test]
    fn the_files_are_the_built_in_worlds() {
        assert_eq!(BUILT_IN.len(), presets::all().len());
        for (name, make) in BUILT_IN {
            let (world, file) = (make(), file_of(name));
            if std::env::var_os("TOUCHSTONE_WRITE_WORLDS").is_some() {
                std::fs::write(&file, world.to_json() + "\n").expect("assets can be written");
            }
            let read = World::load(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
            assert_eq!(read, world, "{}", file.display());
            assert_eq!(find(Path::new(name)).expect("built in"), find(&file).expect("a file"));
        }
    }

    #[test]
    fn unknown_worlds_are_answered_with_all_names() {
        let error = find(Path::new("moon")).expect_err("no such world").to_string();
        assert!(BUILT_IN.iter().all(|(name, _)| error.contains(name)) && error.contains("moon"), "{error}");
        let folder = find(&std::env::temp_dir()).expect_err("a folder is no world");
        assert!(!format!("{folder:#}").contains("there is no world"), "{folder:#}");
    }

    #[test]
    fn a_world_lacks_the_tasks_it_was_not_made_for() {
        let made_for = [
            ("stack", Task::BlockStack),
            ("crank", Task::Crank),
            ("needle", Task::Needle),
            ("barrel", Task::Barrel),
            ("switch", Task::Switch),
        ];
        for (name, make) in BUILT_IN {
            for task in Task::ALL {
                let fits = lacks(&make(), task).is_none();
                assert_eq!(fits, made_for.contains(&(name, task)), "{task:?} in {name}");
            }
        }
    }
}
