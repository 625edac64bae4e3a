//! Data whose units differ from those of the model: a factor on the response, or hertz instead of radians.

use crate::error::{Result, try_copy, try_push};
use crate::studies::fit::fit_data::{DataKind, FitData};
use crate::studies::fit::predicted_data::Predictor;
use std::f64::consts::TAU;

const CONTEXT: &str = "the units of the data";

/// Factors of units, and the distance in log₁₀ within which a factor is suspected.
/// Kind: fixed.
const UNIT_FACTORS: [f64; 4] = [1e-6, 1e-3, 1e3, 1e6];
/// Distance in log₁₀ within which a factor of units is suspected.
/// Kind: tuned; measured on: not recorded.
const UNIT_DISTANCE: f64 = 0.5;

/// Agreement of shapes of data and model above which another unit of the frequency is suspected, and its gain.
/// Kind: tuned; measured on: not recorded.
const UNIT_AGREEMENT: (f64, f64) = (0.4, 0.2);

/// Suspicion that data and model have different units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Suspicion {
    /// No suspicion.
    #[default]
    None,
    /// The responses of the data are this factor times those of the model.
    Response(f64),
    /// The angular frequencies of the data should be multiplied by this factor.
    Frequency(f64),
}

impl Suspicion {
    /// The suspicion in words; empty where there is none.
    #[must_use]
    pub fn sentence(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Response(factor) if factor < 1e-4 => {
                "the responses of the data are about 1e-6 of the model's: check units"
            }
            Self::Response(factor) if factor < 1.0 => {
                "the responses of the data are about 1e-3 of the model's: check units"
            }
            Self::Response(factor) if factor < 1e4 => {
                "the responses of the data are about 1e3 of the model's: check units"
            }
            Self::Response(_) => "the responses of the data are about 1e6 of the model's: check units",
            Self::Frequency(scale) if scale > 1.0 => {
                "the frequencies of the data look like hertz; needs radians per time unit, 2 pi times as large"
            }
            Self::Frequency(_) => {
                "the frequencies of the data are about 2 pi times as large as those of the model: check units"
            }
        }
    }
}

/// Comparison of the responses' shapes: the factor on the model that fits the data best, and the agreement with this
/// factor, 0 to 1.
fn shape(data: &[FitData<'_>], values: &[f64]) -> (f64, f64) {
    let (mut product, mut of_model, mut of_data) = (0.0, 0.0, 0.0);
    let mut row = 0;
    for set in data {
        for (i, z) in set.value.iter().enumerate() {
            if matches!(set.kind, DataKind::Response | DataKind::Amplitude) {
                for (weight, datum) in set.weights(i).into_iter().zip([z.re, z.im]) {
                    let (a, b) = (weight * values[row], weight * datum);
                    product += a * b;
                    of_model += a * a;
                    of_data += b * b;
                    row += 1;
                }
            } else {
                row += 2;
            }
        }
    }
    if of_model == 0.0 || of_data == 0.0 {
        return (f64::NAN, 0.0);
    }
    (product / of_model, product.max(0.0).powi(2) / (of_model * of_data))
}

/// The suspected unit at given values of the parameters, where the data do not fit.
///
/// # Errors
/// Those of the predictor.
pub(super) fn suspected(predictor: &Predictor<'_>, theta: &[f64]) -> Result<Suspicion> {
    let here = predictor.at(theta, false)?;
    let (factor, agreement) = here
        .as_ref()
        .map_or((f64::NAN, 0.0), |found| shape(predictor.data, &found.values));
    let near = |of: &&f64| (factor / **of).log10().abs() < UNIT_DISTANCE;
    if agreement > UNIT_AGREEMENT.0
        && let Some(of) = UNIT_FACTORS.iter().find(near)
    {
        return Ok(Suspicion::Response(*of));
    }
    let mut best = Suspicion::None;
    let mut most = (agreement + UNIT_AGREEMENT.1).max(UNIT_AGREEMENT.0);
    for scale in [TAU, 1.0 / TAU] {
        let mut xs = Vec::new();
        for set in predictor.data {
            let mut x = try_copy(set.x, CONTEXT)?;
            if set.is_forced() {
                for x in &mut x {
                    *x *= scale;
                }
            }
            try_push(&mut xs, x, CONTEXT)?;
        }
        let mut data = Vec::new();
        for (set, x) in predictor.data.iter().zip(&xs) {
            try_push(&mut data, FitData { x, range: None, ..*set }, CONTEXT)?;
        }
        let other = Predictor {
            data: &data,
            ..*predictor
        };
        let found = match other.at(theta, false) {
            Ok(Some(found)) => found,
            Ok(None) => continue,
            Err(e) => return Err(e),
        };
        let (_, with) = shape(&data, &found.values);
        if with > most {
            most = with;
            best = Suspicion::Frequency(scale);
        }
    }
    Ok(best)
}
