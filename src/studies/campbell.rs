//! Campbell diagram: damped modes over the speed of rotation, and the speeds at which engine orders meet them.

use crate::analysis::linear::damped_modes::{self, DampedModes, GROWS, has_equal_senses};
use crate::analysis::linear::linear_contacts::LinearContacts;
use crate::error::{Error, Result, Status, fail, try_copy, try_push};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::roots::Bracket;

/// Relative accuracy of a crossing.
/// Kind: rounding.
const CAMPBELL_TOLERANCE: f64 = 1e-13;

/// Largest number of steps towards a crossing.
/// Kind: cap.
const CAMPBELL_MAX_STEPS: usize = 200;

/// Distance of a frequency from EO·Ω, relative, at which both are one.
/// Kind: rounding.
const MET: f64 = 1e-9;

/// Number of halvings of the interval in which a mode ceases to oscillate.
/// Kind: cap.
const CAMPBELL_MAX_HALVINGS: usize = 40;

const CONTEXT: &str = "the Campbell diagram";

/// Damped modes over the speed of rotation. Lists hold the modes of one speed after those of the speed before.
#[derive(Clone, Debug, Default)]
pub struct Campbell {
    /// Speeds of rotation, rising.
    pub speeds: Vec<f64>,
    /// Number of modes at each speed.
    pub count: usize,
    /// Signed nodal diameter of the modes, −N/2 < d ≤ N/2.
    pub diameter: i64,
    /// Damped angular frequencies, rising at each speed. NaN where fewer motions oscillate, and at a speed whose
    /// modes were not found, which the log reports.
    pub omega: Vec<f64>,
    /// Damping ratios; negative: the motion grows.
    pub damping_ratio: Vec<f64>,
    /// Sense in which the frequency of each mode changes with the speed, as [`DampedModes::direction`].
    pub direction: Vec<i64>,
    /// Speeds at which EO·Ω is a natural frequency of the wave that EO excites, by engine order, then by speed.
    pub crossings: Vec<Crossing>,
}

/// An engine order at the frequency of a mode of the wave that it excites.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Engine order EO that meets the mode.
    pub engine_order: i64,
    /// Signed nodal diameter EO mod N of the wave, −N/2 < d ≤ N/2.
    pub diameter: i64,
    /// Speed of rotation Ω at the crossing.
    pub speed: f64,
    /// Angular frequency ω = EO·Ω at the crossing.
    pub omega: f64,
    /// Sense in which the frequency of the mode changes with the speed, as in the diagram.
    pub direction: i64,
}

/// Computes the `count` lowest damped modes of a signed nodal diameter, modulo N, at each of the rising `speeds`; and
/// the speeds between them at which one of `engine_orders` meets a mode. An engine order excites the wave EO mod N:
/// it meets the modes of this sense of the diameter, whichever sense was given. The log reports engine orders that
/// excite another diameter and thus meet no mode. The speed of the model has no effect.
///
/// # Errors
/// `Dimension`, `NotFinite` or `Argument` for the speeds, the count or an engine order; those of
/// [`damped_modes`](crate::analysis::linear::damped_modes::damped_modes); `StoppedByCaller`.
pub fn campbell(
    model: &Model,
    speeds: &[f64],
    (diameter, contacts, count): (i64, LinearContacts, usize),
    engine_orders: &[i64],
    hooks: &mut Hooks<'_>,
) -> Result<Campbell> {
    check(speeds, engine_orders)?;
    model.structure().check_diameter(diameter)?;
    let structure = model.structure();
    let interrupt = hooks.interrupt();
    let mut modes = ModesAtSpeed {
        rotating: model.try_clone()?,
        contacts,
        count,
        failed: Vec::new(),
        interrupt: &interrupt,
    };
    let is_wheel = structure.sectors() > 1;
    let own = structure.signed_diameter(diameter);
    let other = structure.signed_diameter(-own);
    let mut found = modes.lines(own, speeds)?;
    modes.tell_failures(hooks);
    tell_growth(&found, is_wheel, hooks);
    let stretches = modes.stretches(&found)?;
    let is_other = |order: i64| structure.signed_diameter(order) == other;
    let mut opposite = None;
    if other != own && engine_orders.iter().any(|&order| is_other(order)) && !modes.has_equal_senses(own, speeds)? {
        let lines = modes.lines(other, speeds)?;
        modes.tell_failures(hooks);
        tell_growth(&lines, is_wheel, hooks);
        opposite = Some(modes.stretches(&lines)?);
    }
    for &engine_order in engine_orders {
        let wave = structure.signed_diameter(engine_order);
        // Equal senses have equal frequencies, but opposite directions.
        let (stretches, of, sign) = match &opposite {
            _ if wave == own => (&stretches, own, 1),
            Some(stretches) if wave == other => (stretches, other, 1),
            None if wave == other => (&stretches, own, -1),
            _ => {
                let text = format!(
                    "engine order {engine_order} excites the nodal diameter {wave} and meets no mode of the diameter {own}"
                );
                hooks.log(LogLevel::Info, &text);
                continue;
            }
        };
        let first = found.crossings.len();
        for stretch in stretches {
            let met = meetings(
                &mut |speed| modes.at(of, speed),
                stretch,
                engine_order,
                &mut found.crossings,
                &interrupt,
            );
            if let Err(error) = met {
                let text = format!(
                    "crossings of engine order {engine_order} between the speeds {} and {} may be missing",
                    stretch.low.speed, stretch.high.speed
                );
                hooks.log(LogLevel::Warn, &reason_of_one_speed(error, &text)?);
            }
        }
        for crossing in &mut found.crossings[first..] {
            crossing.diameter = wave;
            crossing.direction *= sign;
        }
        found.crossings[first..].sort_by(|a, b| a.speed.total_cmp(&b.speed));
    }
    Ok(found)
}

