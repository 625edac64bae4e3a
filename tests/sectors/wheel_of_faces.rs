//! The whole wheel of a sector with both faces: against the wave of the sector, and mistuned against the wheel of the sector from
//! its blocks.

use crate::boundary_sector::{BoundarySector, N, dofs};
use crate::common::refusal::refused;
use crate::common::{all_harmonics, harmonics, relative_gap, slip, solve_at};
use crate::sector_contacts::{PAIR, Pair, jenkins};
use hbvib::{BladeProperty, ContactState, MatrixKind, MatrixView, Mistuning, Model, SectorFrame, Status};
use num_complex::Complex64;

const DELTA: [f64; N] = [
    0.011, -0.023, 0.004, 0.017, -0.009, 0.021, -0.014, 0.002, -0.019, 0.008, 0.013, -0.011,
];

const BLADE: usize = 3 * 32 + 1;
const DISK: usize = 3 * 27 + 1;
const TIP: usize = 106;

/// A degree of freedom on the free part of the right face.
fn right(sector: &BoundarySector) -> usize {
    dofs(&sector.right)[3 * PAIR + 1]
}

/// The sector with contacts inside and on its right face, and forces inside and on that.
fn loaded(sector: &BoundarySector, engine_order: i64) -> Model {
    let mut model = sector.model(engine_order);
    let r = right(sector);
    for contact in [jenkins(DISK, BLADE, 0), jenkins(r, BLADE, 0)] {
        model.add_contact(&contact).unwrap();
    }
    model.add_force(TIP, 1, 1500.0.into()).unwrap();
    model.add_force(r, 1, Complex64::new(400.0, 250.0)).unwrap();
    model.set_rayleigh(0.0, 2e-6).unwrap();
    model
}

fn natural(model: &Model, diameter: i64) -> f64 {
    model.linear_modes(diameter, ContactState::Stuck).unwrap().omega[0]
}

#[test]
fn the_wheel_of_a_sector_with_faces_moves_as_its_wave_in_both_frames() {
    for frame in [SectorFrame::Cartesian, SectorFrame::Cylindrical] {
        let sector = BoundarySector::read(frame);
        for engine_order in [3, -2] {
            let model = loaded(&sector, engine_order);
            let wheel = model.wheel().unwrap();
            let omega = 0.985 * natural(&model, engine_order.abs());
            let (wave, whole) = (
                solve_at(&model, &harmonics(3), omega),
                solve_at(&wheel, &harmonics(3), omega),
            );
            let (x, n) = (all_harmonics(&wave, 0), sector.ndof());
            let mut expected = Vec::new();
            for h in 0..=3 {
                for s in 0..N {
                    let lag = model.structure().phase(h, s as i64);
                    expected.extend(x[n * h..n * (h + 1)].iter().map(|x| lag * x));
                }
            }
            let gap = relative_gap(&all_harmonics(&whole, 0), &expected);
            println!(
                "{frame:?}, EO {engine_order}: slip {:.2}, gap {gap:.1e}",
                slip(&wave, 0)
            );
            // The wheel of 1080 degrees of freedom is solved with factors of other rounding than the wave.
            assert!(slip(&wave, 0) > 0.0 && gap < 1e-11, "{gap}");
        }
    }
}

