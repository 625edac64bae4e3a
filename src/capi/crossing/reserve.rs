//! The allocator of the C library: that of the system, with a reserve for requests that fail.
//!
//! A failing request of code that cannot report it would abort the process of the caller. It is served from 4 MiB of
//! static memory instead, and noted ([`crate::shortage`]), so that the call ends with `HBVIB_E_OUT_OF_MEMORY` before the
//! reserve is used up. The reserve is memory of no cost until it is written.
//!
//! A program in Rust may use it too, as its `#[global_allocator]`; the crate itself sets none.

use crate::capi::crossing::thread_memory::take_aside;
use crate::error::{Error, Result};
use crate::shortage;
use core::alloc::{GlobalAlloc, Layout};
use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::alloc::System;

/// Bytes of the reserve.
const SIZE: usize = 4 << 20;

/// Smallest part of it; all parts begin at a multiple.
const GRAIN: usize = 64;

const GRAINS: usize = SIZE / GRAIN;

/// Free grains below which no call begins.
const NEEDED: usize = GRAINS / 4 * 3;

#[repr(align(4096))]
struct Bytes(UnsafeCell<[u8; SIZE]>);

/// One bit a grain: taken or not.
struct Taken(UnsafeCell<[u64; GRAINS / 64]>);

// The parts of `Bytes` belong to those to whom they were given; `Taken` is read and written under the lock.
unsafe impl Sync for Bytes {}
unsafe impl Sync for Taken {}

static BYTES: Bytes = Bytes(UnsafeCell::new([0; SIZE]));
static TAKEN: Taken = Taken(UnsafeCell::new([0; GRAINS / 64]));
static LOCK: AtomicBool = AtomicBool::new(false);
static FREE: AtomicUsize = AtomicUsize::new(GRAINS);

/// Takes the lock, which is held for microseconds, and only where memory is short.
pub(crate) fn hold() {
    while LOCK
        .compare_exchange_weak(false, true, Ordering::Acquire, Ordering::Relaxed)
        .is_err()
    {
        core::hint::spin_loop();
    }
}

/// Releases the lock.
pub(crate) fn let_go() {
    LOCK.store(false, Ordering::Release);
}

/// Works on the map of grains, alone.
fn locked<T>(work: impl FnOnce(&mut [u64; GRAINS / 64]) -> T) -> T {
    hold();
    // SAFETY: the lock is held.
    let result = work(unsafe { &mut *TAKEN.0.get() });
    let_go();
    result
}

fn is_taken(map: &[u64; GRAINS / 64], grain: usize) -> bool {
    map[grain / 64] >> (grain % 64) & 1 == 1
}

/// The first row of free grains of this length that begins at a multiple of `step`.
fn find(map: &[u64; GRAINS / 64], count: usize, step: usize) -> Option<usize> {
    let mut first = 0;
    while first + count <= GRAINS {
        match (first..first + count).rev().find(|&grain| is_taken(map, grain)) {
            None => return Some(first),
            Some(taken) => first = (taken + 1).next_multiple_of(step),
        }
    }
    None
}

/// Grains of a request; at least one.
fn grains(layout: Layout) -> usize {
    layout.size().div_ceil(GRAIN).max(1)
}

/// Memory that was set aside for such a request, a part of the reserve, noted, or NULL.
#[cold]
fn take(layout: Layout) -> *mut u8 {
    let aside = take_aside(layout);
    if !aside.is_null() {
        return aside;
    }
    let (count, step) = (grains(layout), layout.align().div_ceil(GRAIN));
    if count > GRAINS || layout.align() > 4096 {
        return core::ptr::null_mut();
    }
    let found = locked(|map| {
        let first = find(map, count, step)?;
        for grain in first..first + count {
            map[grain / 64] |= 1 << (grain % 64);
        }
        Some(first)
    });
    let Some(first) = found else {
        return core::ptr::null_mut();
    };
    FREE.fetch_sub(count, Ordering::Relaxed);
    shortage::note();
    // SAFETY: the part lies within the reserve.
    unsafe { BYTES.0.get().cast::<u8>().add(first * GRAIN) }
}

/// The first grain of a part of the reserve; `None` for memory of the system.
#[inline]
fn grain_of(memory: *mut u8) -> Option<usize> {
    let offset = memory.addr().wrapping_sub(BYTES.0.get().addr());
    (offset < SIZE).then_some(offset / GRAIN)
}

