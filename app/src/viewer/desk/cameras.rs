//! What is done to the camera by a command.

use std::time::Instant;

use super::{Desk, Order};
use crate::camera_text;
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::picture::picture_view::Motion;

impl Desk {
    /// Does what `action` says, if it is about the camera.
    pub(super) fn move_camera(&mut self, action: Action) {
        let session = &mut self.session;
        match action {
            Action::Reset => session.reset_camera(),
            Action::Look(side) => session.look_from(side),
            Action::ZoomIn | Action::ZoomOut => self.picture.zoom(session, action == Action::ZoomIn),
            Action::Fly => self.picture.motion.toggle(Motion::Fly),
            Action::Walk => self.picture.motion.toggle(Motion::Walk),
            Action::CopyCamera => self.copy_camera(),
            Action::PasteCamera => self.orders.push(Order::PasteCamera),
            Action::Bookmark => session.add_bookmark(),
            Action::GoTo(number) => session.go_to_bookmark(usize::from(number) - 1, Instant::now()),
            Action::Keyframe => session.toggle_keyframe(),
            Action::FollowPath => session.set_following(!session.follows_path()),
            _ => {}
        }
    }

    fn copy_camera(&mut self) {
        let Some(camera) = self.session.camera else { return };
        match camera_text::to_text(&camera.to_view()) {
            Ok(text) => {
                self.orders.push(Order::Copy(text));
                self.session.messages.note("The camera is on the clipboard, as view.json writes it");
                self.session.log("copied camera");
            }
            Err(error) => self.session.complain(format!("{error:#}")),
        }
    }

    /// Goes to the camera that is on the clipboard, `text`.
    pub fn paste_camera(&mut self, text: Option<String>) {
        let text = text.unwrap_or_default();
        if text.trim().is_empty() {
            self.session.complain("clipboard: holds no text: copy a camera or a view.json first");
            return;
        }
        match camera_text::from_text(&text) {
            Ok(camera) => {
                self.session.paste_camera(&camera, Instant::now());
                self.session.log("pasted camera");
            }
            Err(error) => self.session.complain(format!("{error:#}")),
        }
    }
}
