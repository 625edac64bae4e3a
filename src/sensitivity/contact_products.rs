//! Products of the adjoint motion of a contact with the parts of its force from which derivatives by constants follow.

use crate::aft::{Evaluation, Evaluator};
use crate::condense::Condensed;
use crate::contact::forms::force_derivative::{Combination, ForceDerivative};
use crate::contact::{Contact, Law, Role};
use crate::error::{Result, fail, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::{add_product, dot};
use crate::model::Model;
use crate::model::matrices::wave::Wave;
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use crate::sensitivity::sampled_model::SampledModel;
use std::sync::Arc;

/// Products with the forces along the tangential directions and along the normal, by which derivatives follow.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ContactProducts {
    tangential: Combination,
    normal: Combination,
}

/// A contact at a solution: its law, and its packed motions in the solver's units, direction after direction.
pub(super) struct ContactMotion {
    /// The law in the solver's units; `None` for a contact without relative coordinates.
    pub law: Option<Arc<dyn Law>>,
    pub motion: Vec<f64>,
    /// Packed adjoint motions of the contact.
    pub field: Vec<f64>,
    /// Index of the normal direction; `None` without one.
    normal: Option<usize>,
}

impl ContactMotion {
    /// A contact of `model`, which is the model at the frequency of the solution.
    ///
    /// # Errors
    /// Those of the constants; `OutOfMemory`.
    pub fn new(model: &Model, number: usize, condensed: &Condensed, adjoint: &Adjoint) -> Result<Self> {
        let contact = &model.contacts()[number];
        let m = condensed.set().packed_len();
        let size = m.saturating_mul(contact.directions());
        let mut motion = try_vec(size, 0.0, CONTEXT)?;
        let mut field = try_vec(size, 0.0, CONTEXT)?;
        for k in 0..contact.directions() {
            let relative = model.structure().contact_motion(contact, k);
            let row = |h| model.structure().row(&relative, Wave::Harmonic(h));
            let range = k * m..(k + 1) * m;
            adjoint.relative_motion(condensed, row, (&mut motion[range.clone()], &mut field[range]));
        }
        for y in &mut motion {
            *y /= condensed.length();
        }
        let mut laws = condensed.laws().iter();
        let assembled = laws.find(|assembled| assembled.contact == number);
        if let Some(assembled) = assembled {
            // The relative motions of the solution, not the difference of large motions.
            for (k, &c) in assembled.coordinates.iter().enumerate() {
                motion[k * m..(k + 1) * m].copy_from_slice(&adjoint.relative[c * m..(c + 1) * m]);
            }
        }
        Ok(Self {
            law: match assembled {
                Some(_) => Some(contact.law(condensed.length())?),
                None => None,
            },
            motion,
            field,
            normal: contact.normal_direction(),
        })
    }

    /// Computes the products, by an evaluation of the law at the motion.
    ///
    /// # Errors
    /// Those of the law; `StoppedByCaller`.
    pub fn products(
        &self,
        contact: &Contact,
        solution: SampledModel<'_>,
        omega: f64,
        interrupt: &Interrupt<'_>,
    ) -> Result<ContactProducts> {
        let condensed = solution.condensed;
        let set = condensed.set();
        let m = set.packed_len();
        let mut products = ContactProducts::default();
        let length = condensed.length();
        let size = self.motion.len();
        let evaluation = match &self.law {
            Some(law) => Some(evaluate(&**law, solution, omega, &self.motion, interrupt)?),
            None if contact.role() == Role::Active => {
                return fail!(Internal, "an active contact has no relative motion");
            }
            None => None,
        };
        let slider = contact.slider().map(|w| w / length);
        // J x over the tangential motions, J y over the normal one, J e of a unit normal motion, J e of unit motions along t1
        // and t2.
        let mut parts = [(); 5].map(|()| Vec::new());
        for part in &mut parts {
            *part = try_vec(size, 0.0, CONTEXT)?;
        }
        if let Some(found) = &evaluation {
            for (k, y) in self.motion.chunks_exact(m).enumerate() {
                let columns = &found.jacobian[k * m * size..(k + 1) * m * size];
                let normal = self.normal == Some(k);
                add_product(1.0, columns, y, &mut parts[usize::from(normal)]);
                if normal && set.has_mean() {
                    parts[2].copy_from_slice(&columns[..size]);
                } else if k < contact.sliders() && set.has_mean() {
                    // Motions count from the slider's place before any motion.
                    parts[3 + k].copy_from_slice(&columns[..size]);
                    for (part, column) in parts[0].iter_mut().zip(columns) {
                        *part -= slider[k] * column;
                    }
                }
            }
        }
        for (k, field) in self.field.chunks_exact(m).enumerate() {
            let range = k * m..(k + 1) * m;
            let along = |values: &[f64]| dot(field, &values[range.clone()]);
            let mut own = Combination {
                motion: length * along(&self.motion),
                ..Combination::ZERO
            };
            if let Some(found) = &evaluation {
                own.by_tangential = length * along(&parts[0]);
                own.force = length * along(&found.force);
                own.by_slider = [along(&parts[3]), along(&parts[4])];
                if self.normal == Some(k) || !found.stuck {
                    own.by_normal = length * along(&parts[1]);
                    own.by_shift = along(&parts[2]);
                    own.offset = length * along(&found.offset);
                    for (k, w) in slider.iter().enumerate() {
                        own.offset += w * length * own.by_slider[k];
                    }
                }
            }
            let sum = if self.normal == Some(k) {
                &mut products.normal
            } else {
                &mut products.tangential
            };
            *sum = sum.plus(&own);
        }
        Ok(products)
    }
}

impl ContactProducts {
    /// The product with the derivative of the force by a constant.
    pub fn with(&self, derivative: &ForceDerivative) -> f64 {
        self.tangential.times(&derivative.tangential) + self.normal.times(&derivative.normal)
    }
}

/// A law at packed motions in the solver's units.
pub(super) fn evaluate(
    law: &dyn Law,
    SampledModel { condensed, samples }: SampledModel<'_>,
    omega: f64,
    motion: &[f64],
    interrupt: &Interrupt<'_>,
) -> Result<Evaluation> {
    let set = condensed.set();
    let motion = try_copy(motion, CONTEXT)?;
    let mut evaluator = Evaluator::refined(set, (samples, condensed.refinement()), core::iter::once(law))?;
    let mut found = Evaluation::new(set, law.directions())?;
    if law.directions() == 1 {
        evaluator.prepare(set, &motion, interrupt)?;
    }
    evaluator.evaluate(law, set, &motion, omega, &mut found, interrupt)?;
    Ok(found)
}
