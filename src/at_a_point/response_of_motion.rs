//! A response of any periodic motion that is given by its harmonics: of a nonlinear mode, a synthesis, an integration in time.

use crate::error::{Result, fail, try_vec};
use crate::fourier::{HarmonicSet, Reader, Reading};
use crate::interrupt::Interrupt;
use crate::options::{Measure, Response};
use num_complex::Complex64;

/// Reads a response of a motion of `ndof` degrees of freedom at `omega`; `x` has its harmonics 0 … H, (H + 1) × ndof
/// numbers, harmonic by harmonic. The fundamental is harmonic 1. Sectors other than 0 are refused, since the motion
/// is that of one sector.
///
/// # Errors
/// `Dimension`, `Argument`, `NotFinite` or those of [`Response::check`]; `OutOfMemory`.
pub fn response_of(response: &Response<'_>, ndof: usize, omega: f64, x: &[Complex64]) -> Result<Reading> {
    response.check(ndof, 1)?;
    if response.dofs.is_empty() {
        return fail!(Argument, "dofs is empty, needs the degrees of freedom of the gauge");
    }
    let rows = x.len() / ndof.max(1);
    if rows == 0 || rows * ndof != x.len() {
        return fail!(
            Dimension,
            "x has {} complex entries, needs (H + 1) * ndof, a multiple of {ndof}",
            x.len()
        );
    }
    if !omega.is_finite() {
        return fail!(NotFinite, "omega = {omega}, needs a finite angular frequency");
    }
    let set = HarmonicSet::all(rows - 1)?;
    let mut packed = try_vec(set.packed_len(), 0.0, "a response")?;
    for (h, motion) in x.chunks_exact(ndof).enumerate() {
        let mut sum = Complex64::ZERO;
        for (k, dof) in response.dofs.iter().enumerate() {
            sum += motion[*dof] * response.weights.get(k).copied().unwrap_or(1.0);
        }
        let rate = Complex64::new(0.0, h as f64 * omega);
        set.set(&mut packed, h, sum * rate.powi(response.component.order()));
    }
    if let Some(i) = packed.iter().position(|x| !x.is_finite()) {
        return fail!(
            NotFinite,
            "the gauge is not finite in number {i} of its packed harmonics"
        );
    }
    let measure = match response.measure {
        Measure::Fundamental => Measure::Harmonic(1),
        other => other,
    };
    Reader::new(&set)?.read(&set, measure, &packed, &Interrupt::none())
}
