//! Numbers of the matrices that are factored: real or complex.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use nalgebra::ComplexField;
use num_complex::Complex64;
use pulp::bytemuck::{cast_slice, cast_slice_mut};

/// Scalars of the matrices: `f64` and [`Complex64`].
pub trait Scalar: ComplexField<RealField = f64> + faer::traits::ComplexField + Copy {
    /// Size |re| + |im|: as good as the modulus for choosing a pivot, and cheaper.
    fn size(self) -> f64;

    /// The number times i; a real number, which needs no turn, is returned as it is.
    #[must_use]
    fn turned(self) -> Self;

    /// y ← y − x l, where `turned` is i x: complex products by real ones on the numbers as they lie in memory, to the
    /// same digits.
    fn subtract(y: &mut [Self], x: &[Self], turned: &[Self], l: Self);
}

impl Scalar for f64 {
    #[inline]
    fn size(self) -> f64 {
        self.abs()
    }

    #[inline(always)]
    fn turned(self) -> Self {
        self
    }

    #[inline(always)]
    fn subtract(y: &mut [Self], x: &[Self], _turned: &[Self], l: Self) {
        for (y, x) in y.iter_mut().zip(x) {
            *y -= x * l;
        }
    }
}

impl Scalar for Complex64 {
    #[inline]
    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }

    #[inline(always)]
    fn turned(self) -> Self {
        Self::new(-self.im, self.re)
    }

    #[inline(always)]
    fn subtract(y: &mut [Self], x: &[Self], turned: &[Self], l: Self) {
        let (y, x): (&mut [f64], &[f64]) = (cast_slice_mut(y), cast_slice(x));
        for ((y, x), turned) in y.iter_mut().zip(x).zip(cast_slice::<_, f64>(turned)) {
            *y -= x * l.re + turned * l.im;
        }
    }
}
