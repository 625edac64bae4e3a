//! The library in the process of the caller: what to do when it is copied (fork) and when the library is unloaded. The
//! shared library calls these functions; a program in Rust has its own ways.

use super::{handles, reserve};

/// Before the process is copied: no other thread changes the table of handles or the reserve meanwhile, so that the copy
/// finds both whole. A handle that a call of another thread uses stays busy in the copy, where that call never ends.
pub fn before_fork() {
    handles::hold();
    reserve::hold();
}

/// After the process was copied, in both of them.
pub fn after_fork() {
    reserve::let_go();
    handles::let_go();
}

/// At the end: frees the table of handles where none is alive.
pub fn at_unload() {
    handles::release();
}
