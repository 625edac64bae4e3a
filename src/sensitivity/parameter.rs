//! Parameters of a model: the quantities by which results are differentiated.

use crate::contact::forms::constants::Constant;
use crate::error::{Result, fail};
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::model::matrices::structure::MatrixKind;

/// A parameter of a model.
#[derive(Clone, Copy, Debug)]
pub enum Parameter<'a> {
    /// A factor on all forces, whose present value is 1.
    Force,
    /// A constant of a contact.
    Contact {
        /// The constant of the contact.
        constant: Constant,
        /// Index of the contact; `None`: the constant of all contacts that have it, changed together.
        contact: Option<usize>,
    },
    /// The coefficient, with present value 0, of a matrix that is added to the mass, damping or stiffness matrix; in
    /// a cyclic model to the sector's own block.
    Direction {
        /// Matrix that is changed: mass, damping or stiffness.
        which: MatrixKind,
        /// The added matrix, over the caller's degrees of freedom.
        direction: MatrixView<'a>,
    },
    /// A factor, with present value 1, on the whole mass, damping or stiffness matrix with its couplings. The factor
    /// of the damping acts on Rayleigh and modal damping as well. With a direction E of the same matrix A in one list the values
    /// make sA + dE, in any order of the list.
    Factor {
        /// Matrix that is changed: mass, damping or stiffness.
        which: MatrixKind,
    },
    /// The fixed speed of rotation Ω.
    Speed,
}

/// Reason why a derivative is NaN.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// No reason: the derivative exists.
    Exists,
    /// A contact is at the onset of slip: the derivatives on the two sides differ.
    OnsetOfSlip {
        /// Index of the contact.
        contact: usize,
    },
    /// The constant is zero, and the force depends on it for positive values only.
    ZeroConstant,
    /// The point is a fold, where the result changes infinitely fast.
    Fold,
}

impl Parameter<'_> {
    /// Refuses a parameter that the model does not have.
    ///
    /// # Errors
    /// `Index` for an unknown contact; `Unsupported` for a constant that the law of a contact does not have, or whose
    /// derivative it does not give; for mass or stiffness under modal damping, whose modes depend on them; for a speed
    /// that is tied to the frequency; for other matrices than mass, damping and stiffness.
    pub fn check(&self, model: &Model) -> Result<()> {
        match self {
            Self::Force => Ok(()),
            Self::Contact { constant, contact } => check_contact(model, *constant, *contact),
            Self::Direction { which, .. } | Self::Factor { which } => check_matrix(model, *which),
            Self::Speed => match model.speed() {
                Speed::Fixed(_) => Ok(()),
                Speed::PerOmega(_) => fail!(
                    Unsupported,
                    "speed: it is tied to the frequency of the response, so that it is no parameter of its own"
                ),
            },
        }
    }
}

fn check_contact(model: &Model, constant: Constant, contact: Option<usize>) -> Result<()> {
    let contacts = model.contacts();
    let name = constant.name();
    let Some(id) = contact else {
        if contacts.iter().any(|c| c.by_constant(constant).is_some()) {
            return Ok(());
        }
        return fail!(Unsupported, "{name}: no contact of the model has this constant");
    };
    let Some(contact) = contacts.get(id) else {
        return fail!(
            Index,
            "{name} of contact {id}, but the model has {} contacts",
            contacts.len()
        );
    };
    if contact.by_constant(constant).is_some() {
        return Ok(());
    }
    if contact.kind.user().is_some() {
        return fail!(
            Unsupported,
            "{name} of contact {id}: a law of the caller does not give the derivative of its force by constants"
        );
    }
    fail!(
        Unsupported,
        "{name} of contact {id}, but that is a {}, which has none",
        contact.law_name()
    )
}

fn check_matrix(model: &Model, which: MatrixKind) -> Result<()> {
    match which {
        MatrixKind::Mass | MatrixKind::Stiffness if model.structure().has_modal_damping() => fail!(
            Unsupported,
            "{}: the modal damping depends on the modes, which it changes",
            which.name()
        ),
        MatrixKind::Mass | MatrixKind::Damping | MatrixKind::Stiffness => Ok(()),
        MatrixKind::Structural | MatrixKind::Gyroscopic | MatrixKind::StiffnessSpeed2 => fail!(
            Unsupported,
            "the {} matrix is no parameter: needs mass, damping or stiffness",
            which.name()
        ),
    }
}