#[cold]
fn give_back(first: usize, layout: Layout) {
    let count = grains(layout);
    locked(|map| {
        for grain in first..first + count {
            map[grain / 64] &= !(1 << (grain % 64));
        }
    });
    FREE.fetch_add(count, Ordering::Relaxed);
}

/// Refuses a call where so much of the reserve is in use that it might not suffice.
///
/// # Errors
/// `OutOfMemory`.
pub(crate) fn check() -> Result<()> {
    if FREE.load(Ordering::Relaxed) < NEEDED {
        return Err(Error::out_of_memory("another call; free models and branches"));
    }
    Ok(())
}

/// The allocator of the system with a reserve; see the module.
pub struct ReserveAllocator;

// SAFETY: memory comes from the system's allocator, or is a part of the reserve that nobody else has, of the requested size
// and alignment; it goes back where it came from.
unsafe impl GlobalAlloc for ReserveAllocator {
    #[inline]
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let memory = unsafe { System.alloc(layout) };
        if memory.is_null() { take(layout) } else { memory }
    }

    #[inline]
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        let memory = unsafe { System.alloc_zeroed(layout) };
        if !memory.is_null() {
            return memory;
        }
        let memory = take(layout);
        if !memory.is_null() {
            unsafe { memory.write_bytes(0, layout.size()) };
        }
        memory
    }

    #[inline]
    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        match grain_of(memory) {
            None => unsafe { System.dealloc(memory, layout) },
            Some(first) => give_back(first, layout),
        }
    }

    #[inline]
    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if grain_of(memory).is_none() {
            let moved = unsafe { System.realloc(memory, layout, size) };
            if !moved.is_null() {
                return moved;
            }
        }
        // SAFETY: the caller guarantees a size that fits the alignment.
        let moved = unsafe { self.alloc(Layout::from_size_align_unchecked(size, layout.align())) };
        if !moved.is_null() {
            unsafe {
                moved.copy_from_nonoverlapping(memory, layout.size().min(size));
                self.dealloc(memory, layout);
            }
        }
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A request for more than any address space has, which the system refuses, of which `used` bytes are written.
    fn refused(align: usize) -> Layout {
        Layout::from_size_align(1 << 62, align).unwrap()
    }

    #[test]
    fn parts_are_aligned_disjoint_and_given_back() {
        let before = shortage::erase();
        let layouts = [(1, 1), (64, 8), (65, 128), (5000, 4096), (100_000, 16)].map(|(size, align)| {
            let layout = Layout::from_size_align(size, align).unwrap();
            (take(layout), layout)
        });
        assert!(shortage::is_noted());
        for (k, (memory, layout)) in layouts.iter().enumerate() {
            assert!(!memory.is_null() && memory.addr() % layout.align() == 0);
            unsafe { memory.write_bytes(k as u8, layout.size()) };
        }
        for (k, (memory, layout)) in layouts.iter().enumerate() {
            let bytes = unsafe { core::slice::from_raw_parts(*memory, layout.size()) };
            assert!(bytes.iter().all(|&b| b == k as u8));
        }
        let taken: usize = layouts.iter().map(|(_, layout)| grains(*layout)).sum();
        assert_eq!(FREE.load(Ordering::Relaxed), GRAINS - taken);
        // Moving a part keeps its content, and goes back to the system's memory.
        let (memory, layout) = layouts[4];
        let moved = unsafe { ReserveAllocator.realloc(memory, layout, 200_000) };
        assert!(grain_of(moved).is_none() && unsafe { *moved.add(99_999) } == 4);
        unsafe { System.dealloc(moved, Layout::from_size_align(200_000, 16).unwrap()) };
        for (memory, layout) in &layouts[..4] {
            unsafe { ReserveAllocator.dealloc(*memory, *layout) };
        }
        assert_eq!(FREE.load(Ordering::Relaxed), GRAINS);
        assert!(take(refused(8)).is_null());
        // Too little is left for another call.
        let layout = Layout::from_size_align(SIZE / 2, 64).unwrap();
        let half = take(layout);
        assert!(check().is_err());
        give_back(grain_of(half).unwrap(), layout);
        assert!(check().is_ok());
        shortage::restore(before);
    }
}
