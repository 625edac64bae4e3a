//! The state at time 0 of a periodic motion given by its harmonics.

use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::fourier::transform::{Lane, Transform};
use crate::model::Model;
use crate::time_integration::event_law::Row;
use crate::time_integration::event_loop::State;
use crate::time_integration::unrolled_structure::System;
use num_complex::Complex64;

/// Number of times per period of the highest harmonic at which the sliders of an initial motion are updated, where that
/// is not more than `INITIAL_STATE_POINTS` a period; then as few as a quarter of them. Chosen: the largest motion between times is
/// missed by 5e-6 of it.
/// Kind: tuned; measured on: nothing, it is chosen.
pub(crate) const SLIDER_POINTS_PER_WAVE: usize = 64;
const INITIAL_STATE_POINTS: usize = 1024;

const CONTEXT: &str = "the start of the motion in time";

/// The state at time 0 of a periodic motion. Each slider has the place that it reaches after two periods of the
/// motion from its unloaded place.
pub(crate) fn state_of(model: &Model, system: &System<'_>, harmonics: &[Complex64]) -> Result<State> {
    let (given, ndof) = (model.ndof(), system.ndof);
    let count = harmonics.len() / given;
    let mut sector = try_vec(count.saturating_mul(ndof), Complex64::ZERO, CONTEXT)?;
    for (x, all) in sector.chunks_exact_mut(ndof).zip(harmonics.chunks_exact(given)) {
        system.degrees.restrict(all, x);
    }
    state_of_sector(model, system, &sector)
}

/// The state at time 0 as `state_of` gives it, from the harmonics of the independent degrees of freedom of a sector.
pub(crate) fn state_of_sector(model: &Model, system: &System<'_>, sector: &[Complex64]) -> Result<State> {
    let mut state = State::rest(system)?;
    let ndof = system.ndof;
    for (h, own) in sector.chunks_exact(ndof).enumerate() {
        for s in 0..system.wave.sectors {
            let phase = model.structure().phase(h, s as i64);
            for (dof, x) in own.iter().enumerate() {
                let x = moved(x, phase, h);
                state.x[s * ndof + dof] += x.re;
                state.v[s * ndof + dof] -= h as f64 * system.omega * x.im;
            }
        }
    }
    place_sliders(model, system, sector, &mut state)?;
    Ok(state)
}

/// A harmonic coefficient in the sector with the given phase; means are real.
fn moved(x: &Complex64, phase: Complex64, h: usize) -> Complex64 {
    if h == 0 { x.re.into() } else { x * phase }
}

/// Drags each slider along with the motion, whose harmonics in one sector are `sector`.
fn place_sliders(model: &Model, system: &System<'_>, sector: &[Complex64], state: &mut State) -> Result<()> {
    let ndof = system.ndof;
    let count = sector.len() / ndof;
    if count == 0 || !system.elements.iter().any(|e| e.slider().is_some()) {
        return Ok(());
    }
    let set = HarmonicSet::all(count - 1)?;
    let fine = SLIDER_POINTS_PER_WAVE * count;
    let points = fine.min(INITIAL_STATE_POINTS.max(fine / 4));
    let mut transform = Transform::new(&set, points, false)?;
    let times = transform.held();
    let mut packed = try_vec(set.packed_len(), 0.0, CONTEXT)?;
    let mut motions = try_vec(times.saturating_mul(2), 0.0, CONTEXT)?;
    for (stretch, e) in state.e.iter_mut().zip(&system.elements) {
        let Some(slider) = e.slider() else { continue };
        system.interrupt.check_before((64 * times + sector.len()) as u64)?;
        motions.fill(0.0);
        for (k, row) in e.rows.iter().take(2).enumerate() {
            for (h, own) in sector.chunks_exact(ndof).enumerate() {
                set.set(&mut packed, h, along(model, row, h, own));
            }
            transform.synthesise(&set, &packed, &mut motions, Lane { first: k, step: 2 });
        }
        // The slider's place is kept until the end, where the stretch follows from it and the motion at time 0.
        let mut place = slider.start();
        for motion in motions.chunks_exact(2).cycle().take(2 * times + 1) {
            place = slider.drag([motion[0], motion[1]], place);
        }
        *stretch = motions[0] - place;
    }
    Ok(())
}

/// A harmonic coefficient of the relative motion along a row of the unrolled structure, from the coefficients of one
/// sector.
fn along(model: &Model, row: &Row, h: usize, own: &[Complex64]) -> Complex64 {
    let terms = row.iter().flatten();
    terms
        .map(|&(dof, a)| {
            let phase = model.structure().phase(h, (dof / own.len()) as i64);
            a * moved(&own[dof % own.len()], phase, h)
        })
        .sum()
}
