//! Destructors of thread-local variables without a request for memory.
//!
//! The library of glibc that registers them asks for memory and ends the process where there is none. Rust calls it by
//! the name `__cxa_thread_atexit_impl`; within this library, and nowhere else, that is the function below. A thread has a
//! table of fixed size, and a key of POSIX threads whose destructor works it off. Where a table is full or the system has
//! no memory for the key, memory of that thread stays until the process ends.

use core::arch::global_asm;
use core::cell::Cell;
use core::ffi::{c_int, c_void};
use core::ptr::null_mut;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

type Destructor = unsafe extern "C" fn(*mut c_void);

/// Variables of a thread that may have destructors; the library has three.
const MOST: usize = 32;

type Entry = (Option<Destructor>, *mut c_void);

thread_local! {
    static ENTRIES: [Cell<Entry>; MOST] = const { [const { Cell::new((None, null_mut())) }; MOST] };
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

static KEY: AtomicU32 = AtomicU32::new(0);
static HAS_KEY: AtomicBool = AtomicBool::new(false);

// The name with hidden visibility: that of glibc stays the one of all other libraries of the process.
#[cfg(target_arch = "x86_64")]
global_asm!(
    ".pushsection .text.__cxa_thread_atexit_impl,\"ax\",@progbits",
    ".globl __cxa_thread_atexit_impl",
    ".hidden __cxa_thread_atexit_impl",
    ".type __cxa_thread_atexit_impl,@function",
    "__cxa_thread_atexit_impl:",
    "jmp {register}",
    ".size __cxa_thread_atexit_impl, . - __cxa_thread_atexit_impl",
    ".popsection",
    register = sym register,
);

/// At the load of the library.
pub(super) fn at_load() {
    let mut key = 0;
    // SAFETY: the key is written by the call; the destructor stays until the key is deleted.
    if unsafe { libc::pthread_key_create(&raw mut key, Some(work_off)) } == 0 {
        KEY.store(key, Ordering::Relaxed);
        HAS_KEY.store(true, Ordering::Release);
    }
}

/// Before the library is unloaded: the variables of this thread; other threads keep theirs.
pub(super) fn at_unload() {
    if HAS_KEY.swap(false, Ordering::Acquire) {
        // SAFETY: the key was created, and nobody uses it any more.
        unsafe {
            work_off(null_mut());
            libc::pthread_key_delete(KEY.load(Ordering::Relaxed));
        }
    }
}

/// Registers a destructor of a variable of this thread, as `__cxa_thread_atexit_impl`.
unsafe extern "C" fn register(destructor: Destructor, object: *mut c_void, _library: *mut c_void) -> c_int {
    let count = COUNT.get();
    if count < MOST {
        ENTRIES.with(|entries| entries[count].set((Some(destructor), object)));
        COUNT.set(count + 1);
        if count == 0 && HAS_KEY.load(Ordering::Acquire) {
            let some = (&raw const KEY).cast::<c_void>();
            // SAFETY: the key exists.
            let _ = unsafe { libc::pthread_setspecific(KEY.load(Ordering::Relaxed), some) };
        }
    }
    0
}

/// Calls the destructors of this thread, the last one first; they may register others.
unsafe extern "C" fn work_off(_: *mut c_void) {
    while let Some(last) = COUNT.get().checked_sub(1) {
        COUNT.set(last);
        let (destructor, object) = ENTRIES.with(|entries| entries[last].replace((None, null_mut())));
        if let Some(destructor) = destructor {
            // SAFETY: it was registered for this object, which lives as long as its thread.
            unsafe { destructor(object) };
        }
    }
}
