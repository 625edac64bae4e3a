//! Sweeps over structures of 40 to 420 degrees of freedom whose contacts stick, against a direct solution at each stored point, first,
//! last, interior, requested and at peaks: the truth, since nothing is left but a linear system; and where contacts slip, the sweep
//! against the same frequency alone.

use crate::common::depth::some_of;
use crate::common::friction::Random;
use crate::common::{harmonics, omega_range};
use faer::Mat;
use faer::linalg::solvers::Solve;
use hbvib::internals::FlexibilityWay;
use hbvib::{
    Contact, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, Part, SolverOptions, Speed, forced_response,
};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

/// Largest deviation of a motion from the direct solution, relative to its largest degree of freedom.
const BOUND: f64 = 1e-9;

#[derive(Clone, Copy, Debug)]
enum Shape {
    Chain,
    Grid,
    Random,
}

#[derive(Clone, Copy, Debug)]
enum Damping {
    Proportional,
    General,
    Structural,
    Gyroscopic,
}

const SHAPES: [Shape; 3] = [Shape::Chain, Shape::Grid, Shape::Random];
const DAMPINGS: [Damping; 4] = [
    Damping::Proportional,
    Damping::General,
    Damping::Structural,
    Damping::Gyroscopic,
];

/// A random structure with frequencies up to about 200, with its contacts and the range of its sweep.
#[derive(Debug)]
struct Case {
    n: usize,
    shape: Shape,
    damping: Damping,
    mass: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    /// C + G, of which G is the skew part.
    viscous: DMatrix<f64>,
    loss_factor: f64,
    /// Proportional damping βK.
    beta: f64,
    contacts: Vec<usize>,
    kt: f64,
    harmonics: usize,
    range: (f64, f64),
    forced: usize,
    response: usize,
}

impl Case {
    fn new(seed: u64, n: usize, shape: Shape, damping: Damping) -> Self {
        let mut random = Random(seed);
        random.next();
        let (mass, stiffness) = matrices(&mut random, n, shape);
        let beta = 10.0_f64.powf(between(&mut random, -6.0, -3.0));
        let mut viscous = &stiffness * beta;
        let mut loss_factor = 0.0;
        match damping {
            Damping::Proportional => {}
            Damping::General => {
                for _ in 0..5 {
                    let i = below(&mut random, n);
                    viscous[(i, i)] += 10.0_f64.powf(between(&mut random, 0.0, 2.0));
                }
            }
            Damping::Structural => {
                viscous.fill(0.0);
                loss_factor = 10.0_f64.powf(between(&mut random, -4.0, -1.5));
            }
            Damping::Gyroscopic => {
                for _ in 0..8 {
                    let (i, j) = (below(&mut random, n), below(&mut random, n));
                    if i != j {
                        let g = between(&mut random, -20.0, 20.0);
                        viscous[(i, j)] += g;
                        viscous[(j, i)] -= g;
                    }
                }
            }
        }
        let count = [1, 2, 5, 12, 30, 60][below(&mut random, 6)].min(n / 2);
        let mut contacts: Vec<usize> = Vec::new();
        while contacts.len() < count {
            let dof = below(&mut random, n);
            if !contacts.contains(&dof) {
                contacts.push(dof);
            }
        }
        let (low, high) = if below(&mut random, 2) == 0 {
            (60.0, 195.0)
        } else {
            (100.0, 106.0)
        };
        Self {
            n,
            shape,
            damping,
            mass,
            stiffness,
            viscous,
            loss_factor,
            beta,
            contacts,
            kt: 10.0_f64.powf(between(&mut random, 2.0, 4.0)),
            harmonics: [1, 3, 5, 9][below(&mut random, 4)],
            range: if below(&mut random, 2) == 0 {
                (low, high)
            } else {
                (high, low)
            },
            forced: below(&mut random, n),
            response: below(&mut random, n),
        }
    }

    /// The model, with sliders that hold forces up to a limit.
    fn model(&self, limit: f64) -> Model {
        let mut model = Model::new(self.n).unwrap();
        let mut set = |kind: MatrixKind, a: &DMatrix<f64>| {
            let part = if kind == MatrixKind::Gyroscopic {
                Part::General
            } else {
                Part::Full
            };
            let view = MatrixView::dense(self.n, a.as_slice()).part(part);
            model.set_matrix(kind, &view).unwrap();
        };
        set(MatrixKind::Mass, &self.mass);
        set(MatrixKind::Stiffness, &self.stiffness);
        let transposed = self.viscous.transpose();
        match self.damping {
            Damping::Proportional | Damping::Structural => {}
            Damping::General => set(MatrixKind::Damping, &self.viscous),
            Damping::Gyroscopic => {
                set(MatrixKind::Damping, &((&self.viscous + &transposed) * 0.5));
                set(MatrixKind::Gyroscopic, &((&self.viscous - &transposed) * 0.5));
            }
        }
        model
            .set_rayleigh(
                0.0,
                if matches!(self.damping, Damping::Proportional) {
                    self.beta
                } else {
                    0.0
                },
            )
            .unwrap();
        model.set_speed(Speed::Fixed(1.0)).unwrap();
        model.set_loss_factor(self.loss_factor).unwrap();
        for &dof in &self.contacts {
            model
                .add_contact(&Contact::jenkins(dof, None, self.kt, 0.3, limit / 0.3))
                .unwrap();
        }
        model.add_force(self.forced, 1, Complex64::new(0.5, 0.0)).unwrap();
        model
    }

