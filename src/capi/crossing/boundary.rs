//! The boundary to C: panics become a status, errors the last error of the thread.

use crate::capi::crossing::float_environment::FloatEnvironment;
use crate::capi::crossing::last_error::LAST;
use crate::capi::crossing::outcome::Outcome;
use crate::capi::crossing::reserve;
use crate::capi::crossing::thread_memory;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Error, Result, Status, TEXT_CAPACITY, Text};
use crate::shortage;
use core::cell::{Cell, RefCell};
use core::fmt::Write as _;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind};
use std::sync::{Once, OnceLock};

thread_local! {
    /// Message of a panic inside the library.
    static PANIC: RefCell<Text> = const { RefCell::new(Text::EMPTY) };
    /// Whether this thread runs code of the library (and not a callback of the caller).
    static INSIDE: Cell<bool> = const { Cell::new(false) };
    /// The floating-point environment of the caller, for its callbacks.
    static CALLER: Cell<FloatEnvironment> = const { Cell::new(FloatEnvironment::DEFAULT) };
}

/// Runs the body of an exported function and turns its outcome into a status. Success empties the
/// last error; anything else fills it.
pub(crate) fn call<T: Into<Outcome>>(body: impl FnOnce() -> Result<T>) -> hbvib_status {
    call_to_free(|| {
        reserve::check()?;
        body()
    })
}

/// The same for functions that free memory, and so succeed where there is none.
pub(crate) fn call_to_free<T: Into<Outcome>>(body: impl FnOnce() -> Result<T>) -> hbvib_status {
    match guarded(body) {
        Ok(outcome) => {
            let Outcome { status, reason } = outcome.into();
            remember(reason.as_ref().map_or(status.sentence(), Error::message), 0);
            status as hbvib_status
        }
        Err(error) => {
            remember(error.message(), error.argument);
            error.status as hbvib_status
        }
    }
}

/// The same for functions that return a count: negative values are a status.
pub(crate) fn call_count(body: impl FnOnce() -> Result<usize>) -> i64 {
    match guarded(body) {
        Ok(count) => {
            remember("", 0);
            i64::try_from(count).unwrap_or(i64::MAX)
        }
        Err(error) => {
            remember(error.message(), error.argument);
            error.status as i64
        }
    }
}

/// Runs a callback of the caller in the caller's floating-point environment. A panic in the
/// callback is not reported as one of the library.
pub(crate) fn outside<T>(callback: impl FnOnce() -> T) -> T {
    let before = INSIDE.replace(false);
    CALLER.get().restore();
    let result = callback();
    // The callback may have changed the environment of the caller.
    CALLER.set(FloatEnvironment::of_the_caller());
    FloatEnvironment::enter();
    INSIDE.set(before);
    result
}

/// Runs work of the library on a thread of its own: in the default floating-point environment, and a panic is not
/// printed. False: there is no memory for the thread, and nothing was done.
pub(crate) fn within(work: &mut dyn FnMut()) -> bool {
    INSIDE.set(true);
    FloatEnvironment::enter();
    if thread_memory::prepare().is_err() || shortage::is_noted() {
        return false;
    }
    // Work that panics leaves its outcome as it was, which says so.
    let _ = catch_unwind(AssertUnwindSafe(work));
    true
}

fn guarded<T>(body: impl FnOnce() -> Result<T>) -> Result<T> {
    quiet_panics();
    let before = INSIDE.replace(true);
    let caller_before = CALLER.replace(FloatEnvironment::of_the_caller());
    FloatEnvironment::enter();
    let noted_before = shortage::erase();
    let outcome = catch_unwind(AssertUnwindSafe(body));
    shortage::restore(noted_before);
    CALLER.replace(caller_before).restore();
    INSIDE.set(before);
    outcome.unwrap_or_else(|_| {
        let said = PANIC.with_borrow(|text| *text);
        Err(Error::new(
            Status::Internal,
            format_args!("defect of the library, please report it: {}", said.as_str()),
        ))
    })
}

/// Installs, once, a panic hook that does not print panics inside the library. All others go to the
/// previous hook, so that a Rust program which links the crate is not disturbed.
fn quiet_panics() {
    type Hook = Box<dyn Fn(&PanicHookInfo<'_>) + Send + Sync>;
    static PREVIOUS: OnceLock<Hook> = OnceLock::new();
    static INSTALLED: Once = Once::new();
    if INSTALLED.is_completed() || std::thread::panicking() {
        return;
    }
    INSTALLED.call_once(|| {
        PREVIOUS.get_or_init(std::panic::take_hook);
        // The closure captures nothing, so its box takes no memory that unloading would leak.
        std::panic::set_hook(Box::new(|info| {
            if !INSIDE.get() {
                if let Some(previous) = PREVIOUS.get() {
                    previous(info);
                }
                return;
            }
            PANIC.with(|text| {
                let Ok(mut text) = text.try_borrow_mut() else { return };
                *text = Text::EMPTY;
                // Writing into the fixed buffer cuts, it cannot fail.
                let _ = match info.location() {
                    Some(place) => write!(text, "{}:{}: ", place.file(), place.line()),
                    None => Ok(()),
                };
                let payload = info.payload();
                let said = payload.downcast_ref::<&str>().copied();
                let said = said.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
                let _ = text.write_str(said.unwrap_or("panic"));
            });
        }));
    });
}

pub(crate) fn remember(sentence: &str, argument: i32) {
    LAST.with_borrow_mut(|last| {
        let len = sentence.len().min(TEXT_CAPACITY);
        last.text[..len].copy_from_slice(&sentence.as_bytes()[..len]);
        last.text[len] = 0;
        last.argument = argument;
    });
}

/// Attributes an error to an argument of the C function.
pub(crate) trait WithArgument<T> {
    /// The same error with the number of the argument, counted from 1, unless it already has one. A stop by the caller
    /// belongs to no argument.
    fn with_argument(self, argument: i32) -> Result<T>;
}

impl<T> WithArgument<T> for Result<T> {
    fn with_argument(self, argument: i32) -> Result<T> {
        let attribute = |e: &Error| e.argument == 0 && e.status != Status::StoppedByCaller;
        self.map_err(|e| if attribute(&e) { e.in_argument(argument) } else { e })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capi::hbvib_last_error;
    use core::ffi::CStr;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Panics of this test that reached the caller's own hook.
    static SEEN: AtomicUsize = AtomicUsize::new(0);

    #[test]
    fn a_panic_becomes_a_status_and_only_those_of_the_caller_are_reported() {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(|_| {
            SEEN.fetch_add(1, Ordering::Relaxed);
        }));
        let status = call::<Status>(|| panic!("out of {}", "order"));
        assert_eq!(status, Status::Internal as i32);
        let text = unsafe { CStr::from_ptr(hbvib_last_error()) }.to_str().unwrap();
        assert!(text.contains("boundary.rs") && text.ends_with("out of order"), "{text}");
        assert_eq!(SEEN.load(Ordering::Relaxed), 0);

        // Panics of the caller, in a callback too, go to the hook of the caller.
        assert_eq!(
            call(|| outside(|| {
                assert!(catch_unwind(|| panic!("caller")).is_err());
                Ok(Status::Ok)
            })),
            0
        );
        assert!(catch_unwind(|| panic!("caller")).is_err());
        assert_eq!(SEEN.load(Ordering::Relaxed), 2);
        std::panic::set_hook(before);
    }
}
