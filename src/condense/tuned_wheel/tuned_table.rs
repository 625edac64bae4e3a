//! The flexibility of a wheel's contacts from the waves of the tuned wheel, without motions of all sectors.
//!
//! The contacts of all sectors are alike, so that wave p has k contact forces and one matrix of flexibilities R_p Z_p⁻¹ R_pᴴ. A
//! transform over the sectors makes the table of the tuned wheel of them, and the differences of its sectors subtract
//!
//! > G⁰_ww − G_ww = G⁰_wb (I + D G⁰_bb)⁻¹ D G⁰_bw,
//!
//! with the excitation as one more column and the response as one more row.

use crate::condense::HarmonicBlock;
use crate::condense::tuned_wheel::tuned_factors::TunedFactors;
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products::multiply;
use crate::model::few_motions::reduced_wave::MotionRow;
use num_complex::Complex64;

const CONTEXT: &str = "the contact flexibility of a wheel";

/// Motions under a force in the first sector, by the distance from it: under each of k contact forces and the
/// excitation.
struct ByDistance {
    /// Motions read by the contacts and by the response after them: k + 1 rows of k + 1 columns for each distance.
    read: Vec<Complex64>,
    /// Wave after wave: motions of the basis read by the rows R_p; and products of bᴴ with the first k + 1 columns.
    left: Vec<Complex64>,
    along: Vec<Complex64>,
}

/// Inputs and outputs of the table: rows of the contacts of the first sector, force on all sectors, and row of the
/// response.
pub(crate) struct Outputs<'a> {
    rows: &'a [MotionRow],
    force: &'a [Complex64],
    response: &'a MotionRow,
}

impl<'a> Outputs<'a> {
    /// Rows of a block under a force; `None` where the contacts of its sectors are not alike.
    pub fn new(
        block: &'a HarmonicBlock,
        (sectors, order): (usize, usize),
        force: &'a [Complex64],
        response: &'a MotionRow,
    ) -> Option<Self> {
        let all = block.motions.rows.len();
        if !all.is_multiple_of(sectors) {
            return None;
        }
        let k = all / sectors;
        let is_turned = |c: usize, row: &MotionRow| {
            let shift = c / k * order;
            let first = block.motions.rows[c % k].terms();
            let terms = row.terms();
            terms.len() == first.len()
                && terms
                    .zip(first)
                    .all(|(a, b)| a.0 == (b.0 + shift) % (sectors * order) && a.1 == b.1)
        };
        let are_alike = block.motions.rows.iter().enumerate().all(|(c, row)| is_turned(c, row));
        are_alike.then_some(Self {
            rows: &block.motions.rows[..k],
            force,
            response,
        })
    }
}

impl TunedFactors {
    /// Makes the table with the current factors, and the motion under the excitation.
    ///
    /// # Errors
    /// `Singular`; `OutOfMemory`; `StoppedByCaller`.
    pub(crate) fn tabulate(
        &mut self,
        outputs: &Outputs<'_>,
        (value, excited): (&mut [Complex64], &mut [Complex64]),
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        excited.copy_from_slice(outputs.force);
        self.solve(excited, interrupt)?;
        let found = self.by_distance(outputs, interrupt)?;
        self.assemble(&found, outputs.rows.len(), value);
        if self.plan.basis.rank > 0 {
            self.subtract_low_rank(&found, outputs.rows.len(), value, interrupt)?;
        }
        Ok(())
    }

