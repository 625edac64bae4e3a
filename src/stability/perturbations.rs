//! A basis of the perturbations of a block, carried through a lapse.
//!
//! Columns are perturbations (δx, δv, δw), sliders w last. At the end of a lapse every sector receives the perturbation
//! of the sector whose motion it repeats, so that the map of a lapse, applied as often as the wave has lapses in a
//! period, is the monodromy matrix of the period but for a known factor.

use crate::contact::time_piece::Grazing;
use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::model::structure::Structure;
use crate::stability::closure::Closure;
use crate::stability::ring::{Ring, along};
use crate::stability::variational_step::VariationalStep;
use crate::time_integration::{Interval, System, Variation};
use num_complex::Complex64;

const CONTEXT: &str = "the perturbations";

/// The perturbations of one block.
pub(crate) struct Perturbations {
    pub(super) ring: Ring,
    step: VariationalStep,
    /// Column by column.
    columns: Vec<Complex64>,
}

/// The blocks that are carried together.
pub(crate) struct Blocks<'s> {
    interrupt: &'s Interrupt<'s>,
    /// The blocks.
    pub list: Vec<Perturbations>,
    /// The first contact that touches an event: number of the element, and the event.
    pub grazing: Option<(usize, Grazing)>,
}

impl Perturbations {
    fn new(structure: &Structure, system: &System<'_>, closure: Closure) -> Result<Self> {
        let ring = Ring::new(structure, system, closure)?;
        let states = ring.states();
        let mut columns = try_vec(states.saturating_mul(states), Complex64::ZERO, CONTEXT)?;
        for i in 0..states {
            columns[i * states + i] = Complex64::ONE;
        }
        Ok(Self {
            step: VariationalStep::new(&ring, !system.is_piecewise_linear())?,
            ring,
            columns,
        })
    }

    /// The block.
    pub fn closure(&self) -> &Closure {
        &self.ring.closure
    }

    /// Entry of the map of a lapse: state `i` at the end by state `j` at the begin, sectors exchanged.
    pub(super) fn entry(&self, structure: &Structure, system: &System<'_>, i: usize, j: usize) -> Complex64 {
        let (from, turns) = self.shifted(system, i);
        self.columns[j * self.ring.states() + from] * self.ring.closure.factor(structure, turns)
    }

    /// The state that state `i` repeats a lapse later, and how often the ring is passed on the way to it.
    fn shifted(&self, system: &System<'_>, i: usize) -> (usize, usize) {
        let (n, m) = (self.ring.order, self.ring.closure.sectors);
        let (first, block, at) = match i {
            i if i < n => (0, system.ndof, i),
            i if i < 2 * n => (n, system.ndof, i - n),
            i => (2 * n, 1, i - 2 * n),
        };
        // Sliders are numbered contact by contact, sectors within.
        let (sector, within) = (at / block % m, at % block);
        let group = at - sector * block - within;
        let to = sector + system.follower;
        (first + group + to % m * block + within, to / m)
    }

    fn advance(&mut self, interval: &Interval<'_>, interrupt: &Interrupt<'_>) -> Result<()> {
        self.step.prepare(&self.ring, interval, interrupt)?;
        let states = self.ring.states();
        for column in self.columns.chunks_exact_mut(states) {
            self.step.carry(&mut self.ring, interval, column, interrupt)?;
        }
        Ok(())
    }

    fn couple(&mut self, element: usize, share: f64) {
        let Ok(found) = self.ring.elements.binary_search_by_key(&element, |e| e.source) else {
            return;
        };
        let e = &self.ring.elements[found];
        let Some(slider) = e.slider else { return };
        let at = 2 * self.ring.order + slider;
        for column in self.columns.chunks_exact_mut(self.ring.states()) {
            let mut w = along(&e.rows[0], column);
            if let Some(normal) = e.rows.get(1)
                && share != 0.0
            {
                w += share * along(normal, column);
            }
            column[at] = w;
        }
    }
}

impl<'s> Blocks<'s> {
    /// The blocks of the given closures, before the lapse.
    pub fn new(structure: &Structure, system: &System<'s>, closures: &[Closure]) -> Result<Self> {
        let mut list = Vec::new();
        for closure in closures {
            try_push(&mut list, Perturbations::new(structure, system, *closure)?, CONTEXT)?;
        }
        Ok(Self {
            interrupt: system.interrupt,
            list,
            grazing: None,
        })
    }
}

impl Variation for Blocks<'_> {
    fn advance(&mut self, interval: &Interval<'_>) -> Result<()> {
        for block in &mut self.list {
            block.advance(interval, self.interrupt)?;
        }
        Ok(())
    }

    fn couple(&mut self, element: usize, share: f64) {
        for block in &mut self.list {
            block.couple(element, share);
        }
    }

    fn graze(&mut self, element: usize, grazing: Grazing) {
        self.grazing.get_or_insert((element, grazing));
    }
}
