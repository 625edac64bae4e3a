//! The periodic motion of a block on modes, by Newton's method over a lapse: shooting.

use crate::error::{Result, Status, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::fallible_matrix::zero_vector;
use crate::linalg::factors::lu::Lu;
use crate::linalg::libraries::DVector;
use crate::model::matrices::structure::Structure;
use crate::stability::slider_map::SliderMap;
use crate::stability::slider_motion::{Path, SliderMotion, SliderState};

const CONTEXT: &str = "shooting on modes";

/// Newton's iterations.
/// Kind: cap.
const SLIDER_ORBIT_MOST_ITERATIONS: usize = 30;

/// Smallest share of a Newton step that is tried.
/// Kind: cap.
const SLIDER_ORBIT_SHORTEST: f64 = 1.0 / 64.0;

/// A periodic motion of a block on modes.
pub(crate) struct Orbit {
    pub state: SliderState,
    pub path: Path,
    /// For each contact, whether it slips in some sector.
    pub moves: Vec<bool>,
    /// Largest change over a lapse, relative to the motion.
    pub residual: f64,
}

/// Outcome of one lapse from a state.
struct Trial {
    state: SliderState,
    path: Path,
    moves: Vec<bool>,
    /// Change of the state over the lapse; velocities are divided by ω, places of sliders are in units of
    /// coordinates.
    change: DVector<f64>,
    residual: f64,
}

/// The periodic motion next to a state; `None`: Newton's method did not converge. With `iterate` false the state is taken as it is.
///
/// # Errors
/// Those of [`SliderMotion::run`], `StoppedByCaller`.
pub(crate) fn orbit(
    motion: &SliderMotion<'_>,
    structure: &Structure,
    start: SliderState,
    tolerance: f64,
    iterate: bool,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Orbit>> {
    let mut current = trial(motion, structure, start)?;
    if iterate {
        for _ in 0..SLIDER_ORBIT_MOST_ITERATIONS {
            if current.residual <= tolerance {
                break;
            }
            let Some(step) = newton(motion, structure, &current, interrupt)? else {
                return Ok(None);
            };
            let mut share = 1.0;
            let next = loop {
                match trial(motion, structure, moved(motion, &current, &step, share)?) {
                    Ok(next) if next.residual < current.residual => break Some(next),
                    Err(e) if !matches!(e.status, Status::NoBoundedSolution | Status::NoConvergence) => return Err(e),
                    _ => {}
                }
                share *= 0.5;
                if share < SLIDER_ORBIT_SHORTEST {
                    break None;
                }
            };
            let Some(next) = next else { return Ok(None) };
            current = next;
        }
        if current.residual > tolerance {
            return Ok(None);
        }
    }
    Ok(Some(Orbit {
        state: current.state,
        path: current.path,
        moves: current.moves,
        residual: current.residual,
    }))
}

/// Factor that gives places of sliders the unit of coordinates.
pub(crate) fn scale_of_sliders(motion: &SliderMotion<'_>) -> f64 {
    let largest = motion.ring.rows.amax();
    if largest > 0.0 { 1.0 / largest } else { 1.0 }
}

fn trial(motion: &SliderMotion<'_>, structure: &Structure, state: SliderState) -> Result<Trial> {
    let ring = motion.ring;
    let mut image = state.try_clone()?;
    let path = motion.run(&mut image)?;
    let (order, all) = (ring.order(), ring.all());
    let mut moves = try_vec(all, false, CONTEXT)?;
    for (e, moves) in moves.iter_mut().enumerate() {
        let family = e / ring.closure.sectors * ring.closure.sectors;
        *moves = (family..family + ring.closure.sectors).any(|e| path.moved[e]);
    }
    let scale = scale_of_sliders(motion);
    motion.interrupt.check_before((4 * order * order) as u64)?;
    let mut change = zero_vector(2 * order + all, CONTEXT)?;
    for (first, unit, image, from) in [(0, 1.0, &image.q, &state.q), (order, motion.omega, &image.v, &state.v)] {
        let mut change = change.rows_mut(first, order);
        change.gemv(1.0 / unit, &ring.turn, image, 0.0);
        change.axpy(-1.0 / unit, from, 1.0);
    }
    for e in (0..all).filter(|&e| moves[e]) {
        let (to, turns) = ring.shifted(e);
        let factor = ring.closure.factor(structure, turns).re;
        change[2 * order + e] = scale * (factor * image.w[to] - state.w[e]);
    }
    let unit = |x: f64| if x > 0.0 { x } else { 1.0 };
    let size = (unit(path.largest.0), unit(path.largest.1 / motion.omega));
    let mut residual = 0.0_f64;
    for (i, change) in change.iter().enumerate() {
        let size = if (order..2 * order).contains(&i) {
            size.1
        } else {
            size.0
        };
        residual = residual.max(change.abs() / size);
    }
    Ok(Trial {
        state,
        path,
        moves,
        change,
        residual,
    })
}

/// The Newton correction of coordinates, velocities over ω, and places of moving sliders in units of coordinates.
fn newton(
    motion: &SliderMotion<'_>,
    structure: &Structure,
    trial: &Trial,
    interrupt: &Interrupt<'_>,
) -> Result<Option<DVector<f64>>> {
    let ring = motion.ring;
    let map = SliderMap::new(ring, &trial.path, &trial.moves, interrupt)?;
    let factor = |turns: usize| ring.closure.factor(structure, turns).re;
    let states = map.states();
    let mut factors = Lu::<f64>::new(states, 1)?;
    {
        let matrix = map.matrix((motion.omega, scale_of_sliders(motion)), factor, interrupt)?;
        factors.matrix().copy_from_slice(matrix.as_slice());
    }
    for i in 0..states {
        factors.matrix()[i * states + i] -= 1.0;
    }
    let order = ring.order();
    let mut step = zero_vector(states, CONTEXT)?;
    for i in 0..2 * order {
        step[i] = -trial.change[i];
    }
    for (i, &e) in map.moving.iter().enumerate() {
        step[2 * order + i] = -trial.change[2 * order + e];
    }
    match factors.factor(interrupt) {
        Err(e) if e.status == Status::Singular => return Ok(None),
        factored => factored?,
    }
    factors.solve(step.as_mut_slice());
    if !step.iter().all(|x| x.is_finite()) {
        return Ok(None);
    }
    let mut all = zero_vector(2 * order + ring.all(), CONTEXT)?;
    all.rows_mut(0, 2 * order).copy_from(&step.rows(0, 2 * order));
    for (i, &e) in map.moving.iter().enumerate() {
        all[2 * order + e] = step[2 * order + i];
    }
    Ok(Some(all))
}

fn moved(motion: &SliderMotion<'_>, from: &Trial, step: &DVector<f64>, share: f64) -> Result<SliderState> {
    let (order, scale) = (motion.ring.order(), scale_of_sliders(motion));
    let mut state = from.state.try_clone()?;
    for (i, x) in state.q.iter_mut().enumerate() {
        *x += share * step[i];
    }
    for (i, v) in state.v.iter_mut().enumerate() {
        *v += share * step[order + i] * motion.omega;
    }
    for (e, w) in state.w.iter_mut().enumerate() {
        *w += share * step[2 * order + e] / scale;
    }
    Ok(state)
}
