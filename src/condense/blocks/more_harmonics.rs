//! A condensed model with more harmonics than another one, whose matrices, scale and laws it shares.

use crate::condense::Condensed;
use crate::condense::blocks::harmonic_block::{harmonic_block, of_same_wave, shared_block};
use crate::condense::blocks::memory_limit::{within_directly, within_matrices};
use crate::condense::blocks::relative_coordinates::assign_coordinates;
use crate::condense::condensation::{carried, forced_harmonics, quicker_reference};
use crate::condense::tuned_wheel::tuned_plan::TunedPlan;
use crate::error::{Result, try_copy, try_push};
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::SolverOptions;
use std::sync::Arc;

const CONTEXT: &str = "the matrices per harmonic";

/// The model of a forced response with the harmonics of `options`, no fewer than these; `None` where the structure is on
/// bases, or another reference stiffness is quicker.
///
/// # Errors
/// As [`Condensed::new`].
pub(crate) fn with_more_harmonics(
    condensed: &Condensed,
    model: &Model,
    options: &SolverOptions,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Condensed>> {
    let active = &condensed.contacts.classes.active;
    let set = carried(model, options, &forced_harmonics(model, options)?, active)?;
    let unknowns = condensed.coordinates() * set.packed_len();
    if condensed.is_reduced() || quicker_reference(model, unknowns) != condensed.reference {
        return Ok(None);
    }
    if condensed.wave.tuned.is_some() {
        within_matrices(options.memory_limit, model, set.numbers())?;
    } else {
        within_directly(options.memory_limit, model, set.numbers())?;
    }
    let (_, representatives) = assign_coordinates(model, active, interrupt)?;
    let contacts = (&condensed.contacts.classes, &representatives[..]);
    let kappa = |c: usize, number: usize| {
        condensed
            .reference
            .kappa(condensed.contacts.reference_stiffness[c], number)
    };
    let mut blocks = Vec::new();
    for (i, &number) in set.numbers().iter().enumerate() {
        interrupt.part(Phase::Condensation, i, set.numbers().len())?;
        let known = of_same_wave(model, number, &condensed.blocks.iter().chain(&blocks));
        let mut block = match known {
            Some(known) => shared_block(model, number, known, contacts, kappa)?,
            None => harmonic_block(model, number, contacts, |c| kappa(c, number), interrupt)?,
        };
        if let Some(own) = condensed.blocks.iter().find(|own| own.number == number) {
            block.load.force.copy_from_slice(&own.load.force);
            let unbalance = own.load.unbalance.as_ref();
            block.load.unbalance = unbalance.map(|f| try_copy(f, CONTEXT)).transpose()?;
        }
        try_push(&mut blocks, block, CONTEXT)?;
    }
    let tuned = match (&condensed.wave.tuned, condensed.wave.wheel) {
        (Some(_), Some((sectors, _))) => TunedPlan::new(&blocks, sectors, interrupt)?.map(Arc::new),
        _ => None,
    };
    let mut more = condensed.with_blocks(set, blocks)?;
    more.wave.tuned = tuned;
    more.refinement = options.refinement;
    Ok(Some(more))
}

#[cfg(test)]
mod tests {
    use crate::condense::Condensed;
    use crate::condense::blocks::more_harmonics::with_more_harmonics;
    use crate::condense::by_factors::flexibility::Workspace;
    use crate::condense::test_chains::{DAMPED, chain};
    use crate::contact::Contact;
    use crate::interrupt::Interrupt;
    use crate::options::SolverOptions;

    #[test]
    fn a_model_with_more_harmonics_is_the_one_condensed_with_them() {
        let interrupt = Interrupt::none();
        for (sectors, (damping, loss_factor)) in [1, 9, 24].into_iter().flat_map(|n| DAMPED.map(|d| (n, d))) {
            let mut model = chain(sectors, damping);
            model.set_loss_factor(loss_factor).unwrap();
            // A mean, and so many unknowns that one reference stiffness suits all.
            model
                .add_contact(&Contact::unilateral(None, Some(2), 3.0, 0.1))
                .unwrap();
            let options = |harmonics| SolverOptions {
                harmonics,
                ..SolverOptions::default()
            };
            let condensed = |harmonics| Condensed::new(&model, &options(harmonics), 0.7, &interrupt).unwrap();
            let (few, many) = (condensed(9), condensed(24));
            let more = with_more_harmonics(&few, &model, &options(24), &interrupt).unwrap();
            let Some(more) = more else {
                assert_ne!(few.reference(), many.reference());
                continue;
            };
            assert_eq!(more.set().numbers(), many.set().numbers());
            assert_eq!(more.length().to_bits(), many.length().to_bits());
            let [mut a, mut b] = [&more, &many].map(|of| Workspace::new(of, Some(4)).unwrap());
            for (i, (own, block)) in more.blocks().iter().zip(many.blocks()).enumerate() {
                assert_eq!(own.load.force, block.load.force);
                let table = a.evaluate(&more, i, 0.8, true, &interrupt).unwrap();
                let exact = b.evaluate(&many, i, 0.8, true, &interrupt).unwrap();
                let parts = [(&table.value, &exact.value), (&table.slope, &exact.slope)];
                for (part, exact) in parts {
                    let size = exact.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
                    for (z, exact) in part.iter().zip(exact) {
                        assert!((z - exact).norm() <= 1e-12 * size, "{sectors}, {damping:?}, block {i}");
                    }
                }
            }
        }
    }
}
