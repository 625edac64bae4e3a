//! How calls start threads: as the C library tells when it is loaded, else by the standard library.

use crate::studies::further_threads::{Together, of_std};
use std::sync::OnceLock;

static TOGETHER: OnceLock<Together> = OnceLock::new();

/// Lets calls start threads by this function from now on, unless they do by another one already.
pub fn start_by(together: Together) {
    let _ = TOGETHER.set(together);
}

/// The function that starts threads.
pub(crate) fn together() -> Together {
    TOGETHER.get().copied().unwrap_or(of_std)
}
