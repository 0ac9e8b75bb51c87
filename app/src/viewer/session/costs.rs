//! What the pictures drawn lately took, picture by picture.

use std::collections::VecDeque;
use std::fmt::Write;
use std::time::{Duration, Instant};

use crate::frames::Insertion;
use crate::viewer::render_thread::Shown;

/// What the time of a picture goes into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    Upload,
    Grid,
    Analysis,
    RayCast,
    Prepare,
    Other,
    /// In the background and ahead of the picture: no part of its total.
    Read,
}

impl Stage {
    pub const ALL: [Stage; 7] = [
        Stage::Upload,
        Stage::Grid,
        Stage::Analysis,
        Stage::RayCast,
        Stage::Prepare,
        Stage::Other,
        Stage::Read,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Stage::Upload => "Upload",
            Stage::Grid => "Grid",
            Stage::Analysis => "Analysis",
            Stage::RayCast => "Ray cast",
            Stage::Prepare => "Prepare",
            Stage::Other => "Other",
            Stage::Read => "Read",
        }
    }
}

/// One picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// When it came.
    pub at: Instant,
    /// Number of the frame that it shows.
    pub frame: usize,
    /// Whether it was drawn while something moved.
    pub moving: bool,
    /// Size at full resolution, in pixels, and what it was divided by.
    pub full: [u32; 2],
    pub divisor: u32,
    /// E_I that it was drawn with; `None` for full sampling.
    pub tolerance: Option<f64>,
    /// E_I of the view: smaller, where it was raised to keep a moving picture in time.
    pub wished: Option<f64>,
    /// The largest error that a pixel may have; `None` where all was sampled.
    pub predicted: Option<f64>,
    /// Kernel weights computed.
    pub evaluations: u64,
    /// Device memory that the renderer held.
    pub gpu_bytes: u64,
    milliseconds: [f64; Stage::ALL.len()],
}

impl Entry {
    /// Whether its E_I is larger than that of the view.
    pub fn is_raised(&self) -> bool {
        self.tolerance != self.wished
    }

    /// Milliseconds of a stage.
    pub fn of(&self, stage: Stage) -> f64 {
        self.milliseconds[stage as usize]
    }

    /// Milliseconds from the wish to the picture.
    pub fn total(&self) -> f64 {
        self.milliseconds.iter().sum::<f64>() - self.of(Stage::Read)
    }
}

/// The last pictures, the newest at the end.
#[derive(Clone, Debug, Default)]
pub struct Costs {
    entries: VecDeque<Entry>,
}

/// Over which pictures the rate is counted.
const RATED: Duration = Duration::from_secs(2);

impl Costs {
    /// Pictures that are remembered.
    pub const MOST: usize = 120;

    /// Takes note of a picture that came at `at`, whose frame took `reading` milliseconds to read. One that
    /// is shown again without having been drawn again is none.
    pub fn note(&mut self, at: Instant, shown: &Shown, reading: f64) {
        let Some(drawn) = shown.drawn else { return };
        let stats = &shown.stats;
        let times = &stats.milliseconds;
        let staged = times.upload + times.grid + times.analysis + times.ray_cast;
        let other = (drawn.milliseconds - drawn.preparing - staged).max(0.0);
        let milliseconds =
            [times.upload, times.grid, times.analysis, times.ray_cast, drawn.preparing, other, reading];
        if self.entries.len() == Costs::MOST {
            self.entries.pop_front();
        }
        self.entries.push_back(Entry {
            at,
            frame: shown.index,
            moving: drawn.moving,
            full: shown.full,
            divisor: shown.divisor,
            tolerance: shown.sampling.tolerance,
            wished: shown.wished,
            predicted: (!stats.is_in_full()).then_some(stats.predicted_error),
            evaluations: stats.evaluations.done,
            gpu_bytes: stats.gpu_bytes,
            milliseconds,
        });
    }

    pub(super) fn renumber(&mut self, insertion: &Insertion) {
        self.entries.iter_mut().for_each(|entry| entry.frame = insertion.moved(entry.frame));
    }

    pub fn entries(&self) -> impl DoubleEndedIterator<Item = &Entry> + ExactSizeIterator {
        self.entries.iter()
    }

    pub fn last(&self) -> Option<&Entry> {
        self.entries.back()
    }

    /// Pictures a second, while something moves: of the last two seconds, where there are some.
    pub fn rate(&self) -> Option<f64> {
        let last = self.last().filter(|last| last.moving)?;
        let recent = |entry: &&Entry| entry.moving && last.at.duration_since(entry.at) <= RATED;
        let (count, first) = self
            .entries
            .iter()
            .rev()
            .take_while(recent)
            .fold((0_u32, last.at), |(count, _), entry| (count + 1, entry.at));
        let seconds = last.at.duration_since(first).as_secs_f64();
        (seconds > 0.0).then(|| f64::from(count - 1) / seconds)
    }

