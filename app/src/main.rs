use std::process::ExitCode;

fn main() -> ExitCode {
    quiet_mesa();
    sphcast::cli::run(std::env::args_os())
}

/// Where there is no desktop session, a layer of Mesa's Vulkan loader asks for one all the same and
/// writes an error that is not ours to standard error.
fn quiet_mesa() {
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // SAFETY: no other thread runs yet that could read the environment.
        unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    }
}
