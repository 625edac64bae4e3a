//! Rows of the plain model of four degrees of freedom on which other programs were measured, through the functions for C:
//! from the matrices of the caller to the branch, with all checks at the boundary.
//!
//! It is no wheel: all harmonics feel the same structure, so that its responses need more points and iterations than those
//! of the ring damper.

use crate::calibration::Unit;
use crate::{Row, Work};
use hbvib::capi::{
    hbvib_branch, hbvib_branch_field, hbvib_branch_free, hbvib_branch_points, hbvib_contact, hbvib_contact_init,
    hbvib_contact_kind, hbvib_field, hbvib_forced_options, hbvib_forced_options_init, hbvib_forced_response,
    hbvib_matrix, hbvib_matrix_init, hbvib_matrix_kind, hbvib_mode_options, hbvib_mode_options_init, hbvib_model,
    hbvib_model_add_contact, hbvib_model_add_force, hbvib_model_free, hbvib_model_new, hbvib_model_set_matrix,
    hbvib_nonlinear_mode, hbvib_solver_options, hbvib_solver_options_init, hbvib_status, hbvib_view, hbvib_view_init,
};
use hbvib::{Error, Result, Status};
use std::f64::consts::PI;
use std::mem::MaybeUninit;
use std::ptr::null_mut;

pub const ROWS: &[Row] = &[
    Row {
        name: "blade and ring through C, 20 N, H 9, about 200 points",
        unit: Unit::Lu11,
        stored: 3_750.0,
        run: || response(9, 0.0, 8.2e-3),
    },
    Row {
        name: "blade and ring through C, 20 N, H 9, default steps",
        unit: Unit::Lu11,
        stored: 2_710.0,
        run: || response(9, 0.0, 0.0),
    },
    Row {
        name: "blade and ring through C, backbone, H 9",
        unit: Unit::Lu11,
        stored: 5_050.0,
        run: backbone,
    },
    Row {
        name: "blade and ring through C, 20 N, H 127",
        unit: Unit::Lu11,
        stored: 107_000.0,
        run: || response(127, 0.0, 0.0),
    },
    Row {
        name: "blade and ring through C, 20 N, tolerance 1e-3",
        unit: Unit::Lu11,
        stored: 45_900.0,
        run: || response(9, 1e-3, 0.0),
    },
];

/// Turns a status into an error.
fn checked(status: hbvib_status) -> Result<()> {
    if status == 0 {
        return Ok(());
    }
    Err(Error::new(Status::Internal, format_args!("status {status}")))
}

/// A struct that the library fills.
fn filled<T>(init: unsafe extern "C" fn(*mut T, usize) -> hbvib_status) -> Result<T> {
    let mut filled = MaybeUninit::<T>::uninit();
    // SAFETY: the pointer is valid for the size of the struct.
    checked(unsafe { init(filled.as_mut_ptr(), size_of::<T>()) })?;
    // SAFETY: the function fills the struct where it returns 0.
    Ok(unsafe { filled.assume_init() })
}

/// A model of the library.
struct Model(*mut hbvib_model);

impl Drop for Model {
    fn drop(&mut self) {
        // SAFETY: the handle is valid.
        unsafe { hbvib_model_free(self.0) };
    }
}

/// A branch of the library.
struct Branch(*mut hbvib_branch);

impl Drop for Branch {
    fn drop(&mut self) {
        // SAFETY: the handle is valid.
        unsafe { hbvib_branch_free(self.0) };
    }
}

impl Branch {
    fn work(&self) -> Result<Work> {
        let mut view: hbvib_view = filled(hbvib_view_init)?;
        let field = hbvib_field::HBVIB_NEWTON_ITERATIONS as i32;
        // SAFETY: handle and view are valid.
        checked(unsafe { hbvib_branch_field(self.0, field, &raw mut view) })?;
        // SAFETY: the handle is valid.
        let points = unsafe { hbvib_branch_points(self.0) } as usize;
        // SAFETY: the view has so many numbers while the branch lives.
        let iterations = unsafe { std::slice::from_raw_parts(view.data, points) };
        Ok(Work {
            points,
            iterations: iterations.iter().sum::<f64>() as usize,
            seconds: None,
            per: (1.0, "all"),
        })
    }
}

