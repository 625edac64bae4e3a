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
use crate::stability::modal_ring::ModalRing;
use crate::stability::slider_motion::{Change, Path};
use crate::stability::slipping::Slipping;
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
    /// Forces of moving sliders at rest; those that slip have none of their own.
    p: DMatrix<T>,
    /// Whether a moving slider slips.
    slips: Vec<bool>,
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
            slips: try_vec(moving.len(), false, CONTEXT)?,
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
        let mut slipping = Slipping::new(self.ring, try_copy(&path.first, CONTEXT)?)?;
        for &e in &path.first {
            self.slips[self.number[e]] = true;
        }
        // Change −δt of the time at which the last stretch has reached its limit.
        let mut late: Option<DMatrix<T>> = None;
        for (i, change) in path.changes.iter().enumerate() {
            if change.after > 0.0 {
                self.carry(&slipping, change.after, interrupt)?;
                late = None;
            }
            let number = self.number[change.contact];
            if change.slips {
                if change.speed != 0.0 && stops_others(&path.changes[i + 1..]) {
                    late = Some(self.stretch(&slipping, change.contact)? * T::of((1.0 / change.speed).into()));
                }
                self.p.row_mut(number).fill(T::NONE);
            } else if let Some(at) = slipping.place(change.contact) {
                self.follow(&slipping, &[at])?;
                if let Some(late) = late.as_ref().filter(|_| change.speed != 0.0) {
                    // The slider stops while it moves, at the time of another change.
                    let rate = change.speed * self.ring.stiffness[change.contact];
                    let mut row = self.p.row_mut(number);
                    row -= late * T::of(rate.into());
                }
            }
            slipping.change(self.ring, change.contact, change.slips)?;
            self.slips[number] = change.slips;
        }
        self.carry(&slipping, path.rest, interrupt)?;
        self.follow(&slipping, &all_of(&slipping.list)?)
    }

    /// G_LS p_S
    fn through_others(&self, slipping: &Slipping<T>) -> Result<DMatrix<T>> {
        let list = &slipping.list;
        let mut resting = Vec::new();
        for i in (0..self.moving.len()).filter(|&i| !self.slips[i]) {
            try_push(&mut resting, i, CONTEXT)?;
        }
        let coupling = DMatrix::from_fn(list.len(), resting.len(), |i, j| {
            self.ring.residual[(list[i], self.moving[resting[j]])]
        });
        Ok(coupling * self.p.select_rows(&resting))
    }

    /// Forces of slipping sliders, given by their places in the list, from coordinates and the sliders at rest.
    fn forces(&self, slipping: &Slipping<T>, places: &[usize]) -> Result<DMatrix<T>> {
        let coupled = self.through_others(slipping)?;
        Ok(slipping.rows.select_rows(places) * &self.x + slipping.inverse.select_rows(places) * coupled)
    }

    /// Sets these forces.
    fn follow(&mut self, slipping: &Slipping<T>, places: &[usize]) -> Result<()> {
        if places.is_empty() {
            return Ok(());
        }
        let forces = self.forces(slipping, places)?;
        for (i, &at) in places.iter().enumerate() {
            let number = self.number[slipping.list[at]];
            self.p.row_mut(number).copy_from(&forces.row(i));
        }
        Ok(())
    }

    /// δ(r − w) of a contact at rest.
    fn stretch(&self, slipping: &Slipping<T>, contact: usize) -> Result<DMatrix<T>> {
        let ring = self.ring;
        let list = &slipping.list;
        let mut stretch = ring.rows.rows(contact, 1) * &self.x;
        let coupling = DMatrix::from_fn(1, self.moving.len(), |_, j| ring.residual[(contact, self.moving[j])]);
        // Forces of the list are zero as long as they slip.
        stretch += coupling * &self.p;
        let coupling = DMatrix::from_fn(1, list.len(), |_, j| ring.residual[(contact, list[j])]);
        stretch += coupling * self.forces(slipping, &all_of(list)?)?;
        let own = T::of((-1.0 / ring.stiffness[contact]).into());
        stretch += self.p.rows(self.number[contact], 1) * own;
        Ok(stretch)
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
        load += slipping.rows.ad_mul(&self.through_others(slipping)?);
        let fastest = (0..order)
            .map(|j| {
                slipping
                    .stiffness
                    .column(j)
                    .iter()
                    .map(|z| Scalar::size(*z))
                    .sum::<f64>()
            })
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
            let mut new = if k == 0 {
                load.clone()
            } else {
                DMatrix::zeros(load.nrows(), load.ncols())
            };
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

/// All places of a list.
fn all_of(list: &[usize]) -> Result<Vec<usize>> {
    let mut all = Vec::new();
    for at in 0..list.len() {
        try_push(&mut all, at, CONTEXT)?;
    }
    Ok(all)
}

/// Whether one of the changes at the same time stops a slider that moves.
fn stops_others(next: &[Change]) -> bool {
    let same = next.iter().take_while(|change| change.after == 0.0);
    same.into_iter().any(|change| !change.slips && change.speed != 0.0)
}

/// Largest entry.
fn size<T: Number>(a: &DMatrix<T>) -> f64 {
    a.iter().fold(0.0_f64, |m, z| {
        let size = Scalar::size(*z);
        // Stays NaN once it is.
        if size <= m || m.is_nan() { m } else { size }
    })
}