    /// Computes the flexibilities of all waves and transforms them to distances between sectors.
    fn by_distance(&mut self, outputs: &Outputs<'_>, interrupt: &Interrupt<'_>) -> Result<ByDistance> {
        let (sectors, n, r) = (self.plan.basis.sectors, self.plan.basis.order, self.plan.basis.rank);
        let k = outputs.rows.len();
        let rows = k + 1;
        let mut found = ByDistance {
            read: try_vec(sectors * rows * rows, Complex64::ZERO, CONTEXT)?,
            left: try_vec(sectors * rows * r, Complex64::ZERO, CONTEXT)?,
            along: try_vec(sectors * rows * r, Complex64::ZERO, CONTEXT)?,
        };
        let force = self.over_waves(outputs.force, n)?;
        let mut x = try_vec(n * rows, Complex64::ZERO, CONTEXT)?;
        for p in 0..sectors {
            x.fill(Complex64::ZERO);
            for (x, row) in x.chunks_exact_mut(n).zip(outputs.rows) {
                for &(at, a) in row.terms() {
                    x[at % n] += a.conj() * self.root(p * (at / n));
                }
            }
            x[k * n..].copy_from_slice(&force[p * n..(p + 1) * n]);
            self.solve_wave(p, &mut x, interrupt)?;
            self.along_basis(p, &x, &mut found.along[p * rows * r..(p + 1) * rows * r]);
            let flexible = &self.flexible[p * n * r..(p + 1) * n * r];
            let of_forces = &mut found.read[p * rows * rows..(p + 1) * rows * rows];
            let of_basis = &mut found.left[p * rows * r..(p + 1) * rows * r];
            for (columns, read) in [(&x[..], of_forces), (flexible, of_basis)] {
                for (x, read) in columns.chunks_exact(n).zip(read.chunks_exact_mut(rows)) {
                    let rows = outputs.rows.iter().chain([outputs.response]);
                    for (read, row) in read.iter_mut().zip(rows) {
                        let terms = row.terms();
                        *read = terms
                            .map(|&(at, a)| a * self.root(p * (at / n)).conj() * x[at % n])
                            .sum();
                    }
                }
            }
        }
        found.read = self.over_sectors(&found.read, rows * rows)?;
        Ok(found)
    }

    /// Fills in the table of the tuned wheel.
    fn assemble(&self, found: &ByDistance, k: usize, value: &mut [Complex64]) {
        let (sectors, rows) = (self.plan.basis.sectors, k + 1);
        let outputs = sectors * k + 1;
        for (column, table) in value.chunks_exact_mut(outputs).enumerate() {
            // The excitation acts on all sectors.
            let (t, q) = if column == sectors * k {
                (0, k)
            } else {
                (column / k, column % k)
            };
            for s in 0..sectors {
                let d = (s + sectors - t) % sectors;
                table[s * k..(s + 1) * k].copy_from_slice(&found.read[(d * rows + q) * rows..][..k]);
            }
            // The response is read where it is, at the distance −t.
            table[sectors * k] = found.read[((sectors - t) % sectors * rows + q) * rows + k];
        }
    }

    /// Subtracts the effect of the differences of the sectors, G⁰_wb (I + D G⁰_bb)⁻¹ D G⁰_bw.
    fn subtract_low_rank(
        &mut self,
        found: &ByDistance,
        k: usize,
        value: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (sectors, r) = (self.plan.basis.sectors, self.plan.basis.rank);
        let (rows, outputs, all) = (k + 1, sectors * k + 1, sectors * r);
        let mut left = try_vec(outputs * all, Complex64::ZERO, CONTEXT)?;
        for (column, left) in left.chunks_exact_mut(outputs).enumerate() {
            let (p, read) = (column / r, &found.left[column * rows..(column + 1) * rows]);
            let share = 1.0 / sectors as f64;
            for s in 0..sectors {
                let root = self.root(p * s).conj() * share;
                for (left, read) in left[s * k..(s + 1) * k].iter_mut().zip(read) {
                    *left = root * read;
                }
            }
            left[sectors * k] = read[k] * share;
        }
        let mut right = try_vec(all * outputs, Complex64::ZERO, CONTEXT)?;
        for (column, right) in right.chunks_exact_mut(all).enumerate() {
            let (t, q) = if column == sectors * k {
                (0, k)
            } else {
                (column / k, column % k)
            };
            for (p, right) in right.chunks_exact_mut(r).enumerate() {
                let root = self.root(p * t);
                for (right, along) in right.iter_mut().zip(&found.along[(p * rows + q) * r..]) {
                    *right = root * along;
                }
            }
        }
        interrupt.check_before((all * all * outputs) as u64)?;
        self.correct(&mut right, interrupt)?;
        interrupt.check_before((8 * outputs * all * outputs) as u64)?;
        let mut product = try_vec(value.len(), Complex64::ZERO, CONTEXT)?;
        multiply(&left, &right, &mut product, outputs);
        for (value, product) in value.iter_mut().zip(&product) {
            *value -= product;
        }
        Ok(())
    }
}
