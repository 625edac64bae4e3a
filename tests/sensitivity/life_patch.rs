//! Wear of patches: contacts with a normal stiffness, whose loads vary within the period and with the gap that wear opens.

use crate::common::{at_dof, omega_range};
use hbvib::{
    Constant, Contact, Duty, Hooks, LifeFollow, LifeOptions, MatrixKind, MatrixView, Model, SolverOptions, Status,
    Wear, forced_response, life,
};

fn solver(harmonics: usize) -> SolverOptions {
    at_dof(0, crate::common::harmonics(harmonics))
}

fn diagonal(model: &mut Model, which: MatrixKind, values: &[f64]) {
    let n = values.len();
    let mut all = vec![0.0; n * n];
    for (i, value) in values.iter().enumerate() {
        all[i * n + i] = *value;
    }
    model.set_matrix(which, &MatrixView::dense(n, &all)).unwrap();
}

fn wear(rates: &[f64], areas: &[f64]) -> Vec<Wear> {
    let all = rates.iter().zip(areas).enumerate();
    all.map(|(contact, (rate, area))| Wear {
        contact,
        rate: *rate,
        area: *area,
    })
    .collect()
}

/// A patch of contacts on common tangential motions; its loads are those of the undeformed faces, negative ones are gaps.
#[derive(Clone)]
struct Patch {
    masses: Vec<f64>,
    springs: Vec<f64>,
    damping: f64,
    /// Degrees of freedom of each contact: one or two tangential ones, then the normal one.
    contacts: Vec<Vec<usize>>,
    kt: f64,
    kn: f64,
    mu: f64,
    /// (degree of freedom, harmonic, value)
    forces: Vec<(usize, usize, f64)>,
}

impl Patch {
    fn model(&self, loads: &[f64]) -> Model {
        let n = self.masses.len();
        let mut model = Model::new(n).unwrap();
        diagonal(&mut model, MatrixKind::Mass, &self.masses);
        model
            .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &self.springs))
            .unwrap();
        model.set_rayleigh(0.0, self.damping).unwrap();
        for (dofs, load) in self.contacts.iter().zip(loads) {
            let constants = ((self.kt, self.kn), self.mu, load.max(0.0));
            let mut contact = match dofs[..] {
                [t, z] => Contact::friction_2d([Some(t), Some(z)], [None; 2], constants.0, constants.1, constants.2),
                _ => Contact::friction_3d(
                    [Some(dofs[0]), Some(dofs[1]), Some(dofs[2])],
                    [None; 3],
                    constants.0,
                    constants.1,
                    constants.2,
                ),
            };
            contact.set(Constant::Gap, (-load).max(0.0) / self.kn).unwrap();
            model.add_contact(&contact).unwrap();
        }
        for &(dof, harmonic, value) in &self.forces {
            model.add_force(dof, harmonic, value.into()).unwrap();
        }
        model
    }

    /// Depths by the classical method of Runge and Kutta, with works of contact summaries. A contact that has worn by h has its faces
    /// kn h further apart; the structure itself moves the loads from one to the other.
    fn march(
        &self,
        loads: &[f64],
        wear: &[Wear],
        (omega, harmonics): (f64, usize),
        (cycles, steps): (f64, usize),
    ) -> Vec<f64> {
        let rates = |depths: &[f64]| -> Vec<f64> {
            let worn: Vec<f64> = loads.iter().zip(depths).map(|(load, h)| load - self.kn * h).collect();
            let options = omega_range(omega, omega);
            let branch =
                forced_response(&self.model(&worn), &solver(harmonics), &options, &mut Hooks::default()).unwrap();
            let work = |w: &Wear| branch.contact_summary(0, w.contact).unwrap().work;
            wear.iter().map(|w| w.rate / w.area * work(w)).collect()
        };
        let step = cycles / steps as f64;
        let mut depths = vec![0.0; loads.len()];
        let moved = |depths: &[f64], by: f64, slope: &[f64]| -> Vec<f64> {
            depths.iter().zip(slope).map(|(h, s)| h + by * s).collect()
        };
        for _ in 0..steps {
            let a = rates(&depths);
            let b = rates(&moved(&depths, 0.5 * step, &a));
            let c = rates(&moved(&depths, 0.5 * step, &b));
            let d = rates(&moved(&depths, step, &c));
            for (i, h) in depths.iter_mut().enumerate() {
                *h += step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
            }
        }
        depths
    }
}

