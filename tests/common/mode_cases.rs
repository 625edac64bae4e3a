//! Shared code of the tests of nonlinear modes: models without structural damping, sectors without mirror symmetry,
//! and a separate solver for the linear problems with two real unknowns.

use crate::common::models::Structure;
use crate::common::{Blisk, SECTORS, Wheel, all_harmonics, phase};
use hbvib::{
    Branch, Constant, Contact, Hooks, MatrixKind, ModeField, ModeOptions, Model, SolverOptions, Status, nonlinear_mode,
};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

/// The sector of a case with Rayleigh damping βK.
pub fn damped(case: &Blisk, beta: f64) -> Model {
    let mut model = case.sector();
    model.set_rayleigh(0.0, beta).unwrap();
    model
}

/// Slip limit over contact stiffness, the length at which the contact's law changes.
pub fn delta(case: &Blisk) -> f64 {
    Blisk::mu() * case.preload() / case.kt()
}

/// Follows a mode, which must cover its range.
pub fn follow(model: &Model, solver: &SolverOptions, range: &ModeOptions) -> Branch {
    let branch = nonlinear_mode(model, solver, range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::Ok);
    branch
}

/// Damping ratio along the curve.
pub fn damping(branch: &Branch) -> &[f64] {
    branch.mode_field(ModeField::DampingRatio).unwrap()
}

/// Frequency and damping ratio of the only solution at the i-th requested amplitude.
pub fn only(branch: &Branch, i: usize) -> (f64, f64, usize) {
    let [special] = branch.at(i) else {
        panic!("{} solutions at amplitude {i}", branch.at(i).len());
    };
    let point = branch.mode_at(special.point).unwrap();
    (special.omega, point.damping_ratio, special.point)
}

/// Harmonic h of a stored point.
pub fn harmonic(branch: &Branch, point: usize, h: usize) -> DVector<Complex64> {
    let n = branch.ndof();
    DVector::from_column_slice(&all_harmonics(branch, point)[h * n..(h + 1) * n])
}

/// Matrices of one wave: M, C, K of the structure without its contacts.
pub struct WaveMatrices {
    pub mass: DMatrix<Complex64>,
    pub damping: DMatrix<Complex64>,
    pub stiffness: DMatrix<Complex64>,
}

/// A₀ + A₁ e^{−iφ} + A₁ᵀ e^{iφ} of column-major blocks.
pub fn wave(n: usize, own: &[f64], next: &[f64], lag: Complex64) -> DMatrix<Complex64> {
    DMatrix::from_fn(n, n, |i, j| {
        own[j * n + i] + lag * next[j * n + i] + lag.conj() * next[i * n + j]
    })
}

/// Matrices of harmonic h of the blisk with C = βK.
pub fn blisk_matrices(case: &Blisk, beta: f64, h: usize) -> WaveMatrices {
    let a = case.matrices();
    let lag = phase(h, case.engine_order, 1, SECTORS);
    let stiffness = wave(a.n, &a.own, &a.next, lag);
    WaveMatrices {
        mass: wave(a.n, &a.mass, &vec![0.0; a.n * a.n], lag),
        damping: &stiffness * Complex64::from(beta),
        stiffness,
    }
}

/// k wwᴴ for a contact row w with y = wᴴx.
pub fn spring(row: &DVector<Complex64>, k: Complex64) -> DMatrix<Complex64> {
    row * row.adjoint() * k
}

/// Row of the blisk's contact as a column, y = wᴴx.
pub fn disk_minus_ring() -> DVector<Complex64> {
    DVector::from_fn(4, |i, _| [0.0, 0.0, 1.0, -1.0][i].into())
}

/// Real ω and D, and x, at which A(ω, D) x = 0, from a start nearby.
///
/// A bordered system [A b; bᴴ 0] [x; μ] = [0; 1] has μ = 0 where A is singular; Newton's method solves for the two
/// parts of μ with difference quotients for its slopes.
pub fn singular_at(
    a: impl Fn(f64, f64) -> DMatrix<Complex64>,
    start: (f64, f64),
    shape: &DVector<Complex64>,
) -> (f64, f64, DVector<Complex64>) {
    let n = shape.len();
    let b = shape.unscale(shape.norm());
    let solve = |omega: f64, d: f64| {
        let inner = a(omega, d);
        let size = inner.camax();
        let bordered = DMatrix::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
            (true, true) => inner[(i, j)] / size,
            (true, false) => b[i],
            (false, true) => b[j].conj(),
            (false, false) => Complex64::ZERO,
        });
        let mut right = DVector::zeros(n + 1);
        right[n] = Complex64::ONE;
        bordered.lu().solve(&right).unwrap()
    };
    let (mut omega, mut d) = start;
    for _ in 0..60 {
        let mu = solve(omega, d)[n];
        let (dw, dd) = (1e-6 * omega, 1e-6);
        let by_omega = (solve(omega + dw, d)[n] - solve(omega - dw, d)[n]) / (2.0 * dw);
        let by_d = (solve(omega, d + dd)[n] - solve(omega, d - dd)[n]) / (2.0 * dd);
        let determinant = by_omega.re * by_d.im - by_omega.im * by_d.re;
        let step = (
            (mu.re * by_d.im - mu.im * by_d.re) / determinant,
            (by_omega.re * mu.im - by_omega.im * mu.re) / determinant,
        );
        omega -= step.0;
        d -= step.1;
        if step.0.abs() < 1e-14 * omega && step.1.abs() < 1e-15 {
            break;
        }
    }
    let x = solve(omega, d).rows(0, n).into_owned();
    (omega, d, x)
}

