//! Export of a world to other simulators: MuJoCo's MJCF, URDF and SDF, each as far as it has a counterpart, with a list
//! of omissions.
//!
//! [`scene`] converts a world to rigid bodies on joints, in the frame of those programs; [`mjcf`], [`urdf`] and [`sdf`]
//! write it. Parameters come from the laws themselves, evaluated at chosen motions ([`joint`]).

mod frame;
mod joint;
mod mechanism;
mod mjcf;
mod scene;
mod sdf;
#[cfg(test)]
mod tests;
mod urdf;
mod xml;

use haptics::world::World;
use schemars::JsonSchema;
use serde::Serialize;

/// What a world can be exported to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize, clap::ValueEnum, strum::EnumIter)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// MuJoCo's own format
    Mjcf,
    /// Unified Robot Description Format
    Urdf,
    /// Simulation Description Format, as Gazebo reads it
    Sdf,
}

impl Format {
    /// Name for the user.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mjcf => "MuJoCo MJCF",
            Self::Urdf => "URDF",
            Self::Sdf => "SDF",
        }
    }

    /// Format of a file extension: `.xml` is MuJoCo's.
    pub fn of_ending(path: &std::path::Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "xml" | "mjcf" => Some(Self::Mjcf),
            "urdf" => Some(Self::Urdf),
            "sdf" | "world" => Some(Self::Sdf),
            _ => None,
        }
    }
}

/// How a part of a world went over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, JsonSchema, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fate {
    /// The format has the same.
    Kept,
    /// The format has something like it.
    Approximate,
    /// The format has nothing for it.
    LeftOut,
}

/// One line of what became of a world.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Remark {
    /// `block-1`, `crank`, `floor`, … as in the world.
    pub object: String,
    /// A law's id, or what of the object.
    pub what: String,
    /// Whether it went over.
    pub fate: Fate,
    /// As what it stands in the file, or why it does not, for people.
    pub how: String,
}

/// A world in another format.
#[derive(Clone, Debug)]
pub struct Exported {
    /// The file's text.
    pub text: String,
    /// Names of the movable bodies in the file.
    pub bodies: Vec<String>,
    /// Remarks on every part of the world.
    pub remarks: Vec<Remark>,
}

impl Exported {
    /// The remarks of one fate.
    pub fn of(&self, fate: Fate) -> impl Iterator<Item = &Remark> {
        self.remarks.iter().filter(move |remark| remark.fate == fate)
    }
}

/// Orientation of the world's plane in the file, as text for the file and the user.
pub const FRAME: &str =
    "x to the right and z up are this world's x and y; y points away from the viewer; lengths in m, SI throughout";

/// Writes a world in another format; `fingers` adds two fingertips on springs, if the format has motors for them.
pub fn export(world: &World, format: Format, fingers: bool) -> Exported {
    let mut scene = scene::of_world(world);
    let root = match format {
        Format::Mjcf => mjcf::write(world, &mut scene, fingers),
        Format::Urdf => urdf::write(world, &mut scene),
        Format::Sdf => sdf::write(world, &mut scene),
    };
    if fingers && format != Format::Mjcf {
        scene.remark("hand", "fingers", Fate::LeftOut, "only MJCF has motors with springs");
    }
    scene.remarks.sort_by_key(|remark| remark.fate);
    let text = xml::document(&root, &heading(world, format, &scene.remarks));
    Exported { text, bodies: scene.bodies.into_iter().map(|body| body.name).collect(), remarks: scene.remarks }
}

/// The comment at the top of the file.
fn heading(world: &World, format: Format, remarks: &[Remark]) -> Vec<String> {
    let mut lines = vec![
        format!("{} as {}, written by Touchstone {}", world.name, format.name(), env!("CARGO_PKG_VERSION")),
        format!("Frame: {FRAME}."),
    ];
    for (fate, title) in [
        (Fate::LeftOut, "Not in this file, because the format has nothing like it:"),
        (Fate::Approximate, "In this file as something like it:"),
    ] {
        let mut of_fate = remarks.iter().filter(|remark| remark.fate == fate).peekable();
        if of_fate.peek().is_some() {
            lines.push(title.to_owned());
        }
        lines.extend(of_fate.map(|remark| format!("  {}, {}: {}", remark.object, remark.what, remark.how)));
    }
    lines
}
