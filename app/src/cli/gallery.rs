//! `touchstone gallery`: every panel and scene as pictures, with a page that shows them.

use super::{Output, progress};
use crate::ui::headless::gallery::plates;
use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use std::path::PathBuf;

/// Arguments of `gallery`.
#[derive(Args)]
pub struct Gallery {
    /// Folder for the pictures and their page
    #[arg(long, default_value = "docs/gallery")]
    out: PathBuf,
    /// Only pictures whose names begin like this; the page stays as it is
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
}

/// What `gallery --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// The folder.
    out: PathBuf,
    /// How many pictures were drawn.
    pictures: usize,
    /// Their size together.
    bytes: usize,
}

impl Gallery {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let only = self.only.as_deref();
        let drawn = progress::during("drawing", |share| plates::write_to(&self.out, only, |done| share.tell(done)));
        let (pictures, bytes) = drawn?;
        anyhow::ensure!(pictures > 0, "there is no picture whose name begins with `{}`", only.unwrap_or_default());
        let megabytes = bytes as f64 / 1e6;
        let text = format!("{pictures} pictures, {megabytes:.1} MB, in {}", self.out.display());
        let said = Said { out: self.out.clone(), pictures, bytes };
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }
}
