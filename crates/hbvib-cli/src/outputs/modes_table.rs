//! The table of natural frequencies.

use crate::building::build::built;
use crate::job_file::job::Job;
use crate::print;
use crate::texts::outcome::Outcome;
use hbvib::ContactState;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

/// Number of natural frequencies that are listed.
const LISTED: usize = 10;

/// Prints the table.
///
/// # Errors
/// A sentence; with `strict` also where there are warnings.
pub fn modes(path: &Path, strict: bool) -> Outcome<u8> {
    let job = Job::read(path)?;
    let built = built(&job)?;
    built.warn(strict)?;
    let model = built.model;
    let mut text = String::from("diameter,mode,free_hz,stuck_hz\n");
    // A row of a diameter stands for both senses where they have the same modes.
    let least = if model.has_equal_senses() { 0 } else { i64::MIN };
    for diameter in model.structure().all_diameters().filter(|d| *d >= least) {
        let count = LISTED.min(model.structure().ndof());
        let of = |state| {
            let modes = model.lowest_modes(diameter, state, count);
            modes
                .map(|modes| modes.omega)
                .map_err(|e| format!("diameter {diameter}: {e}"))
        };
        let (free, stuck) = (of(ContactState::Free)?, of(ContactState::Stuck)?);
        for (i, (a, b)) in free.iter().zip(&stuck).enumerate() {
            let _ = writeln!(text, "{diameter},{i},{:.10e},{:.10e}", a / TAU, b / TAU);
        }
    }
    print(&text)?;
    Ok(0)
}
