//! The linear mode from which a nonlinear one starts: its selection, its phase and its amplitude.

use crate::analysis::linear::static_solution::{NEEDS_SPEED, static_state};
use crate::condense::Condensed;
use crate::error::{Result, fail, try_copy};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::matrices::spring::along;
use crate::model::natural_modes::linear_modes::ContactState;
use crate::model::natural_modes::mode_selection::SelectedMode;
use crate::options::Range;
use crate::options::{Amplitude, ModeOptions, SolverOptions};
use crate::problem::epmc::{Gauge, LinearMode};
use crate::results::stored::mode_branch::{ModeData, ModeInfo};

/// Motion that counts as zero, relative to the largest of the mode.
/// Kind: rounding.
const NODE: f64 = 1e-9;

/// The linear mode from which the nonlinear one starts, and how it was selected.
pub(crate) struct ModeStart {
    pub linear: LinearMode,
    pub gauge: Gauge,
    chosen: SelectedMode,
}

impl ModeStart {
    /// The linear mode that the options select, about the static state.
    pub fn new(
        model: &Model,
        solver: &SolverOptions,
        range: &ModeOptions<'_>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let rest = static_state(model, solver, NEEDS_SPEED, interrupt)?;
        // Natural modes are those of a potential; the damped mode has the other forces of laws of the caller, too.
        let symmetric = rest.tangents.symmetric()?;
        let [natural, contacts] = [&symmetric, &rest.tangents].map(|tangents| {
            if rest.is_loaded() {
                ContactState::AboutStatic(tangents)
            } else {
                ContactState::Stuck
            }
        });
        let chosen = model.select_mode_with(range.choice, natural, interrupt)?;
        let damped = model.damped_mode_with(&chosen, contacts, range.damping_form, interrupt)?;
        let mut linear = LinearMode {
            omega: damped.omega,
            damping: damped.damping,
            shape: damped.shape,
            rest,
        };
        let gauge = gauge(model, range, &mut linear)?;
        Ok(Self { linear, gauge, chosen })
    }

    /// Whether several linear modes share its frequency.
    pub fn is_repeated(&self) -> bool {
        self.chosen.multiplicity > 1
    }

    /// Refuses a mode that moves no contact.
    pub fn check_motion(&self, condensed: &Condensed) -> Result<()> {
        let i = condensed.set().fundamental();
        let shape = &self.linear.shape;
        let moved = condensed.blocks()[i]
            .motions
            .rows
            .iter()
            .map(|row| row.along(shape).norm());
        let motion = moved.fold(0.0, f64::max);
        let largest = shape.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
        if condensed.coordinates() == 0 || motion <= NODE * largest {
            return fail!(
                Argument,
                "mode {} (angular frequency {}) moves no contact that can slip: largest relative motion {motion} of {largest}; it is linear",
                self.chosen.index,
                self.chosen.omega
            );
        }
        Ok(())
    }

    /// The data of the mode for its branch. Like all parts of a run it is a function of its own, so that they use a
    /// small stack one after the other.
    #[inline(never)]
    pub fn data(&self, model: &Model, range: &ModeOptions<'_>, linear_up_to: f64) -> Result<ModeData> {
        const CONTEXT: &str = "the nonlinear mode";
        let info = ModeInfo {
            index: self.chosen.index,
            omega: self.chosen.omega,
            multiplicity: self.chosen.multiplicity,
            multiple: self.chosen.multiple,
            reference_dof: model.structure().degrees().origin(self.gauge.reference_dof),
            engine_order: model.structure().engine_order(),
            amplitude: range.amplitude,
            linear_up_to,
            slip_from: f64::INFINITY,
            lift_off_from: f64::INFINITY,
            stuck: try_copy(&self.chosen.stuck, CONTEXT)?,
            free: try_copy(&self.chosen.free, CONTEXT)?,
        };
        let ends = Range::new(range.log10_start, range.log10_stop);
        Ok(ModeData::new(info, self.linear.clone(), self.gauge.clone(), ends))
    }
}

/// Selects the degree of freedom of the phase and scales the linear mode to amplitude 1.
fn gauge(model: &Model, range: &ModeOptions<'_>, linear: &mut LinearMode) -> Result<Gauge> {
    let shape = &mut linear.shape;
    let mut most = 0;
    for (dof, z) in shape.iter().enumerate() {
        // Among degrees of freedom that move alike, up to round-off, the first is selected.
        if z.norm() > (1.0 + 1e-9) * shape[most].norm() {
            most = dof;
        }
    }
    let largest = shape[most].norm();
    let degrees = model.structure().degrees();
    let reference_dof = match range.reference_dof {
        None => most,
        Some(dof) => match degrees.number(dof) {
            Some(number) => number,
            None if degrees.is_fixed(dof) => return fail!(Argument, "reference_dof = {dof} is fixed: it has no phase"),
            None => {
                return fail!(
                    Argument,
                    "reference_dof = {dof} lies on the right face: name its image on the left one"
                );
            }
        },
    };
    if shape[reference_dof].norm() <= NODE * largest {
        return fail!(
            Argument,
            "reference_dof = {} is a node of the mode: it moves {} where dof {} moves {largest}",
            degrees.origin(reference_dof),
            shape[reference_dof].norm(),
            degrees.origin(most)
        );
    }
    let contact = match range.amplitude {
        Amplitude::Modal => None,
        Amplitude::Contact(id) => {
            let contact = &model.contacts()[id];
            let row = model.structure().contact_row(contact, 0, 1);
            let motion = along(&row, shape).norm();
            if motion <= NODE * largest {
                return fail!(
                    Argument,
                    "amplitude_contact = {id}: the mode does not move this contact: relative motion {motion} of {largest}"
                );
            }
            for z in shape.iter_mut() {
                *z /= motion;
            }
            Some(row)
        }
    };
    Ok(Gauge { contact, reference_dof })
}
