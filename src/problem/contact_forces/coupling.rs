//! Coupling of the relative motions by the contact forces: their Jacobians in Newton's matrix, and the elimination of
//! those that equal the reference stiffness.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Result, try_push};
use crate::linalg::add_product;
use crate::linalg::libraries::{Simd, WithSimd};
use crate::problem::contact_forces::ContactForces;
use core::ops::Range;
use num_complex::Complex64;

/// Term added to the diagonal of the means in Newton's matrix, not in the residual. A slipping contact does not
/// resist a mean motion; where nothing else does, as for a ring free to turn, the mean is indeterminate and the
/// matrix singular. With the floor it keeps its initial value.
/// Kind: rounding.
const MEAN_FLOOR: f64 = 1e-8;

/// Columns of a Jacobian between two checks of the interrupt.
/// Kind: block.
const COUPLING_BETWEEN_CHECKS: usize = 16;

impl ContactForces<'_> {
    /// Whether a coordinate is eliminated from Newton's equations: it sticks or, along a normal, is closed, and its
    /// reference stiffness equals that of the contact. Then ∂f/∂y = κ, and no change couples back.
    #[must_use]
    #[inline]
    pub fn is_eliminated(&self, coordinate: usize) -> bool {
        self.told.linear[coordinate] && self.condensed.may_be_eliminated(coordinate)
    }

    /// Whether some law is sampled, so that the forces have a kink wherever an event passes a sample.
    #[must_use]
    pub fn is_sampled(&self) -> bool {
        self.other.is_some()
    }

    /// Whether an eliminated coordinate also has f = κ y, so that its force does not enter the residual; with a
    /// static normal load it does.
    #[must_use]
    #[inline]
    pub fn is_inactive(&self, coordinate: usize) -> bool {
        self.told.inactive[coordinate] && self.condensed.may_be_eliminated(coordinate)
    }

    /// Marks per unknown motion whether some force that is not eliminated depends on it.
    pub fn mark_active(&self, active: &mut [bool]) {
        let m = self.condensed.set().packed_len();
        active.fill(false);
        for c in (0..self.condensed.coordinates()).filter(|&c| !self.is_eliminated(c)) {
            for (by, _) in self.result.jacobians.of_force(c) {
                active[by * m..(by + 1) * m].fill(true);
            }
        }
    }

    /// Whether some force that is not eliminated depends on the motion of a coordinate.
    #[must_use]
    pub fn is_coupled(&self, coordinate: usize) -> bool {
        self.result
            .jacobians
            .of_motion(coordinate)
            .any(|(force, _)| !self.is_eliminated(force))
    }

    /// Change of w = f − κ y in the i-th carried harmonic along a change of the motion.
    #[must_use]
    pub fn along(&self, direction: &[f64], coordinate: usize, i: usize) -> Complex64 {
        let set = self.condensed.set();
        let m = set.packed_len();
        let du = &direction[coordinate * m..(coordinate + 1) * m];
        let mut dw = -self.condensed.kappa(coordinate, i) * set.get(du, i);
        let (at, has_pair) = (set.offset(i), set.numbers()[i] != 0);
        for (by, block) in self.result.jacobians.of_force(coordinate) {
            for (column, d) in block.chunks_exact(m).zip(&direction[by * m..]) {
                match column[at..] {
                    [re, im, ..] if has_pair => dw += Complex64::new(re, im) * d,
                    [re, ..] => dw.re += re * d,
                    [] => {}
                }
            }
        }
        dw
    }

    /// Change of w = f − κ y in all carried harmonics of a coordinate along a change of the motion, with all forces,
    /// eliminated or not.
    pub fn change(&self, direction: &[f64], coordinate: usize, dw: &mut [f64]) {
        let set = self.condensed.set();
        let m = set.packed_len();
        dw.fill(0.0);
        for (by, block) in self.result.jacobians.of_force(coordinate) {
            add_product(1.0, block, &direction[by * m..(by + 1) * m], dw);
        }
        let own = &direction[coordinate * m..(coordinate + 1) * m];
        for i in 0..set.numbers().len() {
            let z = set.get(dw, i) - self.condensed.kappa(coordinate, i) * set.get(own, i);
            set.set(dw, i, z);
        }
    }

    /// Force of a coordinate after a change of the motion and of ω, to first order.
    pub fn behind(&self, (change, along): (&[f64], f64), coordinate: usize, force: &mut [f64]) {
        let m = force.len();
        let here = coordinate * m..(coordinate + 1) * m;
        let numbers = self.result.force[here.clone()].iter().zip(&self.result.by_omega[here]);
        for (to, (force, by_omega)) in force.iter_mut().zip(numbers) {
            *to = force + by_omega * along;
        }
        for (by, block) in self.result.jacobians.of_force(coordinate) {
            add_product(1.0, block, &change[by * m..(by + 1) * m], force);
        }
    }

    /// The blocks ∂f/∂y of the force of a coordinate, each with the coordinate of the motion by which it is the
    /// derivative.
    pub fn blocks_of_force(&self, coordinate: usize) -> impl Iterator<Item = (usize, &[f64])> {
        self.result.jacobians.of_force(coordinate)
    }

    /// Term that is added to the diagonal of a mean in Newton's matrix.
    #[must_use]
    pub fn mean_floor(&self, coordinate: usize) -> f64 {
        if self.is_eliminated(coordinate) {
            0.0
        } else {
            MEAN_FLOOR
        }
    }

    /// Copies the Jacobians of all laws at the motion evaluated last.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn copy_jacobians(&self, values: &mut Vec<f64>) -> Result<()> {
        self.result.jacobians.copy(values)
    }

    /// Copies for each motion whether its force is eliminated at the motion evaluated last.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn copy_silent(&self, silent: &mut Vec<bool>) -> Result<()> {
        silent.clear();
        for c in 0..self.condensed.coordinates() {
            try_push(silent, self.is_eliminated(c), "the products with contact forces")?;
        }
        Ok(())
    }

    /// Exchanges the Jacobians of all laws for those of another motion.
    pub fn swap_jacobians(&mut self, values: &mut Vec<f64>) {
        self.result.jacobians.swap(values);
    }

    /// Adds G (∂f/∂y − κ) in a range of carried harmonics to the column of a Jacobian that belongs to number `q` of
    /// the packed motion of coordinate `motion`. `flexibility` returns G of a harmonic, force after force at a
    /// distance of `stride`; `sum` has one number per coordinate.
    ///
    /// A column is written from top to bottom and the forces are summed before, because the Jacobian of many contacts
    /// is far larger than any cache.
    pub fn couple<'g>(
        &self,
        harmonics: Range<usize>,
        (motion, q): (usize, usize),
        (flexibility, stride): (impl Fn(usize) -> &'g [Complex64], usize),
        sum: &mut [Complex64],
        column: &mut [f64],
    ) {
        let set = self.condensed.set();
        let m = set.packed_len();
        let counts = |(force, _): &(usize, &[f64])| !self.is_eliminated(*force);
        let forces = || self.result.jacobians.of_motion(motion).filter(counts);
        let mut several = forces().skip(1);
        let only = if several.next().is_none() {
            forces().next()
        } else {
            None
        };
        for i in harmonics {
            let at = set.offset(i);
            let mean = set.numbers()[i] == 0;
            let change = |force: usize, block: &[f64]| {
                let z = set.get(&block[q * m..(q + 1) * m], i);
                if force != motion || (q != at && (mean || q != at + 1)) {
                    return z;
                }
                let kappa = self.condensed.kappa(force, i);
                z - if q == at { kappa } else { kappa * Complex64::I }
            };
            if let Some((force, block)) = only {
                let z = change(force, block);
                if z == Complex64::ZERO {
                    continue;
                }
                let g = &flexibility(i)[force * stride..];
                for (s, g) in sum.iter_mut().zip(g) {
                    *s = g * z;
                }
            } else {
                sum.fill(Complex64::ZERO);
                for (force, block) in forces() {
                    let z = change(force, block);
                    for (s, g) in sum.iter_mut().zip(&flexibility(i)[force * stride..]) {
                        *s += g * z;
                    }
                }
            }
            if mean {
                for (x, s) in column[at..].iter_mut().step_by(m).zip(&*sum) {
                    *x += s.re;
                }
                if q == at && !self.is_eliminated(motion) {
                    column[motion * m + at] += MEAN_FLOOR;
                }
            } else {
                for (x, s) in column[at..].chunks_mut(m).zip(&*sum) {
                    x[0] += s.re;
                    x[1] += s.im;
                }
            }
        }
    }

    /// Adds G (∂f/∂y − κ) in all carried harmonics to the columns of a Jacobian of `n` rows that belong to the motion of one
    /// coordinate. `flexibility` holds G harmonic after harmonic for each coordinate, force after force; `change` has the
    /// length of a packed signal.
    ///
    /// Where many harmonics are carried this is faster than [`Self::couple`]: reads and writes are contiguous.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn couple_all(
        &self,
        motion: usize,
        flexibility: &[Complex64],
        change: &mut [f64],
        columns: &mut [f64],
        n: usize,
    ) -> Result<()> {
        let set = self.condensed.set();
        let (m, harmonics) = (set.packed_len(), set.numbers().len());
        let mean = usize::from(set.has_mean());
        let counts = |(force, _): &(usize, &[f64])| !self.is_eliminated(*force);
        for (force, block) in self.result.jacobians.of_motion(motion).filter(counts) {
            let first = force * self.condensed.coordinates() * harmonics;
            let rows = &flexibility[first..first + self.condensed.coordinates() * harmonics];
            if force == motion && mean == 1 {
                columns[motion * m] += MEAN_FLOOR;
            }
            let kappa = |i: usize| {
                if force == motion {
                    self.condensed.kappa(force, i)
                } else {
                    Complex64::ZERO
                }
            };
            for (first, columns) in columns.chunks_mut(COUPLING_BETWEEN_CHECKS * n).enumerate() {
                self.interrupt.check_before(2 * columns.len() as u64)?;
                let first = first * COUPLING_BETWEEN_CHECKS;
                let block = (&block[first * m..], first);
                self.arch.dispatch(Coupling {
                    mean,
                    rows,
                    block,
                    kappa,
                    change: &mut *change,
                    columns: (columns, n),
                });
            }
        }
        Ok(())
    }

    /// Adds G (∂f/∂y − κ), averaged over the phase of the motion, to a column of complex numbers that belongs to a
    /// motion in harmonic i alone. `flexibility` holds the columns of G at a distance of `stride` numbers.
    pub fn add_mean_coupling(
        &self,
        motion: usize,
        i: usize,
        flexibility: &[Complex64],
        stride: usize,
        column: &mut [Complex64],
    ) {
        let set = self.condensed.set();
        let (m, at) = (set.packed_len(), set.offset(i));
        let counts = |(force, _): &(usize, &[f64])| !self.is_eliminated(*force);
        for (force, block) in self.result.jacobians.of_motion(motion).filter(counts) {
            let (by_re, by_im) = (&block[at * m + at..], &block[(at + 1) * m + at..]);
            let mut change = 0.5 * Complex64::new(by_re[0] + by_im[1], by_re[1] - by_im[0]);
            if force == motion {
                change -= self.condensed.kappa(force, i);
            }
            let g = &flexibility[force * stride..];
            for (x, g) in column.iter_mut().zip(g) {
                *x += g * change;
            }
        }
    }

    /// Adds Re(g·∂w/∂y) of the force of coordinate `force` in harmonic i to one row of a Jacobian with `n` rows.
    pub fn couple_scalar(&self, i: usize, (row, force): (usize, usize), g: Complex64, jacobian: &mut [f64], n: usize) {
        let set = self.condensed.set();
        let m = set.packed_len();
        for (by, block) in self.result.jacobians.of_force(force) {
            for (q, column) in block.chunks_exact(m).enumerate() {
                jacobian[(by * m + q) * n + row] += (g * set.get(column, i)).re;
            }
        }
        let gk = g * self.condensed.kappa(force, i);
        let at = force * m + set.offset(i);
        jacobian[at * n + row] -= gk.re;
        if set.numbers()[i] != 0 {
            jacobian[(at + 1) * n + row] += gk.im;
        }
    }
}