/// A pattern of blades, and one of a matrix that reaches over the right face.
#[test]
fn a_mistuned_wheel_of_faces_is_that_of_the_sector_from_its_blocks() {
    let pair = Pair::new();
    let (sector, given) = (&pair.sector, pair.sector.ndof());
    let model = loaded(sector, 3);
    let (l, r) = (dofs(&sector.left)[3 * PAIR + 1], right(sector));
    let n = |dof| pair.number(dof);
    let mut blocks = pair.reference(3);
    blocks.add_contact(&jenkins(n(DISK), n(BLADE), 0)).unwrap();
    // The right node of a sector is the left one of the next: side b lies in the sector before.
    blocks.add_contact(&jenkins(n(l), n(BLADE), -1)).unwrap();
    blocks.add_force(n(TIP), 1, 1500.0.into()).unwrap();
    let lag = model.structure().phase(1, 1);
    blocks
        .add_force(n(l), 1, Complex64::new(400.0, 250.0) * lag.conj())
        .unwrap();
    blocks.set_rayleigh(0.0, 2e-6).unwrap();

    let blade: Vec<usize> = (3 * 32..given).collect();
    let of_blocks: Vec<usize> = blade.iter().map(|&dof| n(dof)).collect();
    let (mut wheel, mut expected) = (model.wheel().unwrap(), blocks.wheel().unwrap());
    let mistune = |wheel: &mut Model, sector: &Model, what: Mistuning<'_>| {
        wheel.mistune(sector, &what, &DELTA).unwrap();
    };
    for property in [BladeProperty::Frequency, BladeProperty::Mass] {
        mistune(&mut wheel, &model, Mistuning::Blade(property, &blade));
        mistune(&mut expected, &blocks, Mistuning::Blade(property, &of_blocks));
    }
    // A spring between the right face and the blade: of the left face of the next sector.
    let mut spring = vec![0.0; given * given];
    for (i, j, sign) in [(r, r, 1.0), (BLADE, BLADE, 1.0), (r, BLADE, -1.0), (BLADE, r, -1.0)] {
        spring[j * given + i] = sign * 1e6;
    }
    let view = MatrixView::dense(given, &spring);
    mistune(&mut wheel, &model, Mistuning::Matrix(MatrixKind::Stiffness, &view));
    let (all, own) = (expected.ndof(), pair.origin.len());
    let mut stiffness = vec![0.0; all * all];
    let known = expected
        .block(MatrixKind::Stiffness, hbvib::internals::Block::Own)
        .unwrap()
        .unwrap();
    for j in 0..all {
        known.column(j).for_each(|(i, v)| stiffness[j * all + i] = v.re);
    }
    for (s, delta) in DELTA.iter().enumerate() {
        let (a, b) = ((s + 1) % N * own + n(l), s * own + n(BLADE));
        for (i, j, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
            stiffness[j * all + i] += sign * delta * 1e6;
        }
    }
    expected
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(all, &stiffness))
        .unwrap();

    let omega = 0.985 * natural(&model, 3);
    let solve = |model: &Model| solve_at(model, &harmonics(3), omega);
    let (found, known) = (solve(&wheel), solve(&expected));
    let (x, y) = (all_harmonics(&found, 0), all_harmonics(&known, 0));
    let kept: Vec<Complex64> = (0..4)
        .flat_map(|h| (0..N).map(move |s| (h * N + s) * given))
        .flat_map(|first| pair.origin.iter().map(move |dof| first + dof))
        .map(|at| x[at])
        .collect();
    let gap = relative_gap(&kept, &y);
    println!("slip {:.2}, gap {gap:.1e}", slip(&found, 0));
    assert!(slip(&found, 0) > 0.0 && gap < 1e-10, "{gap}");
    // Saved and loaded it is the same model.
    let again = Model::load(&wheel.save().unwrap()).unwrap();
    assert!(all_harmonics(&solve(&again), 0) == x);
    assert_eq!(again.save().unwrap(), wheel.save().unwrap());
    assert_eq!(again.structure().whole_wheel(), Some((N, 3)));
}

#[test]
fn faces_of_a_wheel_are_fixed_on_both_sides_or_refused() {
    let sector = BoundarySector::read(SectorFrame::Cylindrical);
    let model = loaded(&sector, 3);
    let given = sector.ndof();
    let (l, r) = (dofs(&sector.left)[3 * PAIR + 2], dofs(&sector.right)[3 * PAIR + 2]);
    let mut wheel = model.wheel().unwrap();
    let words = ["fixed on one side only", "sectors 4 and 5"];
    refused(wheel.fix(&[5 * given + l]), Status::Argument, &words);
    // The last sector is followed by the first.
    wheel.fix(&[(N - 1) * given + r, l]).unwrap();
    let x = all_harmonics(&solve_at(&wheel, &harmonics(1), 0.9 * natural(&model, 3)), 0);
    let at = |s: usize, dof: usize| x[(N + s) * given + dof].norm();
    assert!(at(N - 1, r) == 0.0 && at(0, l) == 0.0 && at(0, r) > 0.0);
    assert!((at(4, r) - at(5, l)).abs() <= 1e-15 * at(4, r));
    let (mut wheel, right) = (model.wheel().unwrap(), right(&sector));
    let blade = Mistuning::Blade(BladeProperty::Stiffness, &[TIP, right]);
    refused(
        wheel.mistune(&model, &blade, &DELTA),
        Status::Argument,
        &["dofs[1]", "right face"],
    );
    // Axes of the next sector are turned in a Cartesian frame.
    let cartesian = BoundarySector::read(SectorFrame::Cartesian);
    let mut model = cartesian.model(3);
    model.add_force(TIP, 1, 1.0.into()).unwrap();
    let mut contact = jenkins(BLADE, DISK, 1);
    contact.dof_b = [Some(3 * 32 + 2), None, None];
    if model.add_contact(&contact).is_ok() {
        refused(model.wheel(), Status::Unsupported, &["contact 0", "cylindrical frame"]);
    }
}
