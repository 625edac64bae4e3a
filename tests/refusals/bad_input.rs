//! Bad matrices, contacts and arrays give their stated error with a sentence that names the place,
//! and leave model and arrays as they were.

use crate::common::refusal::{OMEGA, refused, unharmed};
use crate::common::{BASE, harmonics, solve_at};
use hbvib::{
    Constant, Contact, MatrixKind, MatrixView, Model, Part, Status, Storage, Values, contact_evaluate, forced_residual,
};
use num_complex::Complex64;

#[test]
fn bad_matrices_are_refused_with_the_place_of_the_fault() {
    let good = [4.0, 1.0, 1.0, 3.0];
    let with = |i: usize, v: f64| {
        let mut a = good;
        a[i] = v;
        a
    };
    let mut model = Model::new(2).unwrap();
    let mut set = |which, view: &MatrixView<'_>| model.set_matrix(which, view);
    refused(
        set(MatrixKind::Stiffness, &MatrixView::dense(2, &with(1, f64::NAN))),
        Status::NotFinite,
        &["stiffness[1,0] is NaN"],
    );
    refused(
        set(MatrixKind::Damping, &MatrixView::dense(2, &with(2, f64::INFINITY))),
        Status::NotFinite,
        &["damping[0,1]", "infinite"],
    );
    refused(
        set(MatrixKind::Stiffness, &MatrixView::dense(2, &with(1, 2.0))),
        Status::NotHermitian,
        &["stiffness[", "GENERAL"],
    );
    refused(
        set(MatrixKind::Stiffness, &MatrixView::dense(2, &with(2, 0.0))),
        Status::NotHermitian,
        &["one triangle"],
    );
    refused(
        set(MatrixKind::Stiffness, &MatrixView::dense(3, &[0.0; 9])),
        Status::Dimension,
        &["stiffness is 3 x 3", "2 x 2"],
    );
    refused(
        set(MatrixKind::Stiffness, &MatrixView::dense(2, &good[..3])),
        Status::Dimension,
        &["3 entries", "4"],
    );
    refused(
        set(MatrixKind::Mass, &MatrixView::dense(2, &with(3, -1.0))),
        Status::NotPositiveDefinite,
        &["mass[1,1] = -1"],
    );
    refused(
        set(MatrixKind::Mass, &MatrixView::dense(2, &good).part(Part::General)),
        Status::NotHermitian,
        &["mass"],
    );
    let sparse = |col_ptr: &'static [i64], row_idx: &'static [i64], base| MatrixView {
        rows: 2,
        cols: 2,
        storage: Storage::Csc { col_ptr, row_idx },
        values: Values::Real(&[1.0, 2.0]),
        part: Part::Full,
        index_base: base,
    };
    refused(
        set(MatrixKind::Stiffness, &sparse(&[0, 1, 2], &[0, 2], 0)),
        Status::Index,
        &["row_idx[1] = 2"],
    );
    refused(
        set(MatrixKind::Stiffness, &sparse(&[0, 1, 2], &[0, 1], 1)),
        Status::Index,
        &["col_ptr[0] = 0", "index base 1"],
    );
    refused(
        set(MatrixKind::Stiffness, &sparse(&[0, 2, 1], &[0, 1], 0)),
        Status::Index,
        &["col_ptr[2] = 1"],
    );
    refused(
        set(MatrixKind::Stiffness, &sparse(&[0, 1], &[0, 1], 0)),
        Status::Dimension,
        &["col_ptr has 2 entries"],
    );
    refused(
        model.set_coupling(MatrixKind::Stiffness, &MatrixView::dense(2, &good)),
        Status::Unsupported,
        &["cyclic"],
    );
    refused(model.set_rayleigh(f64::NAN, 0.0), Status::NotFinite, &["alpha_mass"]);
}

