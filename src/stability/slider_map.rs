//! The map of a lapse on modes: perturbations (δq, δv, δw) carried along the path of a motion.
//!
//! The forces of slipping sliders follow from coordinates and sticking ones, δp_L = E (R_L δq + G_LS δp_S), so that
//!
//! > δq″ + C δq′ + (Ω² − R_Lᴴ E R_L) δq = R_Sᴴ δp_S + (E R_L)ᴴ G_LS δp_S
//!
//! between two changes. The right-hand side of the motion is continuous at changes, and displacements and velocities pass them; a
//! slider that comes to rest keeps the place that it has then, and one that begins to slip forgets its own.
//! Sliders that never slip are springs, and no part of the map.

use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::fallible_matrix::{add_product, adjoint, filled, product, zeros};
use crate::linalg::factors::lu::Scalar;
use crate::linalg::libraries::DMatrix;
use crate::stability::modal_ring::ModalRing;
use crate::stability::slider_motion::{Change, Path};
use crate::stability::slipping::Slipping;
use crate::time_integration::Number;

const CONTEXT: &str = "the perturbations on modes";

/// Rate of the fastest motion times the length of one series.
/// Kind: tuned; measured on: not recorded.
pub(super) const SLIDER_MAP_STEP: f64 = 2.0;

/// Share of the largest term at which a series is cut off.
/// Kind: rounding.
const SLIDER_MAP_CUT: f64 = 1e-17;

/// Terms of a series.
/// Kind: cap.
const SLIDER_MAP_MOST_TERMS: usize = 100;

/// Perturbations in columns: of coordinates, of velocities, and of the places of those sticking sliders that move at
/// some time.
pub(crate) struct SliderMap<'r, T: Number> {
    ring: &'r ModalRing<T>,
    /// Contacts that move in some sector, ascending.
    pub moving: Vec<usize>,
    /// Index among the moving contacts of each contact that moves.
    number: Vec<usize>,
    x: DMatrix<T>,
    v: DMatrix<T>,
    /// Forces of the moving sliders that stick at present; slipping ones have no force of their own.
    p: DMatrix<T>,
    /// For each moving slider, whether it slips at present.
    slips: Vec<bool>,
    /// State that each column perturbs.
    carried: Vec<usize>,
}

/// Memory of a lapse, as large as the coordinates of all columns.
struct Series<T: Number> {
    /// Product matrix R_movingᴴ.
    rows: DMatrix<T>,
    load: DMatrix<T>,
    /// Three successive terms of the series.
    this: DMatrix<T>,
    next: DMatrix<T>,
    new: DMatrix<T>,
}

impl<'r, T: Number> SliderMap<'r, T> {
    /// Computes the map of a lapse; `moves` tells whether a contact slips in some sector.
    ///
    /// # Errors
    /// `NoConvergence` for perturbations that grow beyond all bounds; as [`Slipping::new`].
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
        let mut map = Self {
            ring,
            x: zeros(order, columns, CONTEXT)?,
            v: zeros(order, columns, CONTEXT)?,
            p: zeros(moving.len(), columns, CONTEXT)?,
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
        let mut memory = Series {
            rows: filled(order, map.moving.len(), CONTEXT, |j, i| {
                ring.rows[(map.moving[i], j)].conjugated()
            })?,
            load: zeros(order, columns, CONTEXT)?,
            this: zeros(order, columns, CONTEXT)?,
            next: zeros(order, columns, CONTEXT)?,
            new: zeros(order, columns, CONTEXT)?,
        };
        map.through(path, &mut memory, interrupt)?;
        Ok(map)
    }

