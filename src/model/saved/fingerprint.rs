//! The fingerprint of a model: a number for each of its parts, by which a branch knows whether a model is still the one that it was
//! solved from.
//!
//! Contents count, not the history: a copy, a model that was loaded from its bytes, and one whose change was undone have the same
//! fingerprint.

use crate::byte_stream::ByteWriter;
use crate::contact::Contact;
use crate::contact::described::saved_contact;
use crate::error::{Result, fail};
use crate::linalg::sparse_storage::sparse::Columns;
use crate::model::matrices::speed::Speed;
use crate::model::matrices::structure::MatrixKind;
use crate::model::mechanical_model::Model;
use crate::model::saved::saved_matrix;
use crate::model::saved::saved_structure::save_degrees;
use crate::model::wheels::sector_digest::{SectorDigest, SectorUse};

/// Digests of the parts of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint {
    /// Digest of degrees of freedom, sectors, faces, and fixed degrees of freedom.
    degrees: u64,
    /// Digest of mass and stiffness, and the matrices of rotation.
    matrices: u64,
    speed: u64,
    /// Digest of every kind of damping, and the aerodynamic influence.
    damping: u64,
    springs: u64,
    contacts: u64,
    constant_forces: u64,
    vibrating_forces: u64,
    engine_order: i64,
}

/// How a model is used together with a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// With a point of a forced response: all of the model counts.
    Response,
    /// With a point of a nonlinear mode: vibrating forces do not count and, where the mode has its own diameter,
    /// neither does the wave.
    Mode {
        /// Whether the mode belongs to the wave of the model.
        on_wave: bool,
    },
    /// For a synthesis, which has vibrating forces and may have its own damping.
    Synthesis,
}

impl Fingerprint {
    /// Refuses a model that differs from the one of a branch, and names the part that differs.
    ///
    /// # Errors
    /// `Argument`.
    pub fn check(&self, model: &Model, used: Use) -> Result<()> {
        let other = model.fingerprint();
        let in_response = used == Use::Response;
        let wave_counts = matches!(used, Use::Response | Use::Mode { on_wave: true });
        let parts = [
            ("degrees of freedom", self.degrees != other.degrees),
            ("matrices", self.matrices != other.matrices),
            ("speed", self.speed != other.speed),
            ("damping", self.damping != other.damping && used != Use::Synthesis),
            ("springs", self.springs != other.springs),
            ("contacts", self.contacts != other.contacts),
            ("constant forces", self.constant_forces != other.constant_forces),
            ("forces", self.vibrating_forces != other.vibrating_forces && in_response),
            ("wave", self.engine_order != other.engine_order && wave_counts),
        ];
        let Some((part, _)) = parts.iter().find(|(_, differs)| *differs) else {
            return Ok(());
        };
        fail!(
            Argument,
            "the model has other {part} than when the branch was solved; give that model, or solve again"
        )
    }
}