    fn options(&self) -> SolverOptions {
        SolverOptions {
            response_dof: Some(self.response),
            max_points: 120,
            ..harmonics(self.harmonics)
        }
    }

    /// Motion with stuck contacts.
    fn direct(&self, omega: f64) -> DVector<Complex64> {
        let mut z = Mat::from_fn(self.n, self.n, |i, j| {
            let k = self.stiffness[(i, j)];
            Complex64::new(
                k - omega * omega * self.mass[(i, j)],
                omega * self.viscous[(i, j)] + self.loss_factor * k,
            )
        });
        for &dof in &self.contacts {
            z[(dof, dof)] += self.kt;
        }
        let mut force = Mat::zeros(self.n, 1);
        force[(self.forced, 0)] = Complex64::new(0.5, 0.0);
        let motion = z.partial_piv_lu().solve(&force);
        DVector::from_fn(self.n, |i, _| motion[(i, 0)])
    }
}

fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * 0.5 * (1.0 + random.next())
}

fn below(random: &mut Random, n: usize) -> usize {
    ((0.5 * (1.0 + random.next()) * n as f64) as usize).min(n - 1)
}

/// Mass and stiffness with frequencies up to about 200.
fn matrices(random: &mut Random, n: usize, shape: Shape) -> (DMatrix<f64>, DMatrix<f64>) {
    let mut mass = DMatrix::identity(n, n);
    let mut stiffness = DMatrix::zeros(n, n);
    let mut spring = |i: usize, j: Option<usize>, k: f64| {
        stiffness[(i, i)] += k;
        if let Some(j) = j {
            stiffness[(j, j)] += k;
            stiffness[(i, j)] -= k;
            stiffness[(j, i)] -= k;
        }
    };
    match shape {
        Shape::Chain => {
            for i in 0..n {
                spring(i, (i + 1 < n).then_some(i + 1), 1e4);
            }
            spring(0, None, 1e4);
        }
        Shape::Grid => {
            let width = (n as f64).sqrt() as usize;
            for i in 0..n {
                mass[(i, i)] = between(random, 0.8, 1.2);
                spring(i, None, 50.0);
                if i + 1 < n && (i + 1) % width > 0 {
                    spring(i, Some(i + 1), 4e3);
                }
                if i + width < n {
                    spring(i, Some(i + width), 4e3);
                }
            }
        }
        Shape::Random => {
            let turned = DMatrix::from_fn(n, n, |_, _| between(random, -1.0, 1.0)).qr().q();
            let squares = DVector::from_fn(n, |i, _| (2.0 + 198.0 * i as f64 / n as f64).powi(2));
            let full = &turned * DMatrix::from_diagonal(&squares) * turned.transpose();
            stiffness = (&full + full.transpose()) * 0.5;
        }
    }
    (mass, stiffness)
}

/// Sweeps a structure, compares each stored point with a direct solution, and returns the way to its flexibility.
fn compare(case: &Case) -> FlexibilityWay {
    let (start, end) = case.range;
    let at = [0.3, 0.77].map(|x| start + (end - start) * x);
    let forced = ForcedOptions {
        at: &at,
        ..omega_range(start, end)
    };
    let named = format!(
        "{} {:?} {:?}, {} contacts, H = {}, {start} .. {end}",
        case.n,
        case.shape,
        case.damping,
        case.contacts.len(),
        case.harmonics
    );
    let branch = forced_response(&case.model(1e6), &case.options(), &forced, &mut Hooks::default())
        .unwrap_or_else(|e| panic!("{named}: {e}"));
    assert!(
        branch.points() > 1 && branch.omega()[0].to_bits() == start.to_bits(),
        "{named}"
    );
    let mut motion = vec![Complex64::ZERO; (branch.harmonics() + 1) * case.n];
    for point in 0..branch.stored() {
        let omega = branch.omega_at(point).unwrap();
        let right = case.direct(omega);
        branch.harmonics_at(point, &mut motion).unwrap();
        let got = &motion[case.n..2 * case.n];
        let size = right.iter().fold(0.0_f64, |most, z| most.max(z.norm()));
        let off = right
            .iter()
            .zip(got)
            .fold(0.0_f64, |most, (a, b)| most.max((a - b).norm()));
        assert!(
            off < BOUND * size,
            "{named}: point {point} at {omega} is off by {:.1e}",
            off / size
        );
    }
    branch.reduction().flexibility_way
}

