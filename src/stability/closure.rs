//! Blocks of perturbations of a wheel that moves in a travelling wave.
//!
//! The motion repeats after m sectors: exactly, or with the opposite sign, as odd laws allow. The equations of
//! perturbations repeat after m sectors in both cases, so that perturbations fall into N/m blocks with x_{s+m} = c·x_s,
//! c^{N/m} = 1. Block j holds the waves of the diameters j, j + N/m, j + 2N/m, … Blocks j and −j are conjugate.

use crate::error::{Result, try_push};
use crate::model::matrices::structure::Structure;
use crate::options::Waves;
use num_complex::Complex64;

/// A block of perturbations that the motion does not couple with others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closure {
    /// Number m of sectors after which the perturbation repeats but for the factor c.
    pub sectors: usize,
    /// Index j of the block.
    pub index: usize,
    /// Whether a conjugate block exists, whose multipliers are conjugate.
    pub has_conjugate: bool,
    /// Whether the block contains the wave itself.
    pub has_wave: bool,
}

impl Closure {
    /// Factor c^{turns} of a perturbation after `turns` times m sectors.
    pub fn factor(&self, structure: &Structure, turns: usize) -> Complex64 {
        structure.wave_phase(self.index as i64, (turns * self.sectors) as i64)
    }
}

/// Lists the blocks: the one of the wave itself, or one of each pair of conjugate blocks. `odd`: sectors half a wave
/// apart move opposite to each other.
pub(crate) fn closures(structure: &Structure, waves: Waves, odd: bool) -> Result<Vec<Closure>> {
    let repeating = structure.repeating_sectors();
    let sectors = if odd { repeating / 2 } else { repeating };
    let count = structure.sectors() / sectors;
    let own = i128::from(structure.engine_order()).rem_euclid(count as i128) as usize;
    let mut found = Vec::new();
    for index in 0..=count / 2 {
        let conjugate = (count - index) % count;
        let has_wave = own == index || own == conjugate;
        if waves == Waves::Wheel || has_wave {
            let closure = Closure {
                sectors,
                index,
                has_conjugate: conjugate != index && waves == Waves::Wheel,
                has_wave,
            };
            try_push(&mut found, closure, "the blocks of perturbations")?;
        }
    }
    Ok(found)
}
