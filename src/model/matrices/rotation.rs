//! Rotation of a model: its speed, the loads of its contacts that follow from it, unbalance, and the model at one
//! frequency.

use crate::contact::forms::constants::Constant;
use crate::error::{Result, fail, try_push};
use crate::model::Model;
pub use crate::model::matrices::speed::{Speed, SpeedLoad};
use num_complex::Complex64;
use std::borrow::Cow;

/// Sets the speed of rotation.
pub(crate) fn set_speed(model: &mut Model, speed: Speed) -> Result<()> {
    let (name, value) = match speed {
        Speed::Fixed(value) => ("speed", value),
        Speed::PerOmega(value) => ("per_omega", value),
    };
    if !value.is_finite() {
        return fail!(NotFinite, "{name} = {value}, needs a finite number");
    }
    for load in model.speed_loads() {
        check_tied(speed, load.contact, load.per_speed2)?;
    }
    model.structure_mut().speed = speed;
    model.apply_speed();
    Ok(())
}

/// Sets the normal load of a contact at speed Ω to preload + per_speed2·Ω².
pub(crate) fn set_preload_at_speed(model: &mut Model, id: usize, preload: f64, per_speed2: f64) -> Result<()> {
    if !per_speed2.is_finite() {
        return fail!(NotFinite, "per_speed2 = {per_speed2}, needs a finite number");
    }
    if per_speed2 != 0.0 && !preload.is_finite() {
        return fail!(
            Argument,
            "preload = {preload}, needs a finite number where per_speed2 = {per_speed2} is not 0"
        );
    }
    check_tied(model.speed(), id, per_speed2)?;
    let before = model.speed_loads().iter().position(|load| load.contact == id);
    let gap = match (before, model.contacts().get(id)) {
        (Some(at), _) => model.speed_loads()[at].gap,
        (None, Some(contact)) => contact.constant(Constant::Gap),
        (None, None) => 0.0,
    };
    model.change_preload(id, preload, gap)?;
    if let Some(at) = before {
        model.speed_loads_mut().swap_remove(at);
    }
    if per_speed2 != 0.0 {
        let load = SpeedLoad {
            contact: id,
            preload,
            gap,
            per_speed2,
        };
        try_push(model.speed_loads_mut(), load, "the loads of contacts")?;
        model.apply_speed();
    }
    Ok(())
}

/// Sets the static normal load that wear has left to a contact.
pub(crate) fn set_worn_load(model: &mut Model, id: usize, load: f64) -> Result<()> {
    let kn = model
        .contacts()
        .get(id)
        .map_or(0.0, |contact| contact.constant(Constant::Kn));
    let gap = if kn > 0.0 { (-load).max(0.0) / kn } else { 0.0 };
    model.change_preload(id, load.max(0.0), gap)?;
    model.speed_loads_mut().retain(|of| of.contact != id);
    Ok(())
}

/// Adds the force of an unbalance m·e that rotates with the frequency ω of the response.
pub(crate) fn add_unbalance(model: &mut Model, dof_x: usize, dof_y: usize, m_e: f64, phase: f64) -> Result<()> {
    for (name, value) in [("m_e", m_e), ("phase", phase)] {
        if !value.is_finite() {
            return fail!(NotFinite, "unbalance: {name} = {value}, needs a finite number");
        }
    }
    let n = model.ndof();
    for (name, dof) in [("dof_x", dof_x), ("dof_y", dof_y)] {
        if dof >= n {
            return fail!(Index, "unbalance: {name} = {dof}, needs 0 .. {}", n - 1);
        }
    }
    if dof_x == dof_y {
        return fail!(
            Argument,
            "unbalance: dof_x and dof_y are both {dof_x}, need different degrees of freedom"
        );
    }
    let value = Complex64::from_polar(m_e, phase);
    model.add_unbalance_forces([(dof_x, value), (dof_y, value * -Complex64::I)])
}

/// Adds the constant force `mass_radius`·Ω² on a degree of freedom.
pub(crate) fn add_centrifugal(model: &mut Model, dof: usize, mass_radius: f64) -> Result<()> {
    model.add_centrifugal_force(dof, mass_radius)?;
    model.apply_speed();
    Ok(())
}

/// Sets contacts whose load depends on the speed to the load at the present speed.
pub(crate) fn apply_speed(model: &mut Model) {
    let speed = model.speed();
    let mut loads = std::mem::take(model.speed_loads_mut());
    for load in &mut loads {
        let Some(contact) = model.contact_mut(load.contact) else {
            continue;
        };
        *contact = match speed {
            Speed::Fixed(speed) => load.at(contact, speed),
            Speed::PerOmega(p) => load.referred(contact, load.reference(contact, p)),
        };
    }
    *model.speed_loads_mut() = loads;
    model.forces_at_speed(speed);
}

/// Derivative ∂ln|N|/∂ω of a normal load that is tied to the frequency.
pub(crate) fn growth_of_load(model: &Model, contact: usize, omega: f64) -> Option<f64> {
    let Speed::PerOmega(p) = model.speed() else { return None };
    let load = model.speed_loads().iter().find(|load| load.contact == contact)?;
    let rest = load.load_at_rest(&model.contacts()[contact]);
    let square = load.per_speed2 * p * p;
    Some(2.0 * square * omega / (rest + square * omega * omega)).filter(|growth| growth.is_finite())
}

/// Whether anything but the inertia and the damping forces depends on the frequency of the response.
pub(crate) fn depends_on_frequency(model: &Model) -> bool {
    matches!(model.speed(), Speed::PerOmega(_)) || model.excitation().has_unbalance()
}

/// The model at one frequency of the response.
pub(crate) fn at_frequency(model: &Model, omega: f64) -> Result<Cow<'_, Model>> {
    if !model.depends_on_frequency() {
        return Ok(Cow::Borrowed(model));
    }
    let mut model = model.try_clone()?;
    model.structure_mut().speed = Speed::Fixed(model.speed().at(omega));
    model.apply_speed();
    model.fix_unbalance(omega);
    Ok(Cow::Owned(model))
}

fn check_tied(speed: Speed, contact: usize, per_speed2: f64) -> Result<()> {
    if matches!(speed, Speed::PerOmega(_)) && per_speed2 < 0.0 {
        return fail!(
            Argument,
            "per_speed2 = {per_speed2} of contact {contact}, needs a number >= 0 where the speed is tied to the frequency"
        );
    }
    Ok(())
}
