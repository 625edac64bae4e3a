//! Waves of both senses of each nodal diameter against the eigenvalues of the whole wheel as a dense first-order system:
//! random sectors with gyroscopic and aerodynamic forces, general damping and unsymmetric couplings. Every eigenvalue of the
//! wheel is found, each once.

use crate::common::models::Structure;
use crate::common::random;
use crate::rotating_modes::first_order;
use hbvib::{
    AeroForm, Contact, ContactState, Hooks, Interference, LinearContacts, MatrixKind, MatrixView, Model, Part, Speed,
    damped_modes, interference,
};
use nalgebra::DMatrix;
use num_complex::Complex64;
use std::f64::consts::TAU;

const ALPHA: f64 = 0.02;
const BETA: f64 = 0.003;
const ETA: f64 = 0.015;

/// Numbers in −1 … 1.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        random::signed(&mut self.0)
    }

    fn below(&mut self, n: usize) -> usize {
        ((0.5 * (self.next() + 1.0) * n as f64) as usize).min(n - 1)
    }

    fn chance(&mut self, share: f64) -> bool {
        0.5 * (self.next() + 1.0) < share
    }

    fn matrix(&mut self, n: usize, size: f64) -> DMatrix<f64> {
        DMatrix::from_fn(n, n, |_, _| size * self.next())
    }
}

/// Blocks of one matrix: own, to the next and to the previous sector.
struct Ring {
    kind: MatrixKind,
    own: DMatrix<f64>,
    next: DMatrix<f64>,
    previous: DMatrix<f64>,
}

/// A feature of a random sector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Feature {
    Gyroscopic,
    Aero,
    ComplexAero,
    Unsymmetric,
    Structural,
    /// Rayleigh damping and a loss factor.
    Proportional,
    Contact,
    PerDiameter,
}

/// Random features of a sector of `n` degrees of freedom.
fn features(random: &mut Random, n: usize) -> Vec<Feature> {
    let mut features = Vec::new();
    for (feature, share) in [
        (Feature::Gyroscopic, if n > 1 { 0.7 } else { 0.0 }),
        (Feature::Aero, 0.5),
        (Feature::ComplexAero, 0.5),
        (Feature::Unsymmetric, 0.4),
        (Feature::Structural, 0.3),
        (Feature::Proportional, 0.4),
        (Feature::Contact, 0.5),
        (Feature::PerDiameter, 0.3),
    ] {
        if random.chance(share) {
            features.push(feature);
        }
    }
    features
}

/// A random sector.
struct Sector {
    n: usize,
    sectors: usize,
    speed: f64,
    rings: Vec<Ring>,
    /// Offsets and coefficients per displacement and per velocity.
    aero: [(Vec<i64>, Vec<DMatrix<Complex64>>); 2],
    stiffness_of_contact: f64,
    features: Vec<Feature>,
}

