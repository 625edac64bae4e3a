//! Section "Laws of the caller" of the header: a force computed by a callback.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, count, input};
use crate::capi::crossing::boundary::{WithArgument, call, outside};
use crate::capi::crossing::handles::write;
use crate::capi::crossing::indices::index;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_reserved, init, load};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::contact::laws::{Call, User, UserForce};
use crate::contact::{Contact, ContactKind};
use crate::error::{Result, Status, fail, try_push};
use crate::model::Model;
use core::ffi::c_void;
use core::ptr;
use std::sync::Arc;

/// One period for which a force callback computes its force. All arrays are row-major, sample after
/// sample: the entry of sample j, row i and column k of N x n x n numbers is [(j * n + i) * n + k].
///
/// Sample j lies at the time j * 2 pi / (omega * samples). The callback must write all of f, and of
/// z where there are states: they are NaN before the call. The derivatives are 0 before the call;
/// write those that are not 0. They must be the exact derivatives of the f and z written.
///
/// With states, z_j = Z(z_(j-1), motion at j - 1 and at j). z0 is the state before sample 0; the
/// motion before sample 0 is that of the last sample, because the motion is periodic. The library
/// finds the z0 that the last sample reaches again. In a first call z0 is 0, the state of a
/// structure at rest, and samples is 2: loading from rest to the begin of the period. States should
/// be of similar size, because one tolerance holds for all of them together.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_force_call {
    /// Bytes of this struct as the library knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// Angular frequency of the period. States may need it as their time step 2 pi / (omega *
    /// samples); the force must not depend on it in any other way.
    pub omega: f64,
    /// Samples N over the period: the requested number or a few more, and half or twice as many
    /// where the sampling is checked (HBVIB_SAMPLING_ERROR).
    pub samples: i64,
    /// Degrees of freedom n of the force.
    pub n: i64,
    /// Internal states s.
    pub states: i64,
    /// In: motions of these degrees of freedom, N x n.
    pub u: *const f64,
    /// In: their velocities du/dt, N x n; NULL unless uses_velocity.
    pub v: *const f64,
    /// In: states before sample 0, s numbers; NULL without states, as are all fields below whose
    /// names have a z.
    pub z0: *const f64,
    /// Out: forces f of M x'' + C x' + K x + f = f_ex, N x n.
    pub f: *mut f64,
    /// Out: d f / d u at the same time, at given z: N x n x n.
    pub df_du: *mut f64,
    /// Out: d f / d v, likewise: N x n x n; NULL unless uses_velocity.
    pub df_dv: *mut f64,
    /// Out: states, N x s.
    pub z: *mut f64,
    /// Out: d z_j / d z_(j-1), N x s x s.
    pub dz_dz: *mut f64,
    /// Out: d z_j / d u_(j-1), N x s x n.
    pub dz_du_before: *mut f64,
    /// Out: d z_j / d u_j, N x s x n.
    pub dz_du: *mut f64,
    /// Out: d z_j / d v_(j-1), N x s x n; NULL unless uses_velocity.
    pub dz_dv_before: *mut f64,
    /// Out: d z_j / d v_j, N x s x n; NULL unless uses_velocity.
    pub dz_dv: *mut f64,
    /// Out: d z_j / d omega, where the time step enters: N x s.
    pub dz_domega: *mut f64,
    /// Out: d f_j / d z_j, N x n x s.
    pub df_dz: *mut f64,
}

/// A force of the caller. Returns 0 when done. A number above 0: the force cannot be computed at
/// this motion; the solver tries shorter steps, and stops at the smallest. A number below 0 stops
/// the solver at once. A branch that stops so keeps its points (HBVIB_STOPPED_CALLBACK); without
/// points the status is HBVIB_E_CALLBACK; hbvib_last_error has the number. NaN and infinity in the
/// numbers written count as a number above 0. The motions themselves are always finite.
///
/// The same motion must always give the same force. Every thread that uses the model, or a branch
/// of it, may call the function. It may call the library, but not change or free a handle in use
/// (HBVIB_E_BUSY), and must not throw or longjmp. The cancel flag is read between calls.
pub type hbvib_force_fn = Option<unsafe extern "C-unwind" fn(user: *mut c_void, call: *const hbvib_force_call) -> i32>;

/// A force of the caller on some degrees of freedom. Fill it by hbvib_user_force_init, then set
/// dofs, n and force at least.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_user_force {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 1: the force depends on velocities; 0 (default): it does not.
    pub uses_velocity: i32,
    /// 1: f(-u, -v) = -f(u, v), with states of opposite sign too, so that even harmonics may be
    /// left out; 0 (default): even harmonics are carried.
    pub is_odd: i32,
    /// Must be 0.
    pub reserved: i32,
    /// Degrees of freedom on which it acts, each against the ground.
    pub dofs: *const i64,
    /// Their number, at least 1.
    pub n: i64,
    /// Internal states; 0 (default): the force at a time follows from the motion at that time
    /// alone.
    pub states: i64,
    /// Samples per period, more than twice the highest harmonic; 0 (default): those of the solver
    /// options, or automatic: at least 64, with states 256.
    pub samples: i64,
    /// The callback.
    pub force: hbvib_force_fn,
    /// Passed to the callback.
    pub user: *mut c_void,
}

