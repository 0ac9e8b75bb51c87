//! What outlives the program: read when it starts, written soon after it changes and when it ends.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::Desk;
use crate::viewer::Wake;
use crate::viewer::kept::{self, Kept, LastSession, Recent, RecentRuns, Sessions, Settings, Writer};
use crate::viewer::render_thread::RenderThread;

/// What a session that was written is called.
const SESSION: &str = "session";
/// The least time between two writes of the session.
const PAUSE: Duration = Duration::from_secs(2);

pub struct Keeping {
    /// Ends before the lock of the session is given back.
    writer: Writer,
    pub settings: Settings,
    pub recent: RecentRuns,
    /// What was open before the program was started, and what is.
    pub sessions: Sessions,
    /// Size of letters and controls when it was last looked at.
    scale: f32,
    /// What the open run was opened by; empty for the demo, which needs no keeping.
    paths: Vec<PathBuf>,
    /// What the files hold.
    written: (Settings, Option<LastSession>),
    /// Whether the session is being written.
    writing: bool,
    /// When the session may be written next.
    next: Instant,
}

impl Keeping {
    /// Reads what was kept. Also returns what is wrong with it.
    pub fn read(writer: Writer) -> (Keeping, Vec<String>) {
        let mut troubles = Vec::new();
        let settings = kept_or_default::<Settings>(&mut troubles);
        let recent = kept_or_default(&mut troubles);
        let (sessions, more) = Sessions::read();
        troubles.extend(more);
        let written = (settings.clone(), None);
        let paths = Vec::new();
        let (scale, next) = (1.0, Instant::now());
        let keeping =
            Keeping { writer, settings, recent, sessions, scale, paths, written, writing: false, next };
        (keeping, troubles)
    }

    /// Gives letters and controls their size, and takes note of another one that the keyboard has given
    /// them: Ctrl with plus, minus or 0.
    pub(super) fn follow_scale(&mut self, context: &egui::Context) {
        let scale = context.zoom_factor();
        if scale != self.scale {
            self.settings.scale = scale;
        } else if scale != self.settings.usable_scale() {
            context.set_zoom_factor(self.settings.usable_scale());
        }
        self.scale = scale;
    }

    /// Changes the list of runs here and in its file.
    fn change_recent(&mut self, change: impl Fn(&mut RecentRuns) + Send + 'static) {
        change(&mut self.recent);
        self.writer.change(RecentRuns::FILE, move || RecentRuns::change(change));
    }

    /// Writes the settings, if they have changed since they were last written.
    fn keep_settings(&mut self) {
        if self.settings != self.written.0 {
            self.written.0 = self.settings.clone();
            let settings = self.settings.clone();
            self.writer.put(Settings::FILE, move || settings.write());
        }
    }
}

fn kept_or_default<T: Kept + Default>(troubles: &mut Vec<String>) -> T {
    match T::read() {
        Ok(kept) => kept.unwrap_or_default(),
        Err(error) => {
            troubles.push(format!("{error:#}"));
            T::default()
        }
    }
}

impl Desk {
    /// Takes note of a run that was opened.
    pub(super) fn opened(&mut self, paths: &[PathBuf]) {
        let is_demo = paths.is_empty() || paths == [Path::new("demo")];
        self.keeping.paths =
            if is_demo { Vec::new() } else { paths.iter().map(|path| lasting(path)).collect() };
        self.start = false;
        if is_demo {
            return;
        }
        let title = self.session.run().map_or_else(String::new, |run| run.title.clone());
        let frames = self.session.playback.count();
        let run = Recent { paths: self.keeping.paths.clone(), title, frames, when: kept::now() };
        self.keeping.change_recent(move |recent| recent.add(run.clone()));
    }

    /// Removes a run from the list of those that were open.
    pub(in crate::viewer) fn forget(&mut self, paths: &[PathBuf]) {
        let paths = paths.to_vec();
        self.keeping.change_recent(move |recent| recent.remove(&paths));
    }

    /// Opens again what was left behind as `index`.
    pub(in crate::viewer) fn restore(&mut self, index: usize) {
        let left = self.keeping.sessions.left[index].clone();
        self.find_for(left.session.paths.clone(), Some(Box::new(left)));
    }

    /// Writes what has changed since it was last written; the session, no more often than it must be.
    pub(super) fn keep(&mut self, now: Instant) {
        self.keeping.keep_settings();
        let (Some(session), Some(file)) = (self.to_be_kept(false), self.keeping.sessions.file()) else {
            return;
        };
        let written = self.keeping.written.1.as_ref();
        if written.is_some_and(|written| written.is_like(&session)) {
            return;
        }
        if self.keeping.writing || now < self.keeping.next {
            self.due = [self.due, Some(self.keeping.next)].into_iter().flatten().min();
            return;
        }
        self.keeping.next = now + PAUSE;
        self.keeping.written.1 = Some(session.clone());
        self.keeping.writing = true;
        self.keeping.writer.put(SESSION, move || kept::write(&file, &session));
    }

    /// Ends exports, so that no half file is left, and writes settings and session for the last time. Nobody is
    /// left to tell where this fails.
    pub fn close(&mut self) {
        self.exporting.queue.end();
        self.keeping.keep_settings();
        if let (Some(session), Some(file)) = (self.to_be_kept(true), self.keeping.sessions.file()) {
            self.keeping.writer.put(SESSION, move || kept::write(&file, &session));
        }
        self.keeping.writer.end();
    }

    fn to_be_kept(&self, ended: bool) -> Option<LastSession> {
        if self.keeping.paths.is_empty() {
            return None;
        }
        Some(LastSession {
            paths: self.keeping.paths.clone(),
            title: self.session.run()?.title.clone(),
            frame: self.session.playback.index(),
            view: self.session.complete_view(),
            fits_window: Some(self.session.fits_window),
            when: kept::now(),
            ended,
        })
    }

    pub(super) fn written(&mut self, file: &str, result: anyhow::Result<()>) {
        self.keeping.writing &= file != SESSION;
        match result {
            Ok(()) => {
                if let (SESSION, Some(session)) = (file, &self.keeping.written.1) {
                    self.keeping.sessions.saved(&session.paths);
                }
                self.session.log(format!("kept {file}"));
            }
            Err(error) => self.session.messages.warn(format!("{error:#}")),
        }
    }

    /// Goes on with the device and the memory that the settings ask for.
    pub(in crate::viewer) fn apply_settings(&mut self) {
        self.session.limit_frames(self.keeping.settings.frame_cache());
        let gpu = self.keeping.settings.gpu(&self.given_gpu);
        if (&gpu.preferred, gpu.memory) != (&self.gpu.preferred, self.gpu.memory) {
            self.gpu = gpu.clone();
            let before =
                std::mem::replace(&mut self.render, RenderThread::spawn(gpu, Wake::clone(&self.wake)));
            // Ending it waits for the picture in work.
            std::thread::spawn(move || drop(before));
            self.session.adapter = None;
            self.session.ask_again();
        }
    }
}

/// A path that means the same wherever the program is started next.
fn lasting(path: &Path) -> PathBuf {
    let is_generated = path.to_str().is_some_and(|name| name.starts_with("demo:"));
    match std::path::absolute(path) {
        Ok(absolute) if !is_generated => absolute,
        _ => path.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generated_runs_are_no_files() {
        assert_eq!(lasting(Path::new("demo:radial:8")), Path::new("demo:radial:8"));
        assert!(lasting(Path::new("run/*.vtk")).is_absolute());
    }
}
