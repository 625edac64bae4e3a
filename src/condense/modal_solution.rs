//! Numbers that a solution from modes needs at a frequency, and where it goes.

use num_complex::Complex64;

/// c and s, or their derivatives.
#[derive(Clone, Copy)]
pub(super) struct Pair {
    pub c: Complex64,
    pub s: Complex64,
}

/// Where the solution and its derivatives go: Z⁻¹ Wᴴ column after column, x, ∂x/∂ω and ∂x/∂D of all degrees of freedom, of
/// which x alone unless `is_whole`; and the relative motions of all these, in this order.
pub(super) struct Solution<'a> {
    pub is_whole: bool,
    pub relative: &'a mut [Complex64],
    pub columns: &'a mut [Complex64],
    pub x: &'a mut [Complex64],
    pub by_omega: &'a mut [Complex64],
    pub by_damping: &'a mut [Complex64],
}
