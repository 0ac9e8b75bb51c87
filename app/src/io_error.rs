//! What the operating system says, in words for users.

use std::io::{Error, ErrorKind};

/// What went wrong, without the error number, and without any path that the error may hold.
pub fn describe(error: &Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "no such file or directory".to_owned(),
        ErrorKind::PermissionDenied => "permission denied".to_owned(),
        // The words of what was not the system's error, such as text that is not UTF-8.
        _ if error.raw_os_error().is_none() => error.to_string(),
        kind => kind.to_string(),
    }
}
