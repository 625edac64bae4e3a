//! The terms of a flexibility that is a sum: the modes of a wave, or its poles where damping couples the modes.

use crate::condense::by_modes::wave_modes::WaveModes;
use crate::condense::by_modes::wave_poles::WavePoles;
use num_complex::Complex64;
use std::sync::Arc;

/// Terms by which the flexibility is a sum.
#[derive(Clone, Debug)]
pub enum Source {
    /// Modes, with denominators d = 1 + c − s μ, s = ν² − iνα, c = i(νβ + η).
    Modes(Arc<WaveModes>),
    /// Poles, with denominators d = 1 − s μ, s = iν.
    Poles(Arc<WavePoles>),
}

/// Coefficients a and b of the denominators d = a − b μ at a frequency, with their derivatives by it, and iν for
/// dashpots beside modal damping.
#[derive(Clone, Copy)]
pub struct Denominator {
    pub a: Complex64,
    pub d_a: Complex64,
    pub b: Complex64,
    pub d_b: Complex64,
    pub i_nu: Complex64,
    pub d_i_nu: Complex64,
}

/// Factors of the low-rank term: c of the damping by stiffness, 1 + c = a, and iν of the dashpots.
#[derive(Clone, Copy)]
pub struct Factors {
    pub c: Complex64,
    pub i_nu: Complex64,
}

/// Factors of the low-rank term at a frequency, and their derivatives by it.
#[derive(Clone, Copy)]
pub struct Frequency {
    pub at: Factors,
    pub slope: Factors,
}

impl Factors {
    /// Factors for damping by stiffness alone, without dashpots.
    pub fn of_stiffness(c: Complex64) -> Self {
        Self {
            c,
            i_nu: Complex64::ZERO,
        }
    }
}

impl Denominator {
    /// Factors of the low-rank term and their derivatives.
    pub(crate) fn frequency(self) -> Frequency {
        Frequency {
            at: Factors {
                c: self.a - 1.0,
                i_nu: self.i_nu,
            },
            slope: Factors {
                c: self.d_a,
                i_nu: self.d_i_nu,
            },
        }
    }
}

impl Source {
    pub fn is(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Modes(a), Self::Modes(b)) => Arc::ptr_eq(a, b),
            (Self::Poles(a), Self::Poles(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }

    /// Whether stiffness damps the wave, so that the part of K_κ that belongs to no structure counts.
    pub fn is_damped_by_stiffness(&self) -> bool {
        match self {
            Self::Modes(modes) => modes.is_damped_by_stiffness(),
            Self::Poles(_) => false,
        }
    }

    /// Number of modes or poles.
    pub fn len(&self) -> usize {
        match self {
            Self::Modes(modes) => modes.values.len(),
            Self::Poles(poles) => poles.values.len(),
        }
    }

    /// Value μ of the k-th mode or pole.
    pub fn value(&self, k: usize) -> Complex64 {
        match self {
            Self::Modes(modes) => modes.values[k].into(),
            Self::Poles(poles) => poles.values[k],
        }
    }

    /// Shapes and adjoint shapes, column after column; both are the same for modes.
    pub fn shapes(&self) -> (&[Complex64], &[Complex64]) {
        match self {
            Self::Modes(modes) => (&modes.vectors, &modes.vectors),
            Self::Poles(poles) => (&poles.shapes, &poles.adjoints),
        }
    }

    /// Coefficients of the denominators in harmonic h at the angular frequency ω.
    pub fn denominator(&self, h: f64, omega: f64) -> Denominator {
        let nu = h * omega;
        let i = |x: f64| Complex64::new(0.0, x);
        match self {
            Self::Modes(modes) => {
                let (alpha, beta) = modes.proportional;
                Denominator {
                    a: Complex64::new(1.0, nu * beta + modes.loss_factor),
                    d_a: i(h * beta),
                    b: Complex64::new(nu * nu, -nu * alpha),
                    d_b: h * Complex64::new(2.0 * nu, -alpha),
                    i_nu: i(nu),
                    d_i_nu: i(h),
                }
            }
            Self::Poles(_) => Denominator {
                a: Complex64::ONE,
                d_a: Complex64::ZERO,
                b: i(nu),
                d_b: i(h),
                i_nu: i(nu),
                d_i_nu: i(h),
            },
        }
    }

    /// Computes 1/d of all terms at ν, and −∂d/d². Returns `false` where a denominator is small: for modes, whose μ
    /// have all digits, below `near`.
    pub fn invert(
        &self,
        (at, nu, near): (Denominator, f64, f64),
        inverse: &mut [Complex64],
        slopes: &mut [Complex64],
    ) -> bool {
        let is_clear = match self {
            Self::Modes(modes) => modes.invert((at.a - 1.0, at.b), (nu, near), inverse),
            Self::Poles(poles) => poles.invert(nu, inverse),
        };
        for (k, (slope, inverse)) in slopes.iter_mut().zip(inverse).enumerate() {
            *slope = -(at.d_a - at.d_b * self.value(k)) * *inverse * *inverse;
        }
        is_clear
    }
}
