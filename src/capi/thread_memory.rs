//! Memory that a thread keeps: products of large matrices pack their factors there. They ask for it at the first product
//! of a thread, twice the size of the third-level cache, and cannot report that it is missing. So it is set aside before,
//! by a request that can fail, and the allocator hands it over where the system then has no more.

use crate::error::{Error, Result};
use crate::linalg::first_product;
use core::alloc::{GlobalAlloc, Layout};
use core::cell::Cell;
use core::ptr::null_mut;
use core::sync::atomic::{AtomicUsize, Ordering};
use std::alloc::System;

/// Alignment of the memory of products.
const PAGE: usize = 4096;

/// Bytes of it; 0: not known.
static BYTES: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    static PREPARED: Cell<bool> = const { Cell::new(false) };
    /// Memory set aside for the first product of this thread, and its size.
    static ASIDE: Cell<(*mut u8, usize)> = const { Cell::new((null_mut(), 0)) };
}

/// Tells the size of the third-level cache, from which the memory of products follows.
pub fn set_cache_size(bytes: usize) {
    BYTES.store(bytes.saturating_mul(2).saturating_add(16 * PAGE), Ordering::Relaxed);
}

/// Lets this thread ask for the memory of products now, with what it needs set aside.
///
/// # Errors
/// `OutOfMemory`.
pub(super) fn prepare() -> Result<()> {
    let bytes = BYTES.load(Ordering::Relaxed);
    if bytes == 0 || PREPARED.get() {
        return Ok(());
    }
    let layout =
        Layout::from_size_align(bytes, PAGE).map_err(|_| Error::out_of_memory("the products of this thread"))?;
    // SAFETY: the size is above 0.
    let aside = unsafe { System.alloc(layout) };
    if aside.is_null() {
        return Err(Error::out_of_memory("the products of this thread"));
    }
    ASIDE.set((aside, bytes));
    let done = first_product();
    let (left, _) = ASIDE.replace((null_mut(), 0));
    if !left.is_null() {
        // SAFETY: it was not handed over.
        unsafe { System.dealloc(left, layout) };
    }
    PREPARED.set(done.is_ok());
    done
}

/// Memory set aside in this thread, where it has room for a request of the products; otherwise NULL.
#[cold]
pub(super) fn take_aside(layout: Layout) -> *mut u8 {
    let (aside, bytes) = ASIDE.try_with(Cell::get).unwrap_or((null_mut(), 0));
    if layout.align() != PAGE || layout.size() > bytes {
        return null_mut();
    }
    ASIDE.set((null_mut(), 0));
    aside
}
