//! Motion against time at a stored point, and motion, force and state of its contacts.

use crate::contact::Contact;
use crate::contact::forms::contact_state::State;
use crate::error::{Result, fail, try_extend, try_room, try_vec};
use crate::fourier::{HarmonicSet, jet};
use crate::interrupt::{Interrupt, Phase};
use crate::results::motions::contact_loops::Orbit;
use crate::results::motions::recovery;
use crate::results::motions::signal_check::check_time;
use crate::results::{Branch, Recovery};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Largest number of times of a loop or a history.
/// Kind: cap.
pub const MOST_TIMES: usize = 1 << 24;

const LOOP: &str = "the loop of a contact";

/// Motion, force and state of a contact over one period at ωt = 2πj/n, j = 0 .. n, in the caller's units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactLoop {
    /// Number d of relative motions of the contact.
    pub directions: usize,
    /// Relative motions, side a minus side b, n × d, time after time.
    pub motion: Vec<f64>,
    /// Contact forces f, n × d. They act on the rows of side a as +f and on the rows of side b as −f. They are the
    /// whole forces of the law, not only their carried harmonics; along a normal f = −N.
    pub force: Vec<f64>,
    /// States of the contact, n values. A contact without force, or linear at any motion, is reported as stuck, and
    /// so are laws without states.
    pub state: Vec<State>,
}

/// Number of directions in a summary; laws of more directions have the others in [`ContactLoop`] only.
/// Kind: fixed.
pub const SUMMARISED: usize = 3;

/// Numbers of one contact over one period, in the caller's units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactSummary {
    /// Number d of relative motions of the contact.
    pub directions: usize,
    /// Work per cycle that the contact dissipates in all its directions; exactly 0 for friction that does not slip
    /// and for laws of one motion that do not depend on velocity.
    pub work: f64,
    /// Share of the period in the slip state; the open state does not count.
    pub slip_share: f64,
    /// Share of the period in the open state.
    pub open_share: f64,
    /// Half the range of each relative motion, (max − min)/2; 0 beyond d.
    pub half_range: [f64; SUMMARISED],
    /// Smallest relative motions, side a minus side b.
    pub motion_min: [f64; SUMMARISED],
    /// Largest relative motions, side a minus side b.
    pub motion_max: [f64; SUMMARISED],
    /// Smallest normal load. Friction under a constant load has the given load; springs that cannot open, and laws of
    /// the caller, have none: 0.
    pub load_min: f64,
    /// Largest normal load, as for the smallest.
    pub load_max: f64,
}

