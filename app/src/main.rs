use std::process::ExitCode;

fn main() -> ExitCode {
    sphcast::cli::run(std::env::args_os())
}