/// One size below and one above that at which modes or poles begin to take longer than factors along a short sweep, by harmonics and
/// contacts; and sizes at which many resonances in the range make modes the quicker ones again.
#[test]
fn both_ways_beside_a_change_of_the_way_are_direct_solutions() {
    use Damping::{Gyroscopic, Proportional};
    use FlexibilityWay::{Modes, Poles, Sparse};
    for (damping, harmonics, contacts, ways) in [
        (Proportional, 1, 1, [(215, Modes), (233, Sparse)]),
        (Proportional, 1, 30, [(215, Modes), (233, Sparse)]),
        (Proportional, 1, 5, [(230, Modes), (252, Sparse)]),
        (Gyroscopic, 9, 1, [(60, Poles), (150, Sparse)]),
    ] {
        for (n, way) in ways {
            let mut case = Case::new(90 + n as u64, n, Shape::Chain, damping);
            case.harmonics = harmonics;
            case.contacts = (0..contacts).map(|i| 2 + i * (n - 4) / contacts).collect();
            let whole = case.range;
            case.range.1 = whole.0 + 0.01 * (whole.1 - whole.0);
            assert_eq!(compare(&case), way, "{n}: {harmonics} harmonics, {contacts} contacts");
            if matches!(damping, Proportional) {
                case.range = whole;
                assert_eq!(compare(&case), Modes, "{n}: {harmonics} harmonics, {contacts} contacts");
            }
        }
    }
}

#[test]
fn every_stored_point_of_sweeps_with_stuck_contacts_is_the_direct_solution() {
    let mut seed = 0;
    for n in [40, 101, 130, 205] {
        for shape in SHAPES {
            for damping in DAMPINGS {
                seed += 1;
                // The largest ones take the most time. A third of them, of every shape and damping, where depth is not asked for.
                let thinned = some_of(3, 1) * (1 + n as u64 / 60);
                if seed % thinned == 0 {
                    compare(&Case::new(seed, n, shape, damping));
                }
            }
        }
    }
}

/// All sizes, shapes and dampings, up to 36 sweeps of each size.
#[test]
#[ignore = "takes minutes"]
fn every_point_of_hundreds_of_sweeps_is_the_direct_solution() {
    let mut seed = 1000;
    for n in [40, 67, 90, 100, 101, 130, 180, 230, 320, 420] {
        for shape in SHAPES {
            for damping in DAMPINGS {
                for _ in 0..if n > 200 { 1 } else { 3 } {
                    seed += 1;
                    compare(&Case::new(seed, n, shape, damping));
                }
            }
        }
        println!("{n} degrees of freedom: done");
    }
}

/// Where contacts slip, each point of a sweep is the solution of its frequency alone, which is solved with the same harmonics from the
/// point as guess: the first point, points inside, and requested ones.
#[test]
fn points_of_sweeps_that_slip_are_those_of_single_frequencies() {
    let mut slipped = 0;
    for (seed, n) in [(1, 90), (2, 101), (3, 110), (4, 150), (5, 205)] {
        let kinds = [
            (Shape::Chain, Damping::Proportional),
            (Shape::Random, Damping::General),
            (Shape::Grid, Damping::Gyroscopic),
        ];
        for (shape, damping) in kinds.into_iter().cycle().skip(seed as usize).take(some_of(1, 3)) {
            let mut case = Case::new(40 + seed, n, shape, damping);
            case.contacts.truncate(5);
            case.harmonics = case.harmonics.min(3);
            let middle = 0.5 * (case.range.0 + case.range.1);
            let right = case.direct(middle);
            let most = case
                .contacts
                .iter()
                .fold(0.0_f64, |most, &dof| most.max(right[dof].norm()));
            let model = case.model(0.3 * case.kt * most);
            let at = [middle];
            let forced = ForcedOptions {
                at: &at,
                ..omega_range(case.range.0, case.range.1)
            };
            let options = case.options();
            let named = format!("{n} {shape:?} {damping:?}");
            let branch = forced_response(&model, &options, &forced, &mut Hooks::default())
                .unwrap_or_else(|e| panic!("{named}: {e}"));
            let mut points = vec![0, branch.points() / 2, branch.points() - 1];
            points.extend(branch.at(0).iter().map(|special| special.point));
            let mut motion = vec![Complex64::ZERO; (branch.harmonics() + 1) * n];
            let mut alone = motion.clone();
            for point in points {
                branch.harmonics_at(point, &mut motion).unwrap();
                let omega = branch.omega_at(point).unwrap();
                let single = ForcedOptions {
                    guess: Some(&motion),
                    ..omega_range(omega, omega)
                };
                let one = forced_response(&model, &options, &single, &mut Hooks::default())
                    .unwrap_or_else(|e| panic!("{named}: {omega} alone: {e}"));
                one.harmonics_at(0, &mut alone).unwrap();
                let size = motion.iter().fold(0.0_f64, |most, z| most.max(z.norm()));
                let off = motion
                    .iter()
                    .zip(&alone)
                    .fold(0.0_f64, |most, (a, b)| most.max((a - b).norm()));
                assert!(
                    off < BOUND * size,
                    "{named}: point {point} at {omega} is off by {:.1e}",
                    off / size
                );
                slipped += usize::from(branch.slip_fraction_at(point).unwrap().iter().any(|s| *s > 0.0));
            }
        }
    }
    assert!(slipped > 10, "{slipped} points slip");
}