impl Sector {
    fn new(random: &mut Random) -> Self {
        let (n, sectors) = (1 + random.below(4), 2 + random.below(8));
        let features = features(random, n);
        let has = |feature| features.contains(&feature);
        let symmetric = |random: &mut Random, diagonal: f64, size: f64| {
            let a = random.matrix(n, size);
            0.5 * (&a + a.transpose()) + DMatrix::from_diagonal_element(n, n, diagonal)
        };
        let ring = |kind, own: DMatrix<f64>, next: DMatrix<f64>, sign: f64| Ring {
            kind,
            own,
            previous: sign * next.transpose(),
            next,
        };
        let mut rings = vec![
            ring(
                MatrixKind::Mass,
                symmetric(random, 1.0, 0.2),
                random.matrix(n, 0.03),
                1.0,
            ),
            ring(
                MatrixKind::Stiffness,
                symmetric(random, 9.0, 1.0),
                random.matrix(n, 0.8),
                1.0,
            ),
            ring(
                MatrixKind::Damping,
                symmetric(random, 0.08, 0.02),
                random.matrix(n, 0.01),
                1.0,
            ),
        ];
        if has(Feature::Unsymmetric) {
            // General damping and a stiffness with circulatory forces, within the sector and between sectors.
            for (at, size) in [(1, 0.3), (2, 0.02)] {
                rings[at].own += random.matrix(n, size);
                rings[at].previous = random.matrix(n, 2.0 * size);
            }
        }
        if has(Feature::Structural) {
            rings.push(ring(
                MatrixKind::Structural,
                symmetric(random, 0.2, 0.05),
                random.matrix(n, 0.03),
                1.0,
            ));
        }
        if has(Feature::Gyroscopic) {
            let a = random.matrix(n, 0.8);
            rings.push(ring(
                MatrixKind::Gyroscopic,
                &a - a.transpose(),
                random.matrix(n, 0.3),
                -1.0,
            ));
            rings.push(ring(
                MatrixKind::StiffnessSpeed2,
                symmetric(random, -0.3, 0.1),
                random.matrix(n, 0.1),
                1.0,
            ));
        }
        let mut aero: [(Vec<i64>, Vec<DMatrix<Complex64>>); 2] = Default::default();
        if has(Feature::Aero) {
            for ((offsets, coefficients), size) in aero.iter_mut().zip([0.3, 0.02]) {
                for offset in [0, 1, -1, 2].into_iter().take(sectors.min(4)) {
                    if offsets.iter().any(|k: &i64| (k - offset) % sectors as i64 == 0) {
                        continue;
                    }
                    offsets.push(offset);
                    let part = if has(Feature::ComplexAero) { 1.0 } else { 0.0 };
                    coefficients.push(DMatrix::from_fn(n, n, |_, _| {
                        Complex64::new(random.next(), part * random.next()) * size
                    }));
                }
            }
        }
        Self {
            n,
            sectors,
            speed: 0.3 + 0.3 * (random.next() + 1.0),
            rings,
            aero,
            stiffness_of_contact: if has(Feature::Contact) {
                0.5 + 0.4 * random.next()
            } else {
                0.0
            },
            features,
        }
    }

    fn has(&self, feature: Feature) -> bool {
        self.features.contains(&feature)
    }

    /// Whether both senses must differ.
    fn distinguishes(&self) -> bool {
        [Feature::Gyroscopic, Feature::Aero, Feature::Unsymmetric]
            .into_iter()
            .any(|feature| self.has(feature))
    }

    fn model(&self) -> Model {
        let n = self.n;
        let mut model = Model::cyclic(n, self.sectors).unwrap();
        for ring in &self.rings {
            if self.has(Feature::PerDiameter) {
                // Every wave by its signed number, beyond one turn too.
                for diameter in model.structure().all_diameters() {
                    let turn = self.sectors as i64 * (diameter.rem_euclid(3) - 1);
                    let lag = Complex64::cis(-TAU * diameter as f64 / self.sectors as f64);
                    let a = DMatrix::from_fn(n, n, |i, j| {
                        ring.own[(i, j)] + lag * ring.next[(i, j)] + lag.conj() * ring.previous[(i, j)]
                    });
                    let view = MatrixView::dense_complex(n, a.as_slice());
                    let general = !matches!(ring.kind, MatrixKind::Mass | MatrixKind::Gyroscopic);
                    let view = if general { view.part(Part::General) } else { view };
                    model.set_diameter(ring.kind, diameter + turn, &view).unwrap();
                }
                continue;
            }
            let view = |a| MatrixView::dense(n, a);
            let general = !matches!(ring.kind, MatrixKind::Mass | MatrixKind::Gyroscopic);
            let own = view(ring.own.as_slice());
            let own = if general { own.part(Part::General) } else { own };
            model.set_matrix(ring.kind, &own).unwrap();
            model.set_coupling(ring.kind, &view(ring.next.as_slice())).unwrap();
            if general {
                model
                    .set_coupling_previous(ring.kind, &view(ring.previous.as_slice()))
                    .unwrap();
            }
        }
        let dofs: Vec<usize> = (0..n).collect();
        for ((offsets, coefficients), form) in self.aero.iter().zip([AeroForm::Displacement, AeroForm::Velocity]) {
            // Row after row.
            let list: Vec<Complex64> = coefficients
                .iter()
                .flat_map(|c| c.transpose().as_slice().to_vec())
                .collect();
            if !list.is_empty() {
                model.set_aero(&dofs, &list, offsets, form).unwrap();
            }
        }
        if self.has(Feature::Contact) {
            let contact = Contact {
                sector_offset: 1,
                ..Contact::jenkins(n - 1, Some(0), self.stiffness_of_contact, 1.0, 1.0)
            };
            model.add_contact(&contact).unwrap();
        }
        if self.has(Feature::Proportional) {
            model.set_rayleigh(ALPHA, BETA).unwrap();
            model.set_loss_factor(ETA).unwrap();
        }
        model.set_speed(Speed::Fixed(self.speed)).unwrap();
        model
    }

