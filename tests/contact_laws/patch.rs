//! Contact patches: the contacts that they are made of, their directions in space, and what they refuse.

use crate::common::refusal::{refused, unharmed};
use crate::common::{all_harmonics, harmonics, relative_gap, slip, solve_at};
use hbvib::internals::Role;
use hbvib::{
    Constant, Contact, ContactKind, Frame, Friction2d, Friction3d, MatrixKind, MatrixView, Model, Patch, Polynomial,
    Status,
};
use num_complex::Complex64;

type Vector = [f64; 3];
type Rotation = [Vector; 3];

/// Rodrigues' rotation by an angle round an axis of length 1: rows of R.
fn rotation([x, y, z]: Vector, angle: f64) -> Rotation {
    let (s, c) = angle.sin_cos();
    let d = 1.0 - c;
    [
        [c + d * x * x, d * x * y - s * z, d * x * z + s * y],
        [d * x * y + s * z, c + d * y * y, d * y * z - s * x],
        [d * x * z - s * y, d * y * z + s * x, c + d * z * z],
    ]
}

fn turn(r: &Rotation, v: Vector) -> Vector {
    r.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

const NODES: [[Option<usize>; 3]; 2] = [[Some(0), Some(1), Some(2)], [Some(3), Some(4), Some(5)]];
const NORMALS: [Vector; 2] = [[0.0, 0.6, 0.8], [1.0, 0.0, 2.0]];
const TANGENTS: [Vector; 2] = [[1.0, 0.0, 0.0], [0.0, -3.0, 0.0]];
const AREAS: [f64; 2] = [0.5, 2.0];
const PRESSURES: [f64; 2] = [1.2, 0.4];
const GAPS: [f64; 2] = [0.02, -0.05];
const OMEGA: f64 = 1.25;

/// Two coupled nodes with three directions each, turned in space; each node alone is stiffer in one
/// direction than in another, and so is the spring between them.
fn nodes(r: &Rotation) -> Model {
    let mut model = Model::new(6).unwrap();
    let turned = |d: Vector| {
        let mut a = [[0.0; 3]; 3];
        for (i, row) in a.iter_mut().enumerate() {
            for (j, a) in row.iter_mut().enumerate() {
                *a = (0..3).map(|k| r[i][k] * d[k] * r[j][k]).sum();
            }
        }
        a
    };
    for (kind, own, between) in [
        (MatrixKind::Mass, [1.0, 1.0, 1.0], [0.0; 3]),
        (MatrixKind::Damping, [0.02, 0.03, 0.05], [0.01, 0.0, 0.02]),
        (MatrixKind::Stiffness, [1.0, 1.4, 2.0], [0.3, 0.5, 0.1]),
    ] {
        let (own, between) = (turned(own), turned(between));
        let mut a = [0.0; 36];
        for i in 0..3 {
            for j in 0..3 {
                a[6 * j + i] = own[i][j] + between[i][j];
                a[6 * (j + 3) + i + 3] = 1.3 * own[i][j] + between[i][j];
                a[6 * j + i + 3] = -between[i][j];
                a[6 * (j + 3) + i] = -between[i][j];
            }
        }
        model.set_matrix(kind, &MatrixView::dense(6, &a)).unwrap();
    }
    let (re, im) = (turn(r, [0.9, 0.4, 0.2]), turn(r, [0.0, 0.7, -0.1]));
    for (i, (&re, &im)) in re.iter().zip(&im).enumerate() {
        model.add_force(i, 1, Complex64::new(re, im)).unwrap();
    }
    model
}

fn law(kind: ContactKind) -> Contact {
    [
        (Constant::Kt, 2.0),
        (Constant::Kn, 3.0),
        (Constant::Mu, 0.4),
        (Constant::Preload, 0.7),
        (Constant::Gap, 0.01),
    ]
    .into_iter()
    .fold(Contact::between(0, None, kind), |law, (constant, value)| {
        law.with(constant, value).unwrap()
    })
}

fn patch<'a>(law: &'a Contact, normal: &'a [Vector], tangent: Option<&'a [Vector]>) -> Patch<'a> {
    Patch {
        law,
        dof_a: &NODES,
        dof_b: None,
        normal,
        tangent,
        area: &AREAS,
        pressure: Some(&PRESSURES),
        gap: Some(&GAPS),
    }
}

/// All harmonics up to 5, slip proved.
fn response(model: &Model) -> Vec<Complex64> {
    let branch = solve_at(model, &harmonics(5), OMEGA);
    assert!(slip(&branch, 0) > 0.1, "the contacts stick");
    all_harmonics(&branch, 0)
}

const STRAIGHT: Rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

