//! Further threads of a call, which it starts and waits for.
//!
//! A thread of the standard library asks for memory in a way that cannot fail: without it the process ends. Where that must
//! not be, as in the C library, the caller of an analysis brings a function of its own that starts threads.

use std::thread;

/// Memory of the stack of a thread.
/// Kind: cap.
pub const STACK: usize = 8 << 20;

/// A function that runs its last argument in this thread while up to a given number of other threads run the task,
/// each with its index from 0. The last argument receives the number of threads started, which is lower where the
/// system has no further ones. The function returns after all of them. The task does not panic.
pub type Together = fn(usize, &(dyn Fn(usize) + Sync), &mut dyn FnMut(usize));

/// Starts threads of the standard library, as a `Together` function does.
pub fn of_std(others: usize, task: &(dyn Fn(usize) + Sync), own: &mut dyn FnMut(usize)) {
    if others == 0 {
        return own(0);
    }
    thread::scope(|scope| {
        let start = |number: &usize| {
            let number = *number;
            thread::Builder::new()
                .stack_size(STACK)
                .spawn_scoped(scope, move || task(number))
                .is_ok()
        };
        own((0..others).take_while(start).count());
    });
}
