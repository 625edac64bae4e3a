//! Interference (SAFE) diagram: the damped modes of all waves of a wheel, in both senses of each nodal diameter.

use crate::analysis::linear::damped_modes::{self, DampedModes, GROWS, has_equal_senses};
use crate::analysis::linear::linear_contacts::LinearContacts;
use crate::error::{Result, fail, try_push};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Phase;
use crate::model::Model;

const CONTEXT: &str = "the interference diagram";

/// Modes of all waves of a wheel. Lists hold the modes of one diameter after those of the diameter before.
#[derive(Clone, Debug, Default)]
pub struct Interference {
    /// Signed nodal diameters −N/2 < d ≤ N/2, rising: the wave in which sector s + 1 lags by 2πd/N.
    pub diameters: Vec<i64>,
    /// Number of modes of each diameter.
    pub count: usize,
    /// Damped angular frequencies, rising in each diameter; NaN where fewer motions oscillate.
    pub omega: Vec<f64>,
    /// Damping ratios; negative: the motion grows.
    pub damping_ratio: Vec<f64>,
    /// Sense in which the frequency of each mode changes with the speed, as [`DampedModes::direction`].
    pub direction: Vec<i64>,
    /// Whether both senses of every diameter have the same frequencies and damping ratios.
    pub has_equal_senses: bool,
}

impl Interference {
    fn add(&mut self, diameter: i64, modes: &DampedModes, sign: i64) -> Result<()> {
        try_push(&mut self.diameters, diameter, CONTEXT)?;
        for k in 0..self.count {
            let known = k < modes.count();
            let (omega, ratio) = if known {
                (modes.omega(k), modes.damping_ratio(k))
            } else {
                (f64::NAN, f64::NAN)
            };
            let direction = modes.direction.get(k).map_or(0, |direction| sign * direction);
            try_push(&mut self.omega, omega, CONTEXT)?;
            try_push(&mut self.damping_ratio, ratio, CONTEXT)?;
            try_push(&mut self.direction, direction, CONTEXT)?;
        }
        Ok(())
    }

    /// Reverses the order of the diameters.
    fn reverse(&mut self) {
        self.diameters.reverse();
        reverse_rows(&mut self.omega, self.count);
        reverse_rows(&mut self.damping_ratio, self.count);
        reverse_rows(&mut self.direction, self.count);
    }
}

fn reverse_rows<T>(list: &mut [T], count: usize) {
    list.reverse();
    for row in list.chunks_exact_mut(count) {
        row.reverse();
    }
}

/// Computes the `count` lowest damped modes of each of the N waves of a wheel at the speed of the model: together all
/// modes of the wheel, each once. Both senses of a diameter are computed where they differ: with gyroscopic or
/// aerodynamic forces, and with unsymmetric matrices. The log reports waves that grow.
///
/// # Errors
/// `Unsupported` for a plain structure; those of [`damped_modes`](crate::analysis::linear::damped_modes::damped_modes);
/// `StoppedByCaller`.
pub fn interference(
    model: &Model,
    contacts: LinearContacts,
    count: usize,
    hooks: &mut Hooks<'_>,
) -> Result<Interference> {
    let structure = model.structure();
    let sectors = structure.sectors();
    if sectors == 1 {
        return fail!(
            Unsupported,
            "interference needs a cyclic structure: a plain one has no nodal diameters"
        );
    }
    damped_modes::check(model, 0, count)?;
    let interrupt = hooks.interrupt();
    let contacts = contacts.prepared(model, &interrupt)?;
    let state = contacts.state();
    let list = || Interference {
        count,
        ..Interference::default()
    };
    let (mut forward, mut backward) = (list(), list());
    let mut is_equal = true;
    let mut done = 0;
    for diameter in structure.all_diameters().filter(|d| *d >= 0) {
        interrupt.part(Phase::Modes, done, sectors)?;
        let modes = damped_modes::of_wave(model, diameter, state, count, &interrupt)?;
        forward.add(diameter, &modes, 1)?;
        done += 1;
        if structure.signed_diameter(-diameter) == diameter {
            continue;
        }
        interrupt.part(Phase::Modes, done, sectors)?;
        if has_equal_senses(model, diameter, state)? {
            backward.add(-diameter, &modes, -1)?;
        } else {
            is_equal = false;
            let modes = damped_modes::of_wave(model, -diameter, state, count, &interrupt)?;
            backward.add(-diameter, &modes, 1)?;
        }
        done += 1;
    }
    backward.reverse();
    for row in 0..forward.diameters.len() {
        try_push(&mut backward.diameters, forward.diameters[row], CONTEXT)?;
        for at in row * count..(row + 1) * count {
            try_push(&mut backward.omega, forward.omega[at], CONTEXT)?;
            try_push(&mut backward.damping_ratio, forward.damping_ratio[at], CONTEXT)?;
            try_push(&mut backward.direction, forward.direction[at], CONTEXT)?;
        }
    }
    let mut all = backward;
    all.has_equal_senses = is_equal;
    tell_growth(&all, hooks);
    Ok(all)
}

/// Logs the least damped mode, and in how many waves a mode grows.
fn tell_growth(found: &Interference, hooks: &mut Hooks<'_>) {
    let rows = || found.damping_ratio.chunks_exact(found.count);
    let growing = rows().filter(|row| row.iter().any(|ratio| *ratio < GROWS)).count();
    let least = (0..found.damping_ratio.len())
        .filter(|&at| !found.damping_ratio[at].is_nan())
        .min_by(|&a, &b| found.damping_ratio[a].total_cmp(&found.damping_ratio[b]));
    if let Some(at) = least.filter(|_| growing > 0) {
        let text = format!(
            "modes grow in {growing} of {} waves: mode {} of the nodal diameter {} has the damping ratio {:.3e}",
            found.diameters.len(),
            at % found.count,
            found.diameters[at / found.count],
            found.damping_ratio[at]
        );
        hooks.log(LogLevel::Warn, &text);
    }
}
