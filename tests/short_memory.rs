//! Memory: where it is short, the stability of many sliders is `OutOfMemory` and no process ends. A limit stands for the shortage, and is
//! set at many places between the memory before the call and its most.
//!
//! Large requests beyond the limit fail, so that a matrix that is asked for without a check ends this test with a message of the
//! runtime. Small ones are served, and those of products, as the reserve of the shared library does.

mod common;

use crate::common::models::Structure;
use crate::common::{harmonics, omega_range};
use hbvib::{Contact, FloquetOptions, Hooks, MatrixKind, MatrixView, Model, Status, Waves, floquet, forced_response};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// Bytes up to which a request is served beyond the limit: a complex matrix of the order of one sector.
const SMALL: usize = 16 * N * N;

/// Largest alignment of numbers; products of matrices ask for more.
const OF_NUMBERS: usize = 16;

/// Bytes that are allocated, the most of them since the last call of `within`, and their limit. Tests run in threads of their own.
struct Limited;

thread_local! {
    static LIVE: Cell<i64> = const { Cell::new(0) };
    static MOST: Cell<i64> = const { Cell::new(0) };
    static LIMIT: Cell<i64> = const { Cell::new(i64::MAX) };
}

/// Counts a request that makes a block larger by some bytes; `false`: it is refused.
fn is_granted(layout: Layout, more: i64) -> bool {
    let granted = || {
        let live = LIVE.get() + more;
        if live > LIMIT.get() && more > 0 && layout.size() > SMALL && layout.align() <= OF_NUMBERS {
            return false;
        }
        LIVE.set(live);
        MOST.set(MOST.get().max(live));
        true
    };
    // A thread that is being torn down has no counter any more.
    LIVE.try_with(|_| ()).is_err() || granted()
}

// SAFETY: every call that is granted is passed on unchanged to the system's allocator.
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if is_granted(layout, layout.size() as i64) {
            unsafe { System.alloc(layout) }
        } else {
            std::ptr::null_mut()
        }
    }
    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        is_granted(layout, -(layout.size() as i64));
        unsafe { System.dealloc(memory, layout) }
    }
    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        let after = unsafe { Layout::from_size_align_unchecked(size, layout.align()) };
        if is_granted(after, size as i64 - layout.size() as i64) {
            unsafe { System.realloc(memory, layout, size) }
        } else {
            std::ptr::null_mut()
        }
    }
}

#[global_allocator]
static ALLOCATOR: Limited = Limited;

/// The result of `work` within a limit, and the most bytes allocated meanwhile.
fn within<T>(limit: i64, work: impl FnOnce() -> T) -> (T, i64) {
    MOST.set(LIVE.get());
    LIMIT.set(limit);
    let result = work();
    LIMIT.set(i64::MAX);
    (result, MOST.get())
}

const N: usize = 10;
const MODES: usize = 8;

/// Sectors of springs and masses in a row, the last mass on a spring so stiff that stability is computed on modes and sliders; contacts on
/// half of the others.
fn rubbing_wheel(sectors: usize, engine_order: i64) -> Model {
    let (mut mass, mut stiffness) = (vec![0.0; N * N], vec![0.0; N * N]);
    for i in 0..N {
        mass[i * N + i] = if i + 1 < N { 0.2 } else { 1e-4 };
        stiffness[i * N + i] += if i + 1 < N { 8.0 } else { 1e8 };
        if i > 0 {
            stiffness[(i - 1) * N + i - 1] += 8.0;
            stiffness[(i - 1) * N + i] -= 8.0;
            stiffness[i * N + i - 1] -= 8.0;
        }
    }
    let mut model = Structure::cyclic(N, sectors).mass(&mass).stiffness(&stiffness).build();
    let mut next = vec![0.0; N * N];
    next[N + 1] = -0.3;
    let next = MatrixView::dense(N, &next);
    model.set_coupling(MatrixKind::Stiffness, &next).unwrap();
    model.set_wave(engine_order);
    // All modes decay alike, so that numbers of modes agree.
    model.set_rayleigh(0.1, 0.0).unwrap();
    for dof in 1..6 {
        let contact = Contact::jenkins(dof, None, 0.3, 0.5, 0.02 + 0.02 * dof as f64);
        model.add_contact(&contact).unwrap();
    }
    model.add_force(3, 1, 0.3.into()).unwrap();
    model
}

fn stays_within(model: &Model) {
    let solver = harmonics(9);
    let range = omega_range(2.4, 2.4);
    let branch = forced_response(model, &solver, &range, &mut Hooks::default()).unwrap();
    let options = FloquetOptions {
        waves: Waves::Wheel,
        modes: Some(MODES),
        ..FloquetOptions::default()
    };
    let multipliers = || floquet(model, &branch, 0, &options, &mut Hooks::default());
    // The first call sets up what the model keeps.
    let all = multipliers().unwrap();
    let before = LIVE.get();
    let most = within(i64::MAX, || drop(multipliers().unwrap())).1;
    // States are modes and sliders: on all degrees of freedom there were no modes, and on those of contacts hardly any are left.
    assert_eq!(all.modes, MODES);
    assert!(
        all.multipliers.iter().any(|m| m.value.norm() < 1e-12),
        "no slider moves"
    );
    const PLACES: i64 = 30;
    let mut refused = 0;
    for place in 0..PLACES {
        let (found, reached) = within(before + (most - before) * place / PLACES, multipliers);
        match found {
            Err(e) => {
                assert_eq!(e.status, Status::OutOfMemory, "{e}");
                refused += 1;
            }
            Ok(found) => assert_eq!(
                found.radius, all.radius,
                "{place} of {PLACES}: {reached} of {most} bytes"
            ),
        }
        assert_eq!(LIVE.get(), before, "memory was not freed");
    }
    assert!(refused > PLACES * 3 / 4, "{refused}");
    assert_eq!(within(most, multipliers).0.unwrap().radius, all.radius);
    // Text that is held back by the harness is memory of this thread too.
    println!("{refused} of {PLACES} refused, {} bytes", most - before);
}

#[test]
fn sliders_of_a_wave_over_many_sectors_are_refused_where_memory_is_short() {
    stays_within(&rubbing_wheel(12, 1));
}

#[test]
fn sliders_of_waves_of_complex_numbers_are_refused_where_memory_is_short() {
    stays_within(&rubbing_wheel(18, 3));
}