    /// A table with a line for each picture, the oldest first; `seconds` count from that one on.
    pub fn to_csv(&self) -> String {
        let mut text = String::from(
            "seconds,frame,moving,width,height,divisor,tolerance,tolerance_at_rest,predicted_error,evaluations,gpu_bytes",
        );
        for stage in Stage::ALL {
            let _ = write!(text, ",{}_ms", stage.name().to_lowercase().replace(' ', "_"));
        }
        text.push_str(",total_ms\n");
        let begin = self.entries.front().map(|entry| entry.at);
        let optional = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
        for entry in &self.entries {
            let seconds = begin.map_or(0.0, |begin| entry.at.duration_since(begin).as_secs_f64());
            let Entry { frame, moving, full: [width, height], divisor, evaluations, gpu_bytes, .. } = entry;
            let [tolerance, wished, predicted] =
                [entry.tolerance, entry.wished, entry.predicted].map(optional);
            let _ = write!(
                text,
                "{seconds:.3},{frame},{},{width},{height},{divisor},{tolerance},{wished},{predicted},{evaluations},{gpu_bytes}",
                u8::from(*moving),
            );
            for milliseconds in entry.milliseconds {
                let _ = write!(text, ",{milliseconds:.3}");
            }
            let _ = writeln!(text, ",{:.3}", entry.total());
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use renderer::{Evaluations, Milliseconds, SamplingView, Stats};

    use super::*;
    use crate::viewer::render_thread::Drawn;
    use crate::viewer::render_thread::prepare::Facts;

    /// A picture that took 20 ms, of which 12 are those of the device.
    fn shown(moving: bool) -> Shown {
        let milliseconds =
            Milliseconds { upload: 1.0, grid: 2.0, analysis: 3.0, ray_cast: 6.0, ..Milliseconds::default() };
        let evaluations = Evaluations { done: 50, bounds: 10, ..Evaluations::default() };
        let stats = Stats { milliseconds, evaluations, predicted_error: 0.002, ..Stats::default() };
        Shown {
            index: 3,
            numbering: Default::default(),
            width: 1,
            height: 1,
            pixels: Vec::new(),
            full: [640, 400],
            divisor: 2,
            sampling: SamplingView::default(),
            wished: Some(0.001),
            stats,
            facts: Facts::default(),
            drawn: Some(Drawn { moving, preparing: 5.0, milliseconds: 20.0 }),
            cells: None,
            probed: None,
            shot: None,
        }
    }

    #[test]
    fn stages_make_up_what_a_picture_took_and_reading_comes_on_top() {
        let mut costs = Costs::default();
        costs.note(Instant::now(), &shown(true), 30.0);
        let entry = costs.last().unwrap();
        assert_eq!((entry.of(Stage::Prepare), entry.of(Stage::Other)), (5.0, 3.0));
        assert_eq!((entry.total(), entry.of(Stage::Read)), (20.0, 30.0));
        assert_eq!(entry.predicted, Some(0.002));
        let again = Shown { drawn: None, ..shown(true) };
        costs.note(Instant::now(), &again, 0.0);
        assert_eq!(costs.entries().len(), 1, "it is the same picture");
    }

    #[test]
    fn the_oldest_give_way() {
        let mut costs = Costs::default();
        for index in 0..Costs::MOST + 5 {
            costs.note(Instant::now(), &Shown { index, ..shown(true) }, 0.0);
        }
        assert_eq!(costs.entries().len(), Costs::MOST);
        assert_eq!(costs.entries().next().unwrap().frame, 5);
    }

    #[test]
    fn the_rate_is_that_of_moving_pictures_of_late() {
        let mut costs = Costs::default();
        let start = Instant::now();
        assert_eq!(costs.rate(), None);
        costs.note(start, &shown(true), 0.0);
        assert_eq!(costs.rate(), None, "one picture has no rate");
        // After a pause of a minute, ten pictures a second.
        for tenth in 0..50 {
            let at = start + Duration::from_secs(60) + Duration::from_millis(100 * tenth);
            costs.note(at, &shown(true), 0.0);
        }
        assert!((costs.rate().unwrap() - 10.0).abs() < 1e-9);
        costs.note(start + Duration::from_secs(70), &shown(false), 0.0);
        assert_eq!(costs.rate(), None, "at rest nothing follows");
    }

    #[test]
    fn the_table_has_a_line_for_each_picture() {
        let mut costs = Costs::default();
        let start = Instant::now();
        costs.note(start, &shown(true), 30.0);
        let mut full = shown(false);
        (full.sampling.tolerance, full.wished) = (None, None);
        full.stats.evaluations = Evaluations { full: 40, done: 40, ..Evaluations::default() };
        costs.note(start + Duration::from_millis(1500), &full, 0.0);
        assert_eq!(
            costs.to_csv(),
            "seconds,frame,moving,width,height,divisor,tolerance,tolerance_at_rest,predicted_error,evaluations,gpu_bytes,\
             upload_ms,grid_ms,analysis_ms,ray_cast_ms,prepare_ms,other_ms,read_ms,total_ms\n\
             0.000,3,1,640,400,2,0.004,0.001,0.002,50,0,1.000,2.000,3.000,6.000,5.000,3.000,30.000,20.000\n\
             1.500,3,0,640,400,2,,,,40,0,1.000,2.000,3.000,6.000,5.000,3.000,0.000,20.000\n"
        );
    }
}
