//! Nonlinear modes of a sector with faces whose contact changes them by the millionth part: each is followed through
//! the onset of slip to its end, and is that of a dense solution with the describing function of the contact.

use crate::boundary_sector::{BoundarySector, dofs};
use crate::common::depth::{some_of, thorough};
use crate::common::mode_cases::{damping, follow, harmonic, only, singular_at};
use crate::common::{amplitude_range, harmonics, phase};
use hbvib::{Contact, DampingForm, ModeOptions, SectorFrame};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use std::f64::consts::PI;

const KT: f64 = 2e7;
const SLIP_FORCE: f64 = 20.0;

/// Motions of all degrees of freedom by those that are neither fixed nor on the right face, in the wave of an engine order.
fn expansion(sector: &BoundarySector, engine_order: i64) -> DMatrix<Complex64> {
    let (left, right, clamped) = (dofs(&sector.left), dofs(&sector.right), dofs(&sector.clamped));
    let own: Vec<usize> = (0..sector.ndof())
        .filter(|dof| !right.contains(dof) && !clamped.contains(dof))
        .collect();
    let lag = phase(1, engine_order, 1, crate::boundary_sector::N);
    let mut t = DMatrix::zeros(sector.ndof(), own.len());
    for (column, dof) in own.iter().enumerate() {
        t[(*dof, column)] = Complex64::ONE;
        if let Some(pair) = left.iter().position(|l| l == dof) {
            t[(right[pair], column)] = lag;
        }
    }
    t
}

/// Jenkins contact at one harmonic: k_eq + i·loss over kt at amplitude a over the slip motion.
fn describing_function(a: f64) -> Complex64 {
    if a <= 1.0 {
        return Complex64::ONE;
    }
    let theta = (1.0 - 2.0 / a).acos();
    Complex64::new((theta - 0.5 * (2.0 * theta).sin()) / PI, 4.0 * (a - 1.0) / (PI * a * a))
}

#[test]
fn modes_of_a_stiff_sector_pass_the_onset_of_slip_and_have_the_closed_form_of_the_contact() {
    let sector = BoundarySector::read(SectorFrame::Cylindrical);
    let (mut worst, mut slipping) = ((0.0_f64, 0.0_f64), 0);
    for (turn, engine_order) in [-2, 0, 3].into_iter().enumerate() {
        let t = expansion(&sector, engine_order);
        let of_wave = |a: &DMatrix<f64>| t.adjoint() * a.map(Complex64::from) * &t;
        let (k, m) = (of_wave(&sector.k), of_wave(&sector.m));
        // Inside the sector, from the blade to the ground, from the disk to the ground.
        // Every pair with one engine order, all with all of them where that is asked for.
        let pairs = [(82, Some(97)), (98, Some(104)), (106, None), (97, None)]
            .into_iter()
            .enumerate();
        for (_, (a, b)) in pairs.filter(|(pair, _)| thorough() || pair % 3 == turn) {
            let mut row = DVector::zeros(sector.ndof());
            row[a] = Complex64::ONE;
            if let Some(b) = b {
                row[b] -= Complex64::ONE;
            }
            let w = t.adjoint() * &row;
            let forms = [DampingForm::Mass, DampingForm::Stiffness];
            for (eta, form) in [0.0, 0.05].into_iter().flat_map(|eta| forms.map(|form| (eta, form))) {
                let mut model = sector.model(engine_order);
                model.set_loss_factor(eta).unwrap();
                model.add_contact(&Contact::jenkins(a, b, KT, 1.0, SLIP_FORCE)).unwrap();
                let at = [-4.6, -4.2, -3.8, -3.0];
                let range = ModeOptions {
                    at: &at,
                    damping_form: form,
                    ..amplitude_range(-8.0, -2.0)
                };
                let branch = follow(&model, &harmonics(1), &range);
                assert!(branch.points() < 80, "{} points", branch.points());
                assert!(damping(&branch).iter().all(|d| *d > 0.49 * eta - 1e-12));
                for i in 0..at.len() {
                    let (omega, d, point) = only(&branch, i);
                    let x = harmonic(&branch, point, 1);
                    let amplitude = row.dotc(&x).norm() * KT / SLIP_FORCE;
                    slipping += usize::from(amplitude > 1.0);
                    let contact = &w * w.adjoint() * (KT * describing_function(amplitude));
                    let dynamic = |omega: f64, d: f64| {
                        let (of_mass, of_stiffness) = match form {
                            DampingForm::Mass => (2.0 * d, 0.0),
                            DampingForm::Stiffness => (0.0, 2.0 * d),
                        };
                        &k * Complex64::new(1.0, eta - of_stiffness) + &contact
                            - &m * (omega * omega * Complex64::new(1.0, of_mass))
                    };
                    let own: Vec<Complex64> = (0..t.ncols())
                        .map(|c| x[(0..t.nrows()).find(|&r| t[(r, c)] == Complex64::ONE).unwrap()])
                        .collect();
                    let (known, known_d, _) = singular_at(dynamic, (omega, d), &DVector::from_vec(own));
                    worst.0 = worst.0.max((omega / known - 1.0).abs());
                    worst.1 = worst.1.max((d - known_d).abs());
                }
            }
        }
    }
    println!("{slipping} slipping points: ω {:.1e}, D {:.1e}", worst.0, worst.1);
    assert!(
        slipping > some_of(40, 120) && worst.0 < 1e-9 && worst.1 < 1e-9,
        "{worst:?}"
    );
}
