//! The other programs of a desktop, as far as a window deals with them: the file manager from which
//! files are dragged (XDND, version 5), and the window manager that is asked for a full screen.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    AtomEnum, ChangeWindowAttributesAux, ClientMessageEvent, ConfigureWindowAux, ConnectionExt, EventMask,
    ImageFormat, PropMode, SELECTION_NOTIFY_EVENT, SelectionNotifyEvent, SelectionRequestEvent, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

use crate::harness::PATIENCE;

pub struct Desktop {
    connection: RustConnection,
    root: u32,
    /// The window that is driven.
    window: u32,
    /// The file manager's own.
    source: u32,
}

impl Desktop {
    pub fn new(display: &str, window: u32) -> Desktop {
        let (connection, screen) = x11rb::connect(Some(display)).unwrap();
        let root = connection.setup().roots[screen].root;
        let source = connection.generate_id().unwrap();
        let (class, nothing) = (WindowClass::INPUT_ONLY, Default::default());
        connection.create_window(0, source, root, 0, 0, 1, 1, 0, class, 0, &nothing).unwrap();
        // Wishes that a window sends to the window manager go to the root.
        let heard = ChangeWindowAttributesAux::new().event_mask(EventMask::SUBSTRUCTURE_NOTIFY);
        connection.change_window_attributes(root, &heard).unwrap();
        Desktop { connection, root, window, source }
    }

    fn atom(&self, name: &str) -> u32 {
        self.connection.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap().atom
    }

    /// Drags files over the window, until it has looked at them and will take them.
    pub fn hover(&self, paths: &[PathBuf]) {
        let (selection, uris) = (self.atom("XdndSelection"), self.atom("text/uri-list"));
        self.connection.set_selection_owner(self.source, selection, x11rb::CURRENT_TIME).unwrap();
        self.tell("XdndEnter", [self.source, 5 << 24, uris, 0, 0]);
        let place = (100 << 16) | 100;
        let copy = self.atom("XdndActionCopy");
        self.tell("XdndPosition", [self.source, 0, place, x11rb::CURRENT_TIME, copy]);
        let request = self.wait(|event| match event {
            Event::SelectionRequest(request) => Some(request),
            _ => None,
        });
        assert_eq!(request.target, uris);
        self.answer(&request, &uri_list(paths));
        assert_eq!(self.hear("XdndStatus", self.source)[1] & 1, 1, "it takes the files");
    }

    /// Lets go of the files that hover.
    pub fn drop(&self) {
        self.tell("XdndDrop", [self.source, 0, x11rb::CURRENT_TIME, 0, 0]);
        assert_eq!(self.hear("XdndFinished", self.source)[1] & 1, 1, "it has taken the files");
    }

    /// Drags the files away again.
    pub fn leave(&self) {
        self.tell("XdndLeave", [self.source, 0, 0, 0, 0]);
    }

    fn answer(&self, request: &SelectionRequestEvent, data: &str) {
        let SelectionRequestEvent { time, requestor, selection, target, property, .. } = *request;
        let replace = PropMode::REPLACE;
        self.connection.change_property8(replace, requestor, property, target, data.as_bytes()).unwrap();
        let response_type = SELECTION_NOTIFY_EVENT;
        let done =
            SelectionNotifyEvent { response_type, sequence: 0, time, requestor, selection, target, property };
        self.connection.send_event(false, requestor, EventMask::NO_EVENT, done).unwrap();
        self.connection.flush().unwrap();
    }

    fn tell(&self, what: &str, data: [u32; 5]) {
        let message = ClientMessageEvent::new(32, self.window, self.atom(what), data);
        self.connection.send_event(false, self.window, EventMask::NO_EVENT, message).unwrap();
        self.connection.flush().unwrap();
    }

    /// Waits for a message to `receiver`, or about it.
    fn hear(&self, what: &str, receiver: u32) -> [u32; 5] {
        let what = self.atom(what);
        self.wait(|event| match event {
            Event::ClientMessage(message) if (message.type_, message.window) == (what, receiver) => {
                Some(message.data.as_data32())
            }
            _ => None,
        })
    }

    fn wait<T>(&self, wanted: impl Fn(Event) -> Option<T>) -> T {
        let mut found = None;
        eventually("an event", || {
            found = self.connection.poll_for_event().unwrap().and_then(&wanted);
            found.is_some()
        });
        found.unwrap()
    }

    /// Waits until the window wants to fill the screen, or no longer wants to, and does as a window
    /// manager does: gives it that size, and writes down that it has it.
    pub fn grant_full_screen(&self, wanted: bool) {
        let (state, full) = (self.atom("_NET_WM_STATE"), self.atom("_NET_WM_STATE_FULLSCREEN"));
        let [action, what, ..] = self.hear("_NET_WM_STATE", self.window);
        assert_eq!((action == 1, what == full), (wanted, true), "what it wants");
        let (states, [width, height]): (&[u32], _) =
            if wanted { (&[full], [1280, 800]) } else { (&[], [900, 600]) };
        let (replace, atom) = (PropMode::REPLACE, AtomEnum::ATOM);
        self.connection.change_property32(replace, self.window, state, atom, states).unwrap();
        let size = ConfigureWindowAux::new().x(0).y(0).width(width).height(height);
        self.connection.configure_window(self.window, &size).unwrap();
        self.connection.flush().unwrap();
    }

    /// What is on the screen: bytes of the pixels in x, y, width, height.
    pub fn pixels(&self, [x, y, width, height]: [u16; 4]) -> Vec<u8> {
        let (format, place) = (ImageFormat::Z_PIXMAP, [x, y].map(|number| number as i16));
        let image = self.connection.get_image(format, self.root, place[0], place[1], width, height, !0);
        image.unwrap().reply().unwrap().data
    }

    /// What is on the screen once it rests.
    pub fn resting_pixels(&self, area: [u16; 4]) -> Vec<u8> {
        let mut last = Vec::new();
        eventually("a window at rest", || {
            std::thread::sleep(Duration::from_secs(1));
            let before = std::mem::replace(&mut last, self.pixels(area));
            before == last
        });
        last
    }
}

/// Waits until something is so.
pub fn eventually(what: &str, mut is_so: impl FnMut() -> bool) {
    let limit = Instant::now() + PATIENCE;
    while !is_so() {
        assert!(Instant::now() < limit, "waited for {what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

fn uri_list(paths: &[PathBuf]) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/._-".contains(&byte);
    let encode = |byte: u8| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    let uri = |path: &PathBuf| path.to_str().unwrap().bytes().map(encode).collect::<String>();
    paths.iter().map(|path| format!("file://{}\r\n", uri(path))).collect()
}
