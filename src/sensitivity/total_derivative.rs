//! The total derivative of a result by each parameter, from its adjoint.

use crate::contact::forms::constants::Constant;
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use crate::sensitivity::contact_products::{ContactMotion, ContactProducts};
use crate::sensitivity::parameter::{Parameter, Reason};
use crate::sensitivity::sampled_model::SampledModel;
use crate::sensitivity::structure_products::{WaveMatrices, with_direction, with_speed, with_whole};
use num_complex::Complex64;

/// Derivatives of one result. Products with a contact are computed once for all its constants.
pub(crate) struct TotalDerivative<'a> {
    /// The model of the caller; and this model at the frequency of the solution.
    model: &'a Model,
    at_frequency: &'a Model,
    solution: SampledModel<'a>,
    adjoint: &'a Adjoint,
    products: Vec<Option<ContactProducts>>,
    matrices: WaveMatrices,
    interrupt: &'a Interrupt<'a>,
}

impl<'a> TotalDerivative<'a> {
    /// Begins the derivatives of a result; the products of contacts follow when they are needed.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(
        model: &'a Model,
        at_frequency: &'a Model,
        solution: SampledModel<'a>,
        adjoint: &'a Adjoint,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        Ok(Self {
            model,
            at_frequency,
            solution,
            adjoint,
            products: try_vec(model.contacts().len(), None, CONTEXT)?,
            matrices: WaveMatrices::default(),
            interrupt,
        })
    }

    /// Uses matrices that were made for other results of the model.
    pub fn with_matrices(self, matrices: WaveMatrices) -> Self {
        Self { matrices, ..self }
    }

    /// Hands out the matrices, for further results of the model.
    pub fn into_matrices(self) -> WaveMatrices {
        self.matrices
    }

    /// The derivative by a parameter that [`Parameter::check`] accepts; NaN with a reason where there is none.
    ///
    /// # Errors
    /// Those of the matrices and laws; `OutOfMemory`; `StoppedByCaller`.
    pub fn by(&mut self, parameter: &Parameter<'_>) -> Result<(f64, Reason)> {
        self.interrupt.check()?;
        let (model, condensed, adjoint) = (self.at_frequency, self.solution.condensed, self.adjoint);
        let value = match parameter {
            Parameter::Force => self.by_force()?,
            Parameter::Contact { constant, contact } => {
                let numbers = match contact {
                    Some(number) => *number..*number + 1,
                    None => 0..model.contacts().len(),
                };
                let mut sum = 0.0;
                for number in numbers {
                    match self.by_constant(number, *constant)? {
                        Some(value) => sum += value,
                        None => return Ok((f64::NAN, Reason::ZeroConstant)),
                    }
                }
                sum
            }
            Parameter::Direction { which, direction } => -with_direction(model, condensed, adjoint, *which, direction)?,
            Parameter::Factor { which } => -with_whole(model, condensed, adjoint, *which, &mut self.matrices)?,
            Parameter::Speed => {
                let Speed::Fixed(speed) = self.model.speed() else {
                    return Ok((f64::NAN, Reason::ZeroConstant));
                };
                let mut sum = -with_speed(model, condensed, adjoint, speed, &mut self.matrices)?;
                sum += self.by_centrifugal(speed);
                for load in self.model.speed_loads() {
                    let slope = 2.0 * load.per_speed2 * speed;
                    if slope == 0.0 {
                        continue;
                    }
                    match self.by_constant(load.contact, Constant::Preload)? {
                        Some(value) => sum += slope * value,
                        None => return Ok((f64::NAN, Reason::ZeroConstant)),
                    }
                }
                sum
            }
        };
        Ok((value, Reason::Exists))
    }

    /// Derivative by a factor on all forces, for results on which forces act.
    fn by_force(&self) -> Result<f64> {
        let condensed = self.solution.condensed;
        let mut force = try_vec(condensed.degrees().independent(), Complex64::ZERO, CONTEXT)?;
        let mut sum = 0.0;
        for (i, block) in condensed.blocks().iter().enumerate() {
            if block.number > 0 && !self.adjoint.is_forced {
                continue;
            }
            force.fill(Complex64::ZERO);
            self.at_frequency.add_forces_to(block.number, 1.0, &mut force);
            let (_, field) = self.adjoint.harmonic(condensed, i);
            sum += crate::linalg::inner(field, &force).re;
        }
        Ok(sum)
    }

    /// The derivative by the speed of the constant forces that follow it.
    fn by_centrifugal(&self, speed: f64) -> f64 {
        let condensed = self.solution.condensed;
        let forces = self.model.excitation().forces().iter();
        let mut sum = 0.0;
        for force in forces.filter(|force| force.per_speed2 != 0.0) {
            let (_, terms) = self.at_frequency.structure().degrees().image(force.dof);
            for (dof, c) in terms {
                for i in (0..condensed.blocks().len()).filter(|&i| condensed.blocks()[i].number == 0) {
                    let (_, field) = self.adjoint.harmonic(condensed, i);
                    sum += 2.0 * force.per_speed2 * speed * c * field[dof].re;
                }
            }
        }
        sum
    }

    /// The derivative by a constant of one contact, 0 where its law does not have it; `None` where it exists on one
    /// side only.
    fn by_constant(&mut self, number: usize, constant: Constant) -> Result<Option<f64>> {
        let contact = &self.at_frequency.contacts()[number];
        let Some(derivative) = contact.by_constant(constant) else {
            return Ok(Some(0.0));
        };
        if derivative.is_one_sided {
            return Ok(None);
        }
        let products = if let Some(products) = self.products[number] {
            products
        } else {
            let motion = ContactMotion::new(self.at_frequency, number, self.solution.condensed, self.adjoint)?;
            let omega = self.adjoint.omega;
            *self.products[number].insert(motion.products(contact, self.solution, omega, self.interrupt)?)
        };
        Ok(Some(-products.with(&derivative)))
    }
}
