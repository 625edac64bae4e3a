//! Further threads of a call by `pthread_create`, which tells that there is no memory. The standard library ends the process
//! then.

use core::ffi::c_void;
use core::mem::MaybeUninit;
use core::ptr::null_mut;
use engine::internals::STACK;

/// The work of a thread.
struct Work<'a> {
    task: &'a (dyn Fn(usize) + Sync),
    number: usize,
}

/// Threads that were started; they are waited for before what they borrow goes, also where a panic ends the call.
struct Started(Vec<libc::pthread_t>);

impl Drop for Started {
    fn drop(&mut self) {
        for &thread in &self.0 {
            // SAFETY: the thread was started, and is joined once.
            let _ = unsafe { libc::pthread_join(thread, null_mut()) };
        }
    }
}

extern "C" fn run(work: *mut c_void) -> *mut c_void {
    // SAFETY: the work outlives the thread, see `Started`.
    let work = unsafe { &*work.cast::<Work<'_>>() };
    (work.task)(work.number);
    null_mut()
}

/// As [`engine::internals::Together`] says.
pub(super) fn together(others: usize, task: &(dyn Fn(usize) + Sync), own: &mut dyn FnMut(usize)) {
    let mut works = Vec::new();
    let mut started = Started(Vec::new());
    if works.try_reserve_exact(others).is_err() || started.0.try_reserve_exact(others).is_err() {
        return own(0);
    }
    works.extend((0..others).map(|number| Work { task, number }));
    if others > 0 {
        start(&works, &mut started.0);
    }
    own(started.0.len());
}

/// Starts a thread for each work, as long as the system has them.
fn start(works: &[Work<'_>], started: &mut Vec<libc::pthread_t>) {
    let mut attributes = MaybeUninit::uninit();
    // SAFETY: the attributes are used between their creation and their end; a thread is there where the system says so.
    unsafe {
        if libc::pthread_attr_init(attributes.as_mut_ptr()) != 0 {
            return;
        }
        if libc::pthread_attr_setstacksize(attributes.as_mut_ptr(), STACK) == 0 {
            for work in works {
                let mut thread = MaybeUninit::uninit();
                let argument = (&raw const *work).cast_mut().cast();
                if libc::pthread_create(thread.as_mut_ptr(), attributes.as_ptr(), run, argument) != 0 {
                    break;
                }
                started.push(thread.assume_init());
            }
        }
        libc::pthread_attr_destroy(attributes.as_mut_ptr());
    }
}
