//! The result of a step of the command.

/// A value, or a sentence that tells what is wrong.
pub type Outcome<T> = Result<T, String>;
