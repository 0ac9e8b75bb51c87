//! What the program has to tell: errors stay until they are dismissed, notes fade.

use std::time::{Duration, Instant};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    Note,
    Warning,
    Error,
}

#[derive(Clone, Debug)]
pub struct Message {
    pub severity: Severity,
    pub text: String,
    /// How often it was said.
    pub times: u32,
    said: Instant,
}

/// The messages in view, the newest last.
#[derive(Clone, Debug, Default)]
pub struct Messages {
    list: Vec<Message>,
}

/// How long a note stays.
const NOTE: Duration = Duration::from_secs(6);
/// A warning stays longer: it is worth reading, but nothing failed.
const WARNING: Duration = Duration::from_secs(20);
/// More than this do not fit beside a picture: the oldest that is no error gives way.
pub const MOST: usize = 6;
/// So many errors are remembered until they are dismissed.
const MOST_ERRORS: usize = 1000;

impl Messages {
    pub fn note(&mut self, text: impl Into<String>) {
        self.say(Severity::Note, text.into());
    }

    pub fn warn(&mut self, text: impl Into<String>) {
        self.say(Severity::Warning, text.into());
    }

    pub fn error(&mut self, text: impl Into<String>) {
        self.say(Severity::Error, text.into());
    }

    fn say(&mut self, severity: Severity, text: String) {
        let said = Instant::now();
        if let Some(known) = self.list.iter_mut().find(|message| message.text == text) {
            (known.times, known.said) = (known.times + 1, said);
            return;
        }
        if self.list.len() >= MOST {
            let fades = self.list.iter().position(|message| message.severity != Severity::Error);
            // Whatever fails again and again in other words must not fill the memory.
            if let Some(oldest) = fades.or((self.list.len() >= MOST_ERRORS).then_some(0)) {
                self.list.remove(oldest);
            }
        }
        self.list.push(Message { severity, text, times: 1, said });
    }

    pub fn dismiss(&mut self, index: usize) {
        if index < self.list.len() {
            self.list.remove(index);
        }
    }

    /// Takes away what has faded.
    pub fn expire(&mut self, now: Instant) {
        self.list.retain(|message| message.end().is_none_or(|end| now < end));
    }

    /// When the next one fades.
    pub fn due(&self) -> Option<Instant> {
        self.list.iter().filter_map(Message::end).min()
    }

    pub fn list(&self) -> &[Message] {
        &self.list
    }
}

impl Message {
    fn end(&self) -> Option<Instant> {
        match self.severity {
            Severity::Note => Some(self.said + NOTE),
            Severity::Warning => Some(self.said + WARNING),
            Severity::Error => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_fade_and_errors_stay() {
        let mut messages = Messages::default();
        messages.note("saved");
        messages.error("frame 4 is cut short");
        messages.error("frame 4 is cut short");
        messages.expire(Instant::now() + Duration::from_secs(60));
        let [only] = messages.list() else { panic!("one message is left") };
        assert_eq!((only.severity, only.times), (Severity::Error, 2));
        messages.dismiss(0);
        messages.dismiss(7);
        assert!(messages.list().is_empty() && messages.due().is_none());
    }

    #[test]
    fn errors_give_way_to_nothing() {
        let mut messages = Messages::default();
        messages.error("frame 4 is cut short");
        (0..20).for_each(|frame| messages.warn(format!("frame {frame} has holes")));
        let texts: Vec<&str> = messages.list().iter().map(|message| message.text.as_str()).collect();
        assert_eq!(texts.len(), MOST);
        assert_eq!((texts[0], texts[1]), ("frame 4 is cut short", "frame 15 has holes"));
        (0..20).for_each(|frame| messages.error(format!("frame {frame} is lost")));
        messages.note("saved");
        messages.note("saved again");
        assert_eq!(messages.list().len(), 22, "all errors, and the latest note");
        (0..2000).for_each(|frame| messages.error(format!("frame {frame} is gone")));
        assert_eq!(messages.list().len(), MOST_ERRORS);
    }
}
