//! Motion against time at a stored point, and what happens inside its contacts.

use super::{Branch, Recovery};
use crate::contact::Contact;
use crate::contact::cubic::Cubic;
use crate::contact::state::State;
use crate::error::{Result, fail, try_push, try_vec};
use crate::fourier::jet;
use crate::harmonics::HarmonicSet;
use crate::model::spring::along;
use crate::postprocess::loops::Orbit;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Most times of a loop or a history.
pub const MOST_TIMES: usize = 1 << 24;

/// A contact over one period at ωt = 2πj/n, j = 0 .. n, in the caller's units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactLoop {
    /// Relative motion of the sides, a minus b.
    pub motion: Vec<f64>,
    /// Force f, which stands in the row of side a as +f and in that of side b as −f. It is the whole
    /// force of the law, not its carried harmonics.
    pub force: Vec<f64>,
    /// What the contact does. One that is linear at any motion or without force sticks.
    pub state: Vec<State>,
}

/// Numbers of one contact over one period, in the caller's units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactSummary {
    /// Work per cycle that the contact takes from the motion; exactly 0 unless it slips.
    pub work: f64,
    /// Share of the period that it slips.
    pub slip_share: f64,
    /// Share of the period that it is open.
    pub open_share: f64,
    /// Half the range of the relative motion, (max − min)/2.
    pub half_range: f64,
    /// Smallest relative motion, side a minus side b.
    pub motion_min: f64,
    /// Largest relative motion.
    pub motion_max: f64,
    /// Smallest normal load. Friction has the one given, springs that cannot open have none: 0.
    pub load_min: f64,
    /// Largest normal load.
    pub load_max: f64,
}

impl Branch {
    /// Motion of a degree of freedom at a stored point, at ωt = 2πj/n for j = 0 .. n, in the
    /// caller's unit.
    ///
    /// # Errors
    /// `Index` for an unknown point or degree of freedom, `Dimension` for n outside 1 ..=
    /// [`MOST_TIMES`], `OutOfMemory`; `Singular` at an undamped resonance that no contact feels.
    pub fn time_history(&self, point: usize, dof: usize, n: usize) -> Result<Vec<f64>> {
        self.check_point(point)?;
        if dof >= self.ndof() {
            return fail!(Index, "dof = {dof}, needs 0 .. {}", self.ndof());
        }
        check_times(n)?;
        let (set, packed) = self.recover(point, |_, x| x[dof])?;
        let mut history = try_vec(n, 0.0, "a time history")?;
        for (j, x) in history.iter_mut().enumerate() {
            *x = jet(&set, &packed, TAU * j as f64 / n as f64).x;
        }
        Ok(history)
    }

    /// Relative motion, force and state of a contact at a stored point, at ωt = 2πj/n for j = 0 .. n.
    ///
    /// The force is that of this contact alone, at the motion found, with its events located exactly;
    /// where the branch was computed by samples, too. Of a cyclic model it is the contact of sector 0.
    /// Contacts that are linear at any motion have no coordinate of their own, and the whole structure
    /// is recovered for them.
    ///
    /// # Errors
    /// As [`Self::time_history`], with `Index` for an unknown contact.
    pub fn contact_loop(&self, point: usize, contact: usize, n: usize) -> Result<ContactLoop> {
        const WHAT: &str = "the loop of a contact";
        self.check_contact(point, contact)?;
        check_times(n)?;
        self.with_orbit(point, contact, |orbit, length| {
            let mut found = ContactLoop::default();
            for j in 0..n {
                let now = orbit.at(j, n);
                try_push(&mut found.motion, now.motion * length, WHAT)?;
                try_push(&mut found.force, now.force * length, WHAT)?;
                try_push(&mut found.state, now.state, WHAT)?;
            }
            Ok(found)
        })
    }