/// The modes of waves at any speed.
struct ModesAtSpeed<'a> {
    rotating: Model,
    contacts: LinearContacts,
    count: usize,
    /// Speeds whose modes were not found in the last diagram, by index, each with the reason.
    failed: Vec<(usize, String)>,
    interrupt: &'a Interrupt<'a>,
}

impl ModesAtSpeed<'_> {
    fn at(&mut self, diameter: i64, speed: f64) -> Result<DampedModes> {
        self.rotating.set_speed(Speed::Fixed(speed))?;
        damped_modes::check(&self.rotating, diameter, self.count)?;
        let contacts = self.contacts.prepared(&self.rotating, self.interrupt)?;
        damped_modes::of_wave(&self.rotating, diameter, contacts.state(), self.count, self.interrupt)
    }

    /// The diagram of a wave without crossings. A speed whose modes are not found is left out, unless there is no other.
    fn lines(&mut self, diameter: i64, speeds: &[f64]) -> Result<Campbell> {
        let mut found = Campbell {
            count: self.count,
            diameter,
            ..Campbell::default()
        };
        self.failed.clear();
        for (i, &speed) in speeds.iter().enumerate() {
            self.interrupt.part(Phase::Modes, i, speeds.len())?;
            let modes = match self.at(diameter, speed) {
                Err(error) if self.failed.len() + 1 < speeds.len() => {
                    let text = reason_of_one_speed(error, &format!("the modes at the speed {speed} are left out"))?;
                    try_push(&mut self.failed, (i, text), CONTEXT)?;
                    DampedModes::default()
                }
                modes => modes?,
            };
            try_push(&mut found.speeds, speed, CONTEXT)?;
            for k in 0..self.count {
                let known = k < modes.count();
                let omega = if known { modes.omega(k) } else { f64::NAN };
                let ratio = if known { modes.damping_ratio(k) } else { f64::NAN };
                let direction = modes.direction.get(k).copied().unwrap_or(0);
                try_push(&mut found.omega, omega, CONTEXT)?;
                try_push(&mut found.damping_ratio, ratio, CONTEXT)?;
                try_push(&mut found.direction, direction, CONTEXT)?;
            }
        }
        Ok(found)
    }

    /// Logs the speeds that are left out.
    fn tell_failures(&self, hooks: &mut Hooks<'_>) {
        for (_, text) in &self.failed {
            hooks.log(LogLevel::Warn, text);
        }
    }

    /// The intervals between speeds of a diagram in which equally many motions oscillate; speeds that are left out
    /// bound none.
    fn stretches(&mut self, lines: &Campbell) -> Result<Vec<Stretch>> {
        let mut stretches = Vec::new();
        let mut before = None;
        let mut is_first = true;
        for i in 0..lines.speeds.len() {
            if self.failed.iter().any(|(failed, _)| *failed == i) {
                continue;
            }
            let Some(low) = before.replace(i) else { continue };
            let whole = Stretch {
                low: known(lines, low)?,
                high: known(lines, i)?,
                is_first,
            };
            is_first = false;
            let interrupt = self.interrupt;
            let divided = divide(
                &mut |speed| self.at(lines.diameter, speed),
                whole,
                &mut stretches,
                interrupt,
            );
            if let Err(error) = divided {
                // The crossings of the parts that are known are still found.
                reason_of_one_speed(error, "")?;
            }
        }
        Ok(stretches)
    }

    /// Whether both senses of a diameter have the same frequencies at all speeds.
    fn has_equal_senses(&mut self, diameter: i64, speeds: &[f64]) -> Result<bool> {
        for &speed in speeds {
            self.rotating.set_speed(Speed::Fixed(speed))?;
            let contacts = self.contacts.prepared(&self.rotating, self.interrupt)?;
            if !has_equal_senses(&self.rotating, diameter, contacts.state())? {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// The reason for an error that concerns one speed only, as modes that are not found; other errors are returned.
fn reason_of_one_speed(error: Error, text: &str) -> Result<String> {
    if matches!(error.status, Status::NoConvergence | Status::Singular) {
        return Ok(format!("{text}: {error}"));
    }
    Err(error)
}

fn check(speeds: &[f64], engine_orders: &[i64]) -> Result<()> {
    if speeds.is_empty() {
        return fail!(Dimension, "no speeds are given, needs at least 1");
    }
    for (i, speed) in speeds.iter().enumerate() {
        if !speed.is_finite() {
            return fail!(NotFinite, "speeds[{i}] = {speed}, needs a finite number");
        }
        if i > 0 && *speed <= speeds[i - 1] {
            return fail!(
                Argument,
                "speeds[{i}] = {speed}, needs more than speeds[{}] = {}",
                i - 1,
                speeds[i - 1]
            );
        }
    }
    if let Some(i) = engine_orders.iter().position(|&order| order < 1) {
        return fail!(Argument, "engine_orders[{i}] = {}, needs at least 1", engine_orders[i]);
    }
    Ok(())
}

/// Frequencies of the modes that oscillate at one speed.
#[derive(Debug)]
struct Known {
    speed: f64,
    omega: Vec<f64>,
}

impl Known {
    fn new(speed: f64, modes: &DampedModes) -> Result<Self> {
        let mut omega = Vec::new();
        for k in 0..modes.count() {
            try_push(&mut omega, modes.omega(k), CONTEXT)?;
        }
        Ok(Self { speed, omega })
    }

    fn try_clone(&self) -> Result<Self> {
        Ok(Self {
            speed: self.speed,
            omega: try_copy(&self.omega, CONTEXT)?,
        })
    }

    /// Difference ω − EO·Ω of mode k, as a point (speed, difference).
    fn gap(&self, k: usize, order: f64) -> (f64, f64) {
        (self.speed, self.omega[k] - order * self.speed)
    }
}

/// Two speeds at which equally many motions oscillate, so that the k-th modes belong together.
#[derive(Debug)]
struct Stretch {
    low: Known,
    high: Known,
    /// Whether the stretch begins at the first speed.
    is_first: bool,
}

/// Frequencies at the i-th speed of the diagram.
fn known(found: &Campbell, i: usize) -> Result<Known> {
    let mut omega = Vec::new();
    let all = &found.omega[i * found.count..(i + 1) * found.count];
    for value in all.iter().take_while(|omega| !omega.is_nan()) {
        try_push(&mut omega, *value, CONTEXT)?;
    }
    Ok(Known {
        speed: found.speeds[i],
        omega,
    })
}

/// Divides a stretch until equally many motions oscillate at both ends of each part. Parts in which the numbers still
/// differ are too short to matter.
fn divide(
    at: &mut impl FnMut(f64) -> Result<DampedModes>,
    whole: Stretch,
    parts: &mut Vec<Stretch>,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let mut open = Vec::new();
    try_push(&mut open, (whole, 0), CONTEXT)?;
    while let Some((stretch, halvings)) = open.pop() {
        if stretch.low.omega.len() == stretch.high.omega.len() {
            try_push(parts, stretch, CONTEXT)?;
            continue;
        }
        if halvings == CAMPBELL_MAX_HALVINGS {
            continue;
        }
        interrupt.check()?;
        let speed = 0.5 * (stretch.low.speed + stretch.high.speed);
        let middle = Known::new(speed, &at(speed)?)?;
        for half in stretch.halves(middle)? {
            try_push(&mut open, (half, halvings + 1), CONTEXT)?;
        }
    }
    Ok(())
}

impl Stretch {
    fn halves(self, middle: Known) -> Result<[Self; 2]> {
        let low = Self {
            low: self.low,
            high: middle.try_clone()?,
            is_first: self.is_first,
        };
        let high = Self {
            low: middle,
            high: self.high,
            is_first: false,
        };
        Ok([low, high])
    }
}

/// The crossings of an engine order with the modes of a stretch.
fn meetings(
    at: &mut impl FnMut(f64) -> Result<DampedModes>,
    stretch: &Stretch,
    engine_order: i64,
    crossings: &mut Vec<Crossing>,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let order = engine_order as f64;
    for k in 0..stretch.low.omega.len() {
        let (low, high) = (stretch.low.gap(k, order), stretch.high.gap(k, order));
        // A crossing at a speed itself belongs to the stretch that it ends.
        let is_first = stretch.is_first && low.1 == 0.0;
        let meets = low.1 * high.1 < 0.0 || (high.1 == 0.0 && low.1 != 0.0);
        if !(is_first || meets) {
            continue;
        }
        let Some((speed, modes)) = meet(at, k, order, low, high, interrupt)? else {
            continue;
        };
        let crossing = Crossing {
            engine_order,
            diameter: 0,
            speed,
            omega: modes.omega(k),
            direction: modes.direction[k],
        };
        try_push(crossings, crossing, CONTEXT)?;
    }
    Ok(())
}

/// Logs the first mode that grows, and the number of speeds at which one does.
fn tell_growth(found: &Campbell, is_wheel: bool, hooks: &mut Hooks<'_>) {
    let grows = |row: &[f64]| row.iter().position(|ratio| *ratio < GROWS);
    let mut growing = found
        .damping_ratio
        .chunks_exact(found.count)
        .enumerate()
        .filter_map(|(i, row)| grows(row).map(|k| (i, k)));
    let Some((i, k)) = growing.next() else { return };
    let wave = if is_wheel {
        format!(" in the wave of the nodal diameter {}", found.diameter)
    } else {
        String::new()
    };
    let text = format!(
        "modes grow at {} of {} speeds: mode {k} at the speed {} has the damping ratio {:.3e}{wave}",
        1 + growing.count(),
        found.speeds.len(),
        found.speeds[i],
        found.damping_ratio[i * found.count + k]
    );
    hooks.log(LogLevel::Warn, &text);
}

/// The speed between two others at which mode k has the frequency EO·Ω, and
/// the modes at this speed; `None` where the frequency jumps over EO·Ω, or the mode ceases to oscillate between the
/// two.
fn meet(
    at: &mut impl FnMut(f64) -> Result<DampedModes>,
    k: usize,
    order: f64,
    a: (f64, f64),
    b: (f64, f64),
    interrupt: &Interrupt<'_>,
) -> Result<Option<(f64, DampedModes)>> {
    if a.1 == 0.0 || b.1 == 0.0 {
        let speed = if a.1 == 0.0 { a.0 } else { b.0 };
        let modes = at(speed)?;
        return Ok((k < modes.count()).then_some((speed, modes)));
    }
    let mut bracket = Bracket::between(a, b);
    let mut best = None;
    for _ in 0..CAMPBELL_MAX_STEPS {
        interrupt.check()?;
        let speed = bracket.guess();
        let modes = at(speed)?;
        if k >= modes.count() {
            return Ok(None);
        }
        let gap = modes.omega(k) - order * speed;
        let close = CAMPBELL_TOLERANCE * speed.abs();
        let done = gap.abs() <= CAMPBELL_TOLERANCE * modes.omega(k)
            || bracket.narrow(speed, gap) <= close
            || bracket.width() <= close;
        best = Some((speed, modes));
        if done {
            break;
        }
    }
    // The bracket also closes on a jump.
    Ok(best.filter(|(speed, modes)| {
        let omega = modes.omega(k);
        (omega - order * speed).abs() <= MET * omega
    }))
}
