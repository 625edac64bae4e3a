//! Designs: a model with other values of its parameters.

use crate::error::{Result, fail};
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::sensitivity::parameter::Parameter;
use num_complex::Complex64;

impl Parameter<'_> {
    /// Gives the parameter a value: constants of contacts and the speed are set, factors multiply, and directions are
    /// added times the value.
    ///
    /// # Errors
    /// As [`Self::check`]; `NotFinite` or `Argument` for a value out of its range, naming it; `OutOfMemory`.
    pub(crate) fn apply(&self, value: f64, model: &mut Model) -> Result<()> {
        match self {
            Self::Force => model.scale_forces(value),
            Self::Contact {
                constant,
                contact: Some(id),
            } => model.set_constant(*id, *constant, value),
            Self::Contact {
                constant,
                contact: None,
            } => {
                for id in 0..model.contacts().len() {
                    if model.contacts()[id].by_constant(*constant).is_some() {
                        model.set_constant(id, *constant, value)?;
                    }
                }
                Ok(())
            }
            Self::Direction { which, direction } => model.add_direction(*which, direction, value),
            Self::Factor { which } => model.scale_matrix(*which, value),
            Self::Speed => model.set_speed(Speed::Fixed(value)),
        }
    }

    /// Whether two parameters set one constant or the speed both; factors of one matrix multiply, and directions add.
    pub(crate) fn sets_the_same_as(&self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Contact {
                    constant: a,
                    contact: x,
                },
                Self::Contact {
                    constant: b,
                    contact: y,
                },
            ) => a == b && (x.is_none() || y.is_none() || x == y),
            (Self::Speed, Self::Speed) => true,
            _ => false,
        }
    }

    /// Factor on the derivative of a model to which the value was applied: a factor or a force then counts relative
    /// to the value.
    pub(crate) fn relative_at(&self, value: f64) -> f64 {
        match self {
            Self::Force | Self::Factor { .. } => 1.0 / value,
            Self::Contact { .. } | Self::Direction { .. } | Self::Speed => 1.0,
        }
    }

    /// Whether this is a factor on a matrix.
    pub(crate) fn is_factor(&self) -> bool {
        matches!(self, Self::Factor { .. })
    }

    /// Whether this is a direction in the matrix of which `factor` is a factor.
    pub(crate) fn is_direction_beside(&self, factor: &Self) -> bool {
        matches!((self, factor), (Self::Direction { which: a, .. }, Self::Factor { which: b }) if a == b)
    }

    /// Whether a change of the parameter leaves the matrices of the structure as they are.
    pub(crate) fn keeps_structure(&self) -> bool {
        matches!(self, Self::Force | Self::Contact { .. })
    }
}

/// Derivative by the value of the k-th parameter of a design, from the derivatives `of` by the parameters of the design as it is. A
/// matrix sA + Σ dE has the derivative A by s, which is the whole without the directions, over s.
pub(crate) fn by_value(parameters: &[Parameter<'_>], values: &[f64], of: &[Complex64], k: usize) -> Complex64 {
    let factor = &parameters[k];
    let mut whole = of[k];
    for ((other, value), slope) in parameters.iter().zip(values).zip(of) {
        if other.is_direction_beside(factor) {
            whole -= value * slope;
        }
    }
    whole * factor.relative_at(values[k])
}

/// A copy of a model with values of its parameters: factors first, so that directions mean the same in any order of the list. It
/// uses the bases that the model keeps, and stores further ones in a list of its own.
///
/// # Errors
/// `Dimension` for another number of values; those of [`Parameter::apply`], naming the value.
pub(crate) fn design(model: &Model, parameters: &[Parameter<'_>], values: &[f64]) -> Result<Model> {
    with_values(model.separate_clone()?, parameters, values)
}

/// A copy of a model as `design` makes it, which stores further bases in the list of the model, where the parameters
/// do not change its structure: the next design can use them.
///
/// # Errors
/// As [`design`].
pub(crate) fn design_with_bases(model: &Model, parameters: &[Parameter<'_>], values: &[f64]) -> Result<Model> {
    with_values(model.try_clone()?, parameters, values)
}

fn with_values(mut copy: Model, parameters: &[Parameter<'_>], values: &[f64]) -> Result<Model> {
    if values.len() != parameters.len() {
        return fail!(Dimension, "{} values for {} parameters", values.len(), parameters.len());
    }
    for are_factors in [true, false] {
        for (i, (parameter, &value)) in parameters.iter().zip(values).enumerate() {
            if parameter.is_factor() == are_factors {
                parameter
                    .apply(value, &mut copy)
                    .map_err(|e| e.at(format_args!("value {i}")))?;
            }
        }
    }
    Ok(copy)
}
