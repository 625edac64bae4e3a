//! Predictions of a fitted model with their standard deviations.
//!
//! The delta method has the variance ∇vᵀ C ∇v, with exact derivatives. Along each principal direction of the covariance a step of one
//! standard deviation to both sides tells the second order: half the sum of the second differences is the shift of the mean.

use crate::error::{Result, fail, try_copy, try_vec};
use crate::hooks::Hooks;
use crate::linalg::dense::hermitian::eigen;
use crate::model::Model;
use crate::options::SolverOptions;
use crate::sensitivity::Parameter;
use crate::studies::fit::fit_data::FitData;
use crate::studies::fit::fit_unknowns::Named;
use crate::studies::fit::predicted_data::Predictor;
use num_complex::Complex64;

const CONTEXT: &str = "a prediction";

/// Variance of a direction, over the largest one, below which it is rounding.
/// Kind: rounding.
const PREDICTION_ROUNDING: f64 = 1e-14;

/// Predicted numbers, two for each x of the set.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// Predicted numbers at the given values of the parameters, arranged as [`FitData::value`].
    pub values: Vec<f64>,
    /// Standard deviations of the predictions, by the delta method.
    pub sigma: Vec<f64>,
    /// Shift of the predicted means by second-order terms; NaN where a step of one standard deviation has no
    /// solution. Where the shift is not small against the standard deviation, the delta method does not suffice.
    pub shift: Vec<f64>,
}

/// Predicts the numbers of `wanted` at the values `theta` of the parameters with their covariance. The values and
/// standard deviations of `wanted` have no effect.
///
/// # Errors
/// `Dimension` or `NotFinite` for theta and covariance, those of the set, of the analyses and of the derivatives; `NoConvergence` where
/// there is no solution; `StoppedByCaller`.
pub fn predict(
    model: &Model,
    parameters: &[Parameter<'_>],
    (theta, covariance): (&[f64], &[f64]),
    wanted: &FitData<'_>,
    solver: &SolverOptions,
    hooks: &mut Hooks<'_>,
) -> Result<Prediction> {
    let p = parameters.len();
    if theta.len() != p || covariance.len() != p * p {
        return fail!(
            Dimension,
            "theta has {} and covariance {} numbers, need {p} and {}",
            theta.len(),
            covariance.len(),
            p * p
        );
    }
    for (i, x) in theta.iter().chain(covariance).enumerate() {
        if !x.is_finite() {
            return fail!(
                NotFinite,
                "number {i} of theta and covariance is {x}, needs a finite number"
            );
        }
    }
    wanted.check(model, false)?;
    for parameter in parameters {
        parameter.check(model)?;
    }
    let interrupt = hooks.interrupt();
    let set = [FitData {
        value: &[],
        sigma: &[],
        second_sigma: &[],
        ..*wanted
    }];
    let own = model.separate_clone()?;
    let predictor = Predictor {
        model: &own,
        parameters,
        scopes: &[],
        data: &set,
        solver: *solver,
        interrupt: &interrupt,
    };
    let Some(found) = predictor.at(theta, true)? else {
        return fail!(NoConvergence, "the model has no solution at each x of the prediction");
    };
    let rows = found.values.len();
    let mut prediction = Prediction {
        values: found.values,
        sigma: try_vec(rows, 0.0, CONTEXT)?,
        shift: try_vec(rows, 0.0, CONTEXT)?,
    };
    for (sigma, row) in prediction.sigma.iter_mut().zip(found.slopes.chunks_exact(p)) {
        let along = |i: usize| (0..p).map(|j| covariance[i * p + j] * row[j]).sum::<f64>();
        *sigma = (0..p).map(|i| row[i] * along(i)).sum::<f64>().max(0.0).sqrt();
    }
    second_order(&predictor, theta, covariance, &mut prediction)?;
    Ok(prediction)
}

fn second_order(
    predictor: &Predictor<'_>,
    theta: &[f64],
    covariance: &[f64],
    prediction: &mut Prediction,
) -> Result<()> {
    let p = theta.len();
    // In units of the standard deviations.
    let deviation = |k: usize| covariance[k * p + k].max(0.0).sqrt();
    let mut a = try_vec(p * p, Complex64::ZERO, CONTEXT)?;
    for i in 0..p {
        for j in 0..p {
            let unit = deviation(i) * deviation(j);
            if unit > 0.0 {
                a[j * p + i] = (covariance[i * p + j] / unit).into();
            }
        }
    }
    let (values, vectors) = eigen(&mut a, p, predictor.interrupt)?;
    let largest = values.iter().fold(0.0_f64, |a, b| a.max(*b));
    for (k, variance) in values.iter().enumerate() {
        if *variance <= PREDICTION_ROUNDING * largest {
            continue;
        }
        let mut ends = [None, None];
        for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
            let mut moved = try_copy(theta, CONTEXT)?;
            for (i, x) in moved.iter_mut().enumerate() {
                *x += sign * variance.sqrt() * deviation(i) * vectors[k * p + i].re;
            }
            *end = match predictor.at(&moved, false) {
                Ok(found) => found,
                // One standard deviation may lead to a constant below 0.
                Err(e) if matches!(e.status, crate::error::Status::Argument) => None,
                Err(e) => return Err(e),
            };
        }
        for (row, shift) in prediction.shift.iter_mut().enumerate() {
            *shift += match &ends {
                [Some(a), Some(b)] => 0.5 * (a.values[row] - 2.0 * prediction.values[row] + b.values[row]),
                _ => f64::NAN,
            };
        }
    }
    Ok(())
}

/// Refuses parameters that the model does not have, by name.
///
/// # Errors
/// Those of [`Parameter::check`].
pub(super) fn check_parameters(model: &Model, parameters: &[Parameter<'_>]) -> Result<()> {
    for (i, parameter) in parameters.iter().enumerate() {
        parameter
            .check(model)
            .map_err(|e| e.at(format_args!("parameter {i}, {}", Named(parameter))))?;
    }
    Ok(())
}
