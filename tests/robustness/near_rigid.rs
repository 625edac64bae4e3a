//! Contacts that are nearly rigid against the structure: with fixed harmonics every sweep ends at its end, and the
//! forces of its points balance to what rounding leaves, whatever the stiffness, the structure and the units.

use crate::common::models::{Structure, chain_stiffness, dense, diagonal};
use crate::common::{harmonics, sweep};
use crate::random_problems::random::Random;
use hbvib::{
    Branch, Constant, Contact, ContactKind, Iwan, MatrixKind, MatrixView, Model, SolverOptions, Status, Table,
    forced_residual,
};
use num_complex::Complex64;

/// A chain fixed at one end, with springs of about `stiffness` and masses of about `mass`; or one sector of a wheel.
struct Chain {
    model: Model,
    masses: usize,
    stiffness: f64,
    force: f64,
    cyclic: bool,
}

fn chain(random: &mut Random, masses: usize, (force, length): (f64, f64), cyclic: bool) -> Chain {
    let stiffness = force / length;
    let draw = |_| (stiffness * random.within(0.5, 2.0), stiffness * random.within(0.5, 2.0));
    let (mut springs, mass): (Vec<_>, Vec<_>) = (0..masses).map(draw).unzip();
    springs.push(0.0);
    let (mut k, m) = (chain_stiffness(&springs), diagonal(&mass));
    let mut model = if cyclic {
        let link = 0.3 * stiffness;
        let mut next = vec![0.0; masses * masses];
        next[masses * masses - 1] = -link;
        k[masses * masses - 1] += 2.0 * link;
        Structure::cyclic(masses, 12)
            .next(MatrixKind::Stiffness, &next)
            .wave(1 + random.below(4) as i64)
            .build()
    } else {
        Model::new(masses).unwrap()
    };
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
        force,
        cyclic,
    }
}

/// The laws with a stiffness that may be near-rigid.
const LAWS: [&str; 8] = [
    "Jenkins",
    "Iwan",
    "stop",
    "stop, pressed",
    "friction 2D",
    "friction 2D, pressed",
    "friction 3D, constant load",
    "table",
];

