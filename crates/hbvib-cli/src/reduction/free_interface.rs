//! Free-interface reduction: the lowest natural modes of the structure with its kept degrees of freedom free, rigid motions among them,
//! and the static motion that these modes miss under unit forces on the kept degrees of freedom (R. H. MacNeal, Computers & Structures 1
//! (1971), doi:10.1016/0045-7949(71)90031-9; S. Rubin, AIAA Journal 13 (1975), doi:10.2514/3.60497; R. R. Craig and C.-J. Chang,
//! NASA CR-2863 (1977)).
//!
//! With the mass-normalised modes Φ (n × m), the unit forces B (n × b) and the projection P = I − ΦΦᵀM, the residual attachment
//! motions are Ψ = P K⁺ Pᵀ B: the load B less the inertia of the kept modes, PᵀB = B − MΦΦᵀB, which turns no rigid motion, under which
//! the motion is orthogonal to the kept modes. It is the sum of φφᵀB/ω² over the modes that are not kept. The same motion follows from
//! K + σM with a shift σ far below the first ω² that is not kept, by
//!
//! ```text
//! Ψ ← Ψ + P (K + σM)⁻¹ (PᵀB − KΨ),        error · σ/(ω² + σ) at each step,
//! ```
//!
//! so that neither supports nor the difference of near numbers are needed.
//!
//! A motion Φq + Ψf has u = Φ_b q + Ψ_b f on the kept rows. Elimination of the forces makes u coordinates, as Rubin does:
//!
//! ```text
//! x = Ψ Ψ_b⁻¹ u + (Φ − Ψ Ψ_b⁻¹ Φ_b) q.
//! ```
//!
//! Stiffness and mass on these columns contain all m modes exactly, and the static motion under all forces on kept degrees of freedom.

use crate::reduction::basis_motions::Motions;
use crate::reduction::pencil::{Modes, Pencil, TOGETHER, factored};
use crate::texts::outcome::Outcome;
use hbvib::Interrupt;
use hbvib::internals::{Csc, MatrixForm as Form};
use hbvib_io::Matrices;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Largest ω² of a rigid motion, relative to that of the stiffest degree of freedom alone.
const RIGID: f64 = 1e-10;

/// The shift relative to ω² of the first mode that is not kept.
const SHIFT: f64 = 1e-3;

/// Steps after the first solution, each of which takes the error by [`SHIFT`].
const STEPS: usize = 4;

/// Largest part of a unit force, and of a flexibility, that is rounding where the modes alone tell a motion.
const NEGLIGIBLE: f64 = 1e-8;

/// The structure with its kept degrees of freedom free.
pub struct FreeInterface {
    whole: Pencil,
    /// Kept rows, of all and of those that move.
    kept: Vec<(usize, usize)>,
    /// ω² of the stiffest degree of freedom alone.
    stiffest: f64,
}

impl FreeInterface {
    /// The rows that move of a stiffness and a mass.
    ///
    /// # Errors
    /// A sentence: complex matrices, nothing besides the kept degrees of freedom; those of the library.
    pub fn new(found: &Matrices, kept: &[usize], fixed: &[usize]) -> Outcome<Self> {
        let whole = Pencil::without(fixed.iter(), found)?;
        if whole.order() <= kept.len() {
            return Err("all degrees of freedom are kept: there is nothing to reduce".into());
        }
        let place = |row: &usize| {
            let at = whole.rows.binary_search(row);
            at.map(|at| (*row, at))
                .map_err(|_| format!("degree of freedom {row} is fixed"))
        };
        let kept = kept.iter().map(place).collect::<Outcome<Vec<_>>>()?;
        let own = |row: usize| (whole.stiffness.get(row, row).re, whole.mass.get(row, row).re);
        let heavy = (0..whole.order()).map(own).filter(|(_, mass)| *mass > 0.0);
        let stiffest = heavy.fold(0.0_f64, |most, (stiffness, mass)| most.max(stiffness / mass));
        Ok(Self { whole, kept, stiffest })
    }