    /// M, C + ΩG and K + Ω²K₁ + iD of the wheel with its contacts stuck.
    fn wheel(&self) -> [DMatrix<Complex64>; 3] {
        let (n, sectors) = (self.n, self.sectors);
        let order = n * sectors;
        let mut found: [DMatrix<Complex64>; 3] = std::array::from_fn(|_| DMatrix::zeros(order, order));
        let mut place = |to: usize, factor: Complex64, offset: i64, a: &DMatrix<Complex64>| {
            for s in 0..sectors {
                let after = (s as i64 + offset).rem_euclid(sectors as i64) as usize;
                let mut part = found[to].view_mut((s * n, after * n), (n, n));
                part += a * factor;
            }
        };
        for ring in &self.rings {
            let (to, factor) = match ring.kind {
                MatrixKind::Mass => (0, Complex64::ONE),
                MatrixKind::Damping => (1, Complex64::ONE),
                MatrixKind::Stiffness => (2, Complex64::ONE),
                MatrixKind::Structural => (2, Complex64::I),
                MatrixKind::Gyroscopic => (1, self.speed.into()),
                MatrixKind::StiffnessSpeed2 => (2, (self.speed * self.speed).into()),
            };
            for (offset, a) in [(0, &ring.own), (1, &ring.next), (-1, &ring.previous)] {
                let a = a.map(Complex64::from);
                place(to, factor, offset, &a);
                if self.has(Feature::Proportional) && ring.kind == MatrixKind::Mass {
                    place(1, ALPHA.into(), offset, &a);
                }
                if self.has(Feature::Proportional) && ring.kind == MatrixKind::Stiffness {
                    place(1, BETA.into(), offset, &a);
                    place(2, Complex64::new(0.0, ETA), offset, &a);
                }
            }
        }
        for ((offsets, coefficients), to) in self.aero.iter().zip([2, 1]) {
            for (offset, c) in offsets.iter().zip(coefficients) {
                place(to, -Complex64::ONE, *offset, c);
            }
        }
        for s in 0..sectors {
            let ends = [(n * s + n - 1, 1.0), (n * ((s + 1) % sectors), -1.0)];
            for (i, a) in ends {
                for (j, b) in ends {
                    found[2][(i, j)] += self.stiffness_of_contact * a * b;
                }
            }
        }
        found
    }
}

/// Largest distance, relative, of eigenvalues from those of the wheel, each of which is taken once.
fn worst_match(mut found: Vec<Complex64>, known: &[Complex64]) -> f64 {
    assert_eq!(found.len(), known.len());
    let mut worst = 0.0_f64;
    for lambda in known {
        let distance = |a: &Complex64| (a - lambda).norm();
        let (at, _) = found
            .iter()
            .enumerate()
            .min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)))
            .unwrap();
        worst = worst.max(distance(&found.swap_remove(at)) / lambda.norm());
    }
    worst
}

