//! The last error of each thread.

use crate::error::TEXT_CAPACITY;
use core::cell::RefCell;

/// The last error of the thread: a fixed buffer without memory or destructor of its own, so that it
/// can be written when memory is exhausted, and the library can be unloaded.
pub(crate) struct LastError {
    /// Ends with NUL.
    pub text: [u8; TEXT_CAPACITY + 1],
    pub argument: i32,
}

thread_local! {
    pub(crate) static LAST: RefCell<LastError> = const {
        RefCell::new(LastError {
            text: [0; TEXT_CAPACITY + 1],
            argument: 0,
        })
    };
}