#[test]
fn a_patch_is_its_contacts_added_one_by_one() {
    for kind in [
        ContactKind::Friction2d(Friction2d::default()),
        ContactKind::Friction3d(Friction3d::default()),
    ] {
        let law = law(kind);
        let (mut at_once, mut one_by_one) = (nodes(&STRAIGHT), nodes(&STRAIGHT));
        assert_eq!(at_once.add_patch(&patch(&law, &NORMALS, Some(&TANGENTS))).unwrap(), 0);
        for i in 0..2 {
            let contact = Contact {
                dof_a: NODES[i],
                dof_b: [None; 3],
                frame: Some(Frame::new(NORMALS[i], Some(TANGENTS[i])).unwrap()),
                ..law.clone()
            }
            .with(Constant::Kt, 2.0 * AREAS[i])
            .unwrap()
            .with(Constant::Kn, 3.0 * AREAS[i])
            .unwrap()
            .with(Constant::Preload, PRESSURES[i] * AREAS[i])
            .unwrap()
            .with(Constant::Gap, GAPS[i])
            .unwrap();
            one_by_one.add_contact(&contact).unwrap();
        }
        let (a, b) = (response(&at_once), response(&one_by_one));
        assert!(a == b, "{}", relative_gap(&a, &b));
        // Without arrays of its own a patch has the law's pressure and gap, and numbers follow on.
        let plain = Patch {
            pressure: None,
            gap: None,
            ..patch(&law, &NORMALS, Some(&TANGENTS))
        };
        assert_eq!(at_once.add_patch(&plain).unwrap(), 2);
        let added = &at_once.contacts()[3];
        assert!(
            (added.constant(Constant::Preload) - 1.4).abs() < 1e-15
                && added.constant(Constant::Gap).to_bits() == 0.01_f64.to_bits()
        );
    }
}

#[test]
fn a_patch_that_turns_with_its_structure_gives_the_response_that_turns() {
    let axis = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];
    for kind in [
        ContactKind::Friction2d(Friction2d::default()),
        ContactKind::Friction3d(Friction3d::default()),
    ] {
        let law = law(kind);
        let mut straight = nodes(&STRAIGHT);
        straight.add_patch(&patch(&law, &NORMALS, Some(&TANGENTS))).unwrap();
        let expected = response(&straight);
        for angle in [0.1, 0.7, 1.9, 3.0] {
            let r = rotation(axis, angle);
            let mut model = nodes(&r);
            let (normals, tangents) = (NORMALS.map(|v| turn(&r, v)), TANGENTS.map(|v| turn(&r, v)));
            model.add_patch(&patch(&law, &normals, Some(&tangents))).unwrap();
            let mut found = response(&model);
            // Back into the axes of the straight one.
            for node in found.chunks_exact_mut(3) {
                let turned = [node[0], node[1], node[2]];
                for (j, x) in node.iter_mut().enumerate() {
                    *x = (0..3).map(|i| r[i][j] * turned[i]).sum();
                }
            }
            let gap = relative_gap(&found, &expected);
            println!("{:?} by {angle}: {gap:.1e}", law.kind);
            assert!(gap < 1e-11, "{:?} by {angle}: {gap:.1e}", law.kind);
        }
    }
}

#[test]
fn friction_in_a_plane_does_not_mind_which_tangents_are_chosen() {
    let law = law(ContactKind::Friction3d(Friction3d::default()));
    let turned = [[-3.0, 1.6, -1.2], [2.0, 5.0, -1.0]];
    let solve = |tangent| {
        let mut model = nodes(&STRAIGHT);
        model.add_patch(&patch(&law, &NORMALS, tangent)).unwrap();
        response(&model)
    };
    let expected = solve(Some(&TANGENTS[..]));
    for tangent in [None, Some(&turned[..])] {
        let gap = relative_gap(&solve(tangent), &expected);
        println!("{tangent:?}: {gap:.1e}");
        assert!(gap < 1e-11, "{tangent:?}: {gap:.1e}");
    }
}

#[test]
fn pairs_without_area_have_no_force_whatever_presses_on_them() {
    let mut jenkins = Contact::jenkins(0, None, 2.0, 0.4, f64::INFINITY);
    jenkins.set(Constant::Gap, 0.0).unwrap();
    for law in [
        law(ContactKind::Friction2d(Friction2d::default())),
        law(ContactKind::Friction3d(Friction3d::default())),
        jenkins,
    ] {
        let patch = Patch {
            area: &[0.0, 0.0],
            pressure: None,
            gap: None,
            ..patch(&law, &NORMALS, Some(&TANGENTS))
        };
        let mut model = nodes(&STRAIGHT);
        let bare = all_harmonics(&solve_at(&model, &harmonics(5), OMEGA), 0);
        model.add_patch(&patch).unwrap();
        assert!(model.contacts().iter().all(|c| c.role() == Role::Inert));
        let with = all_harmonics(&solve_at(&model, &harmonics(5), OMEGA), 0);
        assert!(relative_gap(&with, &bare) < 1e-13);
    }
}