/// Digest of the bytes that `write` writes.
fn digest(write: impl FnOnce(&mut ByteWriter<'_>)) -> u64 {
    let mut out = ByteWriter::digesting();
    write(&mut out);
    out.digest()
}

/// The fingerprint of the model.
pub(crate) fn fingerprint(model: &Model) -> Fingerprint {
    let structure = &model.structure;
    let forces = |constant: bool| {
        let all = model.excitation.forces().iter();
        all.filter(|force| (force.harmonic == 0) == constant)
            .map(|force| {
                digest(|out| {
                    out.count(force.dof);
                    out.count(force.harmonic);
                    out.f64(force.value.re);
                    out.f64(force.value.im);
                    out.bool(force.per_omega2);
                    if force.per_speed2 != 0.0 {
                        out.f64(force.per_speed2);
                    }
                })
            })
            // In any order.
            .fold(0, u64::wrapping_add)
    };
    let springs = model.springs.iter().map(|spring| {
        digest(|out| {
            out.optional(spring.dof_a);
            out.optional(spring.dof_b);
            out.i64(spring.sector_offset);
            out.f64(spring.stiffness);
        })
    });
    Fingerprint {
        degrees: digest(|out| {
            out.count(structure.degrees.given());
            out.count(structure.sectors);
            save_degrees(&structure.degrees, out);
        }),
        matrices: digest(|out| {
            let kinds = [
                MatrixKind::Mass,
                MatrixKind::Stiffness,
                MatrixKind::Gyroscopic,
                MatrixKind::StiffnessSpeed2,
            ];
            blocks_to(model, &kinds, out);
        }),
        speed: digest(|out| {
            let (per_omega, speed) = match structure.speed {
                Speed::Fixed(speed) => (false, speed),
                Speed::PerOmega(p) => (true, p),
            };
            out.bool(per_omega);
            out.f64(speed);
        }),
        damping: digest(|out| {
            for value in [structure.rayleigh.0, structure.rayleigh.1, structure.loss_factor] {
                out.f64(value);
            }
            damping_matrices_to(model, out);
        }),
        springs: springs.fold(0, u64::wrapping_add),
        contacts: digest(|out| {
            for contact in &model.contacts {
                digest_to(contact, out);
                for place in contact.slider() {
                    out.f64(place);
                }
            }
            for load in &model.speed_loads {
                out.count(load.contact);
                out.f64(load.per_speed2);
            }
        }),
        constant_forces: forces(true),
        vibrating_forces: forces(false),
        engine_order: structure.engine_order,
    }
}

/// Writes matrices of some kinds.
fn blocks_to(model: &Model, kinds: &[MatrixKind], out: &mut ByteWriter<'_>) {
    for kind in kinds {
        let blocks = &model.structure.blocks[*kind as usize];
        // A matrix of zeros is as good as none; no coupling to the previous sector stands for the transpose.
        for block in [&blocks.own, &blocks.next] {
            saved_matrix::save(block.as_ref().filter(|a| a.stored() > 0), out);
        }
        saved_matrix::save(blocks.previous.as_ref(), out);
        saved_matrix::save_list(&blocks.diameters, out);
    }
}

/// Writes every kind of damping that is not a plain number.
fn damping_matrices_to(model: &Model, out: &mut ByteWriter<'_>) {
    blocks_to(model, &[MatrixKind::Damping, MatrixKind::Structural], out);
    saved_matrix::save_list(&model.structure.modal_damping, out);
    model.save_aero(out);
}

/// The digest of a sector, for the wheel that is made of it.
pub(crate) fn sector_digest(model: &Model) -> SectorDigest {
    let all = model.fingerprint();
    SectorDigest {
        degrees: all.degrees,
        matrices: all.matrices,
        damping: digest(|out| damping_matrices_to(model, out)),
        springs: all.springs,
        engine_order: all.engine_order,
    }
}

/// Refuses a sector other than the one of which this wheel was made.
pub(crate) fn check_sector(model: &Model, sector: &Model, used: SectorUse) -> Result<()> {
    let Some(own) = &model.structure.sector else {
        return Ok(());
    };
    own.check(&sector.sector_digest(), used)?;
    let numbers = |model: &Model| (model.structure.rayleigh, model.structure.loss_factor);
    if used != SectorUse::Pattern && numbers(model) != numbers(sector) {
        let ((alpha, beta), loss) = numbers(model);
        let ((of_sector, beta_of_sector), loss_of_sector) = numbers(sector);
        return fail!(
            Argument,
            "the sector has Rayleigh damping {of_sector}, {beta_of_sector} and the loss factor {loss_of_sector}, the wheel {alpha}, \
             {beta} and {loss}; needs the same"
        );
    }
    Ok(())
}

/// Writes the data of a contact that affect results; for a law of the caller those that its program supplies.
fn digest_to(contact: &Contact, out: &mut ByteWriter<'_>) {
    contact.kind.digest_to(out);
    saved_contact::places_to(contact, out);
    if contact.rigid.is_some() {
        saved_contact::rigid_to(contact, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::sparse_storage::matrix_view::MatrixView;
    use num_complex::Complex64;

    fn model() -> Model {
        let mut model = Model::new(2).unwrap();
        for (kind, a) in [
            (MatrixKind::Mass, [1.0, 0.0, 0.0, 2.0]),
            (MatrixKind::Stiffness, [3.0, -1.0, -1.0, 2.0]),
        ] {
            model.set_matrix(kind, &MatrixView::dense(2, &a)).unwrap();
        }
        model.set_rayleigh(0.0, 0.01).unwrap();
        model.add_contact(&Contact::jenkins(0, None, 1.0, 0.3, 2.0)).unwrap();
        model.add_force(1, 1, Complex64::new(0.5, 0.1)).unwrap();
        model.add_force(0, 0, Complex64::new(0.2, 0.0)).unwrap();
        model
    }

    #[test]
    fn contents_count_and_not_how_they_came_to_be() {
        let made = model().fingerprint();
        assert_eq!(made, Model::load(&model().save().unwrap()).unwrap().fingerprint());
        assert_eq!(made, model().try_clone().unwrap().fingerprint());
        let mut changed = model();
        changed.set_preload(0, 5.0).unwrap();
        changed.clear_forces();
        assert_ne!(made, changed.fingerprint());
        changed.set_preload(0, 2.0).unwrap();
        // In another order.
        changed.add_force(0, 0, Complex64::new(0.2, 0.0)).unwrap();
        changed.add_force(1, 1, Complex64::new(0.5, 0.1)).unwrap();
        assert_eq!(made, changed.fingerprint());
        let zeros = MatrixView::dense(2, &[0.0; 4]);
        changed.set_matrix(MatrixKind::Damping, &zeros).unwrap();
        assert_eq!(made, changed.fingerprint());
    }

    type Change = fn(&mut Model);

    #[test]
    fn the_part_that_differs_is_named_where_it_counts() {
        let made = model().fingerprint();
        let uses = [
            Use::Response,
            Use::Mode { on_wave: true },
            Use::Mode { on_wave: false },
            Use::Synthesis,
        ];
        let cases: [(Change, &str, [bool; 4]); 7] = [
            (|m| m.set_preload(0, 3.0).unwrap(), "contacts", [true; 4]),
            (
                |m| m.set_rayleigh(0.0, 0.02).unwrap(),
                "damping",
                [true, true, true, false],
            ),
            (|m| m.set_speed(Speed::Fixed(2.0)).unwrap(), "speed", [true; 4]),
            (|m| m.set_wave(2), "wave", [true, true, false, false]),
            (
                |m| m.add_force(1, 1, Complex64::ONE).unwrap(),
                "forces",
                [true, false, false, false],
            ),
            (
                |m| m.add_force(1, 0, Complex64::ONE).unwrap(),
                "constant forces",
                [true; 4],
            ),
            (
                |m| {
                    let a = [3.0, -1.0, -1.0, 2.5];
                    m.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(2, &a)).unwrap();
                },
                "matrices",
                [true; 4],
            ),
        ];
        for (change, part, refused) in cases {
            let mut other = model();
            change(&mut other);
            for (used, refused) in uses.into_iter().zip(refused) {
                let checked = made.check(&other, used);
                assert_eq!(checked.is_err(), refused, "{part} {used:?}");
                if let Err(e) = checked {
                    assert!(e.to_string().contains(&format!("other {part} than")), "{e}");
                }
            }
        }
    }
}
