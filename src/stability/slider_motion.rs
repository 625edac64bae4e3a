//! The equations of motion of a block on modes, its states, and the path of a lapse by the changes of its sliders.

use crate::contact::time_piece::Grazing;
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::fallible_matrix::copy_of_vector;
use crate::stability::modal_ring::{ModalRing, Sliders};
use nalgebra::DVector;
use num_complex::Complex64;
use std::f64::consts::TAU;

const CONTEXT: &str = "the motion on modes";

/// A force of one harmonic on coordinates, and on the relative motions that the modes leave out: Re(value e^{ihωt}).
pub(crate) struct RingForce {
    pub harmonic: usize,
    pub modal: Vec<Complex64>,
    pub relative: Vec<Complex64>,
}

/// Coordinates, velocities and the places of all sliders.
pub(crate) struct SliderState {
    pub q: DVector<f64>,
    pub v: DVector<f64>,
    pub w: DVector<f64>,
}

impl SliderState {
    /// A copy.
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

/// A change of one contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// Time since the change before.
    pub after: f64,
    pub contact: usize,
    /// Whether it slips from now on.
    pub slips: bool,
    /// Rate x′ with which a stretch reaches its limit; and that of a slider which another change has turned around, so that it
    /// stops while it moves. 0 where the time of the change does not matter.
    pub speed: f64,
}

/// The changes of a lapse, from which perturbations are carried.
#[derive(Default)]
pub(crate) struct Path {
    /// Contacts that slip at the begin.
    pub first: Vec<usize>,
    pub changes: Vec<Change>,
    /// Time from the last change to the end.
    pub rest: f64,
    /// Contacts that have slipped.
    pub moved: Vec<bool>,
    pub grazing: Option<(usize, Grazing)>,
    /// Largest displacement and velocity of a coordinate at the ends of steps.
    pub largest: (f64, f64),
}

/// The equations of motion.
pub(crate) struct SliderMotion<'a> {
    pub ring: &'a ModalRing<f64>,
    pub forces: Vec<RingForce>,
    pub omega: f64,
    /// The part of the period after which every sector repeats the motion of another one.
    pub lapse: f64,
    /// Play of each contact.
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
