//! Energies and losses of a periodic motion x(t) = Re Σₕ Xₕ e^{ihωt}, from its harmonics.
//!
//! With v_h = ihωX_h the kinetic energy is k(t) = ½ v·Mv and the strain energy u(t) = ½ x·Kx; K includes springs
//! and contacts that never slip, but not contacts that may slip, which both store and dissipate energy. The means
//! follow from forms X_hᴴ A_h X_h, the losses per cycle from ∮ f ẋ dt = π Σₕ h Im(F_h conj(X_h)).
//!
//! All quantities are those of one sector in the units of the solver. A sector includes half of its couplings to
//! its neighbours, so that N sectors make the wheel. In the sum of k or u over the wheel, whose harmonic n lags by
//! n·2π·EO/N from sector to sector, only the harmonics with n·EO ≡ 0 mod N remain.

use crate::condense::Condensed;
use crate::error::{Error, Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::fourier::{Extremum, TurningPoints};
use crate::interrupt::Interrupt;
use crate::linalg::exact_sums::quadratic::{ComplexSum, form, product};
use crate::model::matrices::spring::along;
use crate::model::matrices::structure::MatrixKind;
use num_complex::Complex64;
use std::f64::consts::PI;

/// Energies and losses of one sector that follow without a scan of the period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    /// Sum Σ_{h>0} ½ (hω)² X_hᴴ M_h X_h, twice the mean kinetic energy.
    pub twice_mean_kinetic: f64,
    /// Mean strain energy of the linear structure, with springs and contacts that never slip, without the other
    /// contacts.
    pub potential_mean: f64,
    /// Work per cycle that viscous and structural damping, and stiffness without symmetry, dissipate.
    pub structural_loss: f64,
    /// Work per cycle of the contacts that may slip.
    pub friction_loss: f64,
}

/// Balance of a motion `x` (carried harmonics × ndof) at `omega`, whose contacts move by `motion` under `forces`
/// (packed harmonics per coordinate); all in the units of the solver. It does not allocate.
///
/// The forms are summed with their rounding errors: a stiff structure that moves almost rigidly has little of the
/// energy of its largest term, and undamped structures must not appear to dissipate.
#[must_use]
pub fn balance(condensed: &Condensed, omega: f64, x: &[Complex64], forces: &[f64], motion: &[f64]) -> Balance {
    let mut sum = Balance::default();
    for (block, x) in condensed.blocks().iter().zip(x.chunks_exact(condensed.ndof())) {
        let h = block.number as f64;
        let pattern = &block.matrices.reference;
        let stiffness = form(pattern, &block.matrices.stiffness, x);
        let of_speed = match &block.matrices.tied {
            Some(tied) => omega * omega * form(pattern, &tied.stiffness, x).re,
            None => 0.0,
        };
        if block.number == 0 {
            sum.potential_mean += 0.5 * (stiffness.re + of_speed);
            continue;
        }
        let hw = h * omega;
        sum.twice_mean_kinetic += 0.5 * hw * hw * form(pattern, &block.matrices.mass, x).re;
        sum.potential_mean += 0.25 * (stiffness.re + of_speed);
        sum.structural_loss += PI * h * (stiffness.im + hw * form(pattern, &block.matrices.damping, x).re);
        for direction in block.matrices.modal.iter().flat_map(|all| all.iter()) {
            let along = direction.iter().map(|(p, z)| z.conj() * x[*p]).sum::<Complex64>();
            sum.structural_loss += PI * h * hw * along.norm_sqr();
        }
        if let Some(structural) = &block.matrices.structural {
            sum.structural_loss += PI * h * form(pattern, structural, x).re;
        }
    }
    let set = condensed.set();
    let packed = set.packed_len().max(1);
    for (force, motion) in forces.chunks_exact(packed).zip(motion.chunks_exact(packed)) {
        for (i, &h) in set.numbers().iter().enumerate() {
            sum.friction_loss += PI * h as f64 * (set.get(force, i) * set.get(motion, i).conj()).im;
        }
    }
    sum
}

/// Largest energies over the period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peaks {
    /// Kinetic energy of a sector.
    pub kinetic: f64,
    /// Strain energy of a sector, as in [`Balance::potential_mean`].
    pub potential: f64,
    /// Kinetic energy of all sectors.
    pub wheel_kinetic: f64,
    /// Strain energy of all sectors.
    pub wheel_potential: f64,
}

