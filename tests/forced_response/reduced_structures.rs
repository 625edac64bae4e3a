//! A structure on a basis responds as by factors: random structures of every kind, and what forces other ways.

use crate::common::models::{self, unit_chain};
use crate::common::omega_range;
use hbvib::{
    Branch, Contact, Flexibility, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, Part, Phase, PhaseReport,
    SolverOptions, Speed, Spring, Status, forced_response,
};
use num_complex::Complex64;
use std::cell::Cell;

/// Degrees of freedom of the random structures.
const N: usize = 90;

/// Numbers without pattern in −1 .. 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Matrices of a lattice of masses with random springs, some of them between distant masses.
fn lattice(random: &mut Random, grounded: bool) -> (Vec<f64>, Vec<f64>) {
    let (mut k, mut m) = (vec![0.0; N * N], vec![0.0; N * N]);
    for i in 0..N {
        m[i * N + i] = 1.0 + 0.5 * random.next();
        if grounded && i % 15 == 0 {
            k[i * N + i] += 30.0;
        }
        for step in [1, 7] {
            if i >= step {
                spring(&mut k, i, i - step, 200.0 * (1.5 + random.next()));
                let shared = 0.1 * random.next();
                m[i * N + i - step] += shared;
                m[(i - step) * N + i] += shared;
            }
        }
    }
    (k, m)
}

fn spring(k: &mut [f64], i: usize, j: usize, stiffness: f64) {
    k[i * N + i] += stiffness;
    k[j * N + j] += stiffness;
    k[i * N + j] -= stiffness;
    k[j * N + i] -= stiffness;
}

fn set(model: &mut Model, kind: MatrixKind, values: &[f64]) {
    let view = MatrixView::dense(N, values);
    let view = if kind == MatrixKind::Mass {
        view
    } else {
        view.part(Part::General)
    };
    model.set_matrix(kind, &view).unwrap();
}

fn with_contacts(model: &mut Model, offset: i64) {
    for (i, (a, b, kt, limit)) in [
        (3, Some(40), 25.0, 0.02),
        (71, None, 60.0, 0.05),
        (20, Some(85), 9.0, 0.01),
    ]
    .into_iter()
    .enumerate()
    {
        let mut contact = Contact::jenkins(a, b, kt, limit, 1.0);
        contact.sector_offset = if i == 0 { offset } else { 0 };
        model.add_contact(&contact).unwrap();
    }
    let never = Contact::jenkins(11, Some(66), 12.0, 0.3, f64::INFINITY);
    model.add_contact(&never).unwrap();
    let spring = Spring {
        dof_a: Some(50),
        dof_b: Some(8),
        sector_offset: offset,
        stiffness: 15.0,
    };
    model.add_spring(&spring).unwrap();
    model.add_force(89, 1, Complex64::new(0.2, -0.1)).unwrap();
    model.add_force(30, 1, Complex64::new(0.05, 0.02)).unwrap();
}

