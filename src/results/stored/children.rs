//! Branches that branch off from a branch, and curves without connection to it.

use crate::error::{Result, Status, try_push};
use crate::results::{Branch, Descent, Searched};

impl Branch {
    /// Extent of the search for solutions beside this response; `None` where none were requested.
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

    /// The children of this branch, writable.
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

    /// Origin of a branch that was found beside another one; `None` for a requested branch.
    #[must_use]
    pub fn descent(&self) -> Option<Descent> {
        self.family.descent
    }

    /// Number of periods of the parent in one period of this branch.
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