unsafe impl VersionedStruct for hbvib_user_force {
    const NAME: &'static str = "hbvib_user_force";
    const FIRST_SIZE: usize = 64;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            uses_velocity: 0,
            is_odd: 0,
            reserved: 0,
            dofs: ptr::null(),
            n: 0,
            states: 0,
            samples: 0,
            force: None,
            user: ptr::null_mut(),
        }
    }
}

/// Fills the description of a force with zeros: dofs, n and force must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_user_force_init(o: *mut hbvib_user_force, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Adds a force of the caller, which counts as a contact. The callback is not called here, but by
/// every solve and every result of a branch that needs the force (hbvib_branch_harmonics, loops,
/// energies): callback and `user` must outlive the model, its copies, and all branches solved from
/// them.
///
/// Put the linear stiffness and damping of the force into K and C, where they can be separated: a
/// nonlinear mode starts from the structure without the force. A force that is not 0 at rest is a
/// constant load: a forced response and a nonlinear mode start from its static solution.
///
/// o   the description.
/// id  receives the number of the contact, counted from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dofs), HBVIB_E_DIMENSION (n, states, samples), HBVIB_E_ARGUMENT (flags, a
/// degree of freedom twice), HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL (force, dofs), HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_add_user_force(
    model: *mut hbvib_model,
    o: *const hbvib_user_force,
    id: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let o = unsafe { load(o, 2) }?;
        if !id.is_null() {
            check_pointer(id, 3, "id")?;
        }
        let contact = unsafe { contact(&o, model.ndof()) }.with_argument(2)?;
        let number = model.add_contact(&contact).with_argument(2)?;
        if !id.is_null() {
            unsafe { id.write(number as i64) };
        }
        Ok(Status::Ok)
    })
}

/// The callback with its pointer.
struct Callback {
    force: unsafe extern "C-unwind" fn(*mut c_void, *const hbvib_force_call) -> i32,
    user: *mut c_void,
}

// The header states that any thread which uses the model may call it.
unsafe impl Send for Callback {}
unsafe impl Sync for Callback {}

impl UserForce for Callback {
    fn identity(&self) -> u64 {
        (self.force as usize as u64) ^ (self.user.addr() as u64).rotate_left(32)
    }

    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        let states = &mut call.states;
        let period = hbvib_force_call {
            struct_size: size_of::<hbvib_force_call>() as u32,
            reserved: 0,
            omega: call.omega,
            samples: call.samples as i64,
            n: call.directions as i64,
            states: states.count as i64,
            u: input_of(call.u),
            v: input_of(call.v),
            z0: input_of(states.z0),
            f: output_of(call.f),
            df_du: output_of(call.df_du),
            df_dv: output_of(call.df_dv),
            z: output_of(states.z),
            dz_dz: output_of(states.dz_dz),
            dz_du_before: output_of(states.dz_du_before),
            dz_du: output_of(states.dz_du),
            dz_dv_before: output_of(states.dz_dv_before),
            dz_dv: output_of(states.dz_dv),
            dz_domega: output_of(states.dz_domega),
            df_dz: output_of(states.df_dz),
        };
        outside(|| unsafe { (self.force)(self.user, &raw const period) })
    }
}

fn input_of(values: &[f64]) -> *const f64 {
    if values.is_empty() {
        ptr::null()
    } else {
        values.as_ptr()
    }
}

fn output_of(values: &mut [f64]) -> *mut f64 {
    if values.is_empty() {
        ptr::null_mut()
    } else {
        values.as_mut_ptr()
    }
}

fn flag(value: i32, name: &str) -> Result<bool> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        other => fail!(Argument, "hbvib_user_force: {name} = {other}, needs 0 or 1"),
    }
}

/// A number of states above this is taken for an uninitialised field.
const MOST_STATES: usize = 1 << 16;

/// The description as a contact; its degrees of freedom are checked against a model of `ndof`.
unsafe fn contact(o: &hbvib_user_force, ndof: usize) -> Result<Contact> {
    check_reserved(o.reserved, 2, "hbvib_user_force")?;
    let Some(force) = o.force else {
        return fail!(Null, "hbvib_user_force: force is NULL");
    };
    let n = count(o.n, 2, "n")?;
    if n == 0 || n > ndof {
        return fail!(Dimension, "hbvib_user_force: n = {n}, needs 1 .. ndof = {ndof}");
    }
    let mut dofs = Vec::new();
    for (k, &dof) in unsafe { input(o.dofs, n, 2, "dofs") }?.iter().enumerate() {
        let dof = index(dof, ndof, 2, "dof").map_err(|e| e.at(format_args!("hbvib_user_force: dofs[{k}]")))?;
        if dofs.contains(&dof) {
            return fail!(Argument, "hbvib_user_force: dofs[{k}] = {dof} stands there twice");
        }
        try_push(&mut dofs, dof, "the degrees of freedom of a force")?;
    }
    let callback = Callback { force, user: o.user };
    let states = count(o.states, 2, "states")?;
    if states > MOST_STATES {
        return fail!(
            Dimension,
            "hbvib_user_force: states = {states}, needs 0 .. {MOST_STATES}"
        );
    }
    let law = User {
        states,
        velocity: flag(o.uses_velocity, "uses_velocity")?,
        odd: flag(o.is_odd, "is_odd")?,
        ..User::new(Arc::new(callback), n, count(o.samples, 2, "samples")?)?
    };
    Ok(Contact::over(dofs, ContactKind::User(law)))
}