/// The kinds of structure, with the name of each.
fn structures(seed: u64) -> Vec<(&'static str, Model)> {
    let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ seed);
    let mut found = Vec::new();
    let plain = |k: &[f64], m: &[f64]| {
        let mut model = Model::new(N).unwrap();
        set(&mut model, MatrixKind::Stiffness, k);
        set(&mut model, MatrixKind::Mass, m);
        model
    };
    let (k, m) = lattice(&mut random, true);
    let mut model = plain(&k, &m);
    model.set_rayleigh(0.01, 2e-4).unwrap();
    found.push(("proportional damping", model));
    let mut model = plain(&k, &m);
    let mut c = vec![0.0; N * N];
    for (i, j) in [(4, 33), (60, 12), (88, 2)] {
        spring(&mut c, i, j, 0.8 + 0.5 * random.next());
    }
    set(&mut model, MatrixKind::Damping, &c);
    found.push(("dashpots", model));
    for (name, damping) in [("loss factor", None), ("loss factor and dashpots", Some(&c))] {
        let mut model = plain(&k, &m);
        match damping {
            Some(c) => set(&mut model, MatrixKind::Damping, c),
            None => model.set_rayleigh(0.01, 2e-4).unwrap(),
        }
        model.set_loss_factor(0.03).unwrap();
        found.push((name, model));
    }
    let mut massless = m.clone();
    for p in [5, 6, 44, 70] {
        for q in 0..N {
            massless[p * N + q] = 0.0;
            massless[q * N + p] = 0.0;
        }
    }
    let mut model = plain(&k, &massless);
    model.set_rayleigh(0.0, 2e-4).unwrap();
    found.push(("massless degrees of freedom", model));
    let (free, heavy) = lattice(&mut random, false);
    let mut model = plain(&free, &heavy);
    model.set_rayleigh(0.05, 1e-4).unwrap();
    found.push(("free body", model));
    let mut indefinite = k.clone();
    for p in [17, 52] {
        indefinite[p * N + p] -= 1400.0;
    }
    let mut model = plain(&indefinite, &m);
    model.set_rayleigh(0.01, 1e-5).unwrap();
    found.push(("indefinite stiffness", model));
    for (wave, loss_factor) in [(2, 0.0), (22, 0.0), (12, 0.0), (2, 0.02), (22, 0.02)] {
        let mut model = Model::cyclic(N, 24).unwrap();
        model.set_wave(wave);
        set(&mut model, MatrixKind::Stiffness, &k);
        set(&mut model, MatrixKind::Mass, &m);
        let mut to_next = vec![0.0; N * N];
        (to_next[3], to_next[55 * N + 4], to_next[88 * N + 89]) = (-11.0, -7.0, 5.0);
        model
            .set_coupling(
                MatrixKind::Stiffness,
                &MatrixView::dense(N, &to_next).part(Part::General),
            )
            .unwrap();
        model.set_rayleigh(0.01, 2e-4).unwrap();
        model.set_loss_factor(loss_factor).unwrap();
        found.push(("sector", model));
    }
    for sectors in [1, 24] {
        let mut model = if sectors == 1 {
            Model::new(N).unwrap()
        } else {
            Model::cyclic(N, sectors).unwrap()
        };
        model.set_wave(2);
        let lossy: Vec<Complex64> = k.iter().map(|k| k * Complex64::new(1.0, 0.03)).collect();
        let view = MatrixView::dense_complex(N, &lossy).part(Part::Symmetric);
        model.set_matrix(MatrixKind::Stiffness, &view).unwrap();
        set(&mut model, MatrixKind::Mass, &m);
        if sectors > 1 {
            let mut to_next = vec![Complex64::ZERO; N * N];
            to_next[3] = -11.0 * Complex64::new(1.0, 0.03);
            to_next[55 * N + 4] = -7.0 * Complex64::new(1.0, 0.03);
            let view = MatrixView::dense_complex(N, &to_next).part(Part::General);
            model.set_coupling(MatrixKind::Stiffness, &view).unwrap();
        }
        model.set_rayleigh(0.01, 2e-4).unwrap();
        found.push(("complex stiffness", model));
    }
    for sectors in [1, 24] {
        let mut model = if sectors == 1 {
            plain(&k, &m)
        } else {
            let mut model = Model::cyclic(N, sectors).unwrap();
            model.set_wave(2);
            set(&mut model, MatrixKind::Stiffness, &k);
            set(&mut model, MatrixKind::Mass, &m);
            let mut to_next = vec![0.0; N * N];
            (to_next[3], to_next[55 * N + 4]) = (-11.0, -7.0);
            let view = MatrixView::dense(N, &to_next).part(Part::General);
            model.set_coupling(MatrixKind::Stiffness, &view).unwrap();
            model
        };
        let mut gyroscopic = vec![0.0; N * N];
        for i in 1..N {
            let g = 0.05 * (1 + i % 4) as f64;
            (gyroscopic[i * N + i - 1], gyroscopic[(i - 1) * N + i]) = (g, -g);
        }
        let view = MatrixView::dense(N, &gyroscopic).part(Part::General);
        model.set_matrix(MatrixKind::Gyroscopic, &view).unwrap();
        model.set_speed(Speed::Fixed(1.0)).unwrap();
        model.set_rayleigh(0.05, 1e-4).unwrap();
        found.push(("gyroscopic forces", model));
    }
    for (_, model) in &mut found {
        let offset = i64::from(model.structure().sectors() > 1);
        with_contacts(model, offset);
    }
    let mut model = plain(&k, &m);
    with_contacts(&mut model, 0);
    let ratios: Vec<f64> = (0..N).map(|r| 0.01 + 1e-4 * r as f64).collect();
    model.set_modal_damping(&ratios).unwrap();
    found.push(("modal damping", model));
    found
}

