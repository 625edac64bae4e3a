//! Memory that a thread keeps: products of large matrices pack their factors there. They ask for it at the first product
//! of a thread, and cannot report that it is missing. So it is set aside before, by a request that can fail, and the
//! allocator hands it over where the system then has no more.

use crate::error::{Error, Result};
use crate::linalg::first_product;
use core::alloc::{GlobalAlloc, Layout};
use core::cell::Cell;
use core::ptr::null_mut;
use core::sync::atomic::{AtomicBool, Ordering};
use std::alloc::System;

/// Alignment of the memory of products.
const PAGE: usize = 4096;

/// Bytes of it: the crate `private-gemm-x86`, built without its feature "std", packs two parts of 2 MiB, whatever the
/// processor.
const BYTES: usize = (4 << 20) + 16 * PAGE;

/// Whether the allocator of this library hands it over.
static IS_HANDED_OVER: AtomicBool = AtomicBool::new(false);

thread_local! {
    static PREPARED: Cell<bool> = const { Cell::new(false) };
    /// Memory set aside for the first product of this thread.
    static ASIDE: Cell<*mut u8> = const { Cell::new(null_mut()) };
}

/// Lets threads set memory of products aside from now on, because the allocator hands it over.
pub fn hand_over() {
    IS_HANDED_OVER.store(true, Ordering::Relaxed);
}

/// Lets this thread ask for the memory of products now, with what it needs set aside.
///
/// # Errors
/// `OutOfMemory`.
pub(crate) fn prepare() -> Result<()> {
    if PREPARED.get() || !IS_HANDED_OVER.load(Ordering::Relaxed) {
        return Ok(());
    }
    let layout =
        Layout::from_size_align(BYTES, PAGE).map_err(|_| Error::out_of_memory("the products of this thread"))?;
    // SAFETY: the size is above 0.
    let aside = unsafe { System.alloc(layout) };
    if aside.is_null() {
        return Err(Error::out_of_memory("the products of this thread"));
    }
    ASIDE.set(aside);
    let done = first_product();
    let left = ASIDE.replace(null_mut());
    if !left.is_null() {
        // SAFETY: it was not handed over.
        unsafe { System.dealloc(left, layout) };
    }
    PREPARED.set(done.is_ok());
    done
}

/// Memory set aside in this thread, where it has room for a request of the products; otherwise NULL.
#[cold]
pub(crate) fn take_aside(layout: Layout) -> *mut u8 {
    let aside = ASIDE.try_with(Cell::get).unwrap_or(null_mut());
    if layout.align() != PAGE || layout.size() > BYTES {
        return null_mut();
    }
    ASIDE.set(null_mut());
    aside
}