/// Motion over time as [`Branch::time_history`], and the caller may stop it.
pub(crate) fn time_history_with(
    branch: &Branch,
    point: usize,
    dof: usize,
    n: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<f64>> {
    check_point(branch, point)?;
    if dof >= branch.ndof() {
        return fail!(Index, "dof = {dof}, needs 0 .. {}", branch.ndof());
    }
    check_times(n)?;
    let condensed = branch.condensed_at(point);
    let motion = |i, _, x: &[Complex64]| Ok(condensed.motion_row(i, dof)?.along(x));
    let (set, packed) = recover(branch, point, 1, motion, interrupt)?;
    let mut history = try_vec(n, 0.0, "a time history")?;
    for (j, x) in history.iter_mut().enumerate() {
        check_time(interrupt, j, &set)?;
        *x = jet(&set, &packed, TAU * j as f64 / n as f64).x;
    }
    Ok(history)
}

/// Loop of a contact as [`Branch::contact_loop`], and the caller may stop it.
pub(crate) fn contact_loop_with(
    branch: &Branch,
    point: usize,
    contact: usize,
    n: usize,
    interrupt: &Interrupt<'_>,
) -> Result<ContactLoop> {
    check_contact(branch, point, contact)?;
    check_times(n)?;
    with_orbit(branch, point, contact, interrupt, |orbit, length| {
        let directions = orbit.directions();
        let mut found = ContactLoop {
            directions,
            motion: try_room(n.saturating_mul(directions), LOOP)?,
            force: try_room(n.saturating_mul(directions), LOOP)?,
            state: try_room(n, LOOP)?,
        };
        orbit.follow(n, interrupt)?.each(interrupt, |slice| {
            found.motion.extend(slice.motion.iter().map(|x| x * length));
            found.force.extend(slice.force.iter().map(|f| f * length));
            found.state.extend(&slice.state);
        })?;
        Ok(found)
    })
}

/// One direction of [`Branch::contact_loop`].
pub(crate) fn contact_loop_along(
    branch: &Branch,
    (point, contact, direction): (usize, usize, usize),
    n: usize,
    wanted: [bool; 3],
    interrupt: &Interrupt<'_>,
) -> Result<ContactLoop> {
    check_contact(branch, point, contact)?;
    check_times(n)?;
    with_orbit(branch, point, contact, interrupt, |orbit, length| {
        let directions = orbit.directions();
        if direction >= directions {
            return fail!(Index, "direction = {direction}, needs 0 .. {directions}");
        }
        let [motion, force, state] = wanted.map(|wanted| if wanted { n } else { 0 });
        let mut found = ContactLoop {
            directions: 1,
            motion: try_room(motion, LOOP)?,
            force: try_room(force, LOOP)?,
            state: try_room(state, LOOP)?,
        };
        orbit.follow(n, interrupt)?.each(interrupt, |slice| {
            let along = |values: &[f64], to: &mut Vec<f64>| {
                to.extend(values.iter().skip(direction).step_by(directions).map(|x| x * length));
            };
            if wanted[0] {
                along(&slice.motion, &mut found.motion);
            }
            if wanted[1] {
                along(&slice.force, &mut found.force);
            }
            if wanted[2] {
                found.state.extend(&slice.state);
            }
        })?;
        Ok(found)
    })
}

/// Summary of a contact as [`Branch::contact_summary`], and the caller may stop it.
pub(crate) fn contact_summary_with(
    branch: &Branch,
    point: usize,
    contact: usize,
    interrupt: &Interrupt<'_>,
) -> Result<ContactSummary> {
    let kept = check_contact(branch, point, contact)?;
    with_orbit(branch, point, contact, interrupt, |orbit, length| {
        let account = orbit.account(interrupt)?;
        let ranges = orbit.ranges(interrupt)?;
        let mut summary = ContactSummary {
            directions: orbit.directions(),
            work: account.work * length * length,
            slip_share: account.slip,
            open_share: account.open,
            ..ContactSummary::default()
        };
        for (k, (low, high)) in ranges.iter().take(SUMMARISED).enumerate() {
            (summary.motion_min[k], summary.motion_max[k]) = (low * length, high * length);
            summary.half_range[k] = 0.5 * (high - low) * length;
        }
        // The load is largest where the motion of side a against side b is smallest.
        let (low, high) = kept.normal_direction().map_or((0.0, 0.0), |k| ranges[k]);
        let at_speed = contact_at_speed(branch, point, contact);
        let kept = at_speed.as_ref().unwrap_or(kept);
        summary.load_min = kept.normal_load(high * length);
        summary.load_max = kept.normal_load(low * length);
        Ok(summary)
    })
}

/// A contact under its load at the frequency of a point; `None` where the load does not depend on the frequency.
fn contact_at_speed(branch: &Branch, point: usize, contact: usize) -> Option<Contact> {
    let laws = branch.condensed_at(point).laws();
    let found = laws
        .binary_search_by_key(&contact, |assembled| assembled.contact)
        .ok()?;
    let load = laws[found].load.as_ref()?;
    Some(load.contact_at(branch.table.omega[point]))
}

/// Number of relative motions of a contact in [`Branch::contact_loop`].
pub(crate) fn contact_directions(branch: &Branch, contact: usize) -> Option<usize> {
    let kept = branch.resolutions[0]
        .condensed
        .contact_classes()
        .contacts()
        .get(contact)?;
    Some(kept.directions())
}

fn check_point(branch: &Branch, point: usize) -> Result<()> {
    branch.carried_of(point).map(|_| ())
}

fn check_contact(branch: &Branch, point: usize, contact: usize) -> Result<&Contact> {
    check_point(branch, point)?;
    match branch.resolutions[0]
        .condensed
        .contact_classes()
        .contacts()
        .get(contact)
    {
        Some(kept) => Ok(kept),
        None => fail!(Index, "contact = {contact}, needs 0 .. {}", branch.contacts()),
    }
}

/// Calls `use_it` with a contact over the period and the unit of its lengths.
fn with_orbit<T>(
    branch: &Branch,
    point: usize,
    contact: usize,
    interrupt: &Interrupt<'_>,
    use_it: impl FnOnce(&Orbit<'_>, f64) -> Result<T>,
) -> Result<T> {
    let condensed = branch.condensed_at(point);
    let contact_classes = condensed.contact_classes();
    if let Some(at) = contact_classes.linear(contact) {
        let kept = &contact_classes.contacts()[contact];
        let row = |i: usize, k: usize| &condensed.blocks()[i].motions.linear_rows[at + k];
        let (set, packed) = recover(
            branch,
            point,
            kept.directions(),
            |i, k, x| Ok(row(i, k).along(x)),
            interrupt,
        )?;
        let orbit = Orbit::spring(&set, &packed, kept.directions(), kept.stiffness_as_spring());
        return use_it(&orbit, 1.0);
    }
    let laws = condensed.laws();
    let Ok(found) = laws.binary_search_by_key(&contact, |assembled| assembled.contact) else {
        return fail!(Internal, "contact {contact} has no law");
    };
    let assembled = &laws[found];
    let set = condensed.set();
    let m = set.packed_len();
    let mut motion = Vec::new();
    for c in &assembled.coordinates {
        let all = branch.motion_at(point).unwrap_or(&[]);
        try_extend(&mut motion, &all[c * m..(c + 1) * m], "the motion of a contact")?;
    }
    let omega = branch.table.omega[point];
    let law = match &assembled.load {
        None => Arc::clone(&assembled.law),
        Some(load) => load.contact_at(omega).law(condensed.length())?,
    };
    let mut orbit = Orbit::new(set, &motion, &*law, omega, branch.samples_at(point));
    let mut actual = Vec::new();
    if let [c] = assembled.coordinates[..]
        && condensed.is_exchanged(c)
    {
        let all = recovery::relative_motion_at(branch, point, interrupt)?;
        try_extend(&mut actual, &all[c * m..(c + 1) * m], "the motion of a contact")?;
        orbit = orbit.moving(&actual);
    }
    use_it(&orbit, condensed.length())
}

/// Packed harmonics of `signals` signals, one after the other. `of` computes the k-th signal from the i-th
/// carried harmonic of all degrees of freedom, in the caller's unit. The set has all harmonics, because those
/// of linear models have no common step.
fn recover(
    branch: &Branch,
    point: usize,
    signals: usize,
    of: impl Fn(usize, usize, &[Complex64]) -> Result<Complex64>,
    interrupt: &Interrupt<'_>,
) -> Result<(HarmonicSet, Vec<f64>)> {
    const CONTEXT: &str = "the harmonics";
    let carried = branch.carried_of(point)?;
    let highest = carried.last().copied().unwrap_or(0);
    let set = HarmonicSet::all(highest)?;
    let m = set.packed_len();
    let mut packed = try_vec(signals.saturating_mul(m), 0.0, CONTEXT)?;
    let ndof = branch.condensed_at(point).ndof();
    let mut x = try_vec(ndof, Complex64::ZERO, CONTEXT)?;
    let mut recovery = Recovery::at(branch, point, interrupt)?;
    for (i, &h) in carried.iter().enumerate() {
        interrupt.part(Phase::Results, i, carried.len())?;
        recovery.coordinates(i, &mut x)?;
        for (k, signal) in packed.chunks_exact_mut(m).enumerate() {
            set.set(signal, h, of(i, k, &x)?);
        }
    }
    Ok((set, packed))
}

fn check_times(n: usize) -> Result<()> {
    if (1..=MOST_TIMES).contains(&n) {
        return Ok(());
    }
    fail!(Dimension, "n = {n}, needs 1 .. {MOST_TIMES} times")
}
