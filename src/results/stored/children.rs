//! Branches that branch off from a branch, and curves without connection to it.

use crate::error::{Result, Status, try_push};
use crate::results::{Branch, Descent, Searched};

impl Branch {
    /// The solutions that were sought beside this response; `None` where none were asked for.
    #[must_use]
    pub fn searched(&self) -> Option<Searched> {
        self.family.searched
    }

    pub(crate) fn set_searched(&mut self, searched: Searched) {
        self.family.searched = Some(searched);
    }

    /// The branches that branch off from this one, and the detached curves beside it, as far as the option `branches` of
    /// [`crate::options::ForcedOptions`] sought them.
    #[must_use]
    pub fn children(&self) -> &[Self] {
        &self.family.children
    }

    /// The same, writable.
    pub(crate) fn children_mut(&mut self) -> &mut [Self] {
        &mut self.family.children
    }

    /// The children, taken out of the branch.
    pub(crate) fn take_children(&mut self) -> Vec<Self> {
        core::mem::take(&mut self.family.children)
    }

    /// Whether the caller stopped the branch or one of its children.
    pub(crate) fn was_stopped(&self) -> bool {
        self.status() == Status::StoppedByCaller || self.family.children.iter().any(Self::was_stopped)
    }

    /// Where the branch comes from; `None` for one that was asked for.
    #[must_use]
    pub fn descent(&self) -> Option<Descent> {
        self.family.descent
    }

    /// Periods of the parent in one of this branch.
    pub(crate) fn periods(&self) -> usize {
        self.family.descent.map_or(1, |descent| descent.periods)
    }

    pub(crate) fn set_descent(&mut self, descent: Descent) {
        self.family.descent = Some(descent);
    }

    pub(crate) fn push_child(&mut self, child: Self) -> Result<()> {
        try_push(&mut self.family.children, child, "the branches that branch off")
    }
}
