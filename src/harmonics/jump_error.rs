//! The error of a point with exchanged motions, see [`crate::condense::blocks::exchange`]: of forces that jump, and of sticks that ring.
//!
//! Where slip ends the force jumps, so that the response errs by about 1/H at least: twice its change with twice the harmonics. That
//! change may be small by chance, so that half the change from half the harmonics counts, too.
//!
//! Where slip reverses the force takes a stick of a part of a ring, of angular frequency ω_r = √(k/m), from one limit fc to the other.
//! With a structure that pushes by F ≥ fc it comes late by
//!
//! > ∫ (f + fc) dt = 2 fc g/ω_r,  g = ((r + 1) sin θ − (r − 1) θ)/2,  cos θ = (r − 1)/(r + 1),  r = F/fc,
//!
//! 0 < g ≤ 1, twice in a period, so that the fundamental 4 fc/π of the force changes by g/h_r of itself, h_r = ω_r/ω. Equations
//! without the harmonic h_r know nothing of it, and neither does one extension of them. Their own forces come late, too, by about a half of
//! that at H = h_r: the other half is counted, as a change of the slip limit by 1/(2 h_r). A ring is a filter of second order:
//! beyond it the harmonics of the force fall by two powers more, and their sum with H as H^-3.
//!
//! Where the exchanged motion is the force on a mass, the law has all harmonics of the jumps, and its forces are late by g/h_r. Rings that
//! are left when the next slip begins move its end. They are cut at the limit, ever lower as α x rises, so that this slip begins with
//! a momentum between 0 and 2π α x'/h_r², whatever the ring was, and its jump comes late by that over the jump. Jumps are counted as
//! late by the largest such time, or a share of 1/h_r if that is more, whatever the number of harmonics, and by the time by which the
//! motion of the slider does not repeat itself.

use crate::aft::late_jumps;
use crate::condense::Condensed;
use crate::contact::forms::law::PackedMotion;
use crate::error::{Result, try_vec};
use crate::harmonics::estimate::CONTEXT;
use crate::harmonics::extended_system::ExtendedSystem;
use crate::interrupt::Interrupt;
use crate::problem::Problem;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::slip_forces;
use std::f64::consts::TAU;

/// Error of a point over its change with twice the harmonics, where it falls as 1/H.
/// Kind: tuned; measured on: not recorded.
pub(super) const OF_JUMPS: f64 = 2.0;

/// Share of the change from half the harmonics that an error may be: where it falls as 1/H, it is a whole one.
/// Kind: tuned; measured on: not recorded.
pub(super) const OF_HALF: f64 = 0.5;

/// Share of the lateness 1/h_r of the forces that their equations do not have.
/// Kind: tuned; measured on: not recorded.
const OF_RING: f64 = 0.5;

/// Lateness of all jumps over 1/h_r that the law of a mass does not have.
/// Kind: tuned; measured on: the chain of 8 masses of `tests/robustness/near_rigid.rs` with kt/k from 3e4 on.
const OF_RING_OF_MASS: f64 = 0.05;

/// Highest harmonic over that of a ring from which the lateness falls.
/// Kind: tuned; measured on: not recorded.
const BEYOND_RING: f64 = 2.0;

/// Factor and additional term of the error of a point: error = factor · change + term, the term in the solver's unit;
/// 1 and 0 without exchanged motions. `None` where they are not found. The system must have its matrix factored, and
/// must have been evaluated last at `at`.
pub(super) fn beyond_extension(
    system: &mut ExtendedSystem<HarmonicBalance<'_>>,
    condensed: &Condensed,
    (at, omega): (&[f64], f64),
    interrupt: &Interrupt<'_>,
) -> Result<Option<(f64, f64)>> {
    if !condensed.has_exchanges() {
        return Ok(Some((1.0, 0.0)));
    }
    let late = lateness(system, condensed, (at, omega), interrupt)?;
    Ok(late.map(|late| (OF_JUMPS, late)))
}

/// Change of the observed response, in the solver's unit, by the delay of all forces whose stick stiffness rings;
/// `None` where it is not found.
fn lateness(
    system: &mut ExtendedSystem<HarmonicBalance<'_>>,
    condensed: &Condensed,
    (at, omega): (&[f64], f64),
    interrupt: &Interrupt<'_>,
) -> Result<Option<f64>> {
    let (n, set) = (system.problem.unknowns(), condensed.set());
    let m = set.packed_len();
    let highest = set.numbers().last().copied().unwrap_or(0) as f64;
    let mut load = try_vec(n, 0.0, CONTEXT)?;
    let mut change = try_vec(n + 1, 0.0, CONTEXT)?;
    let mut sum = 0.0;
    for law in condensed.laws() {
        let c = law.coordinates[0];
        let Some(exchange) = condensed.exchange_of(c) else {
            continue;
        };
        let of_ring = exchange.ring / omega;
        if of_ring.is_infinite() && exchange.mass_at.is_none() {
            continue; // a rigid stick
        }
        let (late, jumps) = if exchange.mass_at.is_some() {
            let motion = &at[c * m..(c + 1) * m];
            let ring = set.base() as f64 / of_ring;
            let late = |rise: f64| ring * (TAU * rise * ring).max(OF_RING_OF_MASS);
            let Some(jumps) = late_jumps(PackedMotion { set, motion, omega }, &*law.law, late, interrupt)? else {
                continue;
            };
            (1.0, Some(jumps))
        } else {
            let share = (BEYOND_RING * of_ring / highest).min(1.0).powi(3);
            (OF_RING * share / of_ring, None)
        };
        let slips = match &jumps {
            Some(jumps) => slip_forces::by_force(&system.problem, c, |i| set.get(jumps, i), &mut load),
            None => slip_forces::by_slip_limit(&system.problem, c, &mut load),
        };
        if !slips || late == 0.0 {
            continue;
        }
        if !system.solve_for(&load, &mut change[..n], interrupt)? {
            return Ok(None);
        }
        for x in &mut change[..n] {
            *x = -*x;
        }
        let (_, by_motion) = system.problem.observe(at, &change);
        let by_force = match &jumps {
            Some(jumps) => slip_forces::observed_by_force(&system.problem, c, |i| set.get(jumps, i)),
            None => slip_forces::observed_by_slip_limit(&system.problem, c),
        };
        sum += late * (by_motion + by_force).norm();
    }
    Ok(Some(sum))
}
