//! Refused faces, contacts and fixed degrees of freedom: a sentence that names the pair or degree of freedom.

use crate::boundary_sector::{BoundarySector, dofs};
use crate::common::models::sector_of_faces;
use crate::common::refusal::refused;
use hbvib::{
    Contact, ContactState, Frame, MatrixKind, MatrixView, Model, SectorDescription, SectorFrame, Spring, Status,
};

fn changed(
    sector: &BoundarySector,
    change: impl FnOnce(&mut Vec<Option<usize>>, &mut Vec<Option<usize>>, &mut Vec<usize>),
) -> hbvib::Result<Model> {
    let mut left: Vec<_> = dofs(&sector.left).into_iter().map(Some).collect();
    let mut right: Vec<_> = dofs(&sector.right).into_iter().map(Some).collect();
    let mut fixed = dofs(&sector.clamped);
    change(&mut left, &mut right, &mut fixed);
    Model::sector(&SectorDescription {
        fixed: &fixed,
        frame: sector.frame,
        ..sector_of_faces(sector.ndof(), 12, [&left, &right])
    })
}

#[test]
fn bad_faces_are_refused_by_pair_and_degree_of_freedom() {
    let sector = BoundarySector::read(SectorFrame::Cartesian);
    let argument = Status::Argument;
    refused(
        changed(&sector, |_, right, _| right.truncate(21)),
        Status::Dimension,
        &["left face has 24", "right one 21"],
    );
    refused(
        changed(&sector, |left, right, _| {
            left.truncate(23);
            right.truncate(23);
        }),
        Status::Dimension,
        &["23 entries", "3 components"],
    );
    // Pair 6 of the left face and pair 0 of the right one.
    refused(
        changed(&sector, |left, right, _| left[20] = right[1]),
        argument,
        &[
            "degree of freedom 19 is in both faces",
            "pair 6 of the left",
            "pair 0 of the right",
        ],
    );
    refused(
        changed(&sector, |left, _, _| left[20] = left[4]),
        argument,
        &["degree of freedom 4 is twice in the left face", "pairs 1 and 6"],
    );
    refused(
        changed(&sector, |_, right, _| right[3] = Some(108)),
        Status::Index,
        &["right[3] = 108", "0 .. 107"],
    );
    refused(
        changed(&sector, |_, _, fixed| fixed.push(108)),
        Status::Index,
        &["fixed[24] = 108"],
    );
    // Node 8, pair 2, is free on the right.
    refused(
        changed(&sector, |_, _, fixed| fixed.push(25)),
        argument,
        &[
            "pair 2 is fixed on one side only",
            "component 1",
            "degree of freedom 25, which is fixed",
            "43 on the right",
        ],
    );
    refused(
        changed(&sector, |left, _, _| left[6] = None),
        argument,
        &["pair 2", "missing (-1) on the left", "degree of freedom 42"],
    );
    // y alone, on both sides: it is another direction in the axes of the next sector.
    refused(
        changed(&sector, |_, _, fixed| fixed.extend([25, 43])),
        argument,
        &["pair 2", "component 1", "fix component 0 too"],
    );
    changed(&sector, |_, _, fixed| fixed.extend([26, 44])).unwrap();
    changed(&sector, |_, _, fixed| fixed.extend([24, 25, 42, 43])).unwrap();
    changed(&sector, |left, right, _| (left[8], right[8]) = (None, None)).unwrap();
    let axis = sector.try_model(0, |s| s.axis = [0.0; 3]);
    refused(axis, argument, &["axis is zero"]);
    refused(
        sector.try_model(0, |s| s.axis[1] = f64::NAN),
        Status::NotFinite,
        &["axis[1] = NaN"],
    );
    refused(
        sector.try_model(0, |s| s.sectors = 1),
        argument,
        &["sectors = 1", "at least 2"],
    );
    refused(
        sector.try_model(0, |s| s.components = 4),
        Status::Dimension,
        &["4 components", "Cartesian"],
    );
}

#[test]
fn positions_that_contradict_the_description_are_refused_by_pair() {
    let sector = BoundarySector::read(SectorFrame::Cartesian);
    let argument = Status::Argument;
    let (left, right) = (sector.positions(&sector.left), sector.positions(&sector.right));
    for (pair, position, words) in [
        (3, [0.0, 0.0, 0.2], ["pair 3", "left node lies on the axis"]),
        (4, [0.2, 0.0, 0.0], ["pair 4", "degrees about the axis"]),
        (5, [f64::NAN, 0.0, 0.0], ["left[5,0] = NaN", "finite"]),
    ] {
        let mut moved = left.clone();
        moved[pair] = position;
        let status = if position[0].is_nan() {
            Status::NotFinite
        } else {
            argument
        };
        refused(sector.try_placed(0, Some((&moved, &right)), |_| ()), status, &words);
    }
    let mut raised = left.clone();
    raised[7][2] += 0.01;
    refused(
        sector.try_placed(0, Some((&raised, &right)), |_| ()),
        argument,
        &["pair 7", "no image of each other"],
    );
    let few = sector.try_placed(0, Some((&left[1..], &right)), |_| ());
    refused(few, Status::Dimension, &["7 nodes on the left face", "8 pairs"]);
}