fn options(flexibility: Flexibility, harmonics: usize) -> SolverOptions {
    SolverOptions {
        flexibility,
        response_dof: Some(89),
        ..crate::common::harmonics(harmonics)
    }
}

pub fn point(model: &Model, solver: &SolverOptions, omega: f64) -> Branch {
    let range = omega_range(omega, omega);
    forced_response(model, solver, &range, &mut Hooks::default()).unwrap()
}

/// Harmonics of all degrees of freedom at the first point.
fn motion(branch: &Branch) -> Vec<Complex64> {
    let mut x = vec![Complex64::ZERO; (branch.harmonics() + 1) * branch.ndof()];
    branch.harmonics_at(0, &mut x).unwrap();
    x
}

fn size(x: &[Complex64]) -> f64 {
    x.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt()
}

#[test]
fn every_kind_of_structure_responds_as_by_factors() {
    for seed in 1..4 {
        for (name, model) in structures(seed) {
            for (omega, harmonics) in [(0.9, 3), (2.3, 5), (5.1, 1)] {
                let direct = point(&model, &options(Flexibility::Direct, harmonics), omega);
                let reduced = point(&model, &options(Flexibility::Krylov, harmonics), omega);
                let reduction = reduced.reduction();
                assert!(direct.reduction().basis == 0 && reduction.basis > 0 && reduction.basis <= N);
                // The residual at a sample is a sum of squares that cancel, of which rounding leaves the root.
                let told = if name == "gyroscopic forces" { 1e-7 } else { 1e-8 };
                assert!(reduction.certificate <= told, "{name}: {:e}", reduction.certificate);
                let (x, exact) = (motion(&reduced), motion(&direct));
                let off: Vec<Complex64> = x.iter().zip(&exact).map(|(a, b)| a - b).collect();
                let error = size(&off) / size(&exact);
                assert!(
                    error < 1e-7,
                    "{name} at {omega}: {error:e}, {:e}",
                    reduction.certificate
                );
                let (e, exact) = (reduced.energy_at(0).unwrap(), direct.energy_at(0).unwrap());
                for (a, b) in [
                    (e.kinetic_peak, exact.kinetic_peak),
                    (e.potential_peak, exact.potential_peak),
                    (e.kinetic_mean, exact.kinetic_mean),
                    (e.potential_mean, exact.potential_mean),
                    (e.friction_loss, exact.friction_loss),
                    (e.structural_loss, exact.structural_loss),
                ] {
                    let scale = exact.kinetic_peak.abs().max(exact.potential_peak.abs());
                    assert!((a - b).abs() <= 1e-6 * scale, "{name} at {omega}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn a_static_load_on_a_free_body_is_held_by_its_contacts() {
    let mut random = Random(77);
    let (k, m) = lattice(&mut random, false);
    let mut model = Model::new(N).unwrap();
    set(&mut model, MatrixKind::Stiffness, &k);
    set(&mut model, MatrixKind::Mass, &m);
    model.set_rayleigh(0.05, 1e-4).unwrap();
    with_contacts(&mut model, 0);
    // One that can take the load, and sticks.
    model.add_contact(&Contact::jenkins(60, None, 40.0, 5.0, 1.0)).unwrap();
    model.add_force(40, 0, Complex64::new(0.01, 0.0)).unwrap();
    let direct = point(&model, &options(Flexibility::Direct, 3), 1.4);
    let reduced = point(&model, &options(Flexibility::Krylov, 3), 1.4);
    assert!(reduced.reduction().mean_carried && reduced.reduction().held_by_contacts == 1);
    let (x, exact) = (motion(&reduced), motion(&direct));
    let off: Vec<Complex64> = x.iter().zip(&exact).map(|(a, b)| a - b).collect();
    assert!(size(&off) < 1e-7 * size(&exact), "{:e}", size(&off) / size(&exact));
}

#[test]
fn stiffness_without_symmetry_has_no_basis() {
    let mut random = Random(5);
    let (mut k, m) = lattice(&mut random, true);
    k[7 * N + 30] += 20.0;
    let mut model = Model::new(N).unwrap();
    set(&mut model, MatrixKind::Stiffness, &k);
    set(&mut model, MatrixKind::Mass, &m);
    model.set_rayleigh(0.05, 1e-4).unwrap();
    with_contacts(&mut model, 0);
    assert_eq!(
        point(&model, &options(Flexibility::Automatic, 3), 1.4)
            .reduction()
            .basis,
        0
    );
    let range = omega_range(1.4, 1.4);
    let solver = options(Flexibility::Krylov, 3);
    let refused = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap_err();
    assert_eq!(refused.status, Status::Unsupported);
    assert!(refused.message().contains("Hermitian"), "{}", refused.message());
}

/// Number of factorisations of a sparse matrix in a solution.
fn factorisations(model: &Model, solver: &SolverOptions, range: (f64, f64)) -> usize {
    let count = Cell::new(0);
    let sink = |report: &PhaseReport| {
        count.set(count.get() + usize::from(report.phase == Phase::Factorisation));
        false
    };
    let range = omega_range(range.0, range.1);
    let mut hooks = Hooks {
        phase: Some(&sink),
        ..Hooks::default()
    };
    forced_response(model, solver, &range, &mut hooks).unwrap();
    count.get()
}

#[test]
fn what_was_prepared_is_kept_until_a_matrix_changes() {
    let (_, mut model) = structures(9).swap_remove(0);
    let solver = options(Flexibility::Krylov, 3);
    assert_eq!(factorisations(&model, &solver, (1.0, 1.2)), 1);
    assert_eq!(factorisations(&model, &solver, (1.0, 1.2)), 0);
    assert_eq!(factorisations(&model, &solver, (0.8, 1.1)), 0);
    model.clear_forces();
    model.add_force(89, 1, Complex64::new(-0.3, 0.7)).unwrap();
    let copy = model.try_clone().unwrap();
    assert_eq!(factorisations(&copy, &solver, (1.0, 1.2)), 0);
    model.set_preload(1, 3.0).unwrap();
    assert_eq!(factorisations(&model, &solver, (1.0, 1.2)), 0);
    // A contact elsewhere needs its own flexibility.
    model.add_contact(&Contact::jenkins(61, None, 5.0, 0.1, 1.0)).unwrap();
    assert_eq!(factorisations(&model, &solver, (1.0, 1.2)), 1);
    model.set_rayleigh(0.01, 3e-4).unwrap();
    assert_eq!(factorisations(&model, &solver, (1.0, 1.2)), 1);
    // A wheel: harmonics 1, 3, 5, 7 of engine order 3 have three diameters, one of them twice.
    let mut wheel = structures(9).swap_remove(7).1;
    wheel.set_wave(3);
    assert_eq!(factorisations(&wheel, &options(Flexibility::Krylov, 7), (1.0, 1.2)), 2);
}

#[test]
fn threads_that_solve_one_model_find_the_same() {
    let (_, model) = structures(4).swap_remove(7);
    let solver = options(Flexibility::Krylov, 5);
    let alone = motion(&point(&model, &solver, 1.3));
    let (_, fresh) = structures(4).swap_remove(7);
    std::thread::scope(|scope| {
        let all: Vec<_> = (0..4)
            .map(|_| scope.spawn(|| motion(&point(&fresh, &solver, 1.3))))
            .collect();
        for found in all {
            let off: Vec<Complex64> = found.join().unwrap().iter().zip(&alone).map(|(a, b)| a - b).collect();
            assert!(size(&off) <= 1e-10 * size(&alone));
        }
    });
}

#[test]
fn a_memory_limit_is_told_with_the_need_before_memory_is_asked_for() {
    let (_, model) = structures(2).swap_remove(0);
    let range = omega_range(1.0, 1.1);
    for flexibility in [Flexibility::Krylov, Flexibility::Direct] {
        let solver = SolverOptions {
            memory_limit: 1000,
            ..options(flexibility, 3)
        };
        let refused = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap_err();
        assert_eq!(refused.status, Status::OutOfMemory);
        let sentence = refused.message();
        assert!(
            sentence.contains("memory_limit = 1000") && sentence.contains("need"),
            "{sentence}"
        );
        let enough = SolverOptions {
            memory_limit: 1 << 30,
            ..solver
        };
        forced_response(&model, &enough, &range, &mut Hooks::default()).unwrap();
    }
}

/// A plate of masses between springs, clamped at its edges, with sliders against the ground.
pub fn plate(side: usize, sliders: usize) -> Model {
    let n = side * side;
    let slider = |c: usize| Contact::jenkins(c * (n - 1) / (sliders - 1), None, 0.2, 0.004, 1.0);
    models::plate(side)
        .rayleigh(0.0, 0.02)
        .contacts((0..sliders).map(slider))
        .force(n / 3, 1, Complex64::ONE)
        .build()
}

/// On both sides of the number of contacts up to which a basis is taken, 676/15, all points are those of factors.
#[test]
fn plates_with_few_and_many_sliders_respond_as_by_factors() {
    for sliders in [20, 42, 48] {
        let model = plate(26, sliders);
        let solve = |flexibility| {
            let range = ForcedOptions {
                at: &[0.163, 0.19],
                ..omega_range(0.15, 0.2)
            };
            let solver = options(flexibility, 1);
            forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap()
        };
        let (own, factors) = (solve(Flexibility::Automatic), solve(Flexibility::Direct));
        assert_eq!((own.status(), factors.status()), (Status::Ok, Status::Ok));
        let reaches = |branch: &Branch| {
            let mut all = vec![branch.amplitude()[0], branch.amplitude()[branch.points() - 1]];
            all.extend((0..2).map(|i| branch.response_at(branch.at(i)[0].point).unwrap()[0].norm()));
            all.extend(branch.peaks().iter().map(|peak| peak.amplitude));
            all
        };
        let (own, factors) = (reaches(&own), reaches(&factors));
        assert_eq!(own.len(), factors.len(), "{sliders} sliders");
        for (own, factors) in own.iter().zip(&factors) {
            assert!(
                (own / factors - 1.0).abs() < 1e-7,
                "{sliders} sliders: {own} for {factors}"
            );
        }
    }
}

/// A chain of 1,200 masses: few of its resonances are held by a basis, two thirds of them are left to factors, and so is a basis that
/// takes longer than these.
#[test]
fn a_chain_with_many_resonances_is_left_to_factors() {
    let n = 1200;
    let model = unit_chain(n)
        .rayleigh(0.0, 0.02)
        .slider(n / 2, 0.2, 0.004, 1.0)
        .force(n / 3, 1, Complex64::ONE)
        .build();
    for (from, on_basis) in [(0.004, true), (0.1, false), (0.5, false)] {
        let solve = |flexibility| {
            let range = ForcedOptions {
                at: &[1.004 * from],
                ..omega_range(from, 1.01 * from)
            };
            forced_response(&model, &options(flexibility, 3), &range, &mut Hooks::default()).unwrap()
        };
        let (own, factors) = (solve(Flexibility::Automatic), solve(Flexibility::Direct));
        assert_eq!((own.status(), factors.status()), (Status::Ok, Status::Ok), "{from}");
        assert_eq!(own.reduction().basis > 0, on_basis, "{from}");
        let reaches = |branch: &Branch| {
            let point = branch.at(0)[0].point;
            let last = branch.points() - 1;
            [0, point, last].map(|point| branch.response_at(point).unwrap()[0].norm())
        };
        for (own, factors) in reaches(&own).iter().zip(&reaches(&factors)) {
            assert!((own / factors - 1.0).abs() < 1e-7, "{from}: {own} for {factors}");
        }
    }
}

/// Beyond 600 degrees of freedom a plate whose range, with nine harmonics, holds too many resonances for a basis is a sum over all modes
/// along a sweep: at its points it responds as by the factors of single frequencies.
#[test]
fn a_plate_with_many_resonances_responds_as_by_factors() {
    let (model, solver) = (plate(25, 3), options(Flexibility::Automatic, 9));
    let at = [0.163, 0.19];
    let range = ForcedOptions {
        at: &at,
        ..omega_range(0.15, 0.2)
    };
    let branch = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::Ok);
    let reduction = branch.reduction();
    assert!(
        reduction.basis == 0 && reduction.flexibility_way == hbvib::internals::FlexibilityWay::Modes,
        "{:?}",
        reduction.flexibility_way
    );
    let mut points = vec![0, branch.points() - 1];
    points.extend((0..at.len()).map(|i| branch.at(i)[0].point));
    for at in points {
        let omega = branch.omega_at(at).unwrap();
        let (found, alone) = (branch.response_at(at).unwrap()[0], point(&model, &solver, omega));
        let alone = alone.response_at(0).unwrap()[0];
        assert!(
            (found - alone).norm() < 1e-9 * alone.norm(),
            "{omega}: {found} for {alone}"
        );
    }
}
