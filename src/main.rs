//! The `dosmc` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    dosmc::cli::main()
}
