//! Checks of a contact or spring before the model stores it: degrees of freedom that exist, none of them twice, and
//! two different sides.

use crate::contact::Contact;
use crate::contact::described::relative_motion::Direction;
use crate::error::{Result, fail, try_push, try_vec};
use crate::model::Model;
use crate::model::excitation::Force;
use crate::model::matrices::structure::MatrixKind;
use num_complex::Complex64;

/// Size of a force, over that of the largest one, from which its harmonic is watched.
/// Kind: tuned; measured on: not recorded.
const WATCHED: f64 = 1e-3;

impl Model {
    /// Forces that are not zero, on degrees of freedom that are not fixed.
    pub(crate) fn acting_forces(&self) -> impl Iterator<Item = &Force> {
        let degrees = self.structure().degrees();
        let forces = self.excitation().forces().iter();
        forces.filter(|f| f.value != Complex64::ZERO && !degrees.is_fixed(f.dof))
    }

    /// Harmonic whose amplitude is reported as the response: the lowest one with a vibrating force that is not tiny
    /// against the largest one; `None` without vibrating forces. An unbalance counts at any size.
    pub(crate) fn watched_harmonic(&self) -> Option<usize> {
        let vibrating = || self.acting_forces().filter(|f| f.harmonic > 0);
        let largest = vibrating()
            .filter(|f| !f.per_omega2)
            .fold(0.0_f64, |most, f| most.max(f.value.norm()));
        let counts = |f: &&Force| f.per_omega2 || f.value.norm() >= WATCHED * largest;
        vibrating().filter(counts).map(|f| f.harmonic).min()
    }
}

impl Model {
    /// For each degree of freedom of the caller, whether a contact acts on it.
    pub(crate) fn felt_by_contacts(&self) -> Result<Vec<bool>> {
        let mut felt = try_vec(self.ndof(), false, "the guess")?;
        for contact in self.contacts() {
            let sides = contact.dof_a.iter().chain(&contact.dof_b).flatten();
            let rotations = contact.rigid.iter().flat_map(|rigid| &rigid.rotations).flatten();
            for &dof in sides.chain(&contact.dofs).chain(rotations) {
                felt[dof] = true;
            }
        }
        Ok(felt)
    }

    pub(super) fn check_contact(&self, contact: &Contact) -> Result<()> {
        contact.check_constants()?;
        for (name, side) in [("dof_a", &contact.dof_a), ("dof_b", &contact.dof_b)] {
            let dofs = || side.iter().enumerate().filter_map(|(i, dof)| dof.map(|dof| (i, dof)));
            dofs().try_for_each(|(i, dof)| self.check_dof(name, i, dof))?;
            for (i, dof) in dofs() {
                if let Some((j, _)) = dofs().find(|&(j, other)| j > i && other == dof) {
                    return twice(name, i, j, dof);
                }
            }
        }
        self.check_list("dofs", &contact.dofs)?;
        self.check_rigid(contact)?;
        for k in 0..contact.directions() {
            let node_b = contact.frame.map(|_| contact.dof_b);
            self.check_sides("contact", &contact.direction(k), contact.sector_offset, node_b)?;
        }
        Ok(())
    }

    /// Checks the rotations on side a of a contact: they must be degrees of freedom other than its translations, and
    /// need directions.
    fn check_rigid(&self, contact: &Contact) -> Result<()> {
        let Some(rigid) = contact.rigid else { return Ok(()) };
        if let Some(x) = rigid.arm.iter().chain([&rigid.turn]).find(|x| !x.is_finite()) {
            return fail!(NotFinite, "contact: arm or turn = {x}, needs finite numbers");
        }
        if contact.frame.is_none() && !rigid.is_plain() {
            return fail!(
                Argument,
                "contact: rotation or turn without directions; give normal and tangent"
            );
        }
        for (i, dof) in rigid.rotations.iter().enumerate() {
            let Some(dof) = *dof else { continue };
            self.check_dof("rotation", i, dof)?;
            let before = &rigid.rotations[..i];
            if before.contains(&Some(dof)) || contact.dof_a.contains(&Some(dof)) {
                return fail!(
                    Argument,
                    "contact: rotation[{i}] = {dof} is named twice on side a, needs different degrees of freedom"
                );
            }
        }
        Ok(())
    }

