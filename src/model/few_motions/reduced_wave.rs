//! The structure of one wave on a basis of few motions, and those that a model has kept.
//!
//! The basis V is orthonormal in the inner product of A = K + σM, and rotated so that VᴴMV = diag(μ); then
//! VᴴKV = 1 − σμ, and C = αM + βK is diagonal too. Springs and contacts are added through their rows, so that what is kept
//! holds whatever their constants are.

use crate::error::{Error, Result, try_push, try_vec};
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::model::matrices::spring::Row;
use num_complex::Complex64;
use std::sync::{Arc, Mutex, PoisonError};

const CONTEXT: &str = "the reduced structure";

/// Row that reads a motion from the coordinates of a harmonic.
#[derive(Clone, Debug, Default)]
pub struct MotionRow(Vec<(usize, Complex64)>);

impl MotionRow {
    /// The row itself, over the degrees of freedom as coordinates.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(row: &Row) -> Result<Self> {
        let mut terms = Vec::new();
        for &term in row.iter().flatten() {
            try_push(&mut terms, term, CONTEXT)?;
        }
        Ok(Self(terms))
    }

    /// The row that reads the motion conjugate to a force: xᴴ for a column x.
    pub fn adjoint(column: &SparseVector) -> Result<Self> {
        let mut terms = Vec::new();
        for (p, z) in column {
            try_push(&mut terms, (*p, z.conj()), CONTEXT)?;
        }
        Ok(Self(terms))
    }

    /// Entries of the row: coordinate and coefficient.
    pub fn terms(&self) -> core::slice::Iter<'_, (usize, Complex64)> {
        self.0.iter()
    }

    /// Motion r·x that the row reads from x.
    pub fn along(&self, x: &[Complex64]) -> Complex64 {
        self.0.iter().map(|&(p, a)| a * x[p]).sum()
    }
}

/// Columns of a basis, one after the other, before the rotation.
#[derive(Debug)]
pub enum Basis {
    /// Columns for a real structure.
    Real(Vec<f64>),
    /// Columns for a complex Hermitian structure.
    Complex(Vec<Complex64>),
}

impl Basis {
    /// The columns of a real basis; empty for a complex one.
    pub fn into_real(self) -> Vec<f64> {
        match self {
            Self::Real(v) => v,
            Self::Complex(_) => Vec::new(),
        }
    }

    /// The columns of a complex basis; empty for a real one.
    pub fn into_complex(self) -> Vec<Complex64> {
        match self {
            Self::Complex(v) => v,
            Self::Real(_) => Vec::new(),
        }
    }

    fn entry(&self, at: usize) -> Complex64 {
        match self {
            Self::Real(v) => v[at].into(),
            Self::Complex(v) => v[at],
        }
    }

    /// Number of bytes of the columns.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Real(v) => size_of_val(&v[..]),
            Self::Complex(v) => size_of_val(&v[..]),
        }
    }
}

/// Damping of a wave on its basis.
#[derive(Debug)]
pub enum WaveDamping {
    /// Factors α and β of C = αM + βK.
    Proportional(f64, f64),
    /// Matrix Vᴴ C V on the rotated basis, column after column; with α and β where the basis holds the images of C −
    /// αM − βK.
    General(Vec<Complex64>, Option<(f64, f64)>),
}

/// Part of the images of the last block that the basis cannot represent; see
/// [`crate::linalg::iterative::block_krylov`].
#[derive(Debug, Default)]
pub struct Remainder {
    /// Index of the first column of the last block.
    pub last: usize,
    /// Gram matrix of the parts that the basis cannot represent: first of images by the mass, then by the damping.
    pub gram: Vec<Complex64>,
    /// Relative error of solutions in the norm of A by rounding, which acts like a part that the basis leaves out.
    pub solutions: f64,
    /// Relative error of the stiffness on the basis by rounding.
    pub products: f64,
}

/// Matrices of a wave on its basis.
#[derive(Debug)]
pub struct ReducedPencil {
    /// Shift σ of A = K + σM.
    pub shift: f64,
    /// Values μ of the mass on the basis, falling: the highest frequency is the last.
    pub values: Vec<f64>,
    /// Rotation of the basis, column after column.
    pub rotation: Vec<Complex64>,
    /// Damping on the rotated basis.
    pub damping: WaveDamping,
    /// Part of the images that the basis cannot represent.
    pub remainder: Remainder,
}

impl ReducedPencil {
    /// Number of coordinates, the columns of the basis.
    #[must_use]
    pub fn order(&self) -> usize {
        self.values.len()
    }

    /// Stiffness of a coordinate, without springs. A coordinate beyond the basis has stiffness 1 and no mass.
    #[must_use]
    pub fn stiffness(&self, k: usize) -> f64 {
        self.values.get(k).map_or(1.0, |value| 1.0 - self.shift * value)
    }
}

/// A wave of the structure reduced to a basis, with the basis.
#[derive(Debug)]
pub struct ReducedWave {
    /// Key by which the wave is recognised, see [`WaveKey`].
    pub key: WaveKey,
    /// Vectors whose flexibility the basis holds.
    pub inputs: Vec<SparseVector>,
    /// Matrices on the basis.
    pub pencil: ReducedPencil,
    /// The basis before its rotation.
    pub basis: Basis,
    /// Independent degrees of freedom of the structure.
    pub n: usize,
    /// Number of columns up to which the basis was allowed to grow, where it still did not meet its certificate; else
    /// 0.
    pub refused_up_to: usize,
}

/// Key of a wave: waves with equal matrices have equal keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WaveKey {
    /// Number of waves per turn (nodal diameter).
    pub diameter: usize,
    /// Whether the wave is a mean motion, whose matrices are different.
    pub mean: bool,
}

