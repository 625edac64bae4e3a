//! The shared and the static library behind `include/hbvib.h`: the functions of the crate hbvib, the allocator that makes
//! a failing request for memory a status, and what happens when the process is copied or the library unloaded.

use engine::capi::reserve::ReserveAllocator;

#[global_allocator]
static ALLOCATOR: ReserveAllocator = ReserveAllocator;

#[cfg(target_os = "linux")]
mod further_threads;
#[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
mod thread_exit;

#[cfg(target_os = "linux")]
mod loading {
    use engine::capi::process::{after_fork, at_unload, before_fork};

    /// Called by the loader after loading, also by the start of a program that is linked statically.
    #[used]
    #[unsafe(link_section = ".init_array")]
    static AT_LOAD: extern "C" fn() = at_load;

    /// Called by the loader before unloading, and at the end of a program.
    #[used]
    #[unsafe(link_section = ".fini_array")]
    static AT_UNLOAD: extern "C" fn() = unloaded;

    extern "C" fn at_load() {
        // SAFETY: the functions stay until the library is unloaded, which removes them. Without memory for the entry, a
        // copy of the process that is made while another thread looks up a handle might wait for ever.
        let _ = unsafe { libc::pthread_atfork(Some(prepare), Some(copied), Some(copied)) };
        engine::capi::thread_start::start_by(super::further_threads::together);
        #[cfg(all(target_env = "gnu", target_arch = "x86_64"))]
        {
            super::thread_exit::at_load();
            engine::capi::thread_memory::hand_over();
        }
    }

    extern "C" fn unloaded() {
        #[cfg(all(target_env = "gnu", target_arch = "x86_64"))]
        super::thread_exit::at_unload();
        at_unload();
    }

    unsafe extern "C" fn prepare() {
        before_fork();
    }

    unsafe extern "C" fn copied() {
        after_fork();
    }
}
