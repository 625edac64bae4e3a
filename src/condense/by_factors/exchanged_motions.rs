//! The exchanged motions of a condensed model, see [`crate::condense::blocks::exchange`]: their choice, their tables, and the relative
//! motions that they stand for.

use crate::condense::Condensed;
use crate::condense::blocks::exchange::{CREEP, Exchange};
use crate::condense::blocks::relative_coordinates::AssembledDirection;
use crate::condense::by_factors::flexibility::{Table, Workspace};
use crate::error::{Result, Status, fail, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::model::Model;
use crate::options::Exchanged;
use crate::options::Range;
use num_complex::Complex64;
use std::f64::consts::E;

const CONTEXT: &str = "the near-rigid contacts";

/// Number of harmonics for which α is chosen, whatever the number of those carried, so that motions are the same for
/// all. On 45 random chains with kt/k from 300 to 1e8 and slip the geometric mean of the errors with 15 to 255 harmonics is the
/// same within 15 % for 160 and 500, up to a fifth more for 60, and up to a third more for 20.
/// Kind: tuned; measured on: not recorded.
const NOMINAL: f64 = 160.0;

/// Share of the nominal harmonic at which the structure has the same mass if it has one, and the largest factor between the two.
/// Kind: tuned; measured on: the chain of 8 masses of `tests/robustness/near_rigid.rs`.
const BELOW_NOMINAL: f64 = 0.25;
const MASS_LIKE: f64 = 2.0;

/// Least harmonic at which a stick rings for the force on a mass.
/// Kind: tuned; measured on: the chain of 8 masses of `tests/robustness/near_rigid.rs`.
const MASS_BELOW_RING: f64 = 100.0;

/// Harmonic of a ring over the highest one that is carried for a motion with a mass.
/// Kind: tuned; measured on: the chain of 8 masses of `tests/robustness/near_rigid.rs`.
const RING_ABOVE: f64 = 3.0;

/// Exchanged motion by a force, over that of α, up to which the sides of a contact do not move against each other in a harmonic,
/// as those of
/// blades that move alike: any force that sticks would do there, and a creep of its place takes the least one.
/// Kind: rounding.
const UNMOVED: f64 = 1e-9;

/// Selects the coordinates whose motions are exchanged: coordinates with a single near-rigid slider, which lose their
/// reference stiffness.
pub(crate) fn select_exchanged(
    model: &Model,
    which: Exchanged,
    assembled: &[AssembledDirection],
    (stiffness, reference): (&[f64], &mut [f64]),
    exchanges: &mut [Option<Exchange>],
) -> Result<()> {
    let mut count = try_vec(exchanges.len(), 0_usize, CONTEXT)?;
    for at in assembled {
        count[at.coordinate] += 1;
    }
    for at in assembled {
        let (c, contact) = (at.coordinate, &model.contacts()[at.contact]);
        let is_loaded = model.speed_loads().iter().any(|load| load.contact == at.contact);
        let is_meant = which == Exchanged::NearRigid || contact.is_rigid();
        if is_meant
            && count[c] == 1
            && reference[c] < stiffness[c]
            && !is_loaded
            && contact.exchanged((1.0, None), 1.0).is_some()
        {
            let compliance = stiffness[c].recip();
            exchanges[c] = Some(Exchange {
                stiffness: 1.0,
                compliance,
                ring: f64::INFINITY,
                mass_at: None,
                fastest: 0.0,
            });
            reference[c] = 0.0;
        }
    }
    Ok(())
}

/// Refuses a rigid slider without an exchanged motion: it has no other equations.
///
/// # Errors
/// `Unsupported`.
pub(crate) fn check_rigid(
    model: &Model,
    assembled: &[AssembledDirection],
    exchanges: &[Option<Exchange>],
) -> Result<()> {
    let mut without = assembled.iter().filter(|at| exchanges[at.coordinate].is_none());
    match without.find(|at| model.contacts()[at.contact].is_rigid()) {
        None => Ok(()),
        Some(at) => fail!(
            Unsupported,
            "contact {}: kt = inf, a rigid slider, needs a forced response without stability, free sliders and samples, a motion on which no \
             other contact acts, a constant load and no place of its slider; take a finite kt elsewhere",
            at.contact
        ),
    }
}

impl Condensed {
    /// Highest harmonic that is of use beside motions with a mass whose sticks ring: what is left then are their rings.
    pub(crate) fn highest_below_rings(&self) -> usize {
        let with_mass = self
            .contacts
            .exchanges
            .iter()
            .flatten()
            .filter_map(|e| Some((e.ring, e.mass_at?)));
        let below = with_mass.map(|(ring, omega)| (ring / (RING_ABOVE * omega)) as usize);
        below.min().unwrap_or(usize::MAX)
    }

    /// The highest harmonic on which a force acts.
    fn highest_load(&self) -> f64 {
        let loads = self.blocks().iter().filter(|block| block.has_force());
        loads.map(|block| block.number).max().unwrap_or(0) as f64
    }

    /// Sliders whose motions are exchanged.
    #[must_use]
    pub fn exchanged(&self) -> Exchanged {
        let finite = |exchange: &Exchange| exchange.compliance > 0.0;
        match (
            self.has_exchanges(),
            self.contacts.exchanges.iter().flatten().any(finite),
        ) {
            (false, _) => Exchanged::None,
            (true, false) => Exchanged::Rigid,
            (true, true) => Exchanged::NearRigid,
        }
    }

    /// Whether some motion is exchanged.
    pub fn has_exchanges(&self) -> bool {
        self.contacts.exchanges.iter().any(Option::is_some)
    }

    /// Whether some motion is exchanged, each for the force on a mass.
    pub(crate) fn has_masses(&self) -> bool {
        self.has_exchanges()
            && self
                .contacts
                .exchanges
                .iter()
                .flatten()
                .all(|exchange| exchange.mass_at.is_some())
    }

    /// The exchange of a coordinate.
    #[must_use]
    pub fn exchange_of(&self, coordinate: usize) -> Option<Exchange> {
        self.contacts.exchanges[coordinate]
    }

    /// Whether the motion of a coordinate is exchanged.
    #[must_use]
    pub fn is_exchanged(&self, coordinate: usize) -> bool {
        self.contacts.exchanges[coordinate].is_some()
    }

    /// For each coordinate, whether its motion is exchanged; empty where no motion is.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn rates(&self) -> Result<Vec<bool>> {
        let mut rates = Vec::new();
        for exchange in self.contacts.exchanges.iter().filter(|_| self.has_exchanges()) {
            try_push(&mut rates, exchange.is_some(), CONTEXT)?;
        }
        Ok(rates)
    }

    /// Sets α of all exchanges from the middle of a sweep, and the frequencies at which the stick stiffnesses ring.
    pub(crate) fn set_exchanges(&mut self, sweep: Range, interrupt: &Interrupt<'_>) -> Result<()> {
        if !self.has_exchanges() {
            return Ok(());
        }
        let (n, omega) = (self.coordinates(), NOMINAL * (sweep.start * sweep.stop).sqrt());
        let mut is_set = try_vec(n, false, CONTEXT)?;
        for i in 0..self.set.numbers().len() {
            let number = self.set.numbers()[i] as f64;
            let left = |c: &usize| self.contacts.exchanges[*c].is_some() && !is_set[*c];
            if number == 0.0 || !(0..n).any(|c| left(&c)) {
                continue;
            }
            let flexibility = without_reference(self, (i, omega / number), interrupt)?;
            for c in 0..n {
                let at_nominal = flexibility[c * n + c].norm();
                // Sides may move alike in a harmonic; where they do in all, α stays as it is.
                let Some(mut exchange) = self.contacts.exchanges[c].filter(|_| !is_set[c] && at_nominal > 0.0) else {
                    continue;
                };
                exchange.stiffness = (E * NOMINAL * at_nominal).recip();
                let below = without_reference(self, (i, BELOW_NOMINAL * omega / number), interrupt)?[c * n + c].norm();
                let of_mass = BELOW_NOMINAL * BELOW_NOMINAL * below / at_nominal;
                let is_mass = self.set.is_odd() && (MASS_LIKE.recip()..=MASS_LIKE).contains(&of_mass);
                // A rigid stick does not ring.
                if exchange.compliance > 0.0 {
                    // The mass −1/(Gω²) at the nominal harmonic, then at the ring of that mass.
                    let near = omega * (at_nominal / exchange.compliance).sqrt();
                    let there = without_reference(self, (i, near / number), interrupt)?;
                    exchange.ring = near * (there[c * n + c].norm() / exchange.compliance).sqrt();
                }
                // Loads act on sticks far below their rings.
                let below_ring = MASS_BELOW_RING.max(RING_ABOVE * self.highest_load());
                let fastest = sweep.start.max(sweep.stop);
                if is_mass && exchange.ring >= below_ring * fastest {
                    exchange.fastest = fastest;
                    exchange.stiffness = (NOMINAL * NOMINAL * at_nominal).recip();
                    exchange.mass_at = Some(omega / NOMINAL);
                }
                self.contacts.exchanges[c] = Some(exchange);
                is_set[c] = true;
            }
        }
        for (stiffness, exchange) in self.contacts.stiffness.iter_mut().zip(&self.contacts.exchanges) {
            if let Some(exchange) = exchange {
                *stiffness = exchange.stiffness;
            }
        }
        Ok(())
    }

    /// Turns a table of the i-th carried harmonic at an angular frequency into that of the exchanged motions.
    pub(crate) fn exchange(&self, i: usize, omega: f64, table: &mut Table) {
        let number = self.set.numbers()[i];
        let outputs = self.coordinates() + 1;
        for (c, exchange) in self.contacts.exchanges.iter().enumerate() {
            let Some(exchange) = exchange else { continue };
            let (s, slope_of_s) = exchange.rate(number, omega);
            let entries = table.value.iter_mut().zip(&mut table.slope);
            for (value, slope) in entries.skip(c).step_by(outputs) {
                *slope = s * *slope + slope_of_s * *value;
                *value *= s;
            }
            table.slope[c * outputs + c] += slope_of_s * exchange.compliance_in(number);
            let own = &mut table.value[c * outputs + c];
            let (motion, range) = (own.norm(), exchange.stiffness.recip());
            *own += s * exchange.compliance_in(number) - range;
            if motion <= UNMOVED * range {
                *own += CREEP * range;
            }
        }
    }

    /// The packed relative motions of a point at an angular frequency, of exchanged ones the motion itself.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn relative_motion(&self, motion: &[f64], forces: &[f64], omega: f64) -> Result<Vec<f64>> {
        let mut found = try_copy(motion, CONTEXT)?;
        let m = self.set.packed_len();
        for (c, exchange) in self.contacts.exchanges.iter().enumerate() {
            let Some(exchange) = exchange else { continue };
            for (i, &number) in self.set.numbers().iter().enumerate() {
                let y = exchange.motion(
                    (number, omega),
                    self.set.get_at(motion, c * m, i),
                    self.set.get_at(forces, c * m, i),
                );
                self.set.set(&mut found[c * m..(c + 1) * m], i, y);
            }
        }
        Ok(found)
    }

    /// Turns packed relative motions into initial values of the exchanged ones, where the contact forces are not
    /// known.
    pub fn exchange_start(&self, motion: &mut [f64]) {
        let m = self.set.packed_len();
        for (c, motion) in motion.chunks_exact_mut(m).enumerate() {
            let Some(exchange) = self.contacts.exchanges[c] else {
                continue;
            };
            // About the middle of the range.
            let omega = exchange.mass_at.unwrap_or(1.0);
            for (i, &number) in self.set.numbers().iter().enumerate() {
                let y = self.set.get(motion, i);
                self.set.set(motion, i, exchange.rate(number, omega).0 * y);
            }
        }
    }
}

/// The flexibility of the structure without reference stiffness in the i-th carried harmonic, (1 − Gκ)⁻¹G, column-major.
fn without_reference(
    condensed: &Condensed,
    (i, omega): (usize, f64),
    interrupt: &Interrupt<'_>,
) -> Result<Vec<Complex64>> {
    let n = condensed.coordinates();
    let mut workspace = Workspace::new(condensed, None)?;
    let table = &workspace.evaluate(condensed, i, omega, false, interrupt)?.value;
    let mut found = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    let mut lu = Lu::new(n, n)?;
    let a = lu.matrix();
    for c in 0..n {
        for r in 0..n {
            let g = table[c * (n + 1) + r];
            found[c * n + r] = g;
            a[c * n + r] = Complex64::from(f64::from(u8::from(c == r))) - g * condensed.kappa(c, i);
        }
    }
    match lu.factor(interrupt) {
        // A resonance: the flexibility with reference stiffness is as good a scale.
        Err(e) if e.status == Status::Singular => return Ok(found),
        factored => factored?,
    }
    lu.solve_columns(&mut found, false, interrupt)?;
    Ok(found)
}

#[cfg(test)]
#[path = "exchanged_motions_tests.rs"]
mod tests;
