//! Where pictures go: one file, a number pattern, or a directory.

use std::path::{Path, PathBuf};

use crate::image_file::Format;
use crate::io_error::describe;

/// What `--out`, or another flag, names.
#[derive(Clone, Debug, PartialEq)]
pub enum Output {
    One(PathBuf),
    /// `before{:0width}after` in a folder
    Numbered {
        folder: PathBuf,
        before: String,
        width: usize,
        after: String,
    },
    /// Takes `frame-0000.png` and so on.
    Directory(PathBuf),
}

impl Output {
    /// Understands what `path` says for `frames` pictures in one of `formats`: a pattern where its name
    /// holds `{}`, `{:4}` or `{:04}`; a directory where there is one, or where the name has no ending or closes
    /// with a slash.
    ///
    /// # Errors
    /// The path, and why it does not do.
    pub fn new(path: &Path, frames: usize, formats: &[Format]) -> Result<Output, String> {
        let wrong = |what: &str| format!("{}: {what}", path.display());
        let text = path.to_string_lossy();
        if path.is_dir() || path.extension().is_none() || text.ends_with(['/', std::path::MAIN_SEPARATOR]) {
            return Ok(Output::Directory(path.to_owned()));
        }
        if !Format::of(path).is_some_and(|format| formats.contains(&format)) {
            let endings: Vec<&str> = formats.iter().map(|format| format.ending()).collect();
            return Err(wrong(&format!("a picture's name ends in {}", endings.join(" or "))));
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if let Some((before, rest)) = name.split_once('{') {
            let parts = rest.split_once('}').filter(|(_, after)| !after.contains(['{', '}']));
            let parts = parts.and_then(|(number, after)| Some((width(number)?, after)));
            let (width, after) = parts.ok_or_else(|| wrong("a number pattern looks like out-{:04}.png"))?;
            let folder = path.parent().map(Path::to_owned).unwrap_or_default();
            let (before, after) = (before.to_owned(), after.to_owned());
            return Ok(Output::Numbered { folder, before, width, after });
        }
        if frames > 1 {
            let what = "frames need a number pattern, such as out-{:04}.png, or a directory";
            return Err(wrong(&format!("{frames} {what}")));
        }
        Ok(Output::One(path.to_owned()))
    }

    /// The file of the frame with that number.
    pub fn path(&self, number: usize) -> PathBuf {
        match self {
            Output::One(path) => path.clone(),
            Output::Numbered { folder, before, width, after } => {
                folder.join(format!("{before}{number:0width$}{after}"))
            }
            Output::Directory(folder) => folder.join(format!("frame-{number:04}.png")),
        }
    }

    /// The format of all its files.
    pub fn format(&self) -> Option<Format> {
        Format::of(&self.path(0))
    }

    /// Makes the directory, if it is one and is not there.
    pub fn prepare(&self) -> anyhow::Result<()> {
        let Output::Directory(folder) = self else {
            return Ok(());
        };
        std::fs::create_dir_all(folder)
            .map_err(|error| anyhow::anyhow!("{}: cannot be made: {}", folder.display(), describe(&error)))
    }
}

/// Digits that the inside of `{...}` asks for.
fn width(inside: &str) -> Option<usize> {
    match inside.strip_prefix(':') {
        None => inside.is_empty().then_some(0),
        Some(digits) => digits.parse().ok().filter(|width| *width <= 20),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output(path: &str, frames: usize) -> Result<Output, String> {
        Output::new(Path::new(path), frames, &[Format::Png, Format::Exr])
    }

    #[test]
    fn patterns_and_directories_number_their_files() {
        let path = |text, frames| output(text, frames).map(|output| output.path(7)).unwrap();
        assert_eq!(path("a/out-{:04}.png", 3), Path::new("a/out-0007.png"));
        assert_eq!(path("{}.exr", 1), Path::new("7.exr"));
        assert_eq!(path("pictures", 3), Path::new("pictures/frame-0007.png"));
        assert_eq!(path("pictures.d/", 3), Path::new("pictures.d/frame-0007.png"));
        assert_eq!(path("one.png", 1), Path::new("one.png"));
        assert_eq!(path("{a}/one.png", 1), Path::new("{a}/one.png"), "only names are patterns");
    }

    #[test]
    fn what_cannot_be_numbered_is_told() {
        for (wrong, frames) in [("one.png", 2), ("a.jpg", 1), ("a{.png", 1), ("a{x}.png", 1), ("{}{}.png", 2)]
        {
            assert!(output(wrong, frames).is_err(), "{wrong}");
        }
        let only_png = Output::new(Path::new("a.exr"), 1, &[Format::Png]).unwrap_err();
        assert_eq!(only_png, "a.exr: a picture's name ends in .png");
    }
}
