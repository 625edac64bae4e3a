//! Inputs that make no sense, through the C interface: the exact status, and outputs as they were.

use super::Case;
use super::laws::jenkins;
use hbvib::capi::{
    hbvib_branch, hbvib_contact, hbvib_contact_evaluate, hbvib_forced_options, hbvib_forced_options_init,
    hbvib_forced_response, hbvib_last_error, hbvib_matrix, hbvib_matrix_init, hbvib_matrix_kind, hbvib_model,
    hbvib_model_add_contact, hbvib_model_add_force, hbvib_model_free, hbvib_model_new, hbvib_model_set_matrix,
    hbvib_solver_options, hbvib_solver_options_init, hbvib_status_name,
};
use std::ffi::{CStr, c_char};
use std::mem::MaybeUninit;
use std::ptr;

/// A struct as its `_init` function fills it.
fn filled<T>(init: unsafe extern "C" fn(*mut T, usize) -> i32) -> T {
    let mut value = MaybeUninit::uninit();
    assert_eq!(unsafe { init(value.as_mut_ptr(), size_of::<T>()) }, 0);
    // Initialised by the call.
    unsafe { value.assume_init() }
}

fn text(p: *const c_char) -> String {
    unsafe { CStr::from_ptr(p) }.to_str().unwrap().to_owned()
}

/// Name and sentence of the status of the last call.
type Told = (String, String);

fn reported(status: i32) -> Told {
    (text(hbvib_status_name(status)), text(hbvib_last_error()))
}

const UNTOUCHED: f64 = 12345.678;

/// A model of one mass on a spring, with a force.
struct Host(*mut hbvib_model);

impl Host {
    fn new() -> Self {
        let mut model = ptr::null_mut();
        assert_eq!(unsafe { hbvib_model_new(1, &raw mut model) }, 0);
        let caller = Self(model);
        for kind in [hbvib_matrix_kind::HBVIB_MASS, hbvib_matrix_kind::HBVIB_STIFFNESS] {
            assert_eq!(caller.set(kind, 1.0), 0);
        }
        assert_eq!(caller.force(0.1), 0);
        caller
    }

    fn set(&self, kind: hbvib_matrix_kind, value: f64) -> i32 {
        let matrix = hbvib_matrix {
            rows: 1,
            cols: 1,
            values: &raw const value,
            ..filled(hbvib_matrix_init)
        };
        unsafe { hbvib_model_set_matrix(self.0, kind as i32, &raw const matrix) }
    }

    fn force(&self, value: f64) -> i32 {
        unsafe { hbvib_model_add_force(self.0, 0, 1, value, 0.0) }
    }

    /// A contact; its number must stay as it was where it is refused.
    fn contact(&self, law: hbvib_contact) -> i32 {
        let mut id = -77;
        let contact = hbvib_contact {
            dof_a: [0, -1, -1],
            ..law
        };
        let status = unsafe { hbvib_model_add_contact(self.0, &raw const contact, &raw mut id) };
        assert!(status == 0 || id == -77);
        status
    }

    /// A solve at one frequency; the branch must stay as it was where it is refused.
    fn solve(&self, harmonics: i64, samples: i64, omega: f64) -> i32 {
        let solver = hbvib_solver_options {
            harmonics,
            samples,
            ..filled(hbvib_solver_options_init)
        };
        let forced = hbvib_forced_options {
            omega_start: omega,
            omega_stop: omega,
            ..filled(hbvib_forced_options_init)
        };
        let mark = ptr::without_provenance_mut::<hbvib_branch>(64);
        let mut branch = mark;
        let status = unsafe {
            hbvib_forced_response(
                self.0,
                &raw const solver,
                &raw const forced,
                ptr::null(),
                &raw mut branch,
            )
        };
        assert!(status >= 0 || branch == mark);
        if status >= 0 {
            assert_eq!(unsafe { hbvib::capi::hbvib_branch_free(branch) }, 0);
        }
        status
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        unsafe { hbvib_model_free(self.0) };
    }
}

/// A law on a motion; the force must stay as it was where it is refused.
fn evaluate(law: &hbvib_contact, harmonics: i64, samples: i64, motion: f64) -> i32 {
    let motion = [motion; 4];
    let mut force = [UNTOUCHED; 4];
    let status = unsafe {
        hbvib_contact_evaluate(
            ptr::from_ref(law),
            harmonics,
            samples,
            1.0,
            motion.as_ptr(),
            2,
            force.as_mut_ptr(),
            2,
            ptr::null_mut(),
            0,
        )
    };
    assert!(status == 0 || force.iter().all(|f| f.to_bits() == UNTOUCHED.to_bits()));
    status
}

/// Sentences of the calls that an input of the case's list can be handed to.
fn calls(input: &str) -> Vec<Told> {
    let caller = Host::new();
    let good = jenkins(1.0, 0.3);
    let bad = [f64::NAN, f64::INFINITY];
    let refused = |law: hbvib_contact| vec![reported(caller.contact(law)), reported(evaluate(&law, 1, 0, 0.1))];
    match input {
        "NaN in K" => bad
            .map(|v| reported(caller.set(hbvib_matrix_kind::HBVIB_STIFFNESS, v)))
            .to_vec(),
        "Inf in F" => bad.map(|v| reported(caller.force(v))).to_vec(),
        "negative kt" => refused(jenkins(-1.0, 0.3)),
        "negative fc" => [refused(jenkins(1.0, -0.3)), refused(hbvib_contact { mu: -0.3, ..good })].concat(),
        "H<0" => vec![
            reported(caller.solve(-1, 0, 1.0)),
            reported(evaluate(&good, -1, 0, 0.1)),
        ],
        "N<2H+1" => vec![reported(caller.solve(9, 18, 1.3)), reported(evaluate(&good, 1, 2, 0.1))],
        "n=0" => {
            let mark = ptr::without_provenance_mut::<hbvib_model>(64);
            let mut model = mark;
            let status = unsafe { hbvib_model_new(0, &raw mut model) };
            assert_eq!(model, mark);
            vec![reported(status)]
        }
        "omega 0 or negative" => [0.0, -0.0, -1.0]
            .map(|omega| reported(caller.solve(3, 0, omega)))
            .to_vec(),
        other => panic!("the case has an input without a check: {other}"),
    }
}

pub fn bad_inputs(case: &Case) {
    let names = |name: &str| -> Vec<String> {
        let list = case.param(name).as_array().unwrap();
        list.iter().map(|v| v.as_str().unwrap().to_owned()).collect()
    };
    let (inputs, wanted) = (names("cases"), names("statuses"));
    assert_eq!(inputs.len(), wanted.len());
    for (input, wanted) in inputs.iter().zip(&wanted) {
        for (name, sentence) in calls(input) {
            case.holds(
                &format!("{input}: {name}, \"{sentence}\""),
                name == *wanted && !sentence.is_empty(),
            );
        }
    }
    // The same with good numbers is accepted: it was the input that was refused. The motion is looked at, too.
    let caller = Host::new();
    let good = jenkins(1.0, 0.3);
    let accepted = [
        caller.contact(good),
        caller.solve(9, 19, 1.3),
        evaluate(&good, 1, 3, 0.1),
    ];
    case.holds(&format!("good numbers: {accepted:?}"), accepted == [0; 3]);
    let (name, sentence) = reported(evaluate(&good, 1, 0, f64::NAN));
    case.holds(
        &format!("NaN in a motion: {name}, \"{sentence}\""),
        name == "HBVIB_E_NOT_FINITE",
    );
}
