//! A block of perturbations on modes of the stuck structure, for contacts of friction under constant loads.
//!
//! While a contact sticks it is a spring and part of the structure, moved by the force p = kt·w of its slider at w. The
//! modal coordinates q of a ring of sectors satisfy
//!
//! > q″ + C q′ + Ω² q = Rᴴ p + F,  r = R q + G p + r_F,
//!
//! with the flexibility G of the modes that are left out. A slider that slips keeps kt (r − w) = ± limit: with the set L of
//! the slipping contacts, E = (1/kt − G)_LL⁻¹ and the sticking ones S,
//!
//! > p_L = E (R_L q + G_LS p_S + r_F − (± limit)/kt).
//!
//! No degree of freedom of a contact is a state: a block has the modes of its diameters and the sliders that move.

use crate::error::{Result, fail, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::fallible_matrix::{add_product, adjoint, filled, zeros};
use crate::linalg::libraries::DMatrix;
use crate::model::matrices::structure::Structure;
use crate::model::natural_modes::contact_modes::ContactModes;
use crate::stability::closure::Closure;
use crate::time_integration::Number;
use num_complex::Complex64;
use std::f64::consts::SQRT_2;

const CONTEXT: &str = "the sectors on modes";

/// Contacts of friction under constant loads, equal in every sector.
pub(crate) struct Sliders {
    /// Stiffness of each contact.
    pub stiffness: Vec<f64>,
    /// Friction limit of each contact over its stiffness.
    pub play: Vec<f64>,
    /// Place of each slider before any motion.
    pub start: Vec<f64>,
}

/// Position of a wave among the coordinates of a block.
#[derive(Clone, Copy)]
pub(crate) struct RingWave {
    /// Nodal diameter 0 ..= N/2.
    pub diameter: usize,
    /// Index of the first coordinate of the wave.
    pub place: usize,
    /// Whether real and imaginary parts of the modal amplitudes are separate coordinates, times √2, real parts first.
    pub is_pair: bool,
}

/// The equations of a block on modes. Contacts are numbered contact by contact, sectors within.
pub(crate) struct ModalRing<T: Number> {
    pub closure: Closure,
    /// Number of contacts of a sector.
    pub contacts: usize,
    /// The waves of the block, each with `modes` modes.
    pub waves: Vec<RingWave>,
    pub modes: usize,
    /// Squared natural frequency Ω² of each coordinate.
    pub square: Vec<f64>,
    /// Modal damping matrix C; and its diagonal where it has no other entries.
    pub damping: DMatrix<T>,
    pub own_damping: Option<Vec<T>>,
    /// Relative motions R of all contacts in the coordinates.
    pub rows: DMatrix<T>,
    /// Flexibility G of the modes that are left out, contact by contact.
    pub residual: DMatrix<T>,
    /// Matrix that gives every sector the motion, in coordinates, of the sector that it follows.
    pub turn: DMatrix<T>,
    /// Stiffness kt of each contact.
    pub stiffness: Vec<f64>,
    /// Number of sectors by which the wave has moved after a lapse.
    follower: usize,
}

impl<T: Number> ModalRing<T> {
    /// Makes the equations of the block of a closure; `modes` are given by diameter 0 ..= N/2. In real numbers blocks
    /// are their own conjugates.
    ///
    /// # Errors
    /// `OutOfMemory`; `Internal` for a diameter that was not prepared; `StoppedByCaller`.
    pub fn new(
        structure: &Structure,
        closure: Closure,
        (modes, count): (&[Option<ContactModes>], usize),
        sliders: &Sliders,
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let (sectors, contacts) = (closure.sectors, sliders.stiffness.len());
        let (order, all) = (count * sectors, contacts * sectors);
        let mut ring = Self {
            closure,
            contacts,
            waves: Vec::new(),
            modes: count,
            square: try_vec(order, 0.0, CONTEXT)?,
            damping: zeros(order, order, CONTEXT)?,
            own_damping: None,
            rows: zeros(all, order, CONTEXT)?,
            residual: zeros(all, all, CONTEXT)?,
            turn: zeros(order, order, CONTEXT)?,
            stiffness: try_vec(all, 0.0, CONTEXT)?,
            follower: structure.sectors_per_part(),
        };
        for (e, stiffness) in ring.stiffness.iter_mut().enumerate() {
            *stiffness = sliders.stiffness[e / sectors];
        }
        let apart = structure.sectors() / sectors;
        let mut place = 0;
        for number in 0..sectors {
            interrupt.check()?;
            let diameter = number * apart + closure.index;
            let (stored, backward) = structure.fold(diameter as i64);
            let Some(own) = &modes[stored] else {
                return fail!(Internal, "no modes of nodal diameter {stored}");
            };
            ring.add_residual(structure, own, (diameter, backward, count), interrupt)?;
            interrupt.check_before((2 * (all + count) * count) as u64)?;
            let is_pair = !T::IS_COMPLEX && !(2 * stored).is_multiple_of(structure.sectors());
            if !is_pair || !backward {
                let wave = RingWave {
                    diameter: stored,
                    place,
                    is_pair,
                };
                try_push(&mut ring.waves, wave, CONTEXT)?;
            }
            if !is_pair {
                ring.add_wave(structure, own, (diameter, backward, count), place);
                place += count;
            } else if !backward {
                // With the wave of the other sense, which is its conjugate.
                ring.add_pair(structure, own, diameter, count, place);
                place += 2 * count;
            }
        }
        let is_diagonal = (0..order).all(|j| (0..order).all(|i| i == j || ring.damping[(i, j)] == T::NONE));
        if is_diagonal {
            let mut own = Vec::new();
            for i in 0..order {
                try_push(&mut own, ring.damping[(i, i)], CONTEXT)?;
            }
            ring.own_damping = Some(own);
        }
        Ok(ring)
    }

    /// Number of coordinates of the block.
    pub fn order(&self) -> usize {
        self.square.len()
    }

    /// Number of contacts over all sectors.
    pub fn all(&self) -> usize {
        self.stiffness.len()
    }

    /// Adds the flexibility 1/m (R K⁻¹ Rᴴ − Σ ψψᴴ/ω²) e^{−2πi(s − s′)δ/N} of one wave's omitted modes.
    fn add_residual(
        &mut self,
        structure: &Structure,
        own: &ContactModes,
        wave: (usize, bool, usize),
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (diameter, backward, count) = wave;
        let m = self.closure.sectors;
        let own = left_out(own, count, interrupt)?;
        for offset in 0..2 * m - 1 {
            let offset = offset as i64 - (m as i64 - 1);
            let turn = structure.wave_phase(diameter as i64, offset) / m as f64;
            for j in 0..self.contacts {
                interrupt.check_before((self.contacts * m) as u64)?;
                for i in 0..self.contacts {
                    let g = if backward { own[(i, j)].conj() } else { own[(i, j)] };
                    let value = T::of(turn * g);
                    for s in 0..m as i64 {
                        let to = s + offset;
                        if (0..m as i64).contains(&to) {
                            self.residual[(i * m + to as usize, j * m + s as usize)] += value;
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Adds the coordinates of one wave.
    fn add_wave(&mut self, structure: &Structure, own: &ContactModes, wave: (usize, bool, usize), place: usize) {
        let (diameter, backward, count) = wave;
        let m = self.closure.sectors;
        let sense = |z: Complex64| if backward { z.conj() } else { z };
        let share = (m as f64).sqrt().recip();
        let turn = structure.wave_phase(diameter as i64, self.follower as i64);
        for k in 0..count {
            self.square[place + k] = own.omega[k].powi(2);
            self.turn[(place + k, place + k)] = T::of(turn);
            for i in 0..count {
                self.damping[(place + i, place + k)] = T::of(sense(own.damping[(i, k)]));
            }
            for c in 0..self.contacts {
                for s in 0..m {
                    let phase = structure.wave_phase(diameter as i64, s as i64) * share;
                    self.rows[(c * m + s, place + k)] = T::of(phase * sense(own.rows[(c, k)]));
                }
            }
        }
    }

    /// Adds real and imaginary part, times √2, of the coordinates of a wave whose conjugate belongs to the block.
    fn add_pair(&mut self, structure: &Structure, own: &ContactModes, diameter: usize, count: usize, place: usize) {
        let m = self.closure.sectors;
        let share = SQRT_2 / (m as f64).sqrt();
        let real = |x: f64| T::of(x.into());
        let turn = structure.wave_phase(diameter as i64, self.follower as i64);
        for k in 0..count {
            let (a, b) = (place + k, place + count + k);
            self.square[a] = own.omega[k].powi(2);
            self.square[b] = self.square[a];
            (self.turn[(a, a)], self.turn[(a, b)]) = (real(turn.re), real(-turn.im));
            (self.turn[(b, a)], self.turn[(b, b)]) = (real(turn.im), real(turn.re));
            for i in 0..count {
                let c = own.damping[(i, k)];
                let (to_a, to_b) = (place + i, place + count + i);
                (self.damping[(to_a, a)], self.damping[(to_a, b)]) = (real(c.re), real(-c.im));
                (self.damping[(to_b, a)], self.damping[(to_b, b)]) = (real(c.im), real(c.re));
            }
            for c in 0..self.contacts {
                for s in 0..m {
                    let z = structure.wave_phase(diameter as i64, s as i64) * share * own.rows[(c, k)];
                    self.rows[(c * m + s, a)] = real(z.re);
                    self.rows[(c * m + s, b)] = real(-z.im);
                }
            }
        }
    }

    /// The contact whose motion contact `e` has one lapse later, and how often the ring is passed on the way to it.
    pub fn shifted(&self, e: usize) -> (usize, usize) {
        let m = self.closure.sectors;
        let to = e % m + self.follower;
        (e / m * m + to % m, to / m)
    }
}

/// Flexibility R K⁻¹ Rᴴ − Σ ψψᴴ/ω² of one sector's omitted modes.
fn left_out(own: &ContactModes, count: usize, interrupt: &Interrupt<'_>) -> Result<DMatrix<Complex64>> {
    let contacts = own.rows.nrows();
    let scaled = filled(contacts, count, CONTEXT, |c, k| own.rows[(c, k)] / own.omega[k].powi(2))?;
    let kept = adjoint(&filled(contacts, count, CONTEXT, |c, k| own.rows[(c, k)])?, CONTEXT)?;
    let mut left = filled(contacts, contacts, CONTEXT, |i, j| own.flexibility[(i, j)])?;
    add_product(&mut left, -Complex64::ONE, (&scaled, &kept), interrupt)?;
    Ok(left)
}