impl Chain {
    /// Adds a contact of a law with stiffness `ratio` times that of the springs.
    fn touch(&mut self, random: &mut Random, law: &str, ratio: f64) {
        let n = self.masses;
        // Different degrees of freedom, and others or the ground.
        let first = random.below(n);
        let sides: [[Option<usize>; 2]; 3] = std::array::from_fn(|i| {
            let b = (n > 3 && i < 2 && random.happens(0.5)).then_some((first + i + 2) % n);
            [Some((first + i) % n), b]
        });
        let (a, b) = (sides.map(|s| s[0]), sides.map(|s| s[1]));
        let kt = ratio * self.stiffness;
        let limit = self.force * random.decade(-1.5, 0.3);
        let mu = random.within(0.2, 0.8);
        let length = self.force / self.stiffness;
        let [at, to] = sides[0];
        let mut contact = match law {
            "Jenkins" => Contact::jenkins(first, to, kt, 1.0, limit),
            "Iwan" => {
                let between = Contact::jenkins(first, to, 0.0, 0.0, 0.0);
                let joint = Iwan {
                    slip_force: limit,
                    stiffness: kt,
                    chi: -0.5,
                    beta: 1.0,
                };
                self.model.add_iwan(&between, &joint, 5).unwrap();
                return;
            }
            "stop" => Contact::unilateral(at, to, kt, length * random.within(0.0, 1.0)),
            "stop, pressed" => Contact::unilateral(at, to, kt, 0.0)
                .with(Constant::Preload, limit)
                .unwrap(),
            "friction 2D" => Contact::friction_2d([a[0], a[1]], [b[0], b[1]], (kt, kt), mu, 0.0)
                .with(Constant::Gap, 0.1 * length)
                .unwrap(),
            "friction 2D, pressed" => Contact::friction_2d([a[0], a[1]], [b[0], b[1]], (kt, kt), mu, limit),
            "friction 3D, constant load" => {
                Contact::friction_3d([a[0], a[1], None], [b[0], b[1], None], (kt, 0.0), 1.0, limit)
            }
            _ => {
                let (rigid, stiffness) = (limit / kt, self.stiffness);
                let far = limit + stiffness * length;
                let law = Table::new(&[-length, -rigid, 0.0, rigid, length], &[-far, -limit, 0.0, limit, far]);
                Contact::between(first, to, ContactKind::Table(law.unwrap()))
            }
        };
        if self.cyclic && contact.dof_b.iter().flatten().count() > 0 {
            contact.sector_offset = 1;
        }
        self.model.add_contact(&contact).unwrap();
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

    /// Imbalance at points of a sweep.
    fn swept(&self, (from, to): (f64, f64), highest: usize, every: usize, name: &str, found: &mut Vec<f64>) {
        let solver = SolverOptions {
            tol_residual: 1e-12,
            max_points: 20_000,
            ..harmonics(highest)
        };
        let branch = sweep(&self.model, &solver, from, to, &[]);
        assert_eq!(branch.status(), Status::Ok, "{name}: {:?}", branch.reason());
        let mut x = vec![Complex64::ZERO; (highest + 1) * self.masses];
        for point in (0..branch.points()).step_by(every) {
            branch.harmonics_at(point, &mut x).unwrap();
            found.push(self.imbalance(highest, branch.omega()[point], &x));
        }
    }
}

/// Prints the distribution, and bounds it by 10 ε kt/k beside the accuracy of contacts that are not stiff.
fn judge(name: &str, ratio: f64, mut found: Vec<f64>) {
    found.sort_by(f64::total_cmp);
    let share = |percent: usize| found[(found.len() - 1) * percent / 100];
    let [median, most, worst] = [50, 99, 100].map(share);
    println!(
        "{name}, kt/k {ratio:e}: imbalance {median:.1e}, 99 % {most:.1e}, worst {worst:.1e} of {}",
        found.len()
    );
    let rounding = f64::EPSILON * ratio;
    assert!(worst <= 1e-10 + 10.0 * rounding, "{worst:e}");
}

#[test]
fn sweeps_with_nearly_rigid_friction_end_in_balance() {
    for ratio in [1e4, 1e6, 1e8] {
        let mut found = Vec::new();
        for seed in 0..6 {
            let random = &mut Random::of(7, seed);
            let units = (random.decade(-3.0, 6.0), random.decade(-4.0, 4.0));
            let masses = 1 + random.below(7);
            let mut chain = chain(random, masses, units, false);
            for _ in 0..=random.below(2) {
                chain.touch(random, "Jenkins", ratio);
            }
            let at = random.below(masses);
            chain.model.add_force(at, 1, chain.force.into()).unwrap();
            let range = if seed % 2 == 0 { (0.2, 2.5) } else { (2.5, 0.2) };
            let highest = [3, 5, 9, 15][random.below(4)];
            let name = format!("kt/k {ratio:e}, seed {seed}, {masses} masses, H {highest}");
            chain.swept(range, highest, 7, &name, &mut found);
        }
        judge("Jenkins", ratio, found);
    }
}

/// A structure with one near-rigid contact under a force, and a frequency.
fn touched(seed: u64, law: &str, ratio: f64) -> (Chain, f64, Random) {
    let mut random = Random::of(17, seed);

    let units = (random.decade(-3.0, 6.0), random.decade(-4.0, 4.0));
    // Above 32 degrees of freedom the flexibility is interpolated along the sweep.
    let masses = [3, 4, 6, 40][random.below(4)];
    let cyclic = random.happens(0.4);
    let mut chain = chain(&mut random, masses, units, cyclic);
    chain.touch(&mut random, law, ratio);
    let at = random.below(masses);
    chain.model.add_force(at, 1, chain.force.into()).unwrap();
    let omega = random.within(0.2, 1.5);
    (chain, omega, random)
}

/// Sweeps over a tenth of the frequency with every law of `laws`.
fn balance(laws: &[&str], seeds: std::ops::Range<u64>) {
    for law in laws {
        for ratio in [1e4, 1e6, 1e8] {
            let mut found = Vec::new();
            for seed in seeds.clone() {
                let (chain, middle, mut random) = touched(seed, law, ratio);
                let range = if random.happens(0.5) {
                    (middle, 1.1 * middle)
                } else {
                    (1.1 * middle, middle)
                };
                let highest = [3, 5][random.below(2)];
                let name = format!("{law}, kt/k {ratio:e}, seed {seed}, H {highest}");
                chain.swept(range, highest, 3, &name, &mut found);
            }
            judge(law, ratio, found);
        }
    }
}

#[test]
fn every_nearly_rigid_law_ends_in_balance() {
    balance(&LAWS, 2..4);
    balance(&["stop", "friction 2D"], 0..2);
}

#[test]
#[ignore = "long"]
fn every_nearly_rigid_law_ends_in_balance_on_many_structures() {
    balance(&["Jenkins", "Iwan", "stop", "friction 2D"], 2..20);
}

/// A sweep of [`balance`] in its own sense or the other one, and the number of harmonics.
fn one_way(seed: u64, law: &str, ratio: f64, reversed: bool) -> (Chain, Branch, usize) {
    let (chain, middle, mut random) = touched(seed, law, ratio);
    let rising = random.happens(0.5) != reversed;
    let highest = [3, 5][random.below(2)];
    let solver = SolverOptions {
        tol_residual: 1e-12,
        max_points: 20_000,
        ..harmonics(highest)
    };
    let ends = if rising {
        (middle, 1.1 * middle)
    } else {
        (1.1 * middle, middle)
    };
    let branch = sweep(&chain.model, &solver, ends.0, ends.1, &[]);
    (chain, branch, highest)
}

/// At the onset of contact a branch turns within a motion of 1e-16: by more than 179 degrees where the force of the contact
/// pulls the motion towards it. All of these sweeps ended there.
#[test]
fn sweeps_turn_where_a_nearly_rigid_contact_begins_to_close() {
    let cases = [
        ("stop", [32, 45, 54].as_slice()),
        ("stop, pressed", &[13, 22, 43]),
        ("friction 2D", &[19, 32, 33, 34]),
        ("friction 2D, pressed", &[19, 54]),
        ("table", &[95, 164]),
    ];
    for (law, seeds) in cases {
        let mut found = Vec::new();
        for &seed in seeds {
            for reversed in [false, true] {
                let (chain, branch, highest) = one_way(seed, law, 1e8, reversed);
                assert_eq!(branch.status(), Status::Ok, "{law}, seed {seed}, {reversed}");
                let mut x = vec![Complex64::ZERO; (highest + 1) * chain.masses];
                for point in (0..branch.points()).step_by(7) {
                    branch.harmonics_at(point, &mut x).unwrap();
                    found.push(chain.imbalance(highest, branch.omega()[point], &x));
                }
            }
        }
        judge(law, 1e8, found);
    }
}

#[test]
#[ignore = "long"]
fn no_sweep_with_a_nearly_rigid_contact_ends_at_the_smallest_step() {
    for law in [
        "Jenkins",
        "Iwan",
        "stop",
        "stop, pressed",
        "friction 2D",
        "friction 2D, pressed",
        "table",
    ] {
        for ratio in [1e6, 1e8] {
            let mut back = 0;
            for seed in 0..60 {
                for reversed in [false, true] {
                    let (_, branch, _) = one_way(seed, law, ratio, reversed);
                    // Some branches turn back before the other end, and leave at the start.
                    back += usize::from(branch.status() == Status::StoppedLeftRange);
                    let name = format!("{law}, kt/k {ratio:e}, seed {seed}, {reversed}");
                    assert_ne!(branch.status(), Status::StoppedStepTooSmall, "{name}");
                }
            }
            println!("{law}, kt/k {ratio:e}: {back} of 120 branches left at their start");
            assert!(back <= 8, "{law}, {ratio:e}: {back}");
        }
    }
}

/// With a tolerance a frequency ends with an answer or at its bounds, whatever the stiffness: counted in Newton steps.
#[test]
fn a_tolerance_with_nearly_rigid_contacts_ends_soon() {
    let (mut answers, mut most) = (0, 0.0_f64);
    for law in [
        "Jenkins",
        "Iwan",
        "stop",
        "stop, pressed",
        "friction 2D, pressed",
        "table",
    ] {
        for ratio in [1e6, 1e8] {
            for seed in 2..4 {
                let (chain, omega, _) = touched(seed, law, ratio);
                let solver = SolverOptions {
                    tolerance: 1e-2,
                    ..SolverOptions::default()
                };
                let branch = sweep(&chain.model, &solver, omega, omega, &[]);
                let name = format!("{law}, kt/k {ratio:e}, seed {seed}: {:?}", branch.status());
                let estimate = branch.error_estimate()[0];
                match branch.status() {
                    Status::Ok => assert!(estimate <= 1e-2, "{name}: {estimate:e}"),
                    status => assert_eq!(status, Status::StoppedMaxHarmonics, "{name}"),
                }
                answers += usize::from(branch.status() == Status::Ok);
                most = most.max(branch.newton_iterations()[0]);
            }
        }
    }
    println!("{answers} answers of 24, at most {most} Newton steps");
    // A first point that misses the tolerance is sought up to three times, with up to 900 steps each here.
    assert!(answers >= 12 && most <= 2700.0);
}

/// Masses, stiffness of the springs between them and the ground, degrees of freedom along t1, t2 and n, friction coefficient and load, force,
/// and frequency.
type Pressed = (&'static [f64], f64, [usize; 3], (f64, f64), (usize, Complex64), f64);

/// Pressed friction in a plane, 1e4 to 1e8 times as stiff as the structure in all directions: no first point was found. The residual of the
/// point is evaluated in the motion of all degrees of freedom.
#[test]
fn pressed_friction_in_a_plane_has_a_first_point() {
    let both = Complex64::new(1.0, 1.0);
    let cases: [Pressed; 3] = [
        (
            &[1.664, 0.838, 0.95, 1.81, 0.508, 1.732, 1.696],
            1.8458,
            [3, 4, 5],
            (0.353, 0.2),
            (3, both),
            0.9195,
        ),
        (
            &[1.743, 0.724, 1.269, 0.704, 1.534, 1.763],
            0.8115,
            [2, 1, 4],
            (0.695, 0.1285),
            (4, 1.0.into()),
            1.1793,
        ),
        (
            &[1.402, 0.543, 0.722],
            1.2489,
            [1, 2, 0],
            (0.242, 0.0541),
            (2, both),
            1.0084,
        ),
    ];
    let ratios = [2e4, 2e6, 2e8];
    for (case, ratio) in cases.iter().flat_map(|case| ratios.map(|ratio| (case, ratio))) {
        let (masses, spring, at, (mu, load), (dof, force), omega) = *case;
        let n = masses.len();
        let stiffness = chain_stiffness(&vec![spring; n + 1]);
        let mut model = dense(&diagonal(masses), &stiffness).rayleigh(0.02, 0.0).build();
        let k = ratio * spring;
        model
            .add_contact(&Contact::friction_3d(at.map(Some), [None; 3], (k, k), mu, load))
            .unwrap();
        model.add_force(dof, 1, force).unwrap();
        let branch = sweep(&model, &harmonics(3), omega, omega, &[]);
        assert_eq!(branch.status(), Status::Ok, "{n} masses");
        let (mut x, mut r) = (vec![Complex64::ZERO; 4 * n], vec![Complex64::ZERO; 4 * n]);
        branch.harmonics_at(0, &mut x).unwrap();
        forced_residual(&model, &harmonics(3), omega, &x, &mut r, None, None).unwrap();
        let largest = r.iter().fold(0.0_f64, |m, r| m.max(r.norm()));
        println!(
            "{n} masses, {ratio:e}: imbalance {largest:.1e}, {} iterations",
            branch.newton_iterations()[0]
        );
        assert!(largest < 1e-8, "{n} masses, {ratio:e}: {largest:e}");
        assert!(branch.slip_fraction()[0] > 0.0, "{n} masses");
    }
}