    /// Work, shares of the period and ranges of a contact at a stored point, all of them exact for the
    /// motion found; see [`Self::contact_loop`]. The work of all contacts makes up
    /// [`Energy::friction_loss`](super::Energy::friction_loss), up to the error of sampling where the
    /// branch was computed by samples.
    ///
    /// # Errors
    /// As [`Self::contact_loop`].
    pub fn contact_summary(&self, point: usize, contact: usize) -> Result<ContactSummary> {
        let kept = self.check_contact(point, contact)?;
        self.with_orbit(point, contact, |orbit, length| {
            let (low, high) = orbit.range();
            let (low, high) = (low * length, high * length);
            // A contact that opens is pressed most where side a is lowest.
            let loads = [kept.normal_load(high), kept.normal_load(low)];
            Ok(ContactSummary {
                work: orbit.work() * length * length,
                slip_share: orbit.share(State::Slip),
                open_share: orbit.share(State::Open),
                half_range: 0.5 * (high - low),
                motion_min: low,
                motion_max: high,
                load_min: loads[0],
                load_max: loads[1],
            })
        })
    }

    fn check_point(&self, point: usize) -> Result<()> {
        if point < self.stored() {
            return Ok(());
        }
        fail!(
            Index,
            "point = {point}, needs 0 .. {} (points and special points)",
            self.stored()
        )
    }

    fn check_contact(&self, point: usize, contact: usize) -> Result<&Contact> {
        self.check_point(point)?;
        match self.condensed.roster().contacts().get(contact) {
            Some(kept) => Ok(kept),
            None => fail!(Index, "contact = {contact}, needs 0 .. {}", self.contacts()),
        }
    }

    /// Lets `use_it` look at a contact over the period, in units of the length that it is given.
    fn with_orbit<T>(
        &self,
        point: usize,
        contact: usize,
        use_it: impl FnOnce(&Orbit<'_>, f64) -> Result<T>,
    ) -> Result<T> {
        let condensed = &self.condensed;
        let roster = condensed.roster();
        if let Some(at) = roster.linear(contact) {
            let (set, packed) = self.recover(point, |i, x| along(&condensed.blocks()[i].linear_rows[at], x))?;
            let law = Cubic {
                linear: roster.contacts()[contact].stiffness_as_spring(),
                cubic: 0.0,
            };
            return use_it(&Orbit::new(&set, &packed, &law)?, 1.0);
        }
        let laws = condensed.laws();
        let Ok(k) = laws.binary_search_by_key(&contact, |placed| placed.contact) else {
            return fail!(Internal, "contact {contact} has no law");
        };
        let set = condensed.set();
        let m = set.packed_len();
        let begin = (point * condensed.coordinates() + laws[k].coordinates[0]) * m;
        let orbit = Orbit::new(set, &self.motion[begin..begin + m], &*laws[k].law)?;
        use_it(&orbit, condensed.length())
    }

    /// Packed harmonics of a signal, `of` the i-th carried harmonic of all degrees of freedom, in the
    /// caller's unit. Carried harmonics of linear models have no common step: the set has all.
    fn recover(&self, point: usize, of: impl Fn(usize, &[Complex64]) -> Complex64) -> Result<(HarmonicSet, Vec<f64>)> {
        const WHAT: &str = "the harmonics";
        let highest = self.carried().last().copied().unwrap_or(0);
        let set = HarmonicSet::all(highest)?;
        let mut packed = try_vec(set.packed_len(), 0.0, WHAT)?;
        let mut x = try_vec(self.ndof(), Complex64::ZERO, WHAT)?;
        let mut recovery = Recovery::new(self)?;
        recovery.go_to(point)?;
        for (i, &h) in self.carried().iter().enumerate() {
            recovery.harmonic(i, &mut x)?;
            set.set(&mut packed, h, of(i, &x));
        }
        Ok((set, packed))
    }
}

fn check_times(n: usize) -> Result<()> {
    if (1..=MOST_TIMES).contains(&n) {
        return Ok(());
    }
    fail!(Dimension, "n = {n}, needs 1 .. {MOST_TIMES} times")
}
