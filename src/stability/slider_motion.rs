//! The equations of motion of a block on modes, its states, and the path of a lapse by the changes of its sliders.

use crate::contact::forms::time_piece::Grazing;
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::fallible_matrix::copy_of_vector;
use crate::linalg::libraries::DVector;
use crate::stability::modal_ring::{ModalRing, Sliders};
use num_complex::Complex64;
use std::f64::consts::TAU;

const CONTEXT: &str = "the motion on modes";

/// A force of one harmonic, Re(value e^{ihωt}), on coordinates and on the relative motions that the modes leave out.
pub(crate) struct RingForce {
    pub harmonic: usize,
    pub modal: Vec<Complex64>,
    pub relative: Vec<Complex64>,
}

/// State of a block in time: modal coordinates q, velocities v and places w of all sliders.
pub(crate) struct SliderState {
    pub q: DVector<f64>,
    pub v: DVector<f64>,
    pub w: DVector<f64>,
}

impl SliderState {
    /// A copy that returns an error if memory is short.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn try_clone(&self) -> Result<Self> {
        Ok(Self {
            q: copy_of_vector(&self.q, CONTEXT)?,
            v: copy_of_vector(&self.v, CONTEXT)?,
            w: copy_of_vector(&self.w, CONTEXT)?,
        })
    }
}

/// A change of the state of one contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// Time since the previous change.
    pub after: f64,
    pub contact: usize,
    /// Whether the contact slips from now on.
    pub slips: bool,
    /// Rate x′ at which a stretch reaches its limit; or of a slider that another change has turned round, so that it
    /// stops while moving. 0 where the time of the change does not matter.
    pub speed: f64,
}

/// Changes of contacts in a lapse, along which perturbations are carried.
#[derive(Default)]
pub(crate) struct Path {
    /// Contacts that slip at the beginning.
    pub first: Vec<usize>,
    pub changes: Vec<Change>,
    /// Time from the last change to the end of the lapse.
    pub rest: f64,
    /// For each contact, whether it has slipped.
    pub moved: Vec<bool>,
    pub grazing: Option<(usize, Grazing)>,
    /// Largest displacement and velocity of a coordinate at the ends of steps.
    pub largest: (f64, f64),
}

/// The equations of motion of a block on modes.
pub(crate) struct SliderMotion<'a> {
    pub ring: &'a ModalRing<f64>,
    pub forces: Vec<RingForce>,
    pub omega: f64,
    /// Part of the period after which every sector repeats the motion of another one.
    pub lapse: f64,
    /// Play of each contact: friction limit over stiffness.
    pub play: Vec<f64>,
    pub interrupt: &'a Interrupt<'a>,
}

impl<'a> SliderMotion<'a> {
    pub fn new(
        ring: &'a ModalRing<f64>,
        sliders: &Sliders,
        (omega, lapses): (f64, usize),
        forces: Vec<RingForce>,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let m = ring.closure.sectors;
        let mut play = try_vec(ring.all(), 0.0, CONTEXT)?;
        for (e, play) in play.iter_mut().enumerate() {
            *play = sliders.play[e / m];
        }
        Ok(Self {
            ring,
            forces,
            omega,
            lapse: TAU / omega / lapses as f64,
            play,
            interrupt,
        })
    }
}
