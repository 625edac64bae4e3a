//! The terms of the contact forces in a harmonic of the residual where contacts are many: G w in the residual, and G′ w + G ∂f/∂p in its
//! derivative by the parameter, each as the product of a matrix with a vector.

use crate::condense::Condensed;
use crate::condense::frequency_cache::FrequencyCache;
use crate::linalg::dense::complex_columns;
use crate::problem::contact_forces::ContactForces;
use crate::problem::homotopy::Path;
use crate::problem::parametric_problem::{Residual, put};
use num_complex::Complex64;

/// Adds the terms of the i-th harmonic at the motion `u`, along a path or by the frequency, with the derivative where the tables have
/// slopes; returns the square of their rounding. The memory has one number per coordinate.
pub(super) fn add_products(
    (forces, tables, condensed): (&ContactForces<'_>, &FrequencyCache, &Condensed),
    i: usize,
    (u, path, has_slopes): (&[f64], Option<(Path, f64)>, bool),
    (sum, [z, memory]): (&mut [Complex64], &mut [Vec<Complex64>; 2]),
    out: &mut Residual,
) -> f64 {
    let set = condensed.set();
    let (at, m, mean) = (set.offset(i), set.packed_len(), set.numbers()[i] == 0);
    let stride = condensed.coordinates() + 1;
    let table = &tables.current()[i];
    let mut add = |matrix: &[Complex64], z: &[Complex64], to: &mut [f64]| {
        complex_columns::multiply(matrix, stride, z, sum, memory);
        for (c, sum) in sum.iter().enumerate() {
            put(to, c * m + at, mean, *sum);
        }
    };
    let mut rounding = 0.0;
    for ((c, z), column) in z.iter_mut().enumerate().zip(table.value.chunks_exact(stride)) {
        *z = Complex64::ZERO;
        if forces.is_inactive(c) {
            continue;
        }
        *z = forces.minus_reference(u, c, i);
        let lost = forces.rounding(c);
        if lost > 0.0 {
            let size: f64 = column[..stride - 1].iter().map(Complex64::norm_sqr).sum();
            rounding += lost * lost * size;
        }
    }
    add(&table.value, z, &mut out.values);
    if !has_slopes {
        return rounding;
    }
    if path.is_none() && !tables.lacks_slopes_of(i) {
        add(&table.slope, z, &mut out.d_parameter);
    }
    let mut depends = false;
    for (c, z) in z.iter_mut().enumerate() {
        *z = match path {
            _ if forces.is_inactive(c) => Complex64::ZERO,
            None => forces.by_omega(c, i),
            Some((Path::ScaledLaws, _)) => forces.d_ln_scale(c, i),
            Some((Path::Stiffening, _)) => forces.d_ln_stiffening(c, i),
            Some((Path::GrowingLoad | Path::FromTangents, _)) => Complex64::ZERO,
        };
        depends |= *z != Complex64::ZERO;
    }
    if depends {
        add(&table.value, z, &mut out.d_parameter);
    }
    rounding
}
