//! The model of motions whose period is a multiple of that of the forces.

use crate::error::{Result, fail};
use crate::model::Model;
use crate::model::matrices::speed::Speed;

impl Model {
    /// A copy for motions with `periods` times the period: forces in harmonic h act in harmonic `periods`·h, while
    /// unbalances and a speed tied to the frequency are kept. The engine order is chosen such that the forces keep
    /// their wave.
    ///
    /// # Errors
    /// `Argument` for `periods` = 0, or above the highest harmonic number; `Unsupported` where no wave of the sectors has the
    /// longer period; `OutOfMemory`.
    pub fn with_longer_period(&self, periods: usize) -> Result<Self> {
        if periods == 0 {
            return fail!(Argument, "periods = 0, needs at least 1");
        }
        let mut longer = self.try_clone()?;
        if periods == 1 {
            return Ok(longer);
        }
        longer.excitation.stretch(periods)?;
        if let Speed::PerOmega(p) = self.speed() {
            longer.set_speed(Speed::PerOmega(p * periods as f64))?;
        }
        let sectors = self.structure().sectors() as i64;
        let order = self.structure().engine_order();
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
}