#[test]
fn all_signed_diameters_of_200_random_sectors_have_the_eigenvalues_of_the_wheel_each_once() {
    let mut random = Random(17);
    let (mut worst, mut all, mut distinguished) = (0.0_f64, 0, 0);
    for case in 0..200 {
        let sector = Sector::new(&mut random);
        let model = sector.model();
        let [m, c, k] = sector.wheel();
        let known = first_order(&m, &c, &k);
        let mut found = Vec::new();
        for diameter in model.structure().all_diameters() {
            // Any number of waves counts modulo the sectors.
            let given = diameter + sector.sectors as i64 * (random.below(5) as i64 - 2);
            let modes = damped_modes(&model, given, LinearContacts::Stuck, sector.n, &mut Hooks::default()).unwrap();
            found.extend(modes.eigenvalue);
        }
        let gap = worst_match(found, &known);
        assert!(gap < 1e-9, "case {case}, {:?}: {gap:e}", sector.features);
        worst = worst.max(gap);
        all += known.len();
        // The diagram has the same, and the same says which sectors distinguish the senses.
        let diagram = interference(&model, LinearContacts::Stuck, sector.n, &mut Hooks::default()).unwrap();
        let of_diagram = (0..diagram.omega.len()).filter(|&at| diagram.omega[at].is_finite());
        let values = of_diagram.map(|at| {
            let (omega, ratio) = (diagram.omega[at], diagram.damping_ratio[at]);
            Complex64::new(-ratio * omega / (1.0 - ratio * ratio).sqrt(), omega)
        });
        let gap = worst_match(values.collect(), &known);
        assert!(gap < 1e-9, "case {case}, {:?}, diagram: {gap:e}", sector.features);
        // A wheel of two sectors has no wave with a sense.
        if sector.sectors > 2 {
            assert_eq!(
                diagram.has_equal_senses,
                !sector.distinguishes(),
                "{:?}",
                sector.features
            );
            distinguished += usize::from(!diagram.has_equal_senses);
        }
    }
    println!("{all} eigenvalues, {distinguished} sectors distinguish the senses: {worst:.1e}");
    assert!(distinguished > 100 && distinguished < 190);
}

#[test]
fn undamped_modes_of_both_senses_are_those_of_the_rotating_wheel() {
    let mut random = Random(5);
    let mut rotating = 0;
    for _ in 0..60 {
        let mut sector = Sector::new(&mut random);
        sector
            .rings
            .retain(|ring| !matches!(ring.kind, MatrixKind::Damping | MatrixKind::Structural));
        sector.aero = Default::default();
        sector.features.retain(|feature| *feature != Feature::Proportional);
        for ring in sector
            .rings
            .iter_mut()
            .filter(|ring| ring.kind == MatrixKind::Stiffness)
        {
            ring.own = 0.5 * (&ring.own + ring.own.transpose());
            ring.previous = ring.next.transpose();
        }
        let model = sector.model();
        let [m, c, k] = sector.wheel();
        let known = first_order(&m, &c, &k);
        let mut found = Vec::new();
        for diameter in model.structure().all_diameters() {
            let modes = model.linear_modes(diameter, ContactState::Stuck).unwrap();
            let lowest = model.lowest_modes(diameter, ContactState::Stuck, sector.n).unwrap();
            for (a, b) in modes.omega.iter().zip(&lowest.omega) {
                assert!((a - b).abs() < 1e-12 * a);
            }
            let opposite = model.linear_modes(-diameter, ContactState::Stuck).unwrap();
            if !sector.has(Feature::Gyroscopic) && !sector.has(Feature::PerDiameter) && diameter > 0 {
                // The other sense is the conjugate, to the last bit.
                assert_eq!(modes.omega, opposite.omega);
                if 2 * diameter != sector.sectors as i64 {
                    assert!(modes.shapes.iter().zip(&opposite.shapes).all(|(a, b)| *a == b.conj()));
                }
            }
            // Each shape satisfies the equations of its own wave.
            for (omega, shape) in modes.omega.iter().zip(modes.shapes.chunks_exact(sector.n)) {
                let whole: Vec<Complex64> = (0..sector.sectors)
                    .flat_map(|s| {
                        let lag = Complex64::cis(-TAU * (diameter * s as i64) as f64 / sector.sectors as f64);
                        shape.iter().map(move |x| x * lag)
                    })
                    .collect();
                let x = nalgebra::DVector::from_vec(whole);
                let lambda = Complex64::new(0.0, *omega);
                let residual = &m * &x * (lambda * lambda) + &c * &x * lambda + &k * &x;
                assert!(residual.norm() < 1e-9 * (&k * &x).norm(), "{:e}", residual.norm());
            }
            found.extend(modes.omega.iter().map(|omega| Complex64::new(0.0, *omega)));
        }
        rotating += usize::from(sector.has(Feature::Gyroscopic));
        let gap = worst_match(found, &known);
        assert!(gap < 1e-9, "{:?}: {gap:e}", sector.features);
    }
    assert!(rotating > 20);
}

