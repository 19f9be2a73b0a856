//! Opens the window: `cargo run -p app --example ui -- [LOG]`.

fn main() -> anyhow::Result<()> {
    let log = std::env::args().nth(1).map(Into::into);
    let dark = std::env::var("TOUCHSTONE_DARK").ok().map(|v| v == "1");
    app::ui::run(app::ui::RunOptions { log, dark, ..Default::default() })
}
