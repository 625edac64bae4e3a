//! Harmonics whose coupling the iterative linear system of an extended problem factors.

use crate::harmonics::extended_system::Factored;
use crate::harmonics::work::{Sizes, Work};
use crate::linalg::newton::linear_system::automatic::FACTORED_BLOCK;

/// Factorisations of the block for which the work must suffice.
/// Kind: tuned; measured on: not recorded.
const FACTORISATIONS: f64 = 5.0;

/// Factors the lowest harmonics in one block, as far as it is cheap and the work allows, and each other compliant one
/// by itself.
pub(super) fn factored(sizes: &Sizes, compliant: usize, work: &Work) -> Factored {
    within(sizes, compliant, FACTORED_BLOCK as f64, work)
}

/// Factors all harmonics in one block; `None` if the work does not allow it. This is for contacts far stiffer than
/// their reference stiffness, where the compliant harmonics are not enough.
pub(super) fn whole(sizes: &Sizes, work: &Work) -> Option<Factored> {
    let all = sizes.harmonics();
    Some(within(sizes, all, f64::INFINITY, work)).filter(|found| found.block == all)
}

/// Factors the lowest compliant harmonics in one block of at most the given order.
fn within(sizes: &Sizes, compliant: usize, order: f64, work: &Work) -> Factored {
    let fits = |block: usize| {
        let packed = sizes.packed().min(2.0 * block as f64);
        let pairs = (compliant - block) as f64;
        sizes.order(packed) <= order
            && FACTORISATIONS * sizes.factors(packed, pairs) <= work.left()
            && work.fits(sizes.bytes(packed, pairs))
    };
    let block = (1..=compliant)
        .rev()
        .find(|&block| fits(block))
        .unwrap_or(compliant.min(1));
    Factored { block, each: compliant }
}
