//! What the keyboard does: the actions, and which keys call them.

pub mod escape;
pub mod keymap;
pub mod shortcuts;
