//! Section "Model" of the header: a model as bytes.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, count, input, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{insert, read};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Status, fail};
use crate::model::Model;
use core::ffi::c_void;

/// Saves a model as bytes: matrices, faces, contacts, springs, forces, damping and speed. The bytes
/// begin with the version of their format and end with a checksum; they are the same on all
/// machines, and a loaded model solves to the same bits. Write them to a file or send them to
/// another process as they are.
///
/// capacity  bytes that fit into `bytes`.
/// bytes     receives the model, or NULL: then only the size is returned.
/// size      receives the number of bytes that the model takes.
/// Errors: HBVIB_E_UNSUPPORTED (a force of the caller, naming its contact), HBVIB_E_DIMENSION
/// (capacity too small: bytes has no model), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY (being
/// changed). Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_save(
    model: *const hbvib_model,
    capacity: i64,
    bytes: *mut c_void,
    size: *mut i64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let capacity = count(capacity, 2, "capacity")?;
        check_pointer(size, 4, "size")?;
        let needed = if bytes.is_null() {
            model.save_into(&mut []).with_argument(1)?
        } else {
            let place = unsafe { output(bytes.cast::<u8>(), capacity, 3, "bytes") }?;
            model.save_into(place).with_argument(1)?
        };
        unsafe { size.write(needed as i64) };
        if !bytes.is_null() && capacity < needed {
            return fail!(Dimension, "capacity = {capacity}, needs {needed}, as size tells").with_argument(2);
        }
        Ok(Status::Ok)
    })
}

/// Loads a model that hbvib_model_save saved.
///
/// length  number of bytes, >= 0.
/// bytes   the saved model.
/// out     receives the model; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_ARGUMENT (no saved model, or one that is incomplete or damaged),
/// HBVIB_E_UNSUPPORTED (saved by a newer library), HBVIB_E_DIMENSION (length), HBVIB_E_NULL,
/// HBVIB_E_OUT_OF_MEMORY; others where bytes that were not saved by the library describe no model.
/// Memory is taken in proportion to length at most. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_load(
    length: i64,
    bytes: *const c_void,
    out: *mut *mut hbvib_model,
) -> hbvib_status {
    call(|| {
        let length = count(length, 1, "length")?;
        let bytes = unsafe { input(bytes.cast::<u8>(), length, 2, "bytes") }?;
        check_pointer(out, 3, "out")?;
        let model = Model::load(bytes).with_argument(2)?;
        unsafe { out.write(insert(model)?) };
        Ok(Status::Ok)
    })
}