    /// Refuses a model without any matrix or spring, and a model without mass if the analysis needs it.
    ///
    /// # Errors
    /// `Argument`.
    pub fn check_matrices(&self, needs_mass: bool) -> Result<()> {
        let structure = self.structure();
        let has_mass = structure.has(MatrixKind::Mass);
        let has_others = structure.has(MatrixKind::Stiffness) || structure.has(MatrixKind::Damping);
        if !has_mass && !has_others && self.springs().is_empty() {
            return fail!(
                Argument,
                "no matrices were set: the model needs a mass matrix, and a stiffness matrix or springs"
            );
        }
        if !has_mass && needs_mass {
            return fail!(Argument, "no mass matrix was set: a mode needs one");
        }
        Ok(())
    }

    /// Checks a response degree of freedom: it must exist and must not be fixed.
    pub(crate) fn check_response_dof(&self, dof: Option<usize>) -> Result<()> {
        match dof {
            Some(dof) if dof >= self.ndof() => {
                fail!(Index, "response_dof = {dof}, needs 0 .. {}", self.ndof() - 1)
            }
            Some(dof) if self.structure().degrees().is_fixed(dof) => {
                fail!(Argument, "response_dof = {dof} is fixed: it has no response")
            }
            _ => Ok(()),
        }
    }

    /// Checks entry `i` of a list: it must be a degree of freedom of the model.
    fn check_dof(&self, list: &str, i: usize, dof: usize) -> Result<()> {
        if dof < self.ndof() {
            return Ok(());
        }
        fail!(Index, "contact: {list}[{i}] = {dof}, needs 0 .. {}", self.ndof() - 1)
    }

    /// Checks a list: it must name degrees of freedom of the model, each once.
    fn check_list(&self, list: &str, dofs: &[usize]) -> Result<()> {
        let mut places = Vec::new();
        for (i, &dof) in dofs.iter().enumerate() {
            self.check_dof(list, i, dof)?;
            try_push(&mut places, (dof, i), "a list of degrees of freedom")?;
        }
        // Sorted neighbours reveal a repetition in a long list, too.
        places.sort_unstable();
        match places.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            Some(pair) => twice(list, pair[0].1, pair[1].1, pair[0].0),
            None => Ok(()),
        }
    }

    /// Checks both sides of a contact or spring: they must exist and differ; `node_b` is the node on side b of a
    /// contact with a frame.
    pub(super) fn check_sides(
        &self,
        what: &str,
        sides: &Direction,
        sector_offset: i64,
        node_b: Option<[Option<usize>; 3]>,
    ) -> Result<()> {
        let n = self.ndof();
        for (name, side) in [("dof_a", sides.a), ("dof_b", sides.b)] {
            if let Some((dof, _)) = side.into_iter().flatten().find(|&(d, _)| d >= n) {
                return fail!(Index, "{what}: {name} = {dof}, needs 0 .. {}", n - 1);
            }
        }
        let same_sector = self.structure().same_sector(sector_offset);
        let grounded = sides.a.iter().all(Option::is_none);
        if sides.a == sides.b && (same_sector || grounded) {
            return fail!(
                Argument,
                "{what}: dof_a and dof_b are both {}; it needs two different sides",
                if grounded {
                    "the ground"
                } else {
                    "the same degree of freedom"
                }
            );
        }
        if sector_offset != 0 && self.structure().sectors() == 1 {
            return fail!(
                Argument,
                "{what}: sector_offset = {sector_offset}, needs 0 in a plain structure"
            );
        }
        let sectors = self.structure().sectors();
        if sector_offset.unsigned_abs() >= sectors as u64 {
            return fail!(
                Argument,
                "{what}: sector_offset = {sector_offset}, needs -{} .. {} on {sectors} sectors",
                sectors - 1,
                sectors - 1
            );
        }
        self.structure().check_motion(what, sides, sector_offset, node_b)
    }
}

fn twice(list: &str, i: usize, j: usize, dof: usize) -> Result<()> {
    fail!(
        Argument,
        "contact: {list}[{i}] and {list}[{j}] are both {dof}, need different degrees of freedom"
    )
}
