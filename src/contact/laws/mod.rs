//! The contact laws, one file each, and their registry: the kinds of contacts, each with the data of its law, and the only
//! `match`es on them.
//!
//! A law is one file; a new one is its file, its lines in this file, its kind in `capi/contacts` and its test.

mod cubic;
pub(crate) mod friction_2d;
pub(crate) mod friction_3d;
pub(crate) mod jenkins;
mod polynomial;
pub(crate) mod regularised;
mod saturated;
mod sliding_mass;
mod table;
pub(crate) mod unilateral;
mod user_law;

pub use cubic::Cubic;
pub use friction_2d::Friction2d;
pub use friction_3d::Friction3d;
pub use jenkins::Jenkins;
pub(crate) use polynomial::HIGHEST_EXPONENT;
pub use polynomial::{Monomial, Polynomial};
pub use regularised::Regularised;
pub use table::Table;
pub use unilateral::Unilateral;
pub use user_law::{Call, States, User, UserForce};

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::contact::forms::constants::LawData;
use crate::contact::forms::law::ContactLaw;
use crate::error::Result;

/// The kind of a contact: its law with its data.
#[derive(Clone, Debug)]
pub enum ContactKind {
    /// Elastic Coulomb friction with constant normal load in one direction.
    Jenkins(Jenkins),
    /// Spring with a cubic term: f = kt·y + cubic·y³.
    Cubic(Cubic),
    /// Spring that is pressed once a gap has closed, and open otherwise.
    Unilateral(Unilateral),
    /// Elastic Coulomb friction in one tangential direction, t1, under a normal load along n that varies
    /// and may vanish.
    Friction2d(Friction2d),
    /// Elastic Coulomb friction in the plane of t1 and t2, whose force turns with the slip, under a
    /// normal load along n that varies and may vanish; without a degree of freedom along n the load is
    /// constant.
    Friction3d(Friction3d),
    /// Friction with Coulomb's jump smoothed: f = μN₀·tanh(v/velocity).
    Regularised(Regularised),
    /// Spring whose force is straight between the points of a table.
    Table(Table),
    /// Springs and dampers of polynomial form over one or several motions.
    Polynomial(Polynomial),
    /// A law of the caller.
    User(User),
}

/// The data of a law, whichever it is.
macro_rules! data_of {
    ($kind:expr) => {
        match $kind {
            ContactKind::Jenkins(law) => law,
            ContactKind::Cubic(law) => law,
            ContactKind::Unilateral(law) => law,
            ContactKind::Friction2d(law) => law,
            ContactKind::Friction3d(law) => law,
            ContactKind::Regularised(law) => law,
            ContactKind::Table(law) => law,
            ContactKind::Polynomial(law) => law,
            ContactKind::User(law) => law,
        }
    };
}

impl ContactKind {
    /// Answer of the law to a question, of a contact that can move along n or not.
    pub(crate) fn ask<R>(&self, has_normal: bool, question: impl FnOnce(&dyn ContactLaw) -> R) -> R {
        match self {
            Self::Jenkins(law) => question(law),
            Self::Cubic(law) => question(law),
            Self::Unilateral(law) => question(law),
            Self::Friction2d(law) => question(law),
            Self::Friction3d(law) => question(&law.on(has_normal)),
            Self::Regularised(law) => question(law),
            Self::Table(law) => question(law),
            Self::Polynomial(law) => question(law),
            Self::User(law) => question(law),
        }
    }

    /// The data of the law.
    pub(crate) fn data(&self) -> &dyn LawData {
        data_of!(self)
    }

    /// The data of the law, to change them.
    pub(crate) fn data_mut(&mut self) -> &mut dyn LawData {
        data_of!(self)
    }

    /// Writes the kind, but not the constants that have names.
    ///
    /// # Errors
    /// `Unsupported` for a law of the caller.
    pub(crate) fn save_to(&self, out: &mut ByteWriter<'_>) -> Result<()> {
        let data = self.data();
        out.u8(data.number());
        data.save_to(out)
    }

    /// The laws whose data are constants with names, all of them 0.
    pub(crate) fn named() -> [Self; 6] {
        [
            Self::Jenkins(Jenkins::default()),
            Self::Cubic(Cubic::default()),
            Self::Unilateral(Unilateral::default()),
            Self::Friction2d(Friction2d::default()),
            Self::Friction3d(Friction3d::default()),
            Self::Regularised(Regularised::default()),
        ]
    }

    /// Reads a kind, whose constants with names are 0.
    ///
    /// # Errors
    /// `Argument` for bytes that are none; `OutOfMemory`.
    pub(crate) fn load_from(input: &mut ByteReader<'_>) -> Result<Self> {
        Ok(match input.u8()? {
            Table::TABLE_NUMBER => Self::Table(Table::load_from(input)?),
            Polynomial::POLYNOMIAL_NUMBER => Self::Polynomial(Polynomial::load_from(input)?),
            number => match Self::named().into_iter().find(|kind| kind.data().number() == number) {
                Some(kind) => kind,
                None => return Err(input.damaged("a law is unknown")),
            },
        })
    }

    /// Writes the kind into a digest; a law of the caller by what it tells of itself.
    pub(crate) fn digest_to(&self, out: &mut ByteWriter<'_>) {
        let data = self.data();
        out.u8(data.number());
        data.digest_to(out);
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
