//! A nonlinear mode over a range of amplitude: its frequency and damping from contacts that stick to contacts that
//! slide.

use crate::analysis::modes::mode_branches::with_branches;
use crate::analysis::modes::mode_curve::alone;
use crate::error::Result;
use crate::hooks::Hooks;
use crate::model::Model;
use crate::options::{ModeOptions, SolverOptions};
use crate::results::Branch;

/// Follows a nonlinear mode of `model` from `range.log10_start` to `range.log10_stop`.
///
/// The mode vibrates about the static state under the constant forces of the model and the preload of its contacts;
/// vibrating forces have no effect. A branch that ends early is returned with a positive [`Branch::status`]
/// and every point found. Its peaks are the points of largest damping ratio, its folds those where the amplitude
/// turns.
///
/// # Errors
/// Bad options and models ([`SolverOptions::check`], [`ModeOptions::check`], [`Model::select_mode`]), `Argument` for
/// a mode that moves no contact and for a reference degree of freedom at a node of the mode, `NoConvergence` if no
/// static state or no first point was found.
///
/// # Example
/// The frequency falls from √2, where the contact of the mass sticks, to 1, where it slides.
///
/// ```
/// # use hbvib::{Contact, MatrixKind, MatrixView, Model};
/// use hbvib::{Hooks, ModeOptions, SolverOptions, nonlinear_mode};
///
/// # let mut model = Model::new(1)?;
/// # model.set_matrix(MatrixKind::Mass, &MatrixView::dense(1, &[1.0]))?;
/// # model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(1, &[1.0]))?;
/// # model.set_rayleigh(0.0, 0.02)?;
/// # model.add_contact(&Contact::jenkins(0, None, 1.0, 0.3, 1.0))?;
/// # model.add_force(0, 1, 0.2.into())?;
/// let range = ModeOptions { log10_start: -2.0, log10_stop: 1.0, ..ModeOptions::default() };
/// let mode = nonlinear_mode(&model, &SolverOptions::default(), &range, &mut Hooks::default())?;
/// let (first, last) = (mode.omega()[0], mode.omega()[mode.points() - 1]);
/// assert!((first - 2f64.sqrt()).abs() < 1e-6 && last < 1.01);
/// # Ok::<(), hbvib::Error>(())
/// ```
pub fn nonlinear_mode(
    model: &Model,
    solver: &SolverOptions,
    range: &ModeOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    if range.branches == 0 {
        alone(model, solver, range, None, hooks)
    } else {
        with_branches(model, solver, range, hooks)
    }
}
