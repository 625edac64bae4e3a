//! Natural frequencies of a sector with faces against the merged wheel of rotated copies.

use crate::boundary_sector::{BoundarySector, N, about_z, dofs};
use crate::common::models::sector_of_faces;
use crate::common::refusal::refused;
use hbvib::{
    Constant, Contact, ContactState, Frame, MatrixKind, MatrixView, Model, Part, SectorDescription, SectorFrame, Status,
};
use nalgebra::{Cholesky, DMatrix};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// All natural angular frequencies of K, M, ascending.
fn frequencies(k: &DMatrix<f64>, m: DMatrix<f64>) -> Vec<f64> {
    let l = Cholesky::new(m).unwrap().unpack();
    let half = l.solve_lower_triangular(k).unwrap();
    let a = l.solve_lower_triangular(&half.transpose()).unwrap();
    let a = (&a + a.transpose()) * 0.5;
    let mut omega: Vec<f64> = a.symmetric_eigenvalues().iter().map(|x| x.sqrt()).collect();
    omega.sort_by(f64::total_cmp);
    omega
}

/// Those of the sector in both senses of each diameter.
fn all_diameters(model: &Model, contacts: ContactState) -> Vec<f64> {
    let mut all = Vec::new();
    for diameter in model.structure().all_diameters() {
        all.extend(model.linear_modes(diameter, contacts).unwrap().omega);
    }
    all.sort_by(f64::total_cmp);
    all
}

fn worst_gap(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .fold(0.0, |worst, (a, b)| worst.max((a / b - 1.0).abs()))
}

#[test]
fn all_diameters_together_have_the_frequencies_of_the_merged_wheel() {
    let sector = BoundarySector::read(SectorFrame::Cartesian);
    let (k, m) = sector.wheel(&[]);
    let wheel = frequencies(&k, m);
    let found = all_diameters(&sector.model(0), ContactState::Free);
    let gap = worst_gap(&found, &wheel);
    println!("{} frequencies, worst gap {gap:.1e}", wheel.len());
    assert!(gap < 1e-9, "{gap}");
}

#[test]
fn springs_inside_and_across_the_faces_turn_with_their_sector() {
    let sector = BoundarySector::read(SectorFrame::Cartesian);
    let mut model = sector.model(0);
    // A contact inside, one between nodes of neighbouring sectors, one from a right node to the sector after the next.
    let across = [
        (33, 0, 20, [0.6, 0.0, 0.8], 3e7),
        (34, 1, 32, [0.36, 0.48, 0.8], 5e7),
        (30, 1, 35, [0.0, 0.6, -0.8], 2e7),
    ];
    for (a, offset, b, n, kn) in across {
        let node = |node: usize| [0, 1, 2].map(|k| Some(3 * node + k));
        let contact = Contact {
            dof_a: node(a),
            dof_b: node(b),
            frame: Some(Frame::new(n, None).unwrap()),
            sector_offset: offset as i64,
            ..Contact::unilateral(None, None, kn, 0.0)
        }
        .with(Constant::Preload, 1.0)
        .unwrap();
        model.add_contact(&contact).unwrap();
    }
    let (k, m) = sector.wheel(&across);
    let wheel = frequencies(&k, m);
    let gap = worst_gap(&all_diameters(&model, ContactState::Stuck), &wheel);
    println!("worst gap {gap:.1e}");
    assert!(gap < 1e-9, "{gap}");
    assert!(worst_gap(&all_diameters(&model, ContactState::Free), &wheel) > 1e-4);
}

