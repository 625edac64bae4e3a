//! Section "Model" of the header: matrices, springs and forces of a model, read back.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, count, optional};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::crossing::indices::GROUND;
use crate::capi::structures::matrices::matrix_kind;
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail};
use crate::linalg::sparse_storage::sparse::Columns;
use crate::model::Model;
use crate::model::saved::contents::Block;

/// Blocks of a matrix, by the sectors of their columns.
#[repr(C)]
pub enum hbvib_block {
    /// Rows and columns of the same sector: all of a plain structure.
    HBVIB_BLOCK_OWN = 0,
    /// Columns of the next sector.
    HBVIB_BLOCK_NEXT = 1,
    /// Columns of the previous sector, where it was given: else the transpose of HBVIB_BLOCK_NEXT.
    HBVIB_BLOCK_PREVIOUS = 2,
}

/// The engine order of a model, as hbvib_cyclic_set_wave takes it; 0 for a plain structure.
///
/// engine_order  receives the number; untouched on error.
/// Errors: HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_wave(model: *const hbvib_model, engine_order: *mut i64) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        check_pointer(engine_order, 2, "engine_order")?;
        unsafe { engine_order.write(model.structure().engine_order()) };
        Ok(Status::Ok)
    })
}

/// The entries of a matrix of a model, or of a block of it, each once, column after column, without
/// Rayleigh damping, springs and contacts. Rows and columns of fixed degrees of freedom are empty;
/// those of the right face of a sector are in the blocks of the left one.
///
/// which     HBVIB_MASS .. HBVIB_STIFFNESS_SPEED2.
/// block     HBVIB_BLOCK_OWN, HBVIB_BLOCK_NEXT or HBVIB_BLOCK_PREVIOUS.
/// capacity  entries that fit into each array.
/// row       receives numbers of rows, or NULL.
/// column    receives numbers of columns, or NULL.
/// value     receives complex entries, 2 * capacity doubles, or NULL.
/// count     receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_ARGUMENT (which, block), HBVIB_E_UNSUPPORTED (given per nodal diameter),
/// HBVIB_E_DIMENSION (capacity), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed).
/// Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_matrix(
    model: *const hbvib_model,
    which: i32,
    block: i32,
    capacity: i64,
    row: *mut i64,
    column: *mut i64,
    value: *mut f64,
    count: *mut i64,
) -> hbvib_status {
    const OWN: i32 = hbvib_block::HBVIB_BLOCK_OWN as i32;
    const NEXT: i32 = hbvib_block::HBVIB_BLOCK_NEXT as i32;
    const PREVIOUS: i32 = hbvib_block::HBVIB_BLOCK_PREVIOUS as i32;
    call(|| {
        let model = read::<Model>(model, 1)?;
        let which = matrix_kind(which)?;
        let block = match block {
            OWN => Block::Own,
            NEXT => Block::Next,
            PREVIOUS => Block::Previous,
            other => return fail!(Argument, "block = {other}, needs HBVIB_BLOCK_OWN = 0 .. 2").with_argument(3),
        };
        let a = model.block(which, block).with_argument(2)?;
        let row = optional((row, 5), "row")?;
        let column = optional((column, 6), "column")?;
        let value = optional((value, 7), "value")?;
        let entries = a.map_or(0, Columns::stored);
        let wanted = row.is_some() || column.is_some() || value.is_some();
        if !unsafe { fits(entries, wanted, capacity, 4, (count, 8)) }? {
            return Ok(Status::Ok);
        }
        let degrees = model.structure().degrees();
        let columns = a
            .iter()
            .flat_map(|a| (0..a.order()).flat_map(move |j| a.column(j).map(move |(i, v)| (i, j, v))));
        for (k, (i, j, v)) in columns.enumerate() {
            unsafe {
                if let Some(p) = row {
                    p.add(k).write(degrees.origin(i) as i64);
                }
                if let Some(p) = column {
                    p.add(k).write(degrees.origin(j) as i64);
                }
                if let Some(p) = value {
                    p.add(2 * k).write(v.re);
                    p.add(2 * k + 1).write(v.im);
                }
            }
        }
        Ok(Status::Ok)
    })
}

