//! Sizes of a model, and indices of callers that count from 1.

use super::boundary::{Blame, call, call_count, check_pointer};
use super::handles::read;
use super::types::{hbvib_model, hbvib_status};
use crate::error::{Error, Result, Status};
use crate::model::Model;
use core::ffi::{c_char, c_uchar};

/// Degrees of freedom of a model, of one sector if it is cyclic; or a negative status.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed). Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_dofs(model: *const hbvib_model) -> i64 {
    call_count(|| Ok(read::<Model>(model, 1)?.ndof()))
}

/// Sectors of a model, 1 of a plain structure; or a negative status.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed). Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_sectors(model: *const hbvib_model) -> i64 {
    call_count(|| Ok(read::<Model>(model, 1)?.structure().sectors()))
}

/// Contacts of a model, tables, polynomials and forces of the caller among them; or a negative status.
/// Contacts are numbered from 0 in the order in which they were added.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed). Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_contacts(model: *const hbvib_model) -> i64 {
    call_count(|| Ok(read::<Model>(model, 1)?.contacts().len()))
}

/// Turns an index of a language that counts from 1 into one of this library, which counts from 0, and
/// refuses what lies outside in the words of that language: "dof = 0, needs 1 .. 4".
///
/// name       what the index is called, ends with NUL; of more than 40 bytes the first 40 are used.
///            NULL: "index".
/// index      1 .. count.
/// count      how many there are, >= 0.
/// from_zero  receives index - 1; untouched on error.
/// Errors: HBVIB_E_INDEX, HBVIB_E_DIMENSION (count), HBVIB_E_NULL. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_index_from_one(
    name: *const c_char,
    index: i64,
    count: i64,
    from_zero: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut bytes = [0; 40];
        let name = unsafe { short_text(name.cast(), &mut bytes) }.unwrap_or("index");
        check_pointer(from_zero, 4, "from_zero")?;
        let shifted = shift(name, index, count)?;
        unsafe { from_zero.write(shifted) };
        Ok(Status::Ok)
    })
}

fn shift(name: &str, index: i64, count: i64) -> Result<i64> {
    let error = match count {
        ..0 => {
            let error = Error::new(Status::Dimension, format_args!("count = {count}, needs at least 0"));
            return Err(error).blame(3);
        }
        0 => Error::new(Status::Index, format_args!("{name} = {index}, but there is none")),
        _ if (1..=count).contains(&index) => return Ok(index - 1),
        _ => Error::new(Status::Index, format_args!("{name} = {index}, needs 1 .. {count}")),
    };
    Err(error).blame(2)
}

/// The first bytes of a text of the caller, as far as they are UTF-8 and fit; none of NULL.
unsafe fn short_text(text: *const c_uchar, buffer: &mut [u8]) -> Option<&str> {
    if text.is_null() {
        return None;
    }
    let mut len = 0;
    while len < buffer.len() {
        let byte = unsafe { text.add(len).read() };
        if byte == 0 {
            break;
        }
        buffer[len] = byte;
        len += 1;
    }
    let whole = match core::str::from_utf8(&buffer[..len]) {
        Ok(_) => len,
        Err(error) => error.valid_up_to(),
    };
    core::str::from_utf8(&buffer[..whole]).ok()
}