    /// The basis on the lowest modes; rigid motions are taken beyond the number as well.
    ///
    /// # Errors
    /// Those of the library; a kept degree of freedom that no motion moves.
    pub fn motions(&self, modes: Modes) -> Outcome<Motions> {
        let most = self.whole.order() - self.kept.len();
        // One mode beyond those that are taken gives the shift, and shows that no rigid motion is missing.
        let mut asked = match modes {
            Modes::Count(count) => Modes::Count(count.min(most) + 1),
            up_to @ Modes::UpTo(_) => up_to,
        };
        let (found, rigid) = loop {
            let found = self.whole.lowest(asked);
            let (found, _) = found.map_err(|e| format!("modes with free interface: {e}"))?;
            let is_rigid = |omega: &&f64| **omega <= 0.0 || **omega * **omega <= RIGID * self.stiffest;
            let rigid = found.omega.iter().take_while(is_rigid).count();
            let count = found.omega.len();
            let are_all = count == self.whole.order() || matches!(asked, Modes::Count(asked) if count < asked);
            if rigid < count || are_all {
                break (found, rigid);
            }
            asked = Modes::Count(2 * count);
        };
        let wanted = match modes {
            Modes::Count(number) => number,
            Modes::UpTo(hertz) => found.omega.iter().filter(|omega| **omega <= TAU * hertz).count(),
        };
        let wanted = wanted.min(most).max(rigid).min(found.omega.len());
        let shapes: Vec<Vec<f64>> = found
            .shapes
            .chunks_exact(self.whole.order())
            .take(wanted)
            .map(|shape| shape.iter().map(|x| x.re).collect())
            .collect();
        let mut hertz: Vec<f64> = found.omega.iter().take(wanted).map(|omega| omega / TAU).collect();
        // The frequency of a rigid motion is rounding; that of a motion which grows is not.
        for hertz in hertz
            .iter_mut()
            .take(rigid)
            .filter(|hertz| **hertz >= -(RIGID * self.stiffest).sqrt())
        {
            *hertz = 0.0;
        }
        let next = found.omega.get(wanted).or(found.omega.last());
        let next = next.map_or(0.0, |omega| omega * omega);
        if rigid == found.omega.len() || next <= 0.0 {
            return Err("modes with free interface: all are rigid motions, so that there is nothing to reduce".into());
        }
        let attached = self.attachment(&shapes, SHIFT * next)?;
        let columns = self.with_kept_rows(attached, shapes, &mut hertz)?;
        Ok(Motions {
            columns,
            hertz,
            is_complete: wanted >= most || wanted == found.omega.len(),
        })
    }

    /// The residual attachment motions Ψ of mass-normalised modes, a column for each kept degree of freedom; zeros where the modes tell
    /// all of its motion.
    fn attachment(&self, shapes: &[Vec<f64>], shift: f64) -> Outcome<Vec<Vec<f64>>> {
        let order = self.whole.order();
        let said = |e: hbvib::Error| format!("motions under forces on the kept degrees of freedom: {e}");
        let (stiffness, mass) = (&self.whole.stiffness, &self.whole.mass);
        let terms = [
            (Complex64::ONE, stiffness, Form::Plain),
            (Complex64::from(shift), mass, Form::Plain),
        ];
        let shifted = Csc::sum(order, &terms).map_err(said)?;
        let mut factor = factored(&shifted).map_err(said)?;
        let mut inertia = Vec::with_capacity(shapes.len());
        for shape in shapes {
            inertia.push(real(&times(mass, shape)?));
        }
        let mut attached = Vec::with_capacity(self.kept.len());
        for some in self.kept.chunks(TOGETHER) {
            let mut loads = Vec::with_capacity(some.len());
            for (_, at) in some {
                let mut load = vec![0.0; order];
                load[*at] = 1.0;
                for (shape, inertia) in shapes.iter().zip(&inertia) {
                    subtract(&mut load, shape[*at], inertia);
                }
                if load.iter().all(|force| force.abs() <= NEGLIGIBLE) {
                    load.fill(0.0);
                }
                loads.push(load);
            }
            let mut motions = vec![vec![0.0; order]; some.len()];
            for _ in 0..=STEPS {
                let mut left = Vec::with_capacity(some.len() * order);
                for (load, motion) in loads.iter().zip(&motions) {
                    let held = times(stiffness, motion)?;
                    left.extend(load.iter().zip(&held).map(|(force, held)| force - held));
                }
                factor.solve(&mut left, false, &Interrupt::none()).map_err(said)?;
                for (motion, more) in motions.iter_mut().zip(left.chunks_exact(order)) {
                    for (x, more) in motion.iter_mut().zip(more) {
                        *x += more.re;
                    }
                }
            }
            for motion in &mut motions {
                for (shape, inertia) in shapes.iter().zip(&inertia) {
                    let share = motion.iter().zip(inertia).map(|(x, f)| x * f).sum();
                    subtract(motion, share, shape);
                }
            }
            attached.extend(motions);
        }
        Ok(attached)
    }

