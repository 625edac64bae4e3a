//! Shortage of memory: a note of this thread that a request failed and was served from the reserve of the allocator.
//!
//! Boxes, and arrays in the libraries below, cannot report a failing request. Where the allocator of the C library has
//! a reserve, it serves them from it and makes a note here. Every fallible allocation and every check of the interrupt
//! reads the note, so that the call ends with [`Status::OutOfMemory`](crate::error::Status::OutOfMemory) soon after, and
//! what it had allocated is freed. A program in Rust with another allocator never makes the note.

use core::cell::Cell;

thread_local! {
    static NOTED: Cell<bool> = const { Cell::new(false) };
}

/// Notes a shortage of memory.
#[cold]
pub fn note() {
    // A thread that is being torn down makes no call any more.
    let _ = NOTED.try_with(|noted| noted.set(true));
}

/// Whether a shortage was noted since the beginning of the call.
#[must_use]
#[inline]
pub fn is_noted() -> bool {
    NOTED.get()
}

/// Erases the note and returns it, at the begin of a call.
#[must_use]
pub fn erase() -> bool {
    NOTED.replace(false)
}

/// Restores the note of an outer call, at the end of one that a callback made.
pub fn restore(noted: bool) {
    NOTED.set(noted);
}
