//! The check of a stop while a signal is evaluated at many times.

use crate::error::Result;
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;

/// Times between two checks of a stop, and operations of a harmonic at one time.
/// Kind: block.
const SIGNAL_CHECK_BETWEEN_CHECKS: usize = 256;
const OF_ONE_JET: usize = 10;

/// Checks for a stop now and then, before the j-th value of a signal.
pub(crate) fn check_time(interrupt: &Interrupt<'_>, j: usize, set: &HarmonicSet) -> Result<()> {
    if j.is_multiple_of(SIGNAL_CHECK_BETWEEN_CHECKS) {
        interrupt.check_before((SIGNAL_CHECK_BETWEEN_CHECKS * OF_ONE_JET * (set.numbers().len() + 1)) as u64)?;
    }
    Ok(())
}
