//! Factors of K + σM for a shift: a given one, or one below all eigenvalues of the pencil.

use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::hermitian;
use crate::linalg::factors::cholesky::Definite;
use crate::linalg::factors::factor::Factor;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use num_complex::Complex64;

/// Growth of the shift from one attempt to the next, number of attempts, and of halvings of the last growth.
/// Kind: tuned; measured on: not recorded.
const FURTHER: f64 = 100.0;
/// Number of attempts to shift.
/// Kind: cap.
const SHIFTED_INVERSE_ATTEMPTS: i32 = 9;
const HALVINGS: u32 = 5;

/// The inverse of K + σM at a shift −σ below all eigenvalues.
pub(crate) struct BelowAll {
    pub inverse: Inverse,
    pub shift: f64,
    pub place: Place,
}

/// Position of the shift among the eigenvalues.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Next to zero; all eigenvalues are above it.
    First,
    /// Below a negative eigenvalue; all eigenvalues are above it.
    Further,
    /// Next to zero, with eigenvalues below it: K is negative on motions without mass, too.
    Within,
    /// Between eigenvalues of the pencil.
    Inside,
}

/// Finds a shift below all eigenvalues, starting from `shift`, so that the lowest eigenvalues belong to the largest
/// ones of the operator also where K is negative in some direction.
pub(crate) fn below_all(k: &Csc, m: &Csc, shift: f64, interrupt: &Interrupt<'_>) -> Result<BelowAll> {
    let factors = |sigma: f64| definite_inverse(k, sigma, m, interrupt);
    if let Some(inverse) = factors(shift)? {
        let place = Place::First;
        return Ok(BelowAll { inverse, shift, place });
    }
    for attempt in 1..SHIFTED_INVERSE_ATTEMPTS {
        let mut high = shift * FURTHER.powi(attempt);
        let Some(mut inverse) = factors(high)? else { continue };
        // Next to the lowest eigenvalue, the others are far apart.
        let mut low = high / FURTHER;
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            match factors(middle)? {
                Some(better) => (inverse, high) = (better, middle),
                None => low = middle,
            }
        }
        return Ok(BelowAll {
            inverse,
            shift: high,
            place: Place::Further,
        });
    }
    let inverse = Inverse::new(k, (shift, m), interrupt)?;
    Ok(BelowAll {
        inverse,
        shift,
        place: Place::Within,
    })
}

/// The inverse of K + σM; `None` where this matrix is not positive definite.
pub(crate) fn definite_inverse(k: &Csc, shift: f64, m: &Csc, interrupt: &Interrupt<'_>) -> Result<Option<Inverse>> {
    let n = k.rows;
    if n > SHIFTED_INVERSE_DENSE_UP_TO {
        return Ok(Definite::new(k, (shift, m), interrupt)?.map(Inverse::Definite));
    }
    let mut dense = try_vec(n * n, Complex64::ZERO, "the natural modes")?;
    k.add_to_dense(Complex64::ONE, &mut dense);
    m.add_to_dense(shift.into(), &mut dense);
    if hermitian::cholesky(&mut dense, n, interrupt)? {
        return Inverse::new(k, (shift, m), interrupt).map(Some);
    }
    Ok(None)
}

/// Order up to which dense factors are quicker.
/// Kind: tuned; measured on: not recorded.
const SHIFTED_INVERSE_DENSE_UP_TO: usize = 200;

/// Factors of K + σM.
pub enum Inverse {
    /// Factors of a definite matrix, in at most half the memory.
    Definite(Definite),
    /// Factors of a small matrix, or an indefinite one as with springs of negative stiffness.
    General(Factor),
}

impl Inverse {
    /// Factors K + σM.
    ///
    /// # Errors
    /// `Singular`, `OutOfMemory`; `StoppedByCaller`.
    pub fn new(k: &Csc, (shift, m): (f64, &Csc), interrupt: &Interrupt<'_>) -> Result<Self> {
        if k.rows > SHIFTED_INVERSE_DENSE_UP_TO
            && let Some(definite) = Definite::new(k, (shift, m), interrupt)?
        {
            return Ok(Self::Definite(definite));
        }
        let shifted = Csc::sum(
            k.rows,
            &[(Complex64::ONE, k, Form::Plain), (shift.into(), m, Form::Plain)],
        )?;
        interrupt.check()?;
        let mut factor = Factor::new(&shifted, 1)?;
        factor.factor(&shifted, interrupt)?;
        Ok(Self::General(factor))
    }

    /// Solves (K + σM) x = b in place.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn solve(&mut self, b: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        match self {
            Self::Definite(factor) => factor.solve(b, interrupt),
            Self::General(factor) => factor.solve(b, false, interrupt),
        }
    }
}
