//! `--shard I/N`: the part of a run's pictures that one of several computers makes.

use std::str::FromStr;

/// Part `index` of `count`, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl FromStr for Shard {
    type Err = String;

    /// Reads `3/16`.
    fn from_str(text: &str) -> Result<Shard, String> {
        let number = |text: &str| text.trim().parse::<usize>().ok();
        let parts = text.split_once('/').and_then(|(i, n)| Some((number(i)?, number(n)?)));
        match parts {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Shard { index, count }),
            _ => Err("expected I/N with I from 1 to N, such as 3/16".into()),
        }
    }
}

impl Shard {
    /// Whether the frame in that place is this part's. Frames are dealt out in turn, like cards: frames
    /// grow heavier as a run goes on, and so every part gets light ones and heavy ones, and no part more
    /// than one frame more than another.
    pub fn takes(self, place: usize) -> bool {
        place % self.count == self.index - 1
    }

    /// `stats.json` as `stats-3-of-16.json`, so that parts do not write over one another.
    pub fn own(self, path: &std::path::Path) -> std::path::PathBuf {
        let part = |name: Option<&std::ffi::OsStr>| name.unwrap_or_default().to_string_lossy().into_owned();
        let (stem, ending) = (part(path.file_stem()), part(path.extension()));
        let dot = if ending.is_empty() { "" } else { "." };
        path.with_file_name(format!("{stem}-{}-of-{}{dot}{ending}", self.index, self.count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_is_in_one_part_and_parts_are_as_large_as_one_another() {
        for (frames, count) in [(100, 7), (5, 5), (3, 8), (1, 1)] {
            let shards: Vec<Shard> = (1..=count).map(|i| format!("{i}/{count}").parse().unwrap()).collect();
            let owners = |frame| shards.iter().filter(|shard| shard.takes(frame)).count();
            assert!((0..frames).all(|frame| owners(frame) == 1));
            let sizes = shards.iter().map(|shard| (0..frames).filter(|&frame| shard.takes(frame)).count());
            let (least, most) = (sizes.clone().min().unwrap(), sizes.max().unwrap());
            assert!(most - least <= 1, "{frames} frames for {count}: {least} to {most}");
        }
    }

    #[test]
    fn parts_are_counted_from_one() {
        for wrong in ["0/4", "5/4", "1", "1/0", "a/b", "-1/2", "1/2/3", ""] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
        let shard: Shard = "3/16".parse().unwrap();
        assert_eq!(shard.own("a/stats.json".as_ref()), std::path::Path::new("a/stats-3-of-16.json"));
    }
}
