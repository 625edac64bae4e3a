//! One harmonic of a nonlinear mode as sums over the modes of its wave: the flexibility of the contacts, the motion under their forces,
//! its derivatives by frequency and damping ratio, and what the normalisation needs of them.
//!
//! With x = Φ ξ, the rows E = BΦ and the denominators d = a − b μ (see [`crate::condense::by_modes::sum_terms`]) the equations of a harmonic are
//!
//! > (diag(d) − Eᴴ e E) ξ = Eᴴ w,  a = 1 + i(νβ + η),  b = ν² − iνα,  e = (a − 1) k − i Im κ,
//!
//! and e = −iν for the directions of damping beside αM + βK.
//! The artificial damping adds 2ihDω² to b (mass type), or −2ihD to a (stiffness type): the modes stay, their denominators follow D. The
//! flexibility is made as in [`crate::condense::by_modes::modal_table`], with the low-rank term of [`crate::condense::by_modes::low_rank`]: X are the motions of
//! B under unit forces, G its rows of the contacts. The rest takes vectors alone:
//!
//! > ξ = −d⁻¹ Eᴴ (w + e X w),  Z ∂x = −∂Z x:  z = (1 − G′ e)⁻¹ E d⁻¹ r,  ∂ξ = d⁻¹ (r + Eᴴ e z),  r = Eᴴ ∂e E ξ − ∂d ξ,
//! > vᴴ Φᴴ Z⁻¹ Wᴴ = p + p e X,  p = (v*/d) Eᴴ.

use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::condense::by_factors::flexibility::Table;
use crate::condense::by_modes::low_rank::{Coefficients, LowRank, Plain};
use crate::condense::by_modes::modal_rows::ModalRows;
use crate::condense::by_modes::sum_terms::{Denominator, Factors, Source};
use crate::condense::by_modes::wave_modes::{NEAR_MODE, WaveModes};
use crate::condense::{Artificial, Condensed};
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_columns;
use crate::linalg::dense::complex_columns::multiply_adjoint;
use crate::linalg::{expand, inner};
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the flexibility of a mode";

/// Sums over the modes of its wave for one harmonic of a nonlinear mode.
pub(crate) struct ModeSums {
    rows: Arc<ModalRows>,
    modes: Arc<WaveModes>,
    number: f64,
    is_mass_type: bool,
    coefficients: Coefficients,
    /// Largest length of a row of Φ.
    longest_row: f64,
}

/// Products that the normalisation of a nonlinear mode needs from its fundamental: (B x)ᴴ times a motion, and the
/// same motion at the reference degree of freedom.
#[derive(Default)]
pub(crate) struct GaugeProducts {
    /// Products for the motion Z⁻¹ Wᴴ under a unit force at each contact.
    pub of_columns: Vec<[Complex64; 2]>,
    /// Products for the derivatives of the motion by frequency and by damping ratio.
    pub of_rates: [[Complex64; 2]; 2],
}

/// Memory of the sums, used for one harmonic after the other.
pub(crate) struct SumWork {
    at: Denominator,
    /// 1/d, one number per mode.
    inverse: Vec<Complex64>,
    weighted: Vec<Complex64>,
    /// T′, rows × rows; and the flexibility, with the row of the reference degree of freedom.
    plain: Vec<Complex64>,
    table: Table,
    low_rank: LowRank,
    vectors: SumVectors,
    blocks: SumBlocks,
}

/// Motions and forces of a sum.
pub(crate) struct SumVectors {
    /// Modal motion ξ, and its derivatives by frequency and damping ratio.
    motion: Vec<Complex64>,
    rates: [Vec<Complex64>; 2],
    /// Memory: one number per mode; a force and a motion of each row; a product.
    of_modes: Vec<Complex64>,
    force: Vec<Complex64>,
    seen: Vec<Complex64>,
}

/// Memory of products.
pub(crate) struct SumBlocks {
    memory: Vec<Complex64>,
    /// Motion of each row of B.
    inner: Vec<Complex64>,
    /// Memory for a product on all degrees of freedom, and for a force shifted by a quarter period.
    whole: Vec<Complex64>,
    turned: Vec<Complex64>,
}