/// A patch is refused, and neither it nor a part of it is added.
fn rejects(case: &Patch<'_>, status: Status, words: &[&str]) {
    let mut model = nodes(&STRAIGHT);
    refused(model.add_patch(case), status, words);
    assert!(model.contacts().is_empty());
}

#[test]
fn arrays_of_another_length_are_refused_by_name() {
    let law = law(ContactKind::Friction2d(Friction2d::default()));
    let good = patch(&law, &NORMALS, Some(&TANGENTS));
    let (dof_b, normal) = (Some(&NODES[..1]), &NORMALS[..1]);
    let (tangent, area) = (Some(&TANGENTS[..0]), &[1.0; 3]);
    let (pressure, gap) = (Some(&PRESSURES[..1]), Some(&GAPS[..0]));
    let length = Status::Dimension;
    rejects(&Patch { dof_b, ..good }, length, &["dof_b has 1 entries, needs 2"]);
    rejects(&Patch { normal, ..good }, length, &["normal has 1"]);
    rejects(&Patch { tangent, ..good }, length, &["tangent has 0"]);
    rejects(&Patch { area, ..good }, length, &["area has 3"]);
    rejects(&Patch { pressure, ..good }, length, &["pressure has 1"]);
    rejects(&Patch { gap, ..good }, length, &["gap has 0"]);
    let tangent = None;
    rejects(&Patch { tangent, ..good }, Status::Argument, &["tangent is missing"]);
}

#[test]
fn bad_entries_are_refused_by_number_and_the_law_by_itself() {
    let law = law(ContactKind::Friction2d(Friction2d::default()));
    let good = patch(&law, &NORMALS, Some(&TANGENTS));
    let dof_a = &[NODES[0], [Some(3), Some(4), Some(6)]];
    rejects(
        &Patch { dof_a, ..good },
        Status::Index,
        &["entry 1", "dof_a[2] = 6", "0 .. 5"],
    );
    let dof_a = &[NODES[0], [Some(3), Some(3), Some(5)]];
    let words: &[&str] = &["entry 1", "dof_a[0] and dof_a[1] are both 3"];
    rejects(&Patch { dof_a, ..good }, Status::Argument, words);
    let dof_b = Some(&NODES[..]);
    let words = &["entry 0", "same degree of freedom"];
    rejects(&Patch { dof_b, ..good }, Status::Argument, words);
    let area = &[1.0, -1.0];
    rejects(&Patch { area, ..good }, Status::Argument, &["entry 1", "area = -1"]);

    let polynomial = ContactKind::Polynomial(Polynomial::scalar(&[1.0], &[]).unwrap());
    let no_area = Contact::between(0, None, polynomial);
    let words = &["law", "per unit of area"];
    rejects(&Patch { law: &no_area, ..good }, Status::Unsupported, words);
    let soft = law.clone().with(Constant::Kt, -1.0).unwrap();
    rejects(
        &Patch { law: &soft, ..good },
        Status::Argument,
        &["patch, law", "kt = -1"],
    );
    // Right by itself, but not with the second area, and not with a pressure.
    let stiff = law.clone().with(Constant::Kt, 1e308).unwrap();
    rejects(
        &Patch { law: &stiff, ..good },
        Status::NotFinite,
        &["entry 1", "kt = inf"],
    );
    let cubic = Contact::cubic(0, None, 1.0, 2.0);
    let words = &["entry 0", "preload = 0.6, needs 0"];
    rejects(&Patch { law: &cubic, ..good }, Status::Argument, words);
}

#[test]
fn lists_name_degrees_of_freedom_of_the_model_once() {
    unharmed(|model| {
        let law = || ContactKind::Polynomial(Polynomial::tensors(3, &[1.0; 9], &[], &[]).unwrap());
        let mut over = |dofs: &[usize], status, words: &[&str]| {
            refused(model.add_contact(&Contact::over(dofs.to_vec(), law())), status, words);
        };
        over(&[0, 1, 4], Status::Index, &["dofs[2] = 4", "0 .. 3"]);
        over(&[3, 1, 3], Status::Argument, &["dofs[0] and dofs[2] are both 3"]);
        over(&[0, 1], Status::Dimension, &["2 degrees of freedom"]);
        let side = Contact::friction_2d([Some(2), Some(2)], [None; 2], (1.0, 1.0), 0.3, 1.0);
        refused(
            model.add_contact(&side),
            Status::Argument,
            &["dof_a[0] and dof_a[2] are both 2"],
        );
    });
}
