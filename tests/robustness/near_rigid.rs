//! Contacts that are nearly rigid against the structure: with fixed harmonics every sweep ends at its end, and the
//! forces of its points balance to what rounding leaves, whatever the stiffness, the structure and the units.

use crate::common::{harmonics, sweep};
use crate::random_problems::random::Random;
use hbvib::analysis::forced_residual;
use hbvib::contact::Contact;
use hbvib::error::Status;
use hbvib::linalg::matrix_view::MatrixView;
use hbvib::model::Model;
use hbvib::model::structure::MatrixKind;
use hbvib::options::SolverOptions;
use num_complex::Complex64;

/// A chain fixed at one end, with springs of about `stiffness` and masses of about `mass`.
struct Chain {
    model: Model,
    masses: usize,
    stiffness: f64,
    force: f64,
}

fn chain(random: &mut Random, kilo: f64, length: f64) -> Chain {
    let masses = 1 + random.below(7);
    let stiffness = kilo / length;
    let (mut k, mut m) = (vec![0.0; masses * masses], vec![0.0; masses * masses]);
    for i in 0..masses {
        let spring = stiffness * random.within(0.5, 2.0);
        k[i * masses + i] += spring;
        if i > 0 {
            k[(i - 1) * masses + i - 1] += spring;
            k[i * masses + i - 1] -= spring;
            k[(i - 1) * masses + i] -= spring;
        }
        m[i * masses + i] = stiffness * random.within(0.5, 2.0);
    }
    let mut model = Model::new(masses).unwrap();
    model
        .set_matrix(MatrixKind::Mass, &MatrixView::dense(masses, &m))
        .unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(masses, &k))
        .unwrap();
    model.set_rayleigh(0.0, random.decade(-3.0, -2.0)).unwrap();
    Chain {
        model,
        masses,
        stiffness,
        force: kilo,
    }
}

impl Chain {
    /// Adds one or two Jenkins contacts of stiffness `ratio` times that of the springs.
    fn rub(&mut self, random: &mut Random, ratio: f64) {
        for _ in 0..=random.below(2) {
            let a = random.below(self.masses);
            let b = random.below(2 * self.masses);
            let b = (b < self.masses && b != a).then_some(b);
            let limit = self.force * random.decade(-1.5, 0.3);
            let contact = Contact::jenkins(a, b, ratio * self.stiffness, 1.0, limit);
            self.model.add_contact(&contact).unwrap();
        }
    }

    /// Imbalance of forces at a motion over the forces of the structure, each harmonic by its dynamic stiffness.
    fn imbalance(&self, highest: usize, omega: f64, x: &[Complex64]) -> f64 {
        let mut r = vec![Complex64::ZERO; x.len()];
        forced_residual(&self.model, &harmonics(highest), omega, x, &mut r, None, None).unwrap();
        for (h, r) in r.chunks_exact_mut(self.masses).enumerate() {
            for r in r {
                *r /= 1.0 + (h as f64 * omega).powi(2);
            }
        }
        let size = |z: &[Complex64]| z.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        size(&r) / (self.force + self.stiffness * size(x))
    }
}

#[test]
fn sweeps_with_nearly_rigid_friction_end_in_balance() {
    for ratio in [1e4, 1e6, 1e8] {
        let mut found = Vec::new();
        for seed in 0..6 {
            let random = &mut Random::of(7, seed);
            let (force, length) = (random.decade(-3.0, 6.0), random.decade(-4.0, 4.0));
            let mut chain = chain(random, force, length);
            chain.rub(random, ratio);
            chain
                .model
                .add_force(random.below(chain.masses), 1, chain.force.into())
                .unwrap();
            let (from, to) = if seed % 2 == 0 { (0.2, 2.5) } else { (2.5, 0.2) };
            let highest = [3, 5, 9, 15][random.below(4)];
            let solver = SolverOptions {
                tol_residual: 1e-12,
                ..harmonics(highest)
            };
            let branch = sweep(&chain.model, &solver, from, to, &[]);
            let name = format!("kt/k {ratio:e}, seed {seed}, {} masses, H {highest}", chain.masses);
            assert_eq!(branch.status(), Status::Ok, "{name}: {:?}", branch.reason());
            let mut x = vec![Complex64::ZERO; (highest + 1) * chain.masses];
            for point in (0..branch.points()).step_by(7) {
                branch.harmonics_at(point, &mut x).unwrap();
                found.push(chain.imbalance(highest, branch.omega()[point], &x));
            }
        }
        found.sort_by(f64::total_cmp);
        let share = |percent: usize| found[(found.len() - 1) * percent / 100];
        let [median, most, worst] = [50, 99, 100].map(share);
        println!(
            "kt/k {ratio:e}: imbalance {median:.1e}, 99 % {most:.1e}, worst {worst:.1e} of {}",
            found.len()
        );
        let rounding = f64::EPSILON * ratio;
        assert!(median <= 1e-11 + rounding, "{median:e}");
        assert!(most <= 1e-10 + 1e3 * rounding, "{most:e}");
        assert!(worst <= 1e-9 + 2e4 * rounding, "{worst:e}");
    }
}
