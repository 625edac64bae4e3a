//! The equations of the linear parts of a forced response.

use crate::analysis::forced::forced_equations::Equations;
use crate::error::{Result, boxed};
use crate::harmonics::harmonic_levels::HarmonicLevels;
use crate::results::Resolution;

/// The equations of a linear response. Their reference is the stuck structure, where that of the others is different
/// and damping bounds the response of the stuck structure.
pub(crate) struct LinearResponse<'a> {
    levels: &'a HarmonicLevels<'a>,
    equations: Option<(usize, Box<Equations<'a>>)>,
    /// Frequency of the point solved last.
    pub solved: Option<f64>,
}

impl<'a> LinearResponse<'a> {
    pub fn new(levels: &'a HarmonicLevels<'a>) -> Self {
        Self {
            levels,
            equations: None,
            solved: None,
        }
    }

    /// The equations of the linear response at a resolution; `None` where the ordinary ones are as accurate.
    pub fn equations(
        &mut self,
        needed: bool,
        index: usize,
        make: impl FnOnce(&'a Resolution) -> Result<Equations<'a>>,
    ) -> Result<Option<&mut Equations<'a>>> {
        if !needed {
            return Ok(None);
        }
        let stored = self.equations.take().filter(|(at, _)| *at == index);
        let equations = if let Some((_, equations)) = stored {
            equations
        } else {
            let level = self.levels.at(index)?;
            boxed(|| make(level))?
        };
        let (_, equations) = self.equations.insert((index, equations));
        Ok(Some(equations))
    }
}
