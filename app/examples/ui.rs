//! Opens the window: `cargo run -p app --example ui -- [LOG]`.
use app::ui::shell::run::{RunOptions, run};

fn main() -> anyhow::Result<()> {
    let log = std::env::args().nth(1).map(Into::into);
    let dark = std::env::var("TOUCHSTONE_DARK").ok().map(|v| v == "1");
    run(RunOptions { log, dark, ..Default::default() })
}
