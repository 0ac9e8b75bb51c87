//! Changes to the shaders, for tests of the tests: a bound that is wrong on purpose must be noticed.

use std::sync::atomic::{AtomicBool, Ordering};

/// Replacements of text, made in every shader before it is compiled.
#[derive(Debug, Default)]
pub(crate) struct ShaderEdits {
    edits: Vec<Edit>,
}

#[derive(Debug)]
struct Edit {
    from: String,
    to: String,
    /// Whether any shader had the text.
    made: AtomicBool,
}

impl ShaderEdits {
    pub(crate) fn new(edits: &[(String, String)]) -> ShaderEdits {
        let edit = |(from, to): &(String, String)| Edit {
            from: from.clone(),
            to: to.clone(),
            made: AtomicBool::new(false),
        };
        ShaderEdits { edits: edits.iter().map(edit).collect() }
    }

    /// `source` with every edit made.
    pub(crate) fn apply(&self, mut source: String) -> String {
        for edit in &self.edits {
            if source.contains(&edit.from) {
                source = source.replace(&edit.from, &edit.to);
                edit.made.store(true, Ordering::Relaxed);
            }
        }
        source
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.edits.is_empty()
    }

    /// The first edit whose text no shader had.
    pub(crate) fn unmade(&self) -> Option<&str> {
        self.edits.iter().find(|edit| !edit.made.load(Ordering::Relaxed)).map(|edit| edit.from.as_str())
    }
}