#[test]
fn contacts_without_meaning_are_refused_by_degree_of_freedom() {
    let sector = BoundarySector::read(SectorFrame::Cartesian);
    let mut model = sector.model(1);
    let (left, right) = (dofs(&sector.left), dofs(&sector.right));
    for (a, b, offset) in [(left[6], right[6], 0), (right[6], left[6], 1), (left[6], right[6], -1)] {
        let contact = Contact {
            sector_offset: offset,
            ..Contact::jenkins(a, Some(b), 1e6, 0.3, 10.0)
        };
        let words = ["pair 2", "its own image", &format!("dof_a = {a}")];
        refused(model.add_contact(&contact), Status::Argument, &words);
    }
    // No sector is so far away: the phase of 2^40 sectors would be rounding.
    let sectors = model.structure().sectors() as i64;
    for offset in [sectors, -sectors, 1 << 40, i64::MIN, i64::MAX] {
        let contact = Contact {
            sector_offset: offset,
            ..Contact::jenkins(40, Some(41), 1e6, 0.3, 10.0)
        };
        let told = format!("sector_offset = {offset}");
        refused(
            model.add_contact(&contact),
            Status::Argument,
            &[&told, &format!("{}", sectors - 1)],
        );
    }
    // The same node seen from the next sector.
    let contact = Contact {
        sector_offset: 1,
        ..Contact::jenkins(left[6], Some(left[6]), 1e6, 0.3, 10.0)
    };
    model.add_contact(&contact).unwrap();
    let clamped = Contact::jenkins(0, Some(5), 1e6, 0.3, 10.0);
    refused(model.add_contact(&clamped), Status::Argument, &["both sides are fixed"]);
    let to_clamped = Contact::jenkins(40, Some(5), 1e6, 0.3, 10.0);
    model.add_contact(&to_clamped).unwrap();
    let spring = Spring {
        dof_a: Some(left[7]),
        dof_b: Some(right[7]),
        sector_offset: 0,
        stiffness: 1.0,
    };
    refused(model.add_spring(&spring), Status::Argument, &["its own image"]);
    refused(
        model.set_coupling(
            MatrixKind::Stiffness,
            &MatrixView::dense(sector.ndof(), sector.k.as_slice()),
        ),
        Status::Unsupported,
        &["couplings follow"],
    );
    refused(
        model.fix(&[left[6]]),
        Status::Argument,
        &["pair 2 is fixed on one side only"],
    );
    refused(
        model.fix(&[40]),
        Status::Argument,
        &["contact 1", "both sides are fixed"],
    );
    model.fix(&[41]).unwrap();
}

/// A sector whose nodes are not numbered one after the other does not tell the nodes off its faces.
#[test]
fn contacts_in_turned_axes_need_the_node() {
    let (left, right) = ([Some(0), Some(2), Some(1)], [Some(3), Some(5), Some(4)]);
    let mut model = Model::sector(&SectorDescription {
        frame: SectorFrame::Cartesian,
        ..sector_of_faces(12, 6, [&left, &right])
    })
    .unwrap();
    let contact = Contact {
        sector_offset: -2,
        ..Contact::jenkins(6, Some(9), 1.0, 0.3, 1.0)
    };
    refused(
        model.add_contact(&contact),
        Status::Argument,
        &["dof_b = 9", "-120 degrees", "give a normal"],
    );
    let with_node = Contact {
        dof_a: [6, 7, 8].map(Some),
        dof_b: [9, 10, 11].map(Some),
        frame: Some(Frame::new([0.0, 0.0, 1.0], Some([1.0, 0.0, 0.0])).unwrap()),
        ..contact.clone()
    };
    model.add_contact(&with_node).unwrap();
    // Nodes of the faces are known, whatever their numbers.
    let face = Contact {
        dof_b: [Some(2), None, None],
        ..contact
    };
    model.add_contact(&face).unwrap();
}

#[test]
fn fixed_degrees_of_freedom_leave_the_matrices_of_the_others() {
    let n = 4;
    let k: Vec<f64> = (0..16)
        .map(|at| if at % 5 == 0 { 3.0 + f64::from(at) } else { -1.0 })
        .collect();
    let mut model = Model::new(n).unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &k))
        .unwrap();
    model.fix(&[2]).unwrap();
    let mass: Vec<f64> = (0..16).map(|at| f64::from(u8::from(at % 5 == 0))).collect();
    model
        .set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &mass))
        .unwrap();
    model.fix(&[0, 2]).unwrap();
    let modes = model.linear_modes(0, ContactState::Free).unwrap();
    // [8, -1; -1, 18]
    let root = (25.0_f64 + 1.0).sqrt();
    for (w, x) in modes.omega.iter().zip([13.0 - root, 13.0 + root]) {
        assert!((w * w - x).abs() < 1e-12 * x);
    }
    assert_eq!(model.ndof(), 4);
    assert!(modes.shapes[0].norm() + modes.shapes[2].norm() == 0.0);
    refused(
        model.fix(&[1, 3]),
        Status::Argument,
        &["all degrees of freedom are fixed"],
    );
    refused(model.fix(&[4]), Status::Index, &["fixed[0] = 4", "0 .. 3"]);
    assert_eq!(model.linear_modes(0, ContactState::Free).unwrap().omega.len(), 2);
}
