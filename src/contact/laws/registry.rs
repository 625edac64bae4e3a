//! The registry of contact laws: the kinds of contacts, and the only `match` on them.
//!
//! A law is one file: a new one is its file, its lines in this file, its constants in the C interface and its test.

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::contact::constants::Constants;
use crate::contact::law::ContactLaw;
use crate::contact::laws::cubic::CubicContact;
use crate::contact::laws::friction_2d::Friction2dContact;
use crate::contact::laws::friction_3d::Friction3dContact;
use crate::contact::laws::jenkins::JenkinsContact;
use crate::contact::laws::polynomial::Polynomial;
use crate::contact::laws::regularised::RegularisedContact;
use crate::contact::laws::table::Table;
use crate::contact::laws::unilateral::UnilateralContact;
use crate::contact::laws::user_law::User;
use crate::error::{Result, fail};

/// The kind of a contact: its law.
#[derive(Clone, Debug)]
pub enum ContactKind {
    /// Elastic Coulomb friction with constant normal load in one direction.
    Jenkins,
    /// Spring with a cubic term: f = kt·y + cubic·y³.
    Cubic,
    /// Spring that is pressed once a gap has closed, and open otherwise.
    Unilateral,
    /// Elastic Coulomb friction in one tangential direction, t1, under a normal load along n that varies
    /// and may vanish.
    Friction2d,
    /// Elastic Coulomb friction in the plane of t1 and t2, whose force turns with the slip, under a
    /// normal load along n that varies and may vanish; without a degree of freedom along n the load is
    /// constant.
    Friction3d,
    /// Friction with Coulomb's jump smoothed: f = μN₀·tanh(v/velocity).
    Regularised,
    /// Spring whose force is straight between the points of a table.
    Table(Table),
    /// Springs and dampers of polynomial form over one or several motions.
    Polynomial(Polynomial),
    /// A law of the caller.
    User(User),
}

impl ContactKind {
    /// Answer of the law with the given constants to a question.
    pub(crate) fn with_law<R>(&self, constants: &Constants, question: impl FnOnce(&dyn ContactLaw) -> R) -> R {
        match self {
            Self::Jenkins => question(&JenkinsContact::new(constants)),
            Self::Cubic => question(&CubicContact::new(constants)),
            Self::Unilateral => question(&UnilateralContact::new(constants)),
            Self::Friction2d => question(&Friction2dContact::new(constants)),
            Self::Friction3d => question(&Friction3dContact::new(constants)),
            Self::Regularised => question(&RegularisedContact::new(constants)),
            Self::Table(law) => question(law),
            Self::Polynomial(law) => question(law),
            Self::User(law) => question(law),
        }
    }

    /// Writes the kind.
    ///
    /// # Errors
    /// `Unsupported` for a law of the caller.
    pub(crate) fn save_to(&self, out: &mut ByteWriter<'_>) -> Result<()> {
        match self {
            Self::Jenkins => out.u8(0),
            Self::Cubic => out.u8(1),
            Self::Unilateral => out.u8(2),
            Self::Friction2d => out.u8(3),
            Self::Friction3d => out.u8(4),
            Self::Regularised => out.u8(5),
            Self::Table(law) => {
                out.u8(6);
                law.save_to(out);
            }
            Self::Polynomial(law) => {
                out.u8(7);
                law.save_to(out);
            }
            Self::User(_) => {
                return fail!(
                    Unsupported,
                    "a force of the caller is a function of its program, which cannot be saved"
                );
            }
        }
        Ok(())
    }

    /// Writes the kind into a digest; a law of the caller by what it tells of itself.
    pub(crate) fn digest_to(&self, out: &mut ByteWriter<'_>) {
        if let Self::User(law) = self {
            out.u8(8);
            law.digest_to(out);
        } else {
            // Only a law of the caller cannot be saved.
            let _saved = self.save_to(out);
        }
    }

    /// The law of the caller, if it is one.
    #[must_use]
    pub fn user(&self) -> Option<&User> {
        match self {
            Self::User(law) => Some(law),
            _ => None,
        }
    }
}

/// Reads a kind.
///
/// # Errors
/// `Argument` for bytes that are none; `OutOfMemory`.
pub(crate) fn load_kind(input: &mut ByteReader<'_>) -> Result<ContactKind> {
    Ok(match input.u8()? {
        0 => ContactKind::Jenkins,
        1 => ContactKind::Cubic,
        2 => ContactKind::Unilateral,
        3 => ContactKind::Friction2d,
        4 => ContactKind::Friction3d,
        5 => ContactKind::Regularised,
        6 => ContactKind::Table(Table::load_from(input)?),
        7 => ContactKind::Polynomial(Polynomial::load_from(input)?),
        _ => return Err(input.damaged("a law is unknown")),
    })
}
