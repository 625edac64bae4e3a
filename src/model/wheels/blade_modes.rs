//! A sector whose blade moves in its cantilever modes: the reduction by which differences of blades have a low rank.
//!
//! The degrees of freedom b of a blade follow those of the rest, and modes q of the blade with its attachment held:
//! x_b = −K_bb⁻¹K_br x_r + Φ q with K_bbΦ = M_bbΦΛ and ΦᵀM_bbΦ = 1 (Craig & Bampton 1968, doi:10.2514/3.4741). The stiffness has no
//! entries between q and the rest and is Λ among the q, so that a pattern of the q is exactly one of the stiffness of the blade, of as
//! many terms as modes (Lim, Bladh, Castanier & Pierre 2007, doi:10.2514/1.13172).

use crate::contact::Contact;
use crate::error::{Result, fail, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::model::excitation::Force;
use crate::model::matrices::spring::Spring;
use crate::model::matrices::structure::{MatrixKind, Structure};
use crate::model::wheels::blade_basis::{Basis, independent};
use crate::model::{Model, copy};

const CONTEXT: &str = "the modes of a blade";

const KINDS: [MatrixKind; 6] = [
    MatrixKind::Mass,
    MatrixKind::Damping,
    MatrixKind::Stiffness,
    MatrixKind::Structural,
    MatrixKind::Gyroscopic,
    MatrixKind::StiffnessSpeed2,
];

/// A sector reduced to modes of its blade.
#[derive(Debug)]
pub struct BladeModes {
    /// The reduced sector: first the remaining degrees of freedom, in their order, then the modes of the blade.
    pub model: Model,
    /// For each degree of freedom of the given sector its number in the reduced one; `None` for those of the blade,
    /// of the right face, and fixed ones.
    pub numbers: Vec<Option<usize>>,
    /// Number of the first mode in the reduced sector.
    pub first: usize,
    /// Estimate of the largest relative error of a frequency by the omitted modes, over the requested tuned modes of
    /// all nodal diameters, with all contacts stuck and with all of them free. Infinite where one lies above the first
    /// omitted mode; NaN, unknown, where matrices of a speed act: there compare natural frequencies of both sectors.
    pub left_out: f64,
    basis: Basis,
}

impl BladeModes {
    /// Weights of the degrees of freedom of the reduced sector that make the motion of one of the given sector.
    ///
    /// # Errors
    /// `Index`; `Argument` for a degree of freedom that does not move by itself.
    pub fn weights(&self, given: &Model, dof: usize) -> Result<Vec<f64>> {
        let number = independent(given, dof)?;
        let mut weights = try_vec(self.basis.order, 0.0, CONTEXT)?;
        match (self.basis.number[number], self.basis.place[number]) {
            (Some(same), _) => weights[same] = 1.0,
            (None, Some(b)) => {
                for (c, &column) in self.basis.columns.iter().enumerate() {
                    weights[column] += self.basis.values[c * self.basis.blade + b].re;
                }
            }
            (None, None) => {}
        }
        Ok(weights)
    }
}

/// Reduces a sector to the `modes` lowest cantilever modes of the blade `dofs`.
pub(crate) fn on_blade_modes(
    model: &Model,
    dofs: &[usize],
    (modes, families): (usize, usize),
    interrupt: &Interrupt<'_>,
) -> Result<BladeModes> {
    let structure = model.structure();
    let has_diameters = structure.blocks.iter().any(|blocks| !blocks.diameters.is_empty());
    if has_diameters || structure.has_modal_damping() || structure.has_aero() {
        return fail!(
            Unsupported,
            "a blade on its modes in a sector with matrices of single diameters, modal damping or aerodynamic forces"
        );
    }
    let basis = Basis::new(model, dofs, modes, interrupt)?;
    let mut reduced = Model::cyclic(basis.order, structure.sectors())?;
    for kind in KINDS {
        let blocks = &structure.blocks[kind as usize];
        if let Some(own) = &blocks.own {
            let own = basis.reduced(own, kind, interrupt)?;
            reduced.structure.blocks_mut(kind)?.own = Some(KeptMatrix::new(own)?);
        }
        for (coupling, is_next) in [(&blocks.next, true), (&blocks.previous, false)] {
            if let Some(coupling) = coupling {
                let moved = Some(KeptMatrix::new(basis.renumbered(coupling, kind)?)?);
                let blocks = reduced.structure.blocks_mut(kind)?;
                *if is_next {
                    &mut blocks.next
                } else {
                    &mut blocks.previous
                } = moved;
            }
        }
    }
    copy_numbers(structure, &mut reduced.structure);
    basis.move_places(model, &mut reduced)?;
    let mut numbers = Vec::new();
    for dof in 0..structure.degrees().given() {
        let number = independent(model, dof).ok().and_then(|number| basis.number[number]);
        try_push(&mut numbers, number, CONTEXT)?;
    }
    // At speed the blade has other modes than those whose squares the estimate compares with.
    let left_out = if structure.is_rotating() {
        f64::NAN
    } else {
        basis.left_out(model, &reduced, families, interrupt)?
    };
    Ok(BladeModes {
        model: reduced,
        numbers,
        first: basis.order - modes,
        left_out,
        basis,
    })
}

/// Copies damping factors, wave and speed from one structure to another.
fn copy_numbers(from: &Structure, to: &mut Structure) {
    to.rayleigh = from.rayleigh;
    to.loss_factor = from.loss_factor;
    to.loss_of_stiffness = from.loss_of_stiffness;
    to.speed = from.speed;
    to.engine_order = from.engine_order;
}

impl Basis {
    /// Copies contacts, springs, loads and forces, renumbered for the reduced sector.
    fn move_places(&self, from: &Model, to: &mut Model) -> Result<()> {
        let moved = |what: &str, id: usize, dof: usize| match independent(from, dof).map(|number| self.number[number]) {
            Ok(Some(number)) => Ok(number),
            _ => fail!(
                Argument,
                "{what} {id} is at dof = {dof}, which is in the blade, fixed or on the right face; leave it out of dofs"
            ),
        };
        for (id, contact) in from.contacts().iter().enumerate() {
            let mut contact: Contact = copy(contact)?;
            let sides = contact.dof_a.iter_mut().chain(&mut contact.dof_b).flatten();
            let rotations = contact
                .rigid
                .iter_mut()
                .flat_map(|rigid| &mut rigid.rotations)
                .flatten();
            for dof in sides.chain(&mut contact.dofs).chain(rotations) {
                *dof = moved("contact", id, *dof)?;
            }
            try_push(&mut to.contacts, contact, CONTEXT)?;
        }
        for (id, spring) in from.springs().iter().enumerate() {
            let place = |dof: Option<usize>| dof.map(|dof| moved("spring", id, dof)).transpose();
            let spring = Spring {
                dof_a: place(spring.dof_a)?,
                dof_b: place(spring.dof_b)?,
                ..*spring
            };
            try_push(&mut to.springs, spring, CONTEXT)?;
        }
        for load in from.speed_loads() {
            try_push(&mut to.speed_loads, *load, CONTEXT)?;
        }
        for force in from.excitation().forces() {
            let number = independent(from, force.dof).map_err(|e| e.at(format_args!("force")))?;
            let Some(b) = self.place[number] else {
                let dof = self.number[number].unwrap_or_default();
                to.excitation.restore(self.order, Force { dof, ..*force })?;
                continue;
            };
            for (c, &dof) in self.columns.iter().enumerate() {
                let weight = self.values[c * self.blade + b].re;
                if weight != 0.0 {
                    let part = Force {
                        dof,
                        value: weight * force.value,
                        per_speed2: weight * force.per_speed2,
                        ..*force
                    };
                    to.excitation.restore(self.order, part)?;
                }
            }
        }
        Ok(())
    }
}
