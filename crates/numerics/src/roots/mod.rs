//! Roots and minima of functions of one variable.

mod bracket;
mod safe_newton;

pub use bracket::{BRACKET_WIDTH, Bracket, least, root};
pub use safe_newton::{safe_halley, safe_newton};