#[test]
fn the_sense_of_rotation_matters_in_a_cartesian_frame_and_coordinates_reveal_it() {
    let sector = BoundarySector::read(SectorFrame::Cartesian);
    let (left, right) = (sector.positions(&sector.left), sector.positions(&sector.right));
    let placed = Some((&left[..], &right[..]));
    let hertz = |model: &Model, diameter| {
        let omega = model.linear_modes(diameter, ContactState::Free).unwrap().omega;
        omega.iter().map(|w| w / TAU).collect::<Vec<_>>()
    };
    let right_one = sector.try_placed(0, placed, |_| ()).unwrap();
    for (diameter, expected) in sector.reference.iter().enumerate() {
        let gap = worst_gap(&hertz(&right_one, diameter as i64)[..expected.len()], expected);
        assert!(gap < 1e-9, "diameter {diameter}: {gap}");
    }
    let wrong = sector.try_model(0, |s| s.forward = false).unwrap();
    let first = hertz(&wrong, 0)[0];
    assert!((first - 1147.25).abs() < 0.01, "{first}");
    let refusal = sector.try_placed(0, placed, |s| s.forward = false);
    refused(
        refusal,
        Status::Argument,
        &["30.0000 degrees", "direction = -1", "at -30.0000"],
    );
    let refusal = sector.try_placed(0, placed, |s| s.sectors = 13);
    refused(
        refusal,
        Status::Argument,
        &["30.0000 degrees", "sectors = 13", "at 27.6923"],
    );
    // The axis reversed, and the faces exchanged with it.
    let exchanged = sector
        .try_placed(0, Some((&right, &left)), |s| {
            (s.left, s.right) = (s.right, s.left);
            s.axis = [0.0, 0.0, -3.0];
        })
        .unwrap();
    assert!(worst_gap(&hertz(&exchanged, 2), &hertz(&right_one, 2)) < 1e-9);
}

#[test]
fn a_cylindrical_frame_has_the_same_frequencies_with_either_face_on_the_left() {
    let cartesian = all_diameters(
        &BoundarySector::read(SectorFrame::Cartesian).model(0),
        ContactState::Free,
    );
    let sector = BoundarySector::read(SectorFrame::Cylindrical);
    let own = all_diameters(&sector.model(0), ContactState::Free);
    let backward = sector.try_model(0, |s| s.forward = false).unwrap();
    let swapped = sector.try_model(0, |s| (s.left, s.right) = (s.right, s.left)).unwrap();
    for other in [
        &own,
        &all_diameters(&backward, ContactState::Free),
        &all_diameters(&swapped, ContactState::Free),
    ] {
        assert!(worst_gap(other, &cartesian) < 1e-9);
    }
}

#[test]
fn shapes_have_the_phase_of_the_wave_on_the_right_face_and_zeros_where_fixed() {
    let sector = BoundarySector::read(SectorFrame::Cartesian);
    let model = sector.model(0);
    let n = sector.ndof();
    assert_eq!(model.ndof(), n);
    let modes = model.linear_modes(2, ContactState::Free).unwrap();
    let turn = about_z(TAU / N as f64);
    let lag = Complex64::cis(-TAU * 2.0 / N as f64);
    for shape in modes.shapes.chunks_exact(n) {
        for dof in dofs(&sector.clamped) {
            assert!(shape[dof] == Complex64::ZERO);
        }
        for (l, r) in sector.left.iter().zip(&sector.right) {
            for i in 0..3 {
                let image: Complex64 = (0..3).map(|j| turn[(i, j)] * shape[3 * l + j]).sum();
                assert!((shape[3 * r + i] - lag * image).norm() < 1e-12);
            }
        }
        // φᴴ M φ over one sector is that of its own matrix on all degrees of freedom.
        let mass: Complex64 = (0..n * n)
            .map(|at| shape[at / n].conj() * sector.m.as_slice()[at] * shape[at % n])
            .sum();
        assert!((mass - 1.0).norm() < 1e-9, "{mass}");
    }
}

