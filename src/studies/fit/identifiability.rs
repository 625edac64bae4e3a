//! Whether the data tell every unknown, in words.

use crate::contact::forms::constants::Constant;
use crate::error::{Result, fail, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::hermitian::eigen;
use crate::sensitivity::Parameter;
use crate::studies::fit::fit_unknowns::{Named, Unknowns};
use num_complex::Complex64;

const CONTEXT: &str = "what the data tell";

/// Information on an unknown, over the square of its value, below which no datum sees it.
/// Kind: rounding.
const FIT_UNSEEN: f64 = 1e-10;

/// Smallest eigenvalue of the matrix with unit diagonal below which only combinations are seen.
/// Kind: rounding.
const FIT_COMBINED: f64 = 1e-11;

/// Logarithm of the start over an unknown from which the search takes it to zero.
/// Kind: tuned; measured on: fits of noisy responses whose best damping is none, which end at 1e-5 and less of their start.
const FIT_VANISHED: f64 = 7.0;

/// Share of an eigenvector from which an unknown belongs to a combination.
/// Kind: tuned; measured on: not recorded.
const FIT_SHARE: f64 = 0.1;

/// Condition of the fit: largest over smallest eigenvalue of the matrix H, scaled to unit diagonal.
///
/// # Errors
/// `Singular` with a sentence where an unknown, or a combination of some, is not seen; `OutOfMemory`.
pub(super) fn condition(
    h: &[f64],
    (unknowns, parameters): (&Unknowns, &[Parameter<'_>]),
    (z, slips, moves): (&[f64], &[bool], &[bool]),
    interrupt: &Interrupt<'_>,
) -> Result<f64> {
    let n = z.len();
    for k in (0..n).filter(|k| moves[*k]) {
        let free = &unknowns.free[k];
        let size = if free.is_log {
            1.0
        } else {
            z[k].abs().max(free.start.abs())
        };
        let size = if size == 0.0 { 1.0 } else { size };
        if h[k * n + k] * size * size >= FIT_UNSEEN {
            continue;
        }
        let parameter = &parameters[free.parameter];
        let name = Named(parameter);
        if let Parameter::Contact {
            constant: Constant::Mu | Constant::Preload,
            contact,
        } = parameter
        {
            let sticks = contact.map_or(!slips.contains(&true), |id| !slips[id]);
            if sticks {
                return fail!(
                    Singular,
                    "the data do not tell {name}: all points stick there, and only kt is seen; measure with larger forces, or fix it"
                );
            }
        }
        if free.is_log && z[k] < free.start - FIT_VANISHED {
            return fail!(
                Singular,
                "the data are met best with {name} at zero, to which the search goes ({:.1e} here): give it a lower bound, fix it, or give it a \
                 prior",
                z[k].exp()
            );
        }
        return fail!(
            Singular,
            "the data do not tell {name}: no point depends on it; fix it, or give it a prior"
        );
    }
    let mut a = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    for i in 0..n {
        for j in 0..n {
            a[j * n + i] = match (moves[i] && moves[j], i == j) {
                (true, _) => (h[i * n + j] / (h[i * n + i] * h[j * n + j]).sqrt()).into(),
                (false, true) => Complex64::ONE,
                (false, false) => Complex64::ZERO,
            };
        }
    }
    let (values, vectors) = eigen(&mut a, n, interrupt)?;
    let least = (0..n).min_by(|i, j| values[*i].total_cmp(&values[*j])).unwrap_or(0);
    let largest = values.iter().fold(0.0_f64, |a, b| a.max(*b));
    if values[least] > FIT_COMBINED * largest {
        return Ok(largest / values[least]);
    }
    let mut shares = (0..n).filter(|k| vectors[least * n + k].norm() > FIT_SHARE);
    let name = |k: usize| Named(&parameters[unknowns.free[k].parameter]);
    match (shares.next(), shares.next(), shares.next()) {
        (Some(a), Some(b), None) => fail!(
            Singular,
            "the data tell only a combination of {} and {}, as their product; fix one of them, or give it a prior",
            name(a),
            name(b)
        ),
        (Some(a), Some(b), Some(c)) => fail!(
            Singular,
            "the data tell only combinations of {}, {}, {} and perhaps others; fix one of them, or give it a prior",
            name(a),
            name(b),
            name(c)
        ),
        _ => fail!(
            Singular,
            "the data do not tell all unknowns; fix one, or give it a prior"
        ),
    }
}