    /// The columns on all rows with the kept degrees of freedom as coordinates; those of modes follow, and the frequencies of modes that
    /// became columns of kept degrees of freedom are taken out.
    ///
    /// Elimination takes the column Ψ of each kept degree of freedom with its row as pivot, the largest flexibility that is left first.
    /// Where nothing is left the modes tell its motion, as that of a rigid part whose degrees of freedom are all kept; the mode with
    /// the largest motion there is the pivot.
    fn with_kept_rows(
        &self,
        attached: Vec<Vec<f64>>,
        shapes: Vec<Vec<f64>>,
        hertz: &mut Vec<f64>,
    ) -> Outcome<Vec<Vec<f64>>> {
        let count = self.kept.len();
        let own: Vec<f64> = attached.iter().zip(&self.kept).map(|(x, (_, at))| x[*at]).collect();
        let motions: Vec<Vec<f64>> = attached.into_iter().chain(shapes).collect();
        // Of each column the kept rows, and below them the shares of all motions in it.
        let mut columns: Vec<Vec<f64>> = Vec::with_capacity(motions.len());
        for (k, motion) in motions.iter().enumerate() {
            let mut column: Vec<f64> = self.kept.iter().map(|(_, at)| motion[*at]).collect();
            column.resize(count + motions.len(), 0.0);
            column[count + k] = 1.0;
            columns.push(column);
        }
        // Column of each kept degree of freedom.
        let mut pivots: Vec<Option<usize>> = vec![None; count];
        loop {
            let left = |j: usize, columns: &[Vec<f64>]| columns[j][j] / own[j];
            let open = (0..count).filter(|j| pivots[*j].is_none() && own[*j] > 0.0);
            let best = open.max_by(|i, j| left(*i, &columns).total_cmp(&left(*j, &columns)));
            let Some(j) = best.filter(|j| left(*j, &columns) > NEGLIGIBLE) else {
                break;
            };
            eliminate(&mut columns, j, j);
            pivots[j] = Some(j);
        }
        while pivots.iter().any(Option::is_none) {
            let size = |(j, k): &(usize, usize)| columns[*k][*j].abs();
            let open = (0..count).filter(|j| pivots[*j].is_none());
            let modes = (count..columns.len()).filter(|k| !pivots.contains(&Some(*k)));
            let pairs = open.clone().flat_map(|j| modes.clone().map(move |k| (j, k)));
            let best = pairs.max_by(|a, b| size(a).total_cmp(&size(b)));
            let Some((j, k)) = best.filter(|pair| size(pair) > 0.0) else {
                let row = open.map(|j| self.kept[j].0).next().unwrap_or(0);
                return Err(format!(
                    "no motion with free interface moves the kept degree of freedom {row}"
                ));
            };
            eliminate(&mut columns, k, j);
            pivots[j] = Some(k);
        }
        let is_mode = |k: &usize| !pivots.contains(&Some(*k));
        *hertz = (count..columns.len())
            .filter(is_mode)
            .map(|k| hertz[k - count])
            .collect();
        let order = pivots
            .iter()
            .flatten()
            .copied()
            .chain((count..columns.len()).filter(is_mode));
        let all = full(self.whole.order(), &motions);
        let mut found = Vec::with_capacity(order.clone().count());
        for k in order {
            let shares: Vec<Complex64> = columns[k][count..].iter().map(|x| Complex64::from(*x)).collect();
            let mut motion = vec![Complex64::ZERO; self.whole.order()];
            all.multiply_add(Complex64::ONE, &shares, &mut motion);
            for ((_, at), x) in self.kept.iter().zip(&columns[k]) {
                motion[*at] = Complex64::from(*x);
            }
            found.push(self.whole.spread(&motion));
        }
        Ok(found)
    }
}

/// A matrix with these columns, all of whose entries are stored.
fn full(rows: usize, columns: &[Vec<f64>]) -> Csc {
    Csc {
        rows,
        cols: columns.len(),
        col_ptr: (0..=columns.len()).map(|k| k * rows).collect(),
        row_idx: (0..columns.len()).flat_map(|_| 0..rows).collect(),
        values: columns.iter().flatten().map(|x| Complex64::from(*x)).collect(),
    }
}

/// Scales a column to one in a row, and takes it from all others so that these have zero there.
fn eliminate(columns: &mut [Vec<f64>], pivot: usize, row: usize) {
    let mut column = std::mem::take(&mut columns[pivot]);
    let scale = 1.0 / column[row];
    for x in &mut column {
        *x *= scale;
    }
    column[row] = 1.0;
    for other in columns.iter_mut().filter(|other| !other.is_empty()) {
        let share = other[row];
        subtract(other, share, &column);
        other[row] = 0.0;
    }
    columns[pivot] = column;
}

/// x − cy, in x.
fn subtract(x: &mut [f64], c: f64, y: &[f64]) {
    if c != 0.0 {
        for (x, y) in x.iter_mut().zip(y) {
            *x -= c * y;
        }
    }
}

fn real(x: &[Complex64]) -> Vec<f64> {
    x.iter().map(|x| x.re).collect()
}

/// A x.
fn times(a: &Csc, x: &[f64]) -> Outcome<Vec<Complex64>> {
    let x: Vec<Complex64> = x.iter().map(|x| Complex64::from(*x)).collect();
    a.times(&x, "a product").map_err(|e| e.to_string())
}
