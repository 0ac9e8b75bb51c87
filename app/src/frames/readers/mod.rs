//! One reader a format. Each turns the bytes of one file into a [`Frame`](super::Frame), or says
//! what is wrong and where.

mod error;

pub use error::ReadError;