#[test]
fn a_refused_matrix_leaves_the_model_as_it_was() {
    unharmed(|model| {
        let n = model.ndof();
        let mut bad = vec![0.0; n * n];
        bad[5] = f64::NAN;
        refused(
            model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &bad)),
            Status::NotFinite,
            &["stiffness[1,1]"],
        );
        refused(
            model.set_coupling(MatrixKind::Stiffness, &MatrixView::dense(n, &bad)),
            Status::NotFinite,
            &["stiffness[1,1]"],
        );
        let zeros = vec![0.0; n * n];
        refused(
            model.set_diameter(MatrixKind::Stiffness, 2, &MatrixView::dense(n, &zeros)),
            Status::Argument,
            &["sector blocks"],
        );
        refused(
            model.set_coupling_previous(MatrixKind::Mass, &MatrixView::dense(n, &zeros)),
            Status::Unsupported,
            &["mass"],
        );
    });
}

#[test]
fn a_refused_contact_or_force_leaves_the_model_as_it_was() {
    unharmed(|model| {
        let contact = BASE.contact();
        for (bad, status, words) in [
            (
                Contact {
                    dof_a: [Some(4), None, None],
                    ..contact.clone()
                },
                Status::Index,
                "dof_a[0] = 4",
            ),
            (
                Contact {
                    dof_b: [Some(9), None, None],
                    ..contact.clone()
                },
                Status::Index,
                "dof_b[0] = 9",
            ),
            (
                Contact {
                    dof_b: contact.dof_a,
                    ..contact.clone()
                },
                Status::Argument,
                "same degree of freedom",
            ),
            (
                Contact {
                    dof_a: [None; 3],
                    dof_b: [None; 3],
                    ..contact.clone()
                },
                Status::Argument,
                "ground",
            ),
            (
                contact.clone().with(Constant::Kt, f64::NAN).unwrap(),
                Status::NotFinite,
                "kt",
            ),
            (
                contact.clone().with(Constant::Kt, -1.0).unwrap(),
                Status::Argument,
                "kt = -1",
            ),
            (
                contact.clone().with(Constant::Mu, f64::NAN).unwrap(),
                Status::NotFinite,
                "mu",
            ),
            (
                contact.clone().with(Constant::Preload, -2.0).unwrap(),
                Status::Argument,
                "preload = -2",
            ),
        ] {
            refused(model.add_contact(&bad), status, &[words]);
        }
        refused(
            model.set_preload(1, 5.0),
            Status::Index,
            &["contact id = 1", "1 contacts"],
        );
        refused(model.set_preload(0, f64::NAN), Status::NotFinite, &["preload"]);
        let one = Complex64::ONE;
        refused(model.add_force(4, 1, one), Status::Index, &["dof = 4", "0 .. 3"]);
        refused(
            model.add_force(0, 1, one * f64::NAN),
            Status::NotFinite,
            &["force: value = "],
        );
        refused(
            model.add_force(0, 0, Complex64::I),
            Status::Argument,
            &["constant force"],
        );
        refused(
            model.add_force(0, 100_001, one),
            Status::Argument,
            &["harmonic = 100001"],
        );
    });
}

#[test]
fn a_refused_cubic_spring_leaves_the_model_as_it_was() {
    unharmed(|model| {
        let friction = BASE.contact();
        let spring = Contact::cubic(2, Some(3), 1.0, -1.0);
        for (contact, constant, value, status, words) in [
            (
                &spring,
                Constant::Cubic,
                f64::INFINITY,
                Status::NotFinite,
                "cubic = inf",
            ),
            (&friction, Constant::Cubic, f64::NAN, Status::NotFinite, "cubic = NaN"),
            (
                &friction,
                Constant::Cubic,
                2.0,
                Status::Argument,
                "cubic = 2, needs 0 for a Jenkins contact",
            ),
            (
                &spring,
                Constant::Mu,
                0.3,
                Status::Argument,
                "mu = 0.3, needs 0 for a cubic spring",
            ),
            (
                &spring,
                Constant::Preload,
                f64::INFINITY,
                Status::Argument,
                "preload = inf, needs 0 for a cubic spring",
            ),
            (&spring, Constant::Kt, -1.0, Status::Argument, "kt = -1"),
        ] {
            let changed = contact.clone().with(constant, value);
            refused(changed.and_then(|bad| model.add_contact(&bad)), status, &[words]);
        }
        let mut sprung = model.try_clone().unwrap();
        sprung.add_contact(&spring).unwrap();
        refused(
            sprung.set_preload(1, 0.0),
            Status::Argument,
            &["preload", "id = 1", "cubic spring"],
        );
    });
}

