//! The sentence on bands whose search ended early.

use crate::texts::counted::counted;

/// Tells at how many places the search of a band does not claim its ends.
pub fn beyond(incomplete: usize, of: &str) -> String {
    if incomplete == 0 {
        return String::new();
    }
    format!(
        "at {} the ends are attained, but others may lie beyond\n",
        counted(incomplete, of)
    )
}
