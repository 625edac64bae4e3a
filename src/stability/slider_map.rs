//! The map of a lapse on modes: perturbations (δq, δv, δw) carried along the path of a motion.
//!
//! The forces of slipping sliders follow from coordinates and sticking ones, δp_L = E (R_L δq + G_LS δp_S), so that
//!
//! > δq″ + C δq′ + (Ω² − R_Lᴴ E R_L) δq = R_Sᴴ δp_S + (E R_L)ᴴ G_LS δp_S
//!
//! between two changes. The right-hand side of the motion is continuous at changes, and displacements and velocities pass them; a
//! slider that comes to rest keeps the place that it has then, and one that begins to slip forgets its own.
//! Sliders that never slip are springs, and no part of the map.

use crate::error::{Result, check_memory, fail, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::lu::Scalar;
use crate::stability::modal_ring::{ModalRing, Slipping};
use crate::stability::slider_motion::Path;
use crate::time_integration::Number;
use nalgebra::DMatrix;

const CONTEXT: &str = "the perturbations on modes";

/// Rate of the fastest motion times the length of one series.
const SLIDER_MAP_STEP: f64 = 2.0;

/// Share of the largest term at which a series is cut off.
const SLIDER_MAP_CUT: f64 = 1e-17;

/// Terms of a series.
const SLIDER_MAP_MOST_TERMS: usize = 100;

/// Perturbations by columns: those of coordinates, velocities, and the places of sliders at rest that move at some time.
pub(crate) struct SliderMap<'r, T: Number> {
    ring: &'r ModalRing<T>,
    /// Contacts that move in some sector, ascending.
    pub moving: Vec<usize>,
    /// Number of a moving contact.
    number: Vec<usize>,
    x: DMatrix<T>,
    v: DMatrix<T>,
    /// Forces of moving sliders.
    p: DMatrix<T>,
    /// State of each column.
    carried: Vec<usize>,
}

impl<'r, T: Number> SliderMap<'r, T> {
    /// The map of a lapse; `moves` tells whether a contact slips in some sector.
    ///
    /// # Errors
    /// `NoConvergence` for perturbations that grow beyond all bounds; as [`ModalRing::slipping`].
    pub fn new(ring: &'r ModalRing<T>, path: &Path, moves: &[bool], interrupt: &Interrupt<'_>) -> Result<Self> {
        let mut moving = Vec::new();
        let mut number = try_vec(ring.all(), usize::MAX, CONTEXT)?;
        for e in (0..ring.all()).filter(|&e| moves[e]) {
            number[e] = moving.len();
            try_push(&mut moving, e, CONTEXT)?;
        }
        let order = ring.order();
        // Sliders that slip at the begin have no place of their own.
        let mut carried = Vec::new();
        for i in 0..2 * order {
            try_push(&mut carried, i, CONTEXT)?;
        }
        for (i, e) in moving.iter().enumerate() {
            if path.first.binary_search(e).is_err() {
                try_push(&mut carried, 2 * order + i, CONTEXT)?;
            }
        }
        let columns = carried.len();
        check_memory::<T>(columns.saturating_mul(6 * order + 3 * moving.len()), CONTEXT)?;
        let mut map = Self {
            ring,
            x: DMatrix::zeros(order, columns),
            v: DMatrix::zeros(order, columns),
            p: DMatrix::zeros(moving.len(), columns),
            moving,
            number,
            carried,
        };
        for column in 0..columns {
            let state = map.carried[column];
            if state < order {
                map.x[(state, column)] = T::one();
            } else if state < 2 * order {
                map.v[(state - order, column)] = T::one();
            } else {
                let e = map.moving[state - 2 * order];
                map.p[(state - 2 * order, column)] = T::of(ring.stiffness[e].into());
            }
        }
        map.through(path, interrupt)?;
        Ok(map)
    }

    fn through(&mut self, path: &Path, interrupt: &Interrupt<'_>) -> Result<()> {
        let mut list: Vec<usize> = try_copy(&path.first, CONTEXT)?;
        let mut slipping = self.ring.slipping(try_copy(&list, CONTEXT)?)?;
        let mut current = true;
        let mut waiting = 0.0;
        for change in &path.changes {
            waiting += change.after;
            // Changes at one time are one.
            if change.after > 0.0 || !change.slips {
                if !current {
                    slipping = self.ring.slipping(try_copy(&list, CONTEXT)?)?;
                }
                self.carry(&slipping, core::mem::replace(&mut waiting, 0.0), interrupt)?;
            }
            match (list.binary_search(&change.contact), change.slips) {
                (Err(at), true) => {
                    list.insert(at, change.contact);
                    let number = self.number[change.contact];
                    self.p.row_mut(number).fill(T::NONE);
                }
                (Ok(at), false) => {
                    self.follow(&slipping, &[at]);
                    list.remove(at);
                }
                _ => {}
            }
            current = false;
        }
        if !current {
            slipping = self.ring.slipping(list)?;
        }
        self.carry(&slipping, waiting + path.rest, interrupt)?;
        let mut all = Vec::new();
        for at in 0..slipping.list.len() {
            try_push(&mut all, at, CONTEXT)?;
        }
        self.follow(&slipping, &all);
        Ok(())
    }

    /// G_LS p_S
    fn through_others(&self, slipping: &Slipping<T>) -> DMatrix<T> {
        let (list, moving) = (&slipping.list, &self.moving);
        let coupling = DMatrix::from_fn(list.len(), moving.len(), |i, j| self.ring.residual[(list[i], moving[j])]);
        coupling * &self.p
    }