fn depths(
    model: &Model,
    wear: &[Wear],
    (omega, harmonics): (f64, usize),
    cycles: &[f64],
    tolerance: f64,
) -> Vec<Vec<f64>> {
    let duties = [Duty {
        omega,
        force: 1.0,
        share: 1.0,
    }];
    let options = LifeOptions {
        wear,
        follow: LifeFollow::Duties(&duties),
        cycles,
        tolerance,
        ..LifeOptions::default()
    };
    let found = life(model, &solver(harmonics), &options, &mut Hooks::default()).unwrap();
    assert_eq!(found.status, Status::Ok, "{:?}", found.reason);
    println!(
        "{} steps, {} solutions, {:?}",
        found.steps, found.solutions, found.events
    );
    found.points.iter().map(|point| point.depths.clone()).collect()
}

/// Two springs beside each other under a common force P, on a mass so heavy that friction does not change its motion A: loads N₁ + N₂ = P,
/// and their difference falls as e^{−rn}, r = 4 kn α μ (A − μP/kt), with the depth per work α.
#[test]
fn wear_evens_the_pressure_of_two_springs() {
    let (kt, kn, mu, amplitude, force, rate) = (2.0, 3.0, 0.3, 0.9, 1.6, 0.01);
    let patch = Patch {
        masses: vec![1e12, 1.0],
        springs: vec![1e8, 0.0, 0.0, 1e-9],
        damping: 1e-3,
        contacts: vec![vec![0, 1]; 2],
        kt,
        kn,
        mu,
        forces: vec![(0, 1, (1e8 - 1e12) * amplitude), (1, 0, -force)],
    };
    let wear = wear(&[rate; 2], &[1.0; 2]);
    // Faces of different height: half of the difference is pressed, the other half open.
    let difference = 0.8;
    let model = patch.model(&[0.5 * difference, -0.5 * difference]);
    let decay = 4.0 * kn * rate * mu * (amplitude - mu * force / kt);
    let cycles = [5.0, 20.0, 60.0];
    for (n, found) in cycles.iter().zip(depths(&model, &wear, (1.0, 5), &cycles, 1e-7)) {
        let left = difference - kn * (found[0] - found[1]);
        let wanted = difference * (-decay * n).exp();
        assert!(
            (left - wanted).abs() < 2e-6 * difference,
            "{n} cycles: {left} is not {wanted}"
        );
    }
    // An even pressure stays even, and both wear as one: h′ = 4αμN(A − μN/kt), N = P/2.
    let even = depths(&patch.model(&[0.0; 2]), &wear, (1.0, 5), &[30.0], 1e-7);
    let load = 0.5 * force;
    let wanted = 30.0 * 4.0 * rate * mu * load * (amplitude - mu * load / kt);
    for h in &even[0] {
        assert!((h / wanted - 1.0).abs() < 1e-6, "{h} is not {wanted}");
    }
}

/// Loads that vary within the period, in one and in two tangential directions, on faces that an elastic structure couples: against an own
/// march of small steps. Depths differ from contact to contact, as pressure and slip do.
#[test]
fn wear_of_patches_with_varying_pressure_is_that_of_a_march() {
    // Tangential x and y, normals z₁ and z₂ with a spring between them.
    let springs = vec![
        1.0, 0.1, 0.0, 0.0, //
        0.1, 1.3, 0.0, 0.0, //
        0.0, 0.0, 0.5, -0.3, //
        0.0, 0.0, -0.3, 0.6,
    ];
    let plane = Patch {
        masses: vec![1.0, 1.2, 0.1, 0.1],
        springs,
        damping: 0.05,
        contacts: vec![vec![0, 1, 2], vec![0, 1, 3], vec![0, 1, 2]],
        kt: 0.6,
        kn: 0.8,
        mu: 0.3,
        forces: vec![
            (0, 1, 0.5),
            (1, 1, 0.2),
            (2, 0, -0.5),
            (3, 0, -0.4),
            (2, 1, 0.3),
            (3, 1, -0.2),
        ],
    };
    let line = Patch {
        contacts: vec![vec![0, 2], vec![0, 3], vec![0, 2]],
        ..plane.clone()
    };
    let loads = [0.1, 0.25, -0.05];
    for (name, patch, cycles, steps) in [("a line", &line, 8.0, 24), ("a plane", &plane, 8.0, 24)] {
        let wear = wear(&[0.05, 0.04, 0.05], &[1.0, 1.0, 1.5]);
        let wanted = patch.march(&loads, &wear, (0.9, 5), (cycles, steps));
        let found = depths(&patch.model(&loads), &wear, (0.9, 5), &[cycles], 1e-7);
        println!("{name}: {found:?}, {wanted:?}");
        let most = wanted.iter().fold(0.0_f64, |most, h| most.max(*h));
        for (found, wanted) in found[0].iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-5 * most, "{name}: {found} is not {wanted}");
        }
        assert!(
            (wanted[0] / wanted[1] - 1.0).abs() > 1e-2,
            "{name}: the pressure does not differ"
        );
    }
}