/// Largest energies of a motion `x` (carried harmonics × ndof) at `omega`, in the solver's units. The search covers
/// all extrema of the energy's Fourier series, which ends at twice the highest harmonic of the motion.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`.
pub fn peaks(condensed: &Condensed, omega: f64, x: &[Complex64], interrupt: &Interrupt<'_>) -> Result<Peaks> {
    const CONTEXT: &str = "the energies";
    let (order, n) = (condensed.ndof(), condensed.degrees().independent());
    let size = n.saturating_mul(condensed.blocks().len());
    let mut moved = try_vec(size, Complex64::ZERO, CONTEXT)?;
    let mut conjugate = try_vec(size, Complex64::ZERO, CONTEXT)?;
    let mut sums = try_vec(n, ComplexSum::default(), CONTEXT)?;
    let mut series = Series::new(condensed.set())?;
    let mut largest = [[0.0; 2]; 2];
    for (kinetic, largest) in [true, false].into_iter().zip(&mut largest) {
        let rows = moved.chunks_exact_mut(n).zip(conjugate.chunks_exact_mut(n));
        for (((i, block), q), (moved, conjugate)) in condensed
            .blocks()
            .iter()
            .enumerate()
            .zip(x.chunks_exact(order))
            .zip(rows)
        {
            interrupt.check()?;
            let factor = if kinetic {
                Complex64::new(0.0, block.number as f64 * omega)
            } else {
                Complex64::ONE
            };
            condensed.expand(i, q, moved)?;
            for moved in moved.iter_mut() {
                *moved *= factor;
            }
            sums.fill(ComplexSum::default());
            match condensed.structure() {
                None => {
                    let values = if kinetic {
                        &block.matrices.mass
                    } else {
                        &block.matrices.stiffness
                    };
                    product(&block.matrices.reference, values, moved, &mut sums);
                }
                // Harmonics on different bases meet in the degrees of freedom alone.
                Some(structure) => {
                    let kind = if kinetic {
                        MatrixKind::Mass
                    } else {
                        MatrixKind::Stiffness
                    };
                    let matrix = structure.wave_matrix(kind, block.number)?;
                    product(&matrix, &matrix.values, moved, &mut sums);
                }
            }
            for (conjugate, sum) in conjugate.iter_mut().zip(&sums) {
                *conjugate = sum.total();
            }
            if let (false, Some(tied)) = (kinetic, &block.matrices.tied) {
                sums.fill(ComplexSum::default());
                product(&block.matrices.reference, &tied.stiffness, moved, &mut sums);
                for (conjugate, sum) in conjugate.iter_mut().zip(&sums) {
                    *conjugate += omega * omega * sum.total();
                }
            }
            for (force, motion, k) in block.motions.springs.iter().filter(|_| !kinetic) {
                let pull = along(motion, moved) * k;
                for &(p, a) in force.iter().flatten() {
                    conjugate[p] += a.conj() * pull;
                }
            }
        }
        series.set_half_product(condensed.set().numbers(), &moved, &conjugate, n, interrupt)?;
        largest[0] = series.maximum(interrupt)?;
        series.add_sectors(condensed.sectors(), condensed.in_step());
        largest[1] = series.maximum(interrupt)?;
    }
    let [[kinetic, wheel_kinetic], [potential, wheel_potential]] = largest;
    Ok(Peaks {
        kinetic,
        potential,
        wheel_kinetic,
        wheel_potential,
    })
}

/// Fourier series of an energy.
struct Series {
    set: HarmonicSet,
    coefficients: Vec<Complex64>,
    packed: Vec<f64>,
    turning_points: TurningPoints,
    extrema: Vec<Extremum>,
}

impl Series {
    /// Memory for the product of two signals of `motion`.
    fn new(motion: &HarmonicSet) -> Result<Self> {
        const CONTEXT: &str = "the energies";
        let highest = motion.numbers().last().copied().unwrap_or(0);
        let set = HarmonicSet::all(2 * highest)?;
        let mut extrema = Vec::new();
        // The derivative has at most this number of roots, a few of them by rounding.
        extrema
            .try_reserve(4 * highest + 4)
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        Ok(Self {
            coefficients: try_vec(2 * highest + 1, Complex64::ZERO, CONTEXT)?,
            packed: try_vec(set.packed_len(), 0.0, CONTEXT)?,
            turning_points: TurningPoints::new(&set)?,
            extrema,
            set,
        })
    }

    /// Sets the series to ½ Σ a(t) b(t) over n degrees of freedom: harmonics h of a and m of b contribute to h + m
    /// and h − m.
    fn set_half_product(
        &mut self,
        numbers: &[usize],
        a: &[Complex64],
        b: &[Complex64],
        n: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        self.coefficients.fill(Complex64::ZERO);
        for (&h, a) in numbers.iter().zip(a.chunks_exact(n)) {
            interrupt.check()?;
            for (&m, b) in numbers.iter().zip(b.chunks_exact(n)) {
                let (mut above, mut below) = (Complex64::ZERO, Complex64::ZERO);
                for (a, b) in a.iter().zip(b) {
                    above += a * b;
                    below += a * b.conj();
                }
                self.coefficients[h + m] += 0.25 * above;
                self.coefficients[h.abs_diff(m)] += 0.25 * if h < m { below.conj() } else { below };
            }
        }
        Ok(())
    }

    /// Turns the series of one sector's energy into that of all sectors.
    fn add_sectors(&mut self, sectors: usize, in_step: usize) {
        for (n, c) in self.coefficients.iter_mut().enumerate() {
            *c = if n % in_step == 0 {
                *c * sectors as f64
            } else {
                Complex64::ZERO
            };
        }
    }

    /// Largest value of the series; its mean if it is constant.
    fn maximum(&mut self, interrupt: &Interrupt<'_>) -> Result<f64> {
        for (i, &c) in self.coefficients.iter().enumerate() {
            self.set.set(&mut self.packed, i, c);
        }
        let found = &mut self.extrema;
        self.turning_points.find(&self.set, &self.packed, found, interrupt)?;
        let largest = self.extrema.iter().map(|e| e.x).fold(f64::NEG_INFINITY, f64::max);
        Ok(largest.max(self.coefficients[0].re))
    }
}
