//! Work that the data sets of a fit share at the same values of the parameters: they differ in the level of the force alone.

use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::error::{Result, try_push};
use crate::sensitivity::WaveMatrices;

const CONTEXT: &str = "the shared work of a fit";

/// Matrices and modes of the waves of one model.
#[derive(Default)]
pub(super) struct SharedWork {
    /// Matrices that factors multiply.
    pub matrices: WaveMatrices,
    /// Modes of the waves for each response degree of freedom, whose row is kept with them.
    waves: Vec<(Option<usize>, SharedWaves)>,
}

impl SharedWork {
    /// The modes for curves with a response degree of freedom.
    pub fn waves(&mut self, response: Option<usize>) -> Result<&SharedWaves> {
        let position = if let Some(position) = self.waves.iter().position(|(dof, _)| *dof == response) {
            position
        } else {
            try_push(&mut self.waves, (response, SharedWaves::default()), CONTEXT)?;
            self.waves.len() - 1
        };
        Ok(&self.waves[position].1)
    }
}
