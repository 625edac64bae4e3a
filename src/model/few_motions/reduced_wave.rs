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

/// Row of a motion over the coordinates of a harmonic.
#[derive(Clone, Debug, Default)]
pub struct MotionRow(Vec<(usize, Complex64)>);

impl MotionRow {
    /// The same row over the degrees of freedom.
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

    /// The row of the motion under a force: xᴴ for a column x.
    pub fn adjoint(column: &SparseVector) -> Result<Self> {
        let mut terms = Vec::new();
        for (p, z) in column {
            try_push(&mut terms, (*p, z.conj()), CONTEXT)?;
        }
        Ok(Self(terms))
    }

    /// Its entries: coordinate and coefficient.
    pub fn terms(&self) -> core::slice::Iter<'_, (usize, Complex64)> {
        self.0.iter()
    }

    /// r·x
    pub fn along(&self, x: &[Complex64]) -> Complex64 {
        self.0.iter().map(|&(p, a)| a * x[p]).sum()
    }
}

/// The basis, column after column, before its rotation.
#[derive(Debug)]
pub enum Basis {
    /// For a real structure.
    Real(Vec<f64>),
    /// For a complex Hermitian one.
    Complex(Vec<Complex64>),
}

impl Basis {
    /// The columns of a real basis; none of a complex one.
    pub fn into_real(self) -> Vec<f64> {
        match self {
            Self::Real(v) => v,
            Self::Complex(_) => Vec::new(),
        }
    }

    /// The columns of a complex basis; none of a real one.
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

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Real(v) => size_of_val(&v[..]),
            Self::Complex(v) => size_of_val(&v[..]),
        }
    }
}

/// Damping on the basis.
#[derive(Debug)]
pub enum WaveDamping {
    /// α and β of C = αM + βK.
    Proportional(f64, f64),
    /// Vᴴ C V, column after column, of the rotated basis; with α and β where the basis holds the images of C − αM − βK.
    General(Vec<Complex64>, Option<(f64, f64)>),
}

/// Part of the images of the last block that the basis does not hold; see [`crate::linalg::iterative::block_krylov`].
#[derive(Debug, Default)]
pub struct Remainder {
    /// First column of the last block.
    pub last: usize,
    /// Gram matrix of the parts, mass before damping.
    pub gram: Vec<Complex64>,
    /// Relative error of solutions in the norm of A by rounding, a part that the basis leaves out, too.
    pub solutions: f64,
    /// Relative error of the stiffness on the basis by rounding.
    pub products: f64,
}

/// The structure of a wave on its basis.
#[derive(Debug)]
pub struct ReducedPencil {
    /// σ
    pub shift: f64,
    /// μ, descending frequency last.
    pub values: Vec<f64>,
    /// Rotation of the basis, column after column.
    pub rotation: Vec<Complex64>,
    /// Damping.
    pub damping: WaveDamping,
    /// The part that the basis leaves out.
    pub remainder: Remainder,
}

impl ReducedPencil {
    /// Number of coordinates.
    #[must_use]
    pub fn order(&self) -> usize {
        self.values.len()
    }

    /// Stiffness of a coordinate, without springs; that of one beyond the basis is 1, and it has no mass.
    #[must_use]
    pub fn stiffness(&self, k: usize) -> f64 {
        self.values.get(k).map_or(1.0, |value| 1.0 - self.shift * value)
    }
}

/// The structure of a wave on its basis, with the basis.
#[derive(Debug)]
pub struct ReducedWave {
    /// Wave by which it is known again, see [`WaveKey`].
    pub key: WaveKey,
    /// Vectors whose flexibility the basis holds.
    pub inputs: Vec<SparseVector>,
    /// Matrices on the basis.
    pub pencil: ReducedPencil,
    /// The basis.
    pub basis: Basis,
    /// Independent degrees of freedom of the structure.
    pub n: usize,
    /// Columns up to which the basis was allowed to grow where its certificate was not met all the same, else 0.
    pub refused_up_to: usize,
}

/// A wave: matrices that are equal have equal keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WaveKey {
    /// Waves per turn.
    pub diameter: usize,
    /// Whether it belongs to a mean motion whose matrices are others.
    pub mean: bool,
}

/// A reduced wave, or the one that travels against it.
#[derive(Clone, Debug)]
pub struct ReducedView {
    /// The wave.
    pub wave: Arc<ReducedWave>,
    /// Whether everything is conjugated.
    pub conjugated: bool,
}

impl ReducedView {
    fn turned(&self, z: Complex64) -> Complex64 {
        if self.conjugated { z.conj() } else { z }
    }

    /// Matrices on the basis.
    pub fn pencil(&self) -> &ReducedPencil {
        &self.wave.pencil
    }

    /// Damping between two coordinates.
    pub fn damping(&self, i: usize, j: usize) -> Complex64 {
        let pencil = self.pencil();
        match &pencil.damping {
            WaveDamping::Proportional(..) if i != j => Complex64::ZERO,
            WaveDamping::Proportional(alpha, beta) => (alpha * pencil.values[i] + beta * pencil.stiffness(i)).into(),
            WaveDamping::General(c, _) => self.turned(c[j * pencil.order() + i]),
        }
    }

    /// A row over the coordinates with the same motion as one over the degrees of freedom.
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

    /// Coordinates of an input, in which everything of a conjugated wave is that of the wave itself.
    pub fn coordinates(&self, input: &SparseVector) -> Result<Vec<Complex64>> {
        let mut found = self.product(&input.iter().map(|&(p, z)| (p, self.turned(z).conj())))?;
        for z in &mut found {
            *z = z.conj();
        }
        Ok(found)
    }

    /// Σ aₚ (V Q)ₚ
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
    /// The wave of a key.
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

    /// The same waves in a list of its own.
    pub fn separate(&self) -> Result<Self> {
        let waves = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut own = Vec::new();
        for wave in waves.iter() {
            try_push(&mut own, Arc::clone(wave), CONTEXT)?;
        }
        Ok(Self(Arc::new(Mutex::new(own))))
    }

    /// Bytes of all bases.
    pub fn bytes(&self) -> usize {
        let waves = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        waves.iter().map(|wave| wave.basis.bytes()).sum()
    }
}