/// The arguments of [`couple_columns`].
struct Coupling<'a, K> {
    mean: usize,
    rows: &'a [Complex64],
    block: (&'a [f64], usize),
    kappa: K,
    change: &'a mut [f64],
    columns: (&'a mut [f64], usize),
}

impl<K: Fn(usize) -> Complex64> WithSimd for Coupling<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        // With few harmonics most of the time would be spent around loops of unknown length.
        match (self.change.len() - self.mean) / 2 {
            1 => couple_columns::<1, K>(self),
            2 => couple_columns::<2, K>(self),
            3 => couple_columns::<3, K>(self),
            4 => couple_columns::<4, K>(self),
            5 => couple_columns::<5, K>(self),
            7 => couple_columns::<7, K>(self),
            9 => couple_columns::<9, K>(self),
            _ => couple_columns::<0, K>(self),
        }
    }
}

/// Adds G (J − κ) to columns of `n` rows, with the columns of J from `first` on, and with G for each row coordinate
/// harmonic after harmonic. P is the number of vibrating harmonics, known at compile time; 0: any number.
#[inline(always)]
fn couple_columns<const P: usize, K: Fn(usize) -> Complex64>(by: Coupling<'_, K>) {
    let Coupling {
        mean,
        rows,
        block: (jacobian, first),
        kappa,
        change,
        columns: (columns, n),
    } = by;
    let pairs = if P > 0 { P } else { (change.len() - mean) / 2 };
    let m = 2 * pairs + mean;
    let change = &mut change[..m];
    for (q, (column, from)) in columns.chunks_exact_mut(n).zip(jacobian.chunks_exact(m)).enumerate() {
        let q = first + q;
        change.copy_from_slice(from);
        // Column q is that of the real or of the imaginary part of a motion z, and loses κz.
        let kappa = kappa(if mean == 1 { q.div_ceil(2) } else { q / 2 });
        if q < mean {
            change[q] -= kappa.re;
        } else if (q - mean).is_multiple_of(2) {
            change[q] -= kappa.re;
            change[q + 1] -= kappa.im;
        } else {
            change[q - 1] += kappa.im;
            change[q] -= kappa.re;
        }
        let (z_mean, z) = change.split_at(mean);
        let z = &z.as_chunks::<2>().0[..pairs];
        for (x, g) in column.chunks_exact_mut(m).zip(rows.chunks_exact(pairs + mean)) {
            let ((x_mean, x), (g_mean, g)) = (x.split_at_mut(mean), g.split_at(mean));
            for ((x, z), g) in x_mean.iter_mut().zip(z_mean).zip(g_mean) {
                *x += g.re * z;
            }
            let x = &mut x.as_chunks_mut::<2>().0[..pairs];
            for ((x, z), g) in x.iter_mut().zip(z).zip(&g[..pairs]) {
                x[0] += g.re * z[0] - g.im * z[1];
                x[1] += g.re * z[1] + g.im * z[0];
            }
        }
    }
}