#[test]
fn sizes_of_a_model_out_of_range_are_refused() {
    refused(Model::new(0), Status::Dimension, &["ndof = 0"]);
    refused(Model::new(usize::MAX), Status::Dimension, &["ndof"]);
    refused(Model::cyclic(1, 0), Status::Argument, &["sectors = 0"]);
    refused(Model::cyclic(1, usize::MAX), Status::Argument, &["sectors"]);
    let mut across = Contact::jenkins(0, None, 1.0, 1.0, 1.0);
    across.sector_offset = 1;
    refused(
        Model::new(1).unwrap().add_contact(&across),
        Status::Argument,
        &["sector_offset = 1", "plain"],
    );
    // One whole turn on is the same sector.
    let mut round = Contact::jenkins(0, Some(0), 1.0, 1.0, 1.0);
    round.sector_offset = 24;
    refused(
        Model::cyclic(1, 24).unwrap().add_contact(&round),
        Status::Argument,
        &["same degree of freedom"],
    );
}

#[test]
fn arrays_of_the_wrong_length_are_refused_before_anything_is_written() {
    let model = BASE.sector();
    let solver = harmonics(3);
    let x = vec![Complex64::ZERO; 16];
    let mark = Complex64::new(7.0, -7.0);
    let mut r = vec![mark; 16];
    let mut jacobian = vec![3.0; 10];
    refused(
        forced_residual(&model, &solver, OMEGA, &x[..15], &mut r, None, None),
        Status::Dimension,
        &["x has 15", "16"],
    );
    refused(
        forced_residual(&model, &solver, OMEGA, &x, &mut r[..3], None, None),
        Status::Dimension,
        &["r has 3"],
    );
    refused(
        forced_residual(&model, &solver, OMEGA, &x, &mut r, Some(&mut jacobian), None),
        Status::Dimension,
        &["jac has 10", "1024"],
    );
    refused(
        forced_residual(&model, &solver, f64::NAN, &x, &mut r, None, None),
        Status::Argument,
        &["omega"],
    );
    let mut bad = x.clone();
    bad[3].re = f64::NAN;
    refused(
        forced_residual(&model, &solver, OMEGA, &bad, &mut r, None, None),
        Status::NotFinite,
        &["x[3]"],
    );
    assert!(r.iter().all(|z| *z == mark) && jacobian.iter().all(|v| v.to_bits() == 3.0_f64.to_bits()));

    let contact = BASE.contact();
    let mut f = vec![mark; 4];
    refused(
        contact_evaluate(&contact, 3, 0, 1.0, &x[..3], &mut f, None),
        Status::Dimension,
        &["motion has 3"],
    );
    refused(
        contact_evaluate(&contact, 3, 6, 1.0, &x[..4], &mut f, None),
        Status::Argument,
        &["samples = 6"],
    );
    refused(
        contact_evaluate(&contact, 3, 0, 1.0, &bad[..4], &mut f, None),
        Status::NotFinite,
        &["motion[3]"],
    );
    refused(
        contact_evaluate(
            &contact.clone().with(Constant::Kt, f64::NAN).unwrap(),
            3,
            0,
            1.0,
            &x[..4],
            &mut f,
            None,
        ),
        Status::NotFinite,
        &["kt"],
    );
    assert!(f.iter().all(|z| *z == mark));
}

#[test]
fn a_point_that_does_not_exist_is_refused_without_writing() {
    let branch = solve_at(&BASE.sector(), &harmonics(3), OMEGA);
    let mark = Complex64::new(7.0, -7.0);
    let mut x = vec![mark; 16];
    refused(
        branch.harmonics_at(branch.stored(), &mut x),
        Status::Index,
        &["point = 1"],
    );
    refused(
        branch.harmonics_at(0, &mut x[..5]),
        Status::Dimension,
        &["x has 5", "16"],
    );
    assert!(x.iter().all(|z| *z == mark));
    assert!(branch.slip_fraction_at(branch.stored()).is_none());
    assert!(branch.at(0).is_empty());
}