/// Coefficients a and b of the denominators and iν for directions of other damping, or the derivatives of these by
/// one variable.
#[derive(Clone, Copy)]
struct Pair {
    a: Complex64,
    b: Complex64,
    i_nu: Complex64,
}

impl SumWork {
    /// Flexibility of the contacts, column after column; each column ends with the motion of the reference degree of
    /// freedom.
    pub fn table(&self) -> &[Complex64] {
        &self.table.value
    }
}

impl ModeSums {
    /// Sums for the i-th carried harmonic with the rows of its wave. `None` where the rows belong to poles, which would
    /// depend on the damping ratio.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new((condensed, i): (&Condensed, usize), rows: Arc<ModalRows>) -> Result<Option<Self>> {
        let Source::Modes(modes) = rows.source() else {
            return Ok(None);
        };
        let modes = Arc::clone(modes);
        let block = &condensed.blocks()[i];
        let is_mass_type = matches!(block.matrices.artificial, Artificial::Mass);
        let is_damped = modes.is_damped_by_stiffness() || !is_mass_type;
        Ok(Some(Self {
            coefficients: Coefficients::new(condensed, i, (rows.springs(), rows.dampers().len()), is_damped)?,
            number: block.number as f64,
            longest_row: longest_row(&modes),
            is_mass_type,
            modes,
            rows,
        }))
    }

    /// Whether the artificial damping of a block acts on its springs, whatever damps the structure.
    pub fn damps_springs(artificial: &Artificial) -> bool {
        matches!(artificial, Artificial::Stiffness(_))
    }

    /// Makes memory for these sums.
    pub fn work(&self) -> Result<SumWork> {
        let (rows, n, coordinates) = (self.rows.count(), self.rows.terms(), self.rows.coordinates());
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        Ok(SumWork {
            at: denominator(Pair::ZERO, Pair::ZERO),
            inverse: zeros(n)?,
            weighted: zeros(rows * n)?,
            plain: zeros(rows * rows)?,
            table: Table::new(coordinates)?,
            low_rank: LowRank::new(coordinates, self.coefficients.len())?,
            vectors: SumVectors {
                motion: zeros(n)?,
                rates: [zeros(n)?, zeros(n)?],
                of_modes: zeros(n)?,
                force: zeros(rows)?,
                seen: zeros(rows)?,
            },
            blocks: SumBlocks {
                memory: zeros(rows)?,
                inner: zeros(self.coefficients.len())?,
                whole: zeros(n)?,
                turned: zeros(rows)?,
            },
        })
    }

    /// Whether a memory has the size that these sums need.
    pub fn fits(&self, work: &SumWork) -> bool {
        work.inverse.len() == self.rows.terms() && work.vectors.seen.len() == self.rows.count()
    }

    /// Whether this harmonic is the fundamental, which the normalisation reads.
    pub fn is_fundamental(&self) -> bool {
        self.number < 1.5
    }

    /// Solves at frequency `omega` and damping ratio `damping` under the forces w. Writes the motion, of all degrees
    /// of freedom in the fundamental and of the modes in other harmonics, and the relative motions of the contacts
    /// with their derivatives by frequency and damping ratio. Returns `false` so near a resonance of the structure
    /// with its reference stiffness that digits would be lost.
    ///
    /// # Errors
    /// `Singular`, `OutOfMemory`, `StoppedByCaller`.
    pub fn solve(
        &self,
        work: &mut SumWork,
        DampedFrequency { omega, damping }: DampedFrequency,
        w: &[Complex64],
        (x, relative): (&mut [Complex64], &mut [Complex64]),
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let [at, by_omega, by_damping] = self.pairs(omega, damping);
        let nu = self.number * omega;
        if !self
            .modes
            .invert((at.a - 1.0, at.b), (nu, NEAR_MODE), &mut work.inverse)
        {
            return Ok(false);
        }
        work.at = denominator(at, by_omega);
        if let ([w], 1) = (w, self.coefficients.len()) {
            self.solve_single(work, [at, by_omega, by_damping], *w, relative);
            if self.is_fundamental() {
                expand(&self.modes.vectors, &work.vectors.motion, x);
            } else {
                x.copy_from_slice(&work.vectors.motion);
            }
            return Ok(true);
        }
        interrupt.check_before((4 * work.weighted.len() * self.rows.count()) as u64)?;
        self.flexibility(work, interrupt)?;
        self.motion(work, w);
        if self.is_fundamental() {
            self.expand(&work.vectors.motion, x, &mut work.blocks.whole);
        } else {
            x.copy_from_slice(&work.vectors.motion);
        }
        let coordinates = self.rows.coordinates();
        for (variable, slope) in [by_omega, by_damping].into_iter().enumerate() {
            let to = &mut relative[(1 + variable) * coordinates..(2 + variable) * coordinates];
            self.differentiate(work, (variable, slope), to);
        }
        relative[..coordinates].copy_from_slice(&work.vectors.seen[..coordinates]);
        Ok(true)
    }

    /// Turns a motion of the modes into one of all degrees of freedom.
    pub fn expand(&self, of_modes: &[Complex64], x: &mut [Complex64], memory: &mut [Complex64]) {
        complex_columns::multiply(&self.modes.vectors, x.len(), of_modes, x, memory);
    }

    /// Upper bound of the largest motion of a degree of freedom, from a motion of the modes.
    pub fn bound(&self, of_modes: &[Complex64]) -> f64 {
        self.longest_row * of_modes.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt()
    }

    /// Computes the products of the normalisation with the solution of [`Self::solve`], where `weighted` is B x.
    pub fn gauge(&self, work: &mut SumWork, weighted: &[Complex64], out: &mut GaugeProducts) {
        let (rows, coordinates) = (self.rows.count(), self.rows.coordinates());
        multiply_adjoint(
            &self.modes.vectors,
            weighted,
            &mut work.blocks.whole,
            &mut work.vectors.of_modes,
        );
        for (rate, out) in work.vectors.rates.iter().zip(&mut out.of_rates) {
            let left = self.rows.left().chunks_exact(rows);
            let moved: Complex64 = left.zip(rate).map(|(left, xi)| left[coordinates] * xi).sum();
            *out = [inner(&work.vectors.of_modes, rate), moved];
        }
        for (v, inverse) in work.vectors.of_modes.iter_mut().zip(&work.inverse) {
            *v *= inverse.conj();
        }
        complex_columns::multiply(
            self.rows.left(),
            rows,
            &work.vectors.of_modes,
            &mut work.vectors.seen,
            &mut work.blocks.memory,
        );
        let order = self.coefficients.len();
        let row_of = |b: usize| self.coefficients.row_of(b);
        let columns = work.table.value.chunks_exact(coordinates + 1);
        for (c, (out, column)) in out.of_columns.iter_mut().zip(columns).enumerate() {
            let mut size = work.vectors.seen[c].conj();
            if coordinates == 1 && order == 1 {
                let force = self.coefficients.entry(0, work.at.frequency().at) * column[0];
                size += work.vectors.seen[0].conj() * force;
            } else if self.coefficients.counts {
                let force = &work.low_rank.force()[c * order..(c + 1) * order];
                for (b, force) in force.iter().enumerate() {
                    size += work.vectors.seen[row_of(b)].conj() * force;
                }
            }
            *out = [size, column[coordinates]];
        }
    }

    /// Coefficients a, b and iν of the denominators, then their derivatives by ω and by D.
    fn pairs(&self, omega: f64, damping: f64) -> [Pair; 3] {
        let (h, (alpha, beta)) = (self.number, self.modes.proportional);
        let nu = h * omega;
        let imaginary = |x: f64| Complex64::new(0.0, x);
        let (mass, stiffness) = if self.is_mass_type { (1.0, 0.0) } else { (0.0, 1.0) };
        [
            Pair {
                a: Complex64::new(1.0, nu * beta + self.modes.loss_factor - 2.0 * stiffness * h * damping),
                b: Complex64::new(nu * nu, 2.0 * mass * h * damping * omega * omega - nu * alpha),
                i_nu: imaginary(nu),
            },
            Pair {
                a: imaginary(h * beta),
                b: Complex64::new(2.0 * h * nu, h * (4.0 * mass * damping * omega - alpha)),
                i_nu: imaginary(h),
            },
            Pair {
                a: imaginary(-2.0 * stiffness * h),
                b: imaginary(2.0 * mass * h * omega * omega),
                i_nu: Complex64::ZERO,
            },
        ]
    }

    /// Solves for one contact without springs in closed form, the inner loop of every mode with one contact. With q
    /// its motion in each mode, S = Σ |q|²/d and p = 1/(1 − S e), the flexibility is G = S p, and
    ///
    /// > ξ = −p q*/d w,  ∂S = −Σ |q|² ∂d/d²,  ∂p = p² (∂S e + S ∂e),  ∂G = p² (∂S + S² ∂e).
    fn solve_single(&self, work: &mut SumWork, [at, rates @ ..]: [Pair; 3], w: Complex64, relative: &mut [Complex64]) {
        let (sums, values) = (self.rows.left().as_chunks::<2>().0, &self.modes.values);
        let (mut sum, mut squares, mut weighted) = (Complex64::ZERO, Complex64::ZERO, Complex64::ZERO);
        for ((inverse, [q, _]), mu) in work.inverse.iter().zip(sums).zip(values) {
            let size = q.norm_sqr();
            let square = inverse * inverse * size;
            sum += inverse * size;
            squares += square;
            weighted += square * *mu;
        }
        let e = self.coefficients.entry(0, Factors::of_stiffness(at.a - 1.0));
        let pivot = (1.0 - sum * e).inv();
        work.table.value[0] = sum * pivot;
        relative[0] = -sum * pivot * w;
        for (xi, (inverse, [q, _])) in work.vectors.motion.iter_mut().zip(work.inverse.iter().zip(sums)) {
            *xi = -pivot * inverse * q.conj() * w;
        }
        let is_fundamental = self.is_fundamental();
        if is_fundamental {
            let columns = work.inverse.iter().zip(sums);
            let moved: Complex64 = columns
                .map(|(inverse, [q, response])| response * inverse * q.conj())
                .sum();
            work.table.value[1] = moved * pivot;
        }
        for ((slope, rate), to) in rates.into_iter().zip(&mut work.vectors.rates).zip(&mut relative[1..]) {
            let d_sum = slope.b * weighted - slope.a * squares;
            let d_e = self.coefficients.d_entry(0, Factors::of_stiffness(slope.a));
            *to = -pivot * pivot * (d_sum + sum * sum * d_e) * w;
            if is_fundamental {
                let d_pivot = pivot * pivot * (d_sum * e + sum * d_e);
                for ((xi, (inverse, [q, _])), mu) in rate.iter_mut().zip(work.inverse.iter().zip(sums)).zip(values) {
                    let d_inverse = (slope.b * mu - slope.a) * inverse * inverse;
                    *xi = -(d_inverse * pivot + inverse * d_pivot) * q.conj() * w;
                }
            }
        }
    }

    /// Computes T′ and, with the low-rank term, the flexibility.
    fn flexibility(&self, work: &mut SumWork, interrupt: &Interrupt<'_>) -> Result<()> {
        let (rows, outputs) = (self.rows.count(), self.rows.coordinates() + 1);
        let soft = self.rows.add_stiff(work.at, &mut work.plain, None)?;
        self.rows.add(soft, &work.inverse, &mut work.weighted, &mut work.plain);
        for (to, from) in work
            .table
            .value
            .chunks_exact_mut(outputs)
            .zip(work.plain.chunks_exact(rows))
        {
            to.copy_from_slice(&from[..outputs]);
        }
        let plain = Plain {
            value: &work.plain,
            slope: &[],
            rows,
        };
        let at = work.at.frequency();
        work.low_rank
            .add(&self.coefficients, &plain, (at, false), &mut work.table, interrupt)
    }

    /// Computes the modal motion ξ, and E ξ, the motions of the rows.
    fn motion(&self, work: &mut SumWork, w: &[Complex64]) {
        let (order, outputs) = (self.coefficients.len(), w.len() + 1);
        work.vectors.force.fill(Complex64::ZERO);
        work.vectors.force[..w.len()].copy_from_slice(w);
        if self.coefficients.counts {
            for (force, w) in work.low_rank.force().chunks_exact(order.max(1)).zip(w) {
                for (b, force) in force.iter().enumerate() {
                    work.vectors.force[self.coefficients.row_of(b)] += force * w;
                }
            }
        }
        multiply_adjoint(
            self.rows.left(),
            &work.vectors.force,
            &mut work.blocks.turned,
            &mut work.vectors.motion,
        );
        for (xi, inverse) in work.vectors.motion.iter_mut().zip(&work.inverse) {
            *xi *= -inverse;
        }
        let rows = self.rows.count();
        complex_columns::multiply(
            self.rows.left(),
            rows,
            &work.vectors.motion,
            &mut work.vectors.seen,
            &mut work.blocks.memory,
        );
        // The relative motions are those of the flexibility in Newton's matrix, to the last digit.
        let columns = work.table.value.chunks_exact(outputs);
        work.vectors.seen[..w.len()].fill(Complex64::ZERO);
        for (column, w) in columns.zip(w) {
            for (seen, g) in work.vectors.seen.iter_mut().zip(&column[..outputs - 1]) {
                *seen -= g * w;
            }
        }
    }

    /// Computes ∂ξ by one variable, and its relative motions at the contacts.
    fn differentiate(&self, work: &mut SumWork, (variable, slope): (usize, Pair), relative: &mut [Complex64]) {
        let (rows, of) = (self.rows.count(), &self.coefficients);
        work.vectors.force.fill(Complex64::ZERO);
        if of.counts {
            let factors = Factors {
                c: slope.a,
                i_nu: slope.i_nu,
            };
            for b in 0..of.len() {
                work.vectors.force[of.row_of(b)] = of.d_entry(b, factors) * work.vectors.seen[of.row_of(b)];
            }
        }
        let rate = &mut work.vectors.rates[variable];
        multiply_adjoint(self.rows.left(), &work.vectors.force, &mut work.blocks.turned, rate);
        let values = work.vectors.motion.iter().zip(&self.modes.values);
        for ((rate, inverse), (xi, mu)) in rate.iter_mut().zip(&work.inverse).zip(values) {
            *rate = (*rate - (slope.a - slope.b * mu) * xi) * inverse;
        }
        complex_columns::multiply(
            self.rows.left(),
            rows,
            rate,
            &mut work.vectors.force,
            &mut work.blocks.memory,
        );
        if of.counts {
            for (b, z) in work.blocks.inner.iter_mut().enumerate() {
                *z = work.vectors.force[of.row_of(b)];
            }
            work.low_rank.solve_rows(&mut work.blocks.inner);
            relative.copy_from_slice(&work.blocks.inner[..relative.len()]);
            if !self.is_fundamental() {
                return;
            }
            work.blocks.memory.fill(Complex64::ZERO);
            for (b, z) in work.blocks.inner.iter().enumerate() {
                work.blocks.memory[of.row_of(b)] = of.entry(b, work.at.frequency().at) * z;
            }
            multiply_adjoint(
                self.rows.left(),
                &work.blocks.memory,
                &mut work.blocks.turned,
                &mut work.vectors.of_modes,
            );
            for ((rate, inverse), force) in rate.iter_mut().zip(&work.inverse).zip(&work.vectors.of_modes) {
                *rate += inverse * force;
            }
        } else {
            relative.copy_from_slice(&work.vectors.force[..relative.len()]);
        }
    }
}

impl Pair {
    const ZERO: Self = Self {
        a: Complex64::ZERO,
        b: Complex64::ZERO,
        i_nu: Complex64::ZERO,
    };
}

fn longest_row(modes: &WaveModes) -> f64 {
    let n = modes.values.len();
    let square = |row: usize| {
        modes
            .vectors
            .iter()
            .skip(row)
            .step_by(n)
            .map(Complex64::norm_sqr)
            .sum::<f64>()
    };
    (0..n).map(square).fold(0.0, f64::max).sqrt()
}

fn denominator(at: Pair, slope: Pair) -> Denominator {
    Denominator {
        a: at.a,
        d_a: slope.a,
        b: at.b,
        d_b: slope.b,
        i_nu: at.i_nu,
        d_i_nu: slope.i_nu,
    }
}