    /// Forces of slipping sliders, given by their places in the list, from coordinates and the sliders at rest.
    fn follow(&mut self, slipping: &Slipping<T>, places: &[usize]) {
        if places.is_empty() {
            return;
        }
        let coupled = self.through_others(slipping);
        let select = |a: &DMatrix<T>| DMatrix::from_fn(places.len(), a.ncols(), |i, j| a[(places[i], j)]);
        let forces = select(&slipping.rows) * &self.x + select(&slipping.inverse) * coupled;
        for (i, &at) in places.iter().enumerate() {
            let number = self.number[slipping.list[at]];
            self.p.row_mut(number).copy_from(&forces.row(i));
        }
    }

    /// Carries all columns over a time in which no contact changes.
    fn carry(&mut self, slipping: &Slipping<T>, time: f64, interrupt: &Interrupt<'_>) -> Result<()> {
        if time <= 0.0 {
            return Ok(());
        }
        let ring = self.ring;
        let order = ring.order();
        let rows = DMatrix::from_fn(self.moving.len(), order, |i, j| ring.rows[(self.moving[i], j)]);
        interrupt.check_before((2 * self.p.len() * (order + slipping.list.len())) as u64)?;
        let mut load = rows.ad_mul(&self.p);
        load += slipping.rows.ad_mul(&self.through_others(slipping));
        let fastest = (0..order)
            .map(|j| slipping.stiffness.column(j).iter().map(|z| Scalar::size(*z)).sum::<f64>())
            .fold(0.0_f64, f64::max)
            .sqrt();
        let parts = (fastest * time / SLIDER_MAP_STEP).ceil().max(1.0);
        let h = time / parts;
        for _ in 0..parts as usize {
            self.series(slipping, &load, h, interrupt)?;
        }
        Ok(())
    }

    /// Sums the series over a time h.
    fn series(&mut self, slipping: &Slipping<T>, load: &DMatrix<T>, h: f64, interrupt: &Interrupt<'_>) -> Result<()> {
        let real = |x: f64| T::of(x.into());
        let mut this = self.x.clone();
        let mut next = &self.v * real(h);
        self.x += &next;
        let mut largest = size(&this).max(size(&next));
        let mut small = 0;
        for k in 0..SLIDER_MAP_MOST_TERMS {
            interrupt.check_before((2 * self.x.len() * self.x.nrows()) as u64)?;
            let mut new = if k == 0 { load.clone() } else { DMatrix::zeros(load.nrows(), load.ncols()) };
            new.gemm(real(-1.0), &slipping.stiffness, &this, T::one());
            let rate = -((k + 1) as f64) / h;
            match &self.ring.own_damping {
                Some(own) => {
                    for (mut new, next) in new.column_iter_mut().zip(next.column_iter()) {
                        for ((new, next), c) in new.iter_mut().zip(next.iter()).zip(own) {
                            *new += (*c * *next).scaled(rate);
                        }
                    }
                }
                None => new.gemm(real(rate), &self.ring.damping, &next, T::one()),
            }
            new *= real(h * h / ((k + 1) * (k + 2)) as f64);
            self.x += &new;
            let speed = real((k + 2) as f64 / h);
            self.v.zip_apply(&new, |v, new| *v += new * speed);
            let term = size(&new) * (k + 2) as f64;
            if !term.is_finite() {
                return fail!(NoConvergence, "perturbations grow beyond all bounds");
            }
            largest = largest.max(term);
            small = if term <= SLIDER_MAP_CUT * largest { small + 1 } else { 0 };
            if small == 2 {
                return Ok(());
            }
            this = core::mem::replace(&mut next, new);
        }
        fail!(NoConvergence, "the series of perturbations does not end")
    }

    /// Number of states: coordinates, velocities and moving sliders.
    pub fn states(&self) -> usize {
        2 * self.ring.order() + self.moving.len()
    }

    /// The map from the states at the begin to those at the end, in which every sector takes the place of the one that it
    /// follows. Velocities are divided by `omega`, and places of sliders multiplied by `scale`; `factor` is that of a turn of the ring.
    pub fn matrix(&self, omega: f64, scale: f64, factor: impl Fn(usize) -> T) -> DMatrix<T> {
        let order = self.ring.order();
        let mut map = DMatrix::zeros(self.states(), self.states());
        let (x, v) = (&self.ring.turn * &self.x, &self.ring.turn * &self.v);
        for (column, &state) in self.carried.iter().enumerate() {
            let unit = match state {
                s if s < order => 1.0,
                s if s < 2 * order => omega,
                _ => 1.0 / scale,
            };
            for i in 0..order {
                map[(i, state)] = x[(i, column)].scaled(unit);
                map[(order + i, state)] = v[(i, column)].scaled(unit / omega);
            }
            for (i, &e) in self.moving.iter().enumerate() {
                let (to, turns) = self.ring.shifted(e);
                let value = self.p[(self.number[to], column)] * factor(turns);
                map[(2 * order + i, state)] = value.scaled(unit * scale / self.ring.stiffness[e]);
            }
        }
        map
    }
}

/// Largest entry.
fn size<T: Number>(a: &DMatrix<T>) -> f64 {
    a.iter().fold(0.0_f64, |m, z| {
        let size = Scalar::size(*z);
        // Stays NaN once it is.
        if size <= m || m.is_nan() { m } else { size }
    })
}