/// Craig-Bampton with all modes inside is exact: faces and tip physical, modes on no face, clamped nodes missing.
#[test]
fn a_superelement_is_a_sector_with_modes_on_no_face() {
    let sector = BoundarySector::read(SectorFrame::Cartesian);
    let clamped = dofs(&sector.clamped);
    let faces: Vec<usize> = [dofs(&sector.left), dofs(&sector.right)].concat();
    let free = |d: &usize| !clamped.contains(d);
    let physical: Vec<usize> = faces.iter().copied().filter(free).chain([106]).collect();
    let inside: Vec<usize> = (0..sector.ndof())
        .filter(free)
        .filter(|d| !physical.contains(d))
        .collect();
    let (n, m) = (physical.len(), inside.len());
    let block = |a: &DMatrix<f64>, rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| a[(rows[i], columns[j])])
    };
    let inner = block(&sector.k, &inside, &inside);
    let constraint = -Cholesky::new(inner.clone())
        .unwrap()
        .solve(&block(&sector.k, &inside, &physical));
    let l = Cholesky::new(block(&sector.m, &inside, &inside)).unwrap().unpack();
    let half = l.solve_lower_triangular(&inner).unwrap();
    let pencil = l.solve_lower_triangular(&half.transpose()).unwrap();
    let modes = ((&pencil + pencil.transpose()) * 0.5).symmetric_eigen().eigenvectors;
    let modes = l.transpose().solve_upper_triangular(&modes).unwrap();
    let order: Vec<usize> = physical.iter().chain(&inside).copied().collect();
    let mut basis = DMatrix::zeros(n + m, n + m);
    basis.view_mut((0, 0), (n, n)).fill_with_identity();
    basis.view_mut((n, 0), (m, n)).copy_from(&constraint);
    basis.view_mut((n, n), (m, m)).copy_from(&modes);
    let face = |nodes: &[usize]| -> Vec<Option<usize>> {
        dofs(nodes)
            .iter()
            .map(|d| physical.iter().position(|p| p == d))
            .collect()
    };
    let (left, right) = (face(&sector.left), face(&sector.right));
    assert!(left.contains(&None));
    let mut model = Model::sector(&SectorDescription {
        engine_order: 0,
        frame: SectorFrame::Cartesian,
        ..sector_of_faces(n + m, N, [&left, &right])
    })
    .unwrap();
    for (kind, a) in [(MatrixKind::Stiffness, &sector.k), (MatrixKind::Mass, &sector.m)] {
        let reduced = basis.transpose() * block(a, &order, &order) * &basis;
        let reduced = (&reduced + reduced.transpose()) * 0.5;
        model
            .set_matrix(kind, &MatrixView::dense(n + m, reduced.as_slice()))
            .unwrap();
    }
    let whole = all_diameters(&sector.model(0), ContactState::Free);
    let gap = worst_gap(&all_diameters(&model, ContactState::Free), &whole);
    println!("superelement: gap {gap:.1e}");
    assert!(gap < 1e-9, "{gap}");
}

/// K with and without symmetry: every block against T₀ and T₁ as dense matrices.
#[test]
fn couplings_follow_from_matrices_without_symmetry_and_from_complex_symmetric_ones() {
    let (left, right) = ([Some(0), Some(1)], [Some(4), Some(3)]);
    let description = SectorDescription {
        engine_order: 2,
        components: 1,
        fixed: &[5],
        ..sector_of_faces(6, 5, [&left, &right])
    };
    let number = |i: usize| ((i * 37 % 11) as f64 - 5.0) / 3.0;
    let general: Vec<Complex64> = (0..36).map(|i| number(i).into()).collect();
    let symmetric: Vec<Complex64> = (0..36)
        .map(|at| {
            let (i, j) = (at / 6, at % 6);
            Complex64::new(number(i * j + i + j), number(2 * i * j + 1))
        })
        .collect();
    let mut t = [DMatrix::<Complex64>::zeros(6, 3), DMatrix::zeros(6, 3)];
    for (sector, dof, own) in [(0, 0, 0), (0, 1, 1), (0, 2, 2), (1, 4, 0), (1, 3, 1)] {
        t[sector][(dof, own)] = Complex64::ONE;
    }
    for values in [general, symmetric] {
        let mut model = Model::sector(&description).unwrap();
        let view = MatrixView::dense_complex(6, &values).part(Part::General);
        model.set_matrix(MatrixKind::Stiffness, &view).unwrap();
        let k = DMatrix::from_column_slice(6, 6, &values);
        for harmonic in 1..4 {
            let next = Complex64::cis(-TAU * 2.0 * harmonic as f64 / 5.0);
            let whole = &t[0] + &t[1] * next;
            let expected = whole.adjoint() * &k * whole;
            let found = model.structure().wave_matrix(MatrixKind::Stiffness, harmonic).unwrap();
            for i in 0..3 {
                for j in 0..3 {
                    assert!((found.get(i, j) - expected[(i, j)]).norm() < 1e-13);
                }
            }
        }
    }
}