/// A sector of three degrees of freedom without mirror symmetry, its damping not proportional to mass and stiffness,
/// a contact to the ground or across to the next sector.
pub struct Skewed {
    pub engine_order: i64,
    pub sectors: usize,
    pub contacts: Vec<Contact>,
}

/// Order of the skewed sector.
pub const N: usize = 3;
const MASS: [f64; 9] = [1.0, 0.1, 0.0, 0.1, 1.5, 0.0, 0.0, 0.0, 0.7];
const MASS_NEXT: [f64; 9] = [0.02, 0.0, 0.05, 0.0, 0.01, 0.0, -0.03, 0.0, 0.0];
const STIFFNESS: [f64; 9] = [9.0, -2.0, -1.0, -2.0, 8.0, -1.5, -1.0, -1.5, 7.0];
/// Column-major: [i + 3 j] couples i of a sector to j of the next.
const STIFFNESS_NEXT: [f64; 9] = [-0.8, 0.1, -0.9, 0.4, -0.5, 0.0, -0.2, 0.7, -0.6];
const DAMPING: [f64; 9] = [0.05, 0.0, 0.01, 0.0, 0.06, 0.0, 0.01, 0.0, 0.04];
const DAMPING_NEXT: [f64; 9] = [0.004, 0.01, 0.0, -0.003, 0.0, 0.006, 0.0, 0.002, 0.001];

impl Skewed {
    /// One contact within the sector and one across.
    pub fn new(engine_order: i64) -> Self {
        let mut across = Contact::jenkins(2, Some(0), 3.0, 0.4, 0.5);
        across.sector_offset = 1;
        Self {
            engine_order,
            sectors: SECTORS,
            contacts: vec![Contact::jenkins(0, Some(1), 2.0, 0.3, 0.4), across],
        }
    }

    pub fn model(&self, with_damping: bool) -> Model {
        let mut sector = Structure::cyclic(N, self.sectors)
            .mass(&MASS)
            .next(MatrixKind::Mass, &MASS_NEXT)
            .stiffness(&STIFFNESS)
            .next(MatrixKind::Stiffness, &STIFFNESS_NEXT);
        if with_damping {
            sector = sector.damping(&DAMPING).next(MatrixKind::Damping, &DAMPING_NEXT);
        }
        sector.wave(self.engine_order).contacts(&self.contacts).build()
    }

    /// Places mass and stiffness all around a wheel.
    pub fn place_in(wheel: &mut Wheel) {
        wheel.set(MatrixKind::Mass, &MASS, Some(&MASS_NEXT), None);
        wheel.set(MatrixKind::Stiffness, &STIFFNESS, Some(&STIFFNESS_NEXT), None);
    }

    /// Matrices of harmonic h.
    pub fn matrices(&self, h: usize) -> WaveMatrices {
        let lag = phase(h, self.engine_order, 1, self.sectors);
        WaveMatrices {
            mass: wave(N, &MASS, &MASS_NEXT, lag),
            damping: wave(N, &DAMPING, &DAMPING_NEXT, lag),
            stiffness: wave(N, &STIFFNESS, &STIFFNESS_NEXT, lag),
        }
    }

    /// Row of a contact at the fundamental as a column, y = wᴴx.
    pub fn row(&self, contact: usize) -> DVector<Complex64> {
        let contact = &self.contacts[contact];
        let mut w = DVector::zeros(N);
        if let Some(a) = contact.dof_a[0] {
            w[a] += Complex64::ONE;
        }
        if let Some(b) = contact.dof_b[0] {
            let lag = phase(1, self.engine_order * contact.sector_offset, 1, self.sectors);
            w[b] -= lag.conj();
        }
        w
    }

    /// Stiffness with every contact stuck.
    pub fn stuck_stiffness(&self) -> DMatrix<Complex64> {
        let mut k = self.matrices(1).stiffness;
        for (i, contact) in self.contacts.iter().enumerate() {
            k += spring(&self.row(i), contact.constant(Constant::Kt).into());
        }
        k
    }
}