/// The linear springs of a model, in the order in which they were added.
///
/// capacity       numbers that fit into each array.
/// dof_a, dof_b   receive numbers of degrees of freedom or HBVIB_GROUND, or NULL.
/// sector_offset  receives numbers of sectors from side a to side b, or NULL.
/// stiffness      receives the stiffnesses, or NULL.
/// count          receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_springs(
    model: *const hbvib_model,
    capacity: i64,
    dof_a: *mut i64,
    dof_b: *mut i64,
    sector_offset: *mut i64,
    stiffness: *mut f64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let springs = model.springs();
        let dof_a = optional((dof_a, 3), "dof_a")?;
        let dof_b = optional((dof_b, 4), "dof_b")?;
        let offset = optional((sector_offset, 5), "sector_offset")?;
        let stiffness = optional((stiffness, 6), "stiffness")?;
        let wanted = dof_a.is_some() || dof_b.is_some() || offset.is_some() || stiffness.is_some();
        if !unsafe { fits(springs.len(), wanted, capacity, 2, (count, 7)) }? {
            return Ok(Status::Ok);
        }
        let place = |dof: Option<usize>| dof.map_or(GROUND, |dof| dof as i64);
        for (k, spring) in springs.iter().enumerate() {
            unsafe {
                if let Some(p) = dof_a {
                    p.add(k).write(place(spring.dof_a));
                }
                if let Some(p) = dof_b {
                    p.add(k).write(place(spring.dof_b));
                }
                if let Some(p) = offset {
                    p.add(k).write(spring.sector_offset);
                }
                if let Some(p) = stiffness {
                    p.add(k).write(spring.stiffness);
                }
            }
        }
        Ok(Status::Ok)
    })
}

/// The forces of a model, in the order in which they were added; an unbalance is two of them.
///
/// capacity    numbers that fit into each array.
/// dof         receives numbers of degrees of freedom, or NULL.
/// harmonic    receives numbers of harmonics, or NULL.
/// force       receives complex peak values, 2 * capacity doubles, or NULL; over the square of the
///             angular frequency where unbalance is 1.
/// unbalance   receives numbers: 1 for a force that grows with the square of the frequency, else 0;
///             or NULL.
/// count       receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_forces(
    model: *const hbvib_model,
    capacity: i64,
    dof: *mut i64,
    harmonic: *mut i64,
    force: *mut f64,
    unbalance: *mut i64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let forces = model.excitation().forces();
        let dof = optional((dof, 3), "dof")?;
        let harmonic = optional((harmonic, 4), "harmonic")?;
        let force = optional((force, 5), "force")?;
        let unbalance = optional((unbalance, 6), "unbalance")?;
        let wanted = dof.is_some() || harmonic.is_some() || force.is_some() || unbalance.is_some();
        if !unsafe { fits(forces.len(), wanted, capacity, 2, (count, 7)) }? {
            return Ok(Status::Ok);
        }
        for (k, one) in forces.iter().enumerate() {
            unsafe {
                if let Some(p) = dof {
                    p.add(k).write(one.dof as i64);
                }
                if let Some(p) = harmonic {
                    p.add(k).write(one.harmonic as i64);
                }
                if let Some(p) = force {
                    p.add(2 * k).write(one.value.re);
                    p.add(2 * k + 1).write(one.value.im);
                }
                if let Some(p) = unbalance {
                    p.add(k).write(i64::from(one.per_omega2));
                }
            }
        }
        Ok(Status::Ok)
    })
}

/// Writes the count of a list; whether there are arrays, into which the list then fits.
///
/// # Safety
/// The caller of the C function states that a number fits into `count`.
pub(crate) unsafe fn fits(
    len: usize,
    wanted: bool,
    capacity: i64,
    argument: i32,
    out: (*mut i64, i32),
) -> Result<bool> {
    let capacity = count(capacity, argument, "capacity")?;
    check_pointer(out.0, out.1, "count")?;
    unsafe { out.0.write(len as i64) };
    if wanted && capacity < len {
        return fail!(Dimension, "capacity = {capacity}, needs {len}").with_argument(argument);
    }
    Ok(wanted)
}
