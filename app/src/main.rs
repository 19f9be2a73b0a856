//! `touchstone`: with no arguments the app, otherwise a command (see `touchstone --help`).

use std::process::ExitCode;

fn main() -> ExitCode {
    app::cli::main()
}