/// The model: a blade of two masses on a disk, and a ring that rubs on it, in a standing pattern; limit force 5 N.
fn model(force: f64) -> Result<Model> {
    let bend = 4.0 * (PI / 12.0).sin().powi(2);
    let (disk, ring) = (6e5 + bend * 5e7, bend * 2e7);
    let mass = [
        [0.2, 0.0, 0.0, 0.0],
        [0.0, 0.3, 0.0, 0.0],
        [0.0, 0.0, 1.2, 0.0],
        [0.0, 0.0, 0.0, 0.03],
    ];
    let stiffness = [
        [2e6, -2e6, 0.0, 0.0],
        [-2e6, 3e6, -1e6, 0.0],
        [0.0, -1e6, 1e6 + disk, 0.0],
        [0.0, 0.0, 0.0, ring],
    ];
    let damping = stiffness.map(|row| row.map(|k| if force > 0.0 { 2e-6 * k } else { 0.0 }));
    let mut contact: hbvib_contact = filled(hbvib_contact_init)?;
    contact.kind = hbvib_contact_kind::HBVIB_JENKINS as i32;
    (contact.dof_a[0], contact.dof_b[0]) = (2, 3);
    (contact.kt, contact.mu, contact.preload) = (5e7, 1.0, 5.0);
    let mut handle = null_mut();
    // SAFETY: all pointers are valid.
    checked(unsafe { hbvib_model_new(4, &raw mut handle) })?;
    let model = Model(handle);
    for (kind, values) in [
        (hbvib_matrix_kind::HBVIB_MASS, &mass),
        (hbvib_matrix_kind::HBVIB_DAMPING, &damping),
        (hbvib_matrix_kind::HBVIB_STIFFNESS, &stiffness),
    ] {
        let mut matrix: hbvib_matrix = filled(hbvib_matrix_init)?;
        (matrix.rows, matrix.cols, matrix.values) = (4, 4, values.as_ptr().cast());
        // SAFETY: the matrix holds rows times cols numbers.
        checked(unsafe { hbvib_model_set_matrix(model.0, kind as i32, &raw const matrix) })?;
    }
    // SAFETY: handle and struct are valid.
    checked(unsafe { hbvib_model_add_contact(model.0, &raw const contact, null_mut()) })?;
    if force > 0.0 {
        // SAFETY: the handle is valid.
        checked(unsafe { hbvib_model_add_force(model.0, 0, 1, force, 0.0) })?;
    }
    Ok(model)
}

fn solver(harmonics: i64, tolerance: f64, step_max: f64) -> Result<hbvib_solver_options> {
    let mut options: hbvib_solver_options = filled(hbvib_solver_options_init)?;
    (options.harmonics, options.tolerance, options.step_max) = (harmonics, tolerance, step_max);
    options.response_dof = 0;
    Ok(options)
}

/// The response over a tenth about its resonance.
fn response(harmonics: i64, tolerance: f64, step_max: f64) -> Result<Work> {
    let model = model(20.0)?;
    let solver = solver(harmonics, tolerance, step_max)?;
    let mut range: hbvib_forced_options = filled(hbvib_forced_options_init)?;
    (range.omega_start, range.omega_stop) = (1187.306, 1451.152);
    let mut branch = null_mut();
    // SAFETY: all pointers are valid.
    checked(unsafe {
        hbvib_forced_response(
            model.0,
            &raw const solver,
            &raw const range,
            std::ptr::null(),
            &raw mut branch,
        )
    })?;
    Branch(branch).work()
}

/// The first nonlinear mode, from stick to slip.
fn backbone() -> Result<Work> {
    let model = model(0.0)?;
    let solver = solver(9, 0.0, 0.0)?;
    let mut range: hbvib_mode_options = filled(hbvib_mode_options_init)?;
    (range.log10_start, range.log10_stop) = (-5.5, -2.0);
    let mut branch = null_mut();
    // SAFETY: all pointers are valid.
    checked(unsafe {
        hbvib_nonlinear_mode(
            model.0,
            &raw const solver,
            &raw const range,
            std::ptr::null(),
            &raw mut branch,
        )
    })?;
    Branch(branch).work()
}
