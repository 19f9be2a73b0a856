//! `touchstone gallery`: every panel and scene as pictures, with a page that shows them.

use super::{Output, progress};
use crate::ui::gallery;
use clap::Args;
use serde_json::json;
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

impl Gallery {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let only = self.only.as_deref();
        let drawn = progress::during("drawing", |share| gallery::write_to(&self.out, only, |done| share.tell(done)));
        let (pictures, bytes) = drawn?;
        anyhow::ensure!(pictures > 0, "there is no picture whose name begins with `{}`", only.unwrap_or_default());
        let megabytes = bytes as f64 / 1e6;
        let text = format!("{pictures} pictures, {megabytes:.1} MB, in {}", self.out.display());
        Ok(Output { text, json: json!({ "out": self.out, "pictures": pictures, "bytes": bytes }) })
    }
}
