//! Bands of frequency in which a structure with contacts may resonate: each natural frequency lies between its values without
//! contact forces and with stuck contacts, wherever they slip.
//!
//! Prediction errors alone do not show that a step is too long which passes a resonance as a whole. Within a band steps are as
//! short as those of a curve, about, and from outside they lead at most half way to it.

use crate::continuation::Continuation;
use crate::continuation::arc_length::APPROACH;
use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::natural_modes::linear_modes::ContactState;
use crate::options::Range;

/// Degrees of freedom up to which the natural frequencies cost less than the points that they save.
/// Kind: tuned; measured on: not recorded.
const MOST_DEGREES: usize = 16;

/// Change of the frequency in a step within a band, as a share of the range: about that of the largest step of a curve.
/// Kind: tuned; measured on: not recorded.
const RESONANCE_BANDS_SHARE: f64 = 0.05;

/// Bands of frequency in which the harmonics with forces may resonate.
pub(crate) struct ResonanceBands {
    bands: Vec<(f64, f64)>,
    /// Change of the frequency in a step within a band.
    within: f64,
}

impl ResonanceBands {
    /// The bands of a model whose forces act in the harmonics `forced`, for a sweep over `range`. Where natural
    /// frequencies cannot be computed, one band holds all frequencies.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn new(model: &Model, forced: &[usize], range: Range, interrupt: &Interrupt<'_>) -> Result<Self> {
        let mut bands = Vec::new();
        let mut known = true;
        for (i, &h) in forced.iter().enumerate() {
            if h == 0 || forced[..i].contains(&h) {
                continue;
            }
            known &= model.ndof() <= MOST_DEGREES;
            if !known {
                break;
            }
            let free = model.natural_frequencies(h, ContactState::Free, interrupt)?;
            let stuck = model.natural_frequencies(h, ContactState::Stuck, interrupt)?;
            let (Some(free), Some(stuck)) = (free, stuck) else {
                known = false;
                break;
            };
            known &= free.len() == stuck.len();
            for (a, b) in free.iter().zip(&stuck) {
                let (a, b) = (a / h as f64, b / h as f64);
                try_push(&mut bands, (a.min(b), a.max(b)), "the natural frequencies")?;
            }
        }
        if !known {
            bands = try_vec(1, (0.0, f64::INFINITY), "the natural frequencies")?;
        }
        Ok(Self {
            bands,
            within: RESONANCE_BANDS_SHARE * range.width(),
        })
    }

    /// Shortens the next step where it is too long for the bands.
    pub fn shorten_step(&self, continuation: &mut Continuation) {
        let point = continuation.current();
        let rises = point.tangent.last().is_some_and(|t| *t > 0.0);
        continuation.change_at_most(self.most_change(point.parameter(), rises));
    }

    /// Largest change of the frequency that a step may make from `omega`; `rises`: towards higher frequencies.
    fn most_change(&self, omega: f64, rises: bool) -> f64 {
        let distance = |&(low, high): &(f64, f64)| match rises {
            true if omega <= high => Some(low - omega),
            false if omega >= low => Some(omega - high),
            _ => None,
        };
        let nearest = self.bands.iter().filter_map(distance).fold(f64::INFINITY, f64::min);
        (APPROACH * nearest).max(self.within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Contact;
    use crate::linalg::sparse_storage::matrix_view::MatrixView;
    use crate::model::matrices::structure::MatrixKind;

    /// A mass of 1 on a spring of 1, with a slider of stiffness 3 to the ground: bands from 1 to 2 over the harmonic.
    #[test]
    fn steps_are_short_within_a_band_and_lead_half_way_to_it() {
        let mut model = Model::new(1).unwrap();
        model
            .set_matrix(MatrixKind::Mass, &MatrixView::dense(1, &[1.0]))
            .unwrap();
        model
            .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(1, &[1.0]))
            .unwrap();
        model.add_contact(&Contact::jenkins(0, None, 3.0, 1.0, 1.0)).unwrap();
        let interrupt = Interrupt::none();
        let bands = ResonanceBands::new(&model, &[0, 1, 1], (0.1, 8.1).into(), &interrupt).unwrap();
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(close(bands.most_change(0.1, true), 0.45));
        assert!(close(bands.most_change(1.5, true), 0.4) && close(bands.most_change(1.5, false), 0.4));
        assert!(bands.most_change(2.1, true).is_infinite());
        assert!(close(bands.most_change(10.0, false), 4.0));
        let second = ResonanceBands::new(&model, &[2], (0.1, 0.2).into(), &interrupt).unwrap();
        assert!(close(second.most_change(0.1, true), 0.2));
        // Too many degrees of freedom: short steps everywhere.
        let large = Model::new(MOST_DEGREES + 1).unwrap();
        let bands = ResonanceBands::new(&large, &[1], (0.0, 1.0).into(), &interrupt).unwrap();
        assert!(close(bands.most_change(0.7, false), 0.05));
    }
}