/// A reduced wave as a harmonic uses it, or the wave that travels the other way.
#[derive(Clone, Debug)]
pub struct ReducedView {
    /// The reduced wave that is used.
    pub wave: Arc<ReducedWave>,
    /// Whether all its matrices and motions are conjugated.
    pub conjugated: bool,
}

impl ReducedView {
    fn turned(&self, z: Complex64) -> Complex64 {
        if self.conjugated { z.conj() } else { z }
    }

    /// Matrices of the wave on its basis.
    pub fn pencil(&self) -> &ReducedPencil {
        &self.wave.pencil
    }

    /// Entry of the damping between two coordinates.
    pub fn damping(&self, i: usize, j: usize) -> Complex64 {
        let pencil = self.pencil();
        match &pencil.damping {
            WaveDamping::Proportional(..) if i != j => Complex64::ZERO,
            WaveDamping::Proportional(alpha, beta) => (alpha * pencil.values[i] + beta * pencil.stiffness(i)).into(),
            WaveDamping::General(c, _) => self.turned(c[j * pencil.order() + i]),
        }
    }

    /// Row over the coordinates that reads the motion of a given row over the degrees of freedom.
    pub fn row(&self, row: &Row) -> Result<MotionRow> {
        let mut terms = Vec::new();
        for (k, z) in self.product(&row.iter().flatten().copied())?.into_iter().enumerate() {
            try_push(&mut terms, (k, z), CONTEXT)?;
        }
        Ok(MotionRow(terms))
    }

    /// Coordinates Vᴴ f of a force.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn force(&self, f: &[Complex64]) -> Result<Vec<Complex64>> {
        let entries = f.iter().enumerate().filter(|(_, z)| **z != Complex64::ZERO);
        let mut found = self.product(&entries.map(|(p, z)| (p, z.conj())))?;
        for z in &mut found {
            *z = z.conj();
        }
        Ok(found)
    }

    /// Coordinates of an input vector. For a conjugated wave they are computed from the wave itself.
    pub fn coordinates(&self, input: &SparseVector) -> Result<Vec<Complex64>> {
        let mut found = self.product(&input.iter().map(|&(p, z)| (p, self.turned(z).conj())))?;
        for z in &mut found {
            *z = z.conj();
        }
        Ok(found)
    }

    /// Sum Σ aₚ (V Q)ₚ of rows of the rotated basis.
    fn product(&self, entries: &(impl Iterator<Item = (usize, Complex64)> + Clone)) -> Result<Vec<Complex64>> {
        let (order, n) = (self.pencil().order(), self.wave.n);
        let mut plain = try_vec(order, Complex64::ZERO, CONTEXT)?;
        for (k, z) in plain.iter_mut().enumerate() {
            *z = entries
                .clone()
                .map(|(p, a)| self.turned(a) * self.wave.basis.entry(k * n + p))
                .sum();
        }
        let mut rotated = try_vec(order, Complex64::ZERO, CONTEXT)?;
        for (z, q) in rotated
            .iter_mut()
            .zip(self.pencil().rotation.chunks_exact(order.max(1)))
        {
            *z = self.turned(plain.iter().zip(q).map(|(a, q)| a * q).sum());
        }
        Ok(rotated)
    }

    /// Motion of all independent degrees of freedom, x = V q.
    pub fn expand(&self, q: &[Complex64], x: &mut [Complex64]) -> Result<()> {
        let order = self.pencil().order();
        let mut turned = try_vec(order, Complex64::ZERO, CONTEXT)?;
        for (column, &z) in self.pencil().rotation.chunks_exact(order.max(1)).zip(q) {
            let z = self.turned(z);
            for (to, r) in turned.iter_mut().zip(column) {
                *to += r * z;
            }
        }
        x.fill(Complex64::ZERO);
        let n = x.len().max(1);
        match &self.wave.basis {
            Basis::Real(v) => {
                for (column, z) in v.chunks_exact(n).zip(&turned) {
                    for (x, v) in x.iter_mut().zip(column) {
                        *x += z * v;
                    }
                }
            }
            Basis::Complex(v) => {
                for (column, z) in v.chunks_exact(n).zip(&turned) {
                    for (x, v) in x.iter_mut().zip(column) {
                        *x += z * v;
                    }
                }
            }
        }
        if self.conjugated {
            for z in x {
                *z = z.conj();
            }
        }
        Ok(())
    }
}

/// The reduced waves that a model keeps until its matrices change. Any number of threads may use them.
#[derive(Clone, Debug, Default)]
pub struct KeptWaves(Arc<Mutex<Vec<Arc<ReducedWave>>>>);

impl KeptWaves {
    /// The kept wave with a key; `None` if there is none.
    pub fn find(&self, key: WaveKey) -> Option<Arc<ReducedWave>> {
        let waves = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        waves.iter().find(|wave| wave.key == key).map(Arc::clone)
    }

    /// Keeps a wave instead of the one with its key.
    pub fn keep(&self, wave: &Arc<ReducedWave>) -> Result<()> {
        let mut waves = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        waves.retain(|kept| kept.key != wave.key);
        waves.try_reserve(1).map_err(|_| Error::out_of_memory(CONTEXT))?;
        waves.push(Arc::clone(wave));
        Ok(())
    }

    /// A separate list of the same waves.
    pub fn separate(&self) -> Result<Self> {
        let waves = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut own = Vec::new();
        for wave in waves.iter() {
            try_push(&mut own, Arc::clone(wave), CONTEXT)?;
        }
        Ok(Self(Arc::new(Mutex::new(own))))
    }

    /// Number of bytes of all kept bases.
    pub fn bytes(&self) -> usize {
        let waves = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        waves.iter().map(|wave| wave.basis.bytes()).sum()
    }
}