    fn through(&mut self, path: &Path, memory: &mut Series<T>, interrupt: &Interrupt<'_>) -> Result<()> {
        let mut slipping = Slipping::new(self.ring, try_copy(&path.first, CONTEXT)?, interrupt)?;
        for &e in &path.first {
            self.slips[self.number[e]] = true;
        }
        // Change −δt of the time at which the last stretch has reached its limit.
        let mut late: Option<DMatrix<T>> = None;
        for (i, change) in path.changes.iter().enumerate() {
            if change.after > 0.0 {
                self.carry(&slipping, change.after, memory, interrupt)?;
                late = None;
            }
            let number = self.number[change.contact];
            if change.slips {
                if change.speed != 0.0 && stops_others(&path.changes[i + 1..]) {
                    let mut stretch = self.stretch(&slipping, change.contact, interrupt)?;
                    stretch *= T::of((1.0 / change.speed).into());
                    late = Some(stretch);
                }
                self.p.row_mut(number).fill(T::NONE);
            } else if let Some(at) = slipping.place(change.contact) {
                self.follow(&slipping, &[at], interrupt)?;
                if let Some(late) = late.as_ref().filter(|_| change.speed != 0.0) {
                    // The slider stops while it moves, at the time of another change.
                    let rate = change.speed * self.ring.stiffness[change.contact];
                    for (p, late) in self.p.row_mut(number).iter_mut().zip(late.iter()) {
                        *p -= late.scaled(rate);
                    }
                }
            }
            slipping.change(self.ring, change.contact, change.slips, interrupt)?;
            self.slips[number] = change.slips;
        }
        self.carry(&slipping, path.rest, memory, interrupt)?;
        self.follow(&slipping, &all_of(&slipping.list)?, interrupt)
    }

    /// Effect G_LS p_S of sticking sliders on the slipping contacts.
    fn through_others(&self, slipping: &Slipping<T>, interrupt: &Interrupt<'_>) -> Result<DMatrix<T>> {
        let list = &slipping.list;
        let mut resting = Vec::new();
        for i in (0..self.moving.len()).filter(|&i| !self.slips[i]) {
            try_push(&mut resting, i, CONTEXT)?;
        }
        let coupling = filled(list.len(), resting.len(), CONTEXT, |i, j| {
            self.ring.residual[(list[i], self.moving[resting[j]])]
        })?;
        product(&coupling, &selected(&self.p, &resting)?, CONTEXT, interrupt)
    }

    /// Forces of those slipping sliders whose positions in the list are given, from coordinates and sticking sliders.
    fn forces(&self, slipping: &Slipping<T>, places: &[usize], interrupt: &Interrupt<'_>) -> Result<DMatrix<T>> {
        let coupled = self.through_others(slipping, interrupt)?;
        let mut forces = product(&selected(&slipping.rows, places)?, &self.x, CONTEXT, interrupt)?;
        let inverse = selected(&slipping.inverse, places)?;
        add_product(&mut forces, T::one(), (&inverse, &coupled), interrupt)?;
        Ok(forces)
    }

    /// Sets the forces of those slipping sliders whose positions in the list are given.
    fn follow(&mut self, slipping: &Slipping<T>, places: &[usize], interrupt: &Interrupt<'_>) -> Result<()> {
        if places.is_empty() {
            return Ok(());
        }
        let forces = self.forces(slipping, places, interrupt)?;
        for (i, &at) in places.iter().enumerate() {
            let number = self.number[slipping.list[at]];
            self.p.row_mut(number).copy_from(&forces.row(i));
        }
        Ok(())
    }

    /// Perturbation δ(r − w) of the stretch of a sticking contact.
    fn stretch(&self, slipping: &Slipping<T>, contact: usize, interrupt: &Interrupt<'_>) -> Result<DMatrix<T>> {
        let ring = self.ring;
        let list = &slipping.list;
        let mut stretch = product(&selected(&ring.rows, &[contact])?, &self.x, CONTEXT, interrupt)?;
        let coupling = filled(1, self.moving.len(), CONTEXT, |_, j| {
            ring.residual[(contact, self.moving[j])]
        })?;
        // Forces of the list are zero as long as they slip.
        add_product(&mut stretch, T::one(), (&coupling, &self.p), interrupt)?;
        let coupling = filled(1, list.len(), CONTEXT, |_, j| ring.residual[(contact, list[j])])?;
        let forces = self.forces(slipping, &all_of(list)?, interrupt)?;
        add_product(&mut stretch, T::one(), (&coupling, &forces), interrupt)?;
        let own = self.p.row(self.number[contact]);
        for (stretch, p) in stretch.iter_mut().zip(own.iter()) {
            *stretch -= p.scaled(1.0 / ring.stiffness[contact]);
        }
        Ok(stretch)
    }

