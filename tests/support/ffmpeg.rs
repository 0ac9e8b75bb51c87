//! The ffmpeg of this computer, where there is one, and what it finds in a film.

use std::path::Path;
use std::process::Command;

/// Whether there are `ffmpeg` and `ffprobe`.
pub fn is_there() -> bool {
    ["ffmpeg", "ffprobe"].iter().all(|program| Command::new(program).arg("-version").output().is_ok())
}

/// What it says of the film's only stream, as `key=value`.
pub fn facts(film: &Path) -> Vec<String> {
    let output = Command::new("ffprobe")
        .args(["-v", "error", "-count_frames", "-show_streams", "-of", "default=noprint_wrappers=1"])
        .arg(film)
        .output()
        .unwrap();
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

/// Red, green and blue of the pixels of every frame, 0 to 255.
pub fn frames(film: &Path, [width, height]: [usize; 2]) -> Vec<Vec<[f64; 3]>> {
    let output = Command::new("ffmpeg")
        .args(["-v", "error", "-i"])
        .arg(film)
        .args(["-sws_flags", "accurate_rnd+full_chroma_int", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"])
        .output()
        .unwrap();
    let pixels = |frame: &[u8]| frame.as_chunks::<3>().0.iter().map(|pixel| pixel.map(f64::from)).collect();
    output.stdout.chunks_exact(3 * width * height).map(pixels).collect()
}

/// Number of processes that were told to write to `folder`, and are not `sphcast`.
pub fn writers_in(folder: &Path) -> usize {
    let inside = format!("{}/.sphcast-", folder.display());
    let processes = std::fs::read_dir("/proc").unwrap().filter_map(|entry| Some(entry.ok()?.path()));
    let commands = processes.filter_map(|process| std::fs::read(process.join("cmdline")).ok());
    commands.filter(|command| String::from_utf8_lossy(command).contains(&inside)).count()
}
