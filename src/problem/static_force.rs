//! Forces of laws at rest, evaluated where the description of a contact does not determine them.

use crate::aft::{Evaluation, Evaluator};
use crate::condense::Condensed;
use crate::contact::{Form, Law};
use crate::error::{Result, fail, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;

/// The first contact whose force at zero motion is not zero, at the angular frequency `omega`. A law that cannot be
/// evaluated at zero motion is skipped.
///
/// # Errors
/// `Argument` for a law that is declared odd and has a force at zero motion; those of callbacks.
pub fn static_force(
    condensed: &Condensed,
    omega: f64,
    samples: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Option<usize>> {
    // `Contact::is_preloaded` decides for the other laws.
    let needs_evaluation = |law: &dyn Law| matches!(law.form(), Form::Memoryless(_) | Form::Hysteretic(_));
    let set = HarmonicSet::all(0)?;
    let laws = || {
        condensed
            .laws()
            .iter()
            .filter(|assembled| needs_evaluation(&*assembled.law))
    };
    // The memory of the samples is requested where a law needs it.
    if laws().next().is_none() {
        return Ok(None);
    }
    let mut evaluator = Evaluator::new(&set, samples, laws().map(|assembled| &*assembled.law))?;
    let mut found: Vec<Evaluation> = Vec::new();
    for assembled in laws() {
        let d = assembled.law.directions();
        let at = if let Some(at) = found.iter().position(|e| e.directions == d) {
            at
        } else {
            try_push(&mut found, Evaluation::new(&set, d)?, "the contact forces")?;
            found.len() - 1
        };
        let rest = try_vec(d, 0.0, "the contact forces")?;
        let contact = assembled.contact;
        interrupt.check()?;
        match evaluator.evaluate(&*assembled.law, &set, &rest, omega, &mut found[at], interrupt) {
            Err(e) if e.recoverable => continue,
            Err(e) => return Err(e.at(format_args!("contact {contact} at rest"))),
            Ok(()) => {}
        }
        if let Some(force) = found[at].force.iter().find(|f| **f != 0.0) {
            if assembled.law.is_odd() {
                return fail!(
                    Argument,
                    "contact {contact}: its force is said to be odd, but is {} at rest",
                    force * condensed.length()
                );
            }
            return Ok(Some(contact));
        }
    }
    Ok(None)
}
