//! Sweeps whose contacts stick but for the largest motion of one of them, or with it: the motion of the stuck structure, which direct
//! solutions know, tells whether any contact slips within the range.

use crate::common::friction::Random;
use crate::common::models::chain;
use crate::common::{harmonics, omega_range, slip};
use hbvib::{Hooks, Model, forced_response};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

/// Masses of each chain.
const N: usize = 12;

/// A random chain with three sliders against the ground.
struct Case {
    mass: Vec<f64>,
    springs: Vec<f64>,
    rayleigh: [f64; 2],
    /// Mass, stiffness and limit of each slider.
    sliders: [(usize, f64, f64); 3],
    forces: [(usize, Complex64); 2],
    range: (f64, f64),
}

impl Case {
    fn new(random: &mut Random) -> Self {
        let mut between = |low: f64, high: f64| low + (high - low) * 0.5 * (1.0 + random.next());
        let low = between(0.2, 2.0);
        let place = between(0.0, 3.99) as usize;
        Self {
            mass: (0..N).map(|_| between(0.5, 2.0)).collect(),
            springs: (0..=N).map(|_| between(0.5, 2.0)).collect(),
            rayleigh: [between(-5.0, -1.5), between(-5.0, -1.5)].map(|x| 10.0_f64.powf(x)),
            sliders: [place, place + 4, place + 8].map(|dof| (dof, between(0.1, 1.0), between(0.2, 2.0))),
            forces: [1, 7].map(|dof| (dof, Complex64::from_polar(between(0.3, 1.0), between(0.0, 6.0)))),
            range: (low, low + between(0.2, 1.0)),
        }
    }

    fn model(&self, scale: f64) -> Model {
        let [alpha, beta] = self.rayleigh;
        let mut structure = chain(&self.mass, &self.springs).rayleigh(alpha, beta);
        for (dof, kt, limit) in self.sliders {
            structure = structure.slider(dof, kt, limit, 1.0);
        }
        let forces = self.forces.map(|(dof, force)| (dof, 1, force * scale));
        structure.forces(forces).build()
    }

    /// K of the chain, with its sliders stuck or without them.
    fn stiffness(&self, are_stuck: bool) -> DMatrix<f64> {
        let mut k = DMatrix::zeros(N, N);
        for (i, spring) in self.springs.iter().enumerate() {
            for (a, b, sign) in [(i, i, 1.0), (i + 1, i + 1, 1.0), (i, i + 1, -1.0), (i + 1, i, -1.0)] {
                // Rows 0 and N + 1 are the walls.
                if (1..=N).contains(&a) && (1..=N).contains(&b) {
                    k[(a - 1, b - 1)] += sign * spring;
                }
            }
        }
        for (dof, kt, _) in self.sliders.into_iter().filter(|_| are_stuck) {
            k[(dof, dof)] += kt;
        }
        k
    }

    /// Largest force of a stuck slider over its limit at a frequency.
    fn share(&self, [own, stuck]: [&DMatrix<f64>; 2], omega: f64) -> f64 {
        let [alpha, beta] = self.rayleigh;
        let z = DMatrix::from_fn(N, N, |i, j| {
            let mass = if i == j { self.mass[i] } else { 0.0 };
            Complex64::new(
                stuck[(i, j)] - omega * omega * mass,
                omega * (alpha * mass + beta * own[(i, j)]),
            )
        });
        let mut force = DVector::zeros(N);
        for (dof, value) in self.forces {
            force[dof] += value;
        }
        let motion = z.lu().solve(&force).unwrap();
        let shares = self.sliders.map(|(dof, kt, limit)| kt * motion[dof].norm() / limit);
        shares.into_iter().fold(0.0, f64::max)
    }

    /// The largest share over the range.
    fn largest(&self) -> f64 {
        let [own, stuck] = [false, true].map(|are_stuck| self.stiffness(are_stuck));
        let root = |i: usize| self.mass[i].sqrt();
        let scaled = DMatrix::from_fn(N, N, |i, j| stuck[(i, j)] / (root(i) * root(j)));
        let (low, high) = self.range;
        let mut values: Vec<f64> = (0..=500).map(|i| low + (high - low) * f64::from(i) / 500.0).collect();
        for square in scaled.symmetric_eigenvalues().iter() {
            let width = 0.5 * (self.rayleigh[0] + self.rayleigh[1] * square);
            values.extend((-60..=60).map(|i| square.sqrt() + 0.2 * f64::from(i) * width));
        }
        values.retain(|x| (low..=high).contains(x));
        values.sort_by(f64::total_cmp);
        let shares: Vec<f64> = values.iter().map(|&x| self.share([&own, &stuck], x)).collect();
        let most = (0..shares.len())
            .max_by(|&a, &b| shares[a].total_cmp(&shares[b]))
            .unwrap();
        let mut ends = [values[most.saturating_sub(1)], values[(most + 1).min(values.len() - 1)]];
        for _ in 0..60 {
            let third = (ends[1] - ends[0]) / 3.0;
            let inner = [ends[0] + third, ends[1] - third];
            let [a, b] = inner.map(|x| self.share([&own, &stuck], x));
            ends = if a < b {
                [inner[0], ends[1]]
            } else {
                [ends[0], inner[1]]
            };
        }
        self.share([&own, &stuck], 0.5 * (ends[0] + ends[1])).max(shares[most])
    }
}

#[test]
fn contacts_slip_where_the_motion_of_the_stuck_structure_reaches_their_limit_and_nowhere_else() {
    let mut random = Random(5);
    for trial in 0..24 {
        let case = Case::new(&mut random);
        let largest = case.largest();
        let distance = 10.0_f64.powf(-1.5 - 2.5 * (1.0 + random.next()));
        for above in [false, true] {
            let force = if above { 1.0 + distance } else { 1.0 - distance };
            let range = omega_range(case.range.0, case.range.1);
            let branch = forced_response(
                &case.model(force / largest),
                &harmonics(3),
                &range,
                &mut Hooks::default(),
            );
            let branch = branch.unwrap();
            let slips = (0..branch.points()).any(|point| slip(&branch, point) > 0.0);
            assert_eq!(
                slips, above,
                "{trial}: {force:e} of the force at which the first contact slips"
            );
        }
    }
}
