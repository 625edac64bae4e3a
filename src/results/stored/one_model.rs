//! The model of a branch: noted when it is solved, and compared with the one that a later call is given.

use crate::error::{Result, fail};
use crate::model::Model;
use crate::model::saved::fingerprint::Use;
use crate::results::Branch;
use crate::results::stored::origin::Origin;

impl Branch {
    /// Notes the model of the branch; `on_wave`: the branch has the wave of the model.
    pub(crate) fn set_origin(&mut self, model: &Model, on_wave: bool) {
        self.family.origin = Some(Origin {
            model: model.fingerprint(),
            on_wave,
        });
    }

    /// Refuses another model than that of the branch, for use with one of its points.
    ///
    /// # Errors
    /// `Argument`, naming what differs; a branch over a parameter.
    pub(crate) fn check_model(&self, model: &Model) -> Result<()> {
        self.check_one_model()?;
        self.check_size(model)?;
        let on_wave = self.family.origin.is_none_or(|origin| origin.on_wave);
        self.check_origin(
            model,
            if self.mode_data().is_some() {
                Use::Mode { on_wave }
            } else {
                Use::Response
            },
        )
    }

    /// Refuses another model than that of the branch, for a synthesis, which may have other vibrating forces and
    /// damping.
    pub(crate) fn check_model_of_synthesis(&self, model: &Model) -> Result<()> {
        self.check_origin(model, Use::Synthesis)
    }

    fn check_origin(&self, model: &Model, used: Use) -> Result<()> {
        match &self.family.origin {
            Some(origin) => origin.model.check(model, used),
            None => Ok(()),
        }
    }

    fn check_size(&self, model: &Model) -> Result<()> {
        let (ours, theirs) = (model.structure().sectors(), self.reduction().sectors);
        if model.ndof() != self.ndof() || model.contacts().len() != self.contacts() || ours != theirs {
            return fail!(
                Argument,
                "the branch has {} degrees of freedom, {theirs} sectors and {} contacts, the model {}, {ours} and {}: it is another one",
                self.ndof(),
                self.contacts(),
                model.ndof(),
                model.contacts().len()
            );
        }
        Ok(())
    }
}
