//! `touchstone export`: a world for other simulators.

use super::Output;
use crate::export::{Fate, Format, Remark, export};
use anyhow::Context;
use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `export`.
#[derive(Args)]
pub struct Export {
    /// World file, or a built-in world: stack, crank, needle, barrel, switch, guide, table
    world: PathBuf,
    /// The other simulator's format
    #[arg(long)]
    to: Format,
    /// Where to write it
    #[arg(long)]
    out: PathBuf,
    /// Add two fingertips that can be led by motors (MJCF)
    #[arg(long)]
    fingers: bool,
}

/// What `export --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// The file that was written.
    out: PathBuf,
    /// Its format.
    to: Format,
    /// The world's name.
    world: String,
    /// Where the world's plane lies in the file.
    frame: &'static str,
    /// Names of the movable bodies in the file.
    bodies: Vec<String>,
    /// What became of every part of the world.
    parts: Vec<Remark>,
}

impl Export {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let world = crate::worlds::find(&self.world)?;
        let exported = export(&world, self.to, self.fingers);
        anyhow::ensure!(
            !exported.bodies.is_empty(),
            "nothing of the world {} has a counterpart in {}; export a world with blocks, a crank, a switch or a mechanism",
            self.world.display(),
            self.to.name()
        );
        haptics::text_file::write(&self.out, &exported.text).with_context(|| {
            format!("the file cannot be written; check its folder and permissions: {}", self.out.display())
        })?;
        let mut text = format!("{}: {} as {}\n", self.out.display(), exported.bodies.join(", "), self.to.name());
        let _ = writeln!(text, "  {}", crate::export::FRAME);
        for (fate, word) in [(Fate::LeftOut, "left out"), (Fate::Approximate, "approximate")] {
            for remark in exported.of(fate) {
                let _ = writeln!(text, "  {word:<11} {}, {}: {}", remark.object, remark.what, remark.how);
            }
        }
        let said = Said {
            out: self.out.clone(),
            to: self.to,
            world: world.name,
            frame: crate::export::FRAME,
            bodies: exported.bodies,
            parts: exported.remarks,
        };
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }
}
