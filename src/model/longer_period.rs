//! The model of motions whose period is a multiple of that of the forces.

use crate::error::{Result, fail};
use crate::model::Model;
use crate::model::matrices::speed::Speed;

/// A copy for motions with `periods` times the period.
pub(crate) fn with_longer_period(model: &Model, periods: usize) -> Result<Model> {
    if periods == 0 {
        return fail!(Argument, "periods = 0, needs at least 1");
    }
    let mut longer = model.try_clone()?;
    if periods == 1 {
        return Ok(longer);
    }
    longer.excitation.stretch(periods)?;
    if let Speed::PerOmega(p) = model.speed() {
        longer.set_speed(Speed::PerOmega(p * periods as f64))?;
    }
    let sectors = model.structure().sectors() as i64;
    let order = model.structure().engine_order();
    let n = periods as i64;
    // The wave whose harmonic `periods` is that of the forces.
    let wave = (0..n).find_map(|turns| {
        let sum = order + turns * sectors;
        (sum % n == 0).then_some(sum / n)
    });
    let Some(wave) = wave else {
        return fail!(
            Unsupported,
            "no wave of {sectors} sectors has {periods} times the period of engine order {order}"
        );
    };
    longer.set_wave(wave);
    Ok(longer)
}
