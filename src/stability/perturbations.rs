//! A basis of the perturbations of a block, carried through a lapse.
//!
//! Columns are perturbations (δx, δv, δw), sliders w last. At the end of a lapse every sector receives the perturbation
//! of the sector whose motion it repeats, so that the map of a lapse, applied as often as the wave has lapses in a
//! period, is the monodromy matrix of the period but for a known factor.

use crate::contact::forms::time_piece::Grazing;
use crate::error::{Result, try_push};
use crate::model::matrices::structure::Structure;
use crate::stability::closure::Closure;
use crate::stability::ring::Ring;
use crate::time_integration::{Interval, PerturbationBasis, System, Variation};
use num_complex::Complex64;

const CONTEXT: &str = "the perturbations";

/// The perturbations of one block.
pub(crate) struct Perturbations<'s> {
    pub(super) ring: Ring,
    basis: Basis<'s>,
}

/// A basis of the perturbations, in real numbers where the block is real.
enum Basis<'s> {
    Real(PerturbationBasis<'s, f64>),
    Complex(PerturbationBasis<'s, Complex64>),
}

/// Blocks of perturbations that are carried together.
pub(crate) struct Blocks<'s> {
    /// Perturbations of each block.
    pub list: Vec<Perturbations<'s>>,
    /// The first contact that touches an event: index of the element, and the kind of event.
    pub grazing: Option<(usize, Grazing)>,
}

impl<'s> Perturbations<'s> {
    fn new(structure: &Structure, system: &System<'s>, closure: Closure) -> Result<Self> {
        let ring = Ring::new(structure, system, closure)?;
        let (count, smooth) = (system.elements.len(), !system.is_piecewise_linear());
        let interrupt = system.interrupt;
        let basis = if ring.is_real() {
            let equations = ring.equations(interrupt)?;
            Basis::Real(PerturbationBasis::new(equations, count, smooth, interrupt)?)
        } else {
            let equations = ring.equations(interrupt)?;
            Basis::Complex(PerturbationBasis::new(equations, count, smooth, interrupt)?)
        };
        Ok(Self { ring, basis })
    }
}

impl Perturbations<'_> {
    /// The block to which the perturbations belong.
    pub fn closure(&self) -> &Closure {
        &self.ring.closure
    }

    /// The state that state `i` repeats at the end of a lapse, and the factor with which it does.
    pub(super) fn source(&self, structure: &Structure, system: &System<'_>, i: usize) -> (usize, Complex64) {
        let (from, turns) = self.shifted(system, i);
        (from, self.ring.closure.factor(structure, turns))
    }

    /// Derivative of state `i` at the end of the lapse by state `j` at the beginning, before sectors are exchanged.
    pub(super) fn carried(&self, i: usize, j: usize) -> Complex64 {
        let at = j * self.ring.states() + i;
        match &self.basis {
            Basis::Real(basis) => basis.columns[at].into(),
            Basis::Complex(basis) => basis.columns[at],
        }
    }

    /// The state that state `i` repeats one lapse later, and how often the ring is passed on the way to it.
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
        let to = sector + system.wave.follower;
        (first + group + to % m * block + within, to / m)
    }

    /// Sets the perturbations to the identity, before a lapse.
    fn begin(&mut self) {
        match &mut self.basis {
            Basis::Real(basis) => basis.begin(),
            Basis::Complex(basis) => basis.begin(),
        }
    }

    fn variation(&mut self) -> &mut dyn Variation {
        match &mut self.basis {
            Basis::Real(basis) => basis,
            Basis::Complex(basis) => basis,
        }
    }
}

impl<'s> Blocks<'s> {
    /// The blocks of the given closures, before the lapse.
    pub fn new(structure: &Structure, system: &System<'s>, closures: &[Closure]) -> Result<Self> {
        let mut list = Vec::new();
        for closure in closures {
            let mut block = Perturbations::new(structure, system, *closure)?;
            block.begin();
            try_push(&mut list, block, CONTEXT)?;
        }
        Ok(Self { list, grazing: None })
    }
}

impl Variation for Blocks<'_> {
    fn advance(&mut self, interval: &Interval<'_>) -> Result<()> {
        self.list
            .iter_mut()
            .try_for_each(|block| block.variation().advance(interval))
    }

    fn couple(&mut self, element: usize, share: f64) -> Result<()> {
        self.list
            .iter_mut()
            .try_for_each(|block| block.variation().couple(element, share))
    }

    fn end(&mut self) -> Result<()> {
        self.list.iter_mut().try_for_each(|block| block.variation().end())
    }

    fn graze(&mut self, element: usize, grazing: Grazing) {
        self.grazing.get_or_insert((element, grazing));
    }
}

#[cfg(test)]
#[path = "perturbations_tests.rs"]
mod tests;