    /// Carries all columns over a time during which no contact changes.
    fn carry(
        &mut self,
        slipping: &Slipping<T>,
        time: f64,
        memory: &mut Series<T>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        if time <= 0.0 {
            return Ok(());
        }
        memory.load.fill(T::NONE);
        add_product(&mut memory.load, T::one(), (&memory.rows, &self.p), interrupt)?;
        let (rows, coupled) = (
            adjoint(&slipping.rows, CONTEXT)?,
            self.through_others(slipping, interrupt)?,
        );
        add_product(&mut memory.load, T::one(), (&rows, &coupled), interrupt)?;
        let fastest = (0..self.ring.order())
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
            self.series(slipping, memory, h, interrupt)?;
        }
        Ok(())
    }

    /// Sums the series over a time h.
    fn series(
        &mut self,
        slipping: &Slipping<T>,
        memory: &mut Series<T>,
        h: f64,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let real = |x: f64| T::of(x.into());
        let Series {
            load, this, next, new, ..
        } = memory;
        this.copy_from(&self.x);
        next.copy_from(&self.v);
        *next *= real(h);
        self.x += &*next;
        let mut largest = size(this).max(size(next));
        let mut small = 0;
        for k in 0..SLIDER_MAP_MOST_TERMS {
            interrupt.check_before(self.x.len() as u64)?;
            if k == 0 {
                new.copy_from(load);
            } else {
                new.fill(T::NONE);
            }
            add_product(new, real(-1.0), (&slipping.stiffness, &*this), interrupt)?;
            let rate = -((k + 1) as f64) / h;
            match &self.ring.own_damping {
                Some(own) => {
                    for (mut new, next) in new.column_iter_mut().zip(next.column_iter()) {
                        for ((new, next), c) in new.iter_mut().zip(next.iter()).zip(own) {
                            *new += (*c * *next).scaled(rate);
                        }
                    }
                }
                None => add_product(new, real(rate), (&self.ring.damping, &*next), interrupt)?,
            }
            *new *= real(h * h / ((k + 1) * (k + 2)) as f64);
            self.x += &*new;
            let speed = real((k + 2) as f64 / h);
            self.v.zip_apply(&*new, |v, new| *v += new * speed);
            let term = size(new) * (k + 2) as f64;
            if !term.is_finite() {
                return fail!(NoConvergence, "perturbations grow beyond all bounds");
            }
            largest = largest.max(term);
            small = if term <= SLIDER_MAP_CUT * largest { small + 1 } else { 0 };
            if small == 2 {
                return Ok(());
            }
            core::mem::swap(this, next);
            core::mem::swap(next, new);
        }
        fail!(NoConvergence, "the series of perturbations does not end")
    }

    /// Number of states: coordinates, velocities and moving sliders.
    pub fn states(&self) -> usize {
        2 * self.ring.order() + self.moving.len()
    }

    /// The map from the states at the beginning to those at the end of the lapse, in which every sector takes the
    /// place of the one that it follows. Velocities are divided by `omega`, and places of sliders multiplied by
    /// `scale`; `factor` gives the factor of a turn of the ring.
    pub fn matrix(
        &self,
        (omega, scale): (f64, f64),
        factor: impl Fn(usize) -> T,
        interrupt: &Interrupt<'_>,
    ) -> Result<DMatrix<T>> {
        let order = self.ring.order();
        let mut map = zeros(self.states(), self.states(), CONTEXT)?;
        let x = product(&self.ring.turn, &self.x, CONTEXT, interrupt)?;
        let v = product(&self.ring.turn, &self.v, CONTEXT, interrupt)?;
        for (column, &state) in self.carried.iter().enumerate() {
            interrupt.check_before(self.states() as u64)?;
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
        Ok(map)
    }
}

/// The given rows of a matrix.
fn selected<T: Number>(a: &DMatrix<T>, rows: &[usize]) -> Result<DMatrix<T>> {
    filled(rows.len(), a.ncols(), CONTEXT, |i, j| a[(rows[i], j)])
}

/// All positions in a list.
fn all_of(list: &[usize]) -> Result<Vec<usize>> {
    let mut all = Vec::new();
    for at in 0..list.len() {
        try_push(&mut all, at, CONTEXT)?;
    }
    Ok(all)
}

/// Whether one of several simultaneous changes stops a slider that moves.
fn stops_others(next: &[Change]) -> bool {
    let same = next.iter().take_while(|change| change.after == 0.0);
    same.into_iter().any(|change| !change.slips && change.speed != 0.0)
}

/// Largest modulus of an entry.
fn size<T: Number>(a: &DMatrix<T>) -> f64 {
    a.iter().fold(0.0_f64, |m, z| {
        let size = Scalar::size(*z);
        // Stays NaN once it is.
        if size <= m || m.is_nan() { m } else { size }
    })
}