/// The sector of the book whose flow drives the waves of one sense, with 24 sectors.
fn fluttering(after: f64, before: f64) -> Model {
    let mut model = Structure::cyclic(1, 24)
        .mass(&[1.0])
        .stiffness(&[1.0])
        .damping(&[0.005])
        .next(MatrixKind::Stiffness, &[-0.1])
        .build();
    let coefficients = [after.into(), before.into()];
    model
        .set_aero(&[0], &coefficients, &[1, -1], AeroForm::Displacement)
        .unwrap();
    model
}

fn growing(found: &Interference) -> Vec<i64> {
    let pairs = found.diameters.iter().zip(&found.damping_ratio);
    pairs.filter(|(_, ratio)| **ratio < 0.0).map(|(d, _)| *d).collect()
}

#[test]
fn flutter_of_24_sectors_is_found_in_the_sense_that_the_flow_drives() {
    // λ² + 0.005 λ + 1 − 0.2 cos φ − A = 0 with A(d) = c₁ e^{−iφ} + c₋₁ e^{iφ}, φ = 2πd/24, by complex numbers alone.
    let closed = |after: f64, before: f64, d: i64| {
        let phi = TAU * d as f64 / 24.0;
        let force = after * Complex64::cis(-phi) + before * Complex64::cis(phi);
        let root = (Complex64::from(0.0025 * 0.0025) - (1.0 - 0.2 * phi.cos() - force)).sqrt();
        let root = if root.im > 0.0 { root } else { -root };
        let lambda = root - 0.0025;
        -lambda.re / lambda.norm()
    };
    for (after, before, sign) in [(0.01, -0.01, -1), (-0.01, 0.01, 1)] {
        let model = fluttering(after, before);
        let mut lines = Vec::new();
        let mut log = |_: hbvib::LogLevel, line: &str| lines.push(line.to_owned());
        let mut hooks = Hooks {
            log: Some(&mut log),
            ..Hooks::default()
        };
        let found = interference(&model, LinearContacts::Free, 1, &mut hooks).unwrap();
        assert_eq!(found.diameters, (-11..=12).collect::<Vec<i64>>());
        for (d, ratio) in found.diameters.iter().zip(&found.damping_ratio) {
            assert!((ratio - closed(after, before, *d)).abs() < 1e-13, "{d}: {ratio}");
        }
        let least = found.damping_ratio.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((least + 0.007_618_136_725_428).abs() < 1e-12, "{least}");
        let unstable = growing(&found);
        assert!(
            unstable.len() == 10 && unstable.iter().all(|d| d * sign > 0),
            "{unstable:?}"
        );
        assert!(
            lines.iter().any(|line| line.contains("grow in 10 of 24 waves")),
            "{lines:?}"
        );
    }
}
