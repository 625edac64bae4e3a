//! Branches with their children in the table of handles: children belong to their parent.

use crate::capi::crossing::handles::{Kept, KeptBranch, free_all, insert, read};
use crate::error::{Result, try_push};
use crate::results::Branch;

type Opaque = <KeptBranch as Kept>::Opaque;

/// Puts a branch and its children into the table.
pub(crate) fn insert_tree(mut branch: Branch, requested: usize, is_child: bool) -> Result<*mut Opaque> {
    let mut children = Vec::new();
    let inserted = branch.take_children().into_iter().try_for_each(|child| {
        let handle = insert_tree(child, requested, true)?;
        try_push(&mut children, handle.addr(), "the children of a branch")
    });
    let inserted = inserted.and_then(|()| {
        let mut all = Vec::new();
        for child in &children {
            try_push(&mut all, *child, "the children of a branch")?;
        }
        insert(KeptBranch {
            branch,
            requested,
            children: all,
            is_child,
        })
    });
    if inserted.is_err() {
        // Nobody knows their handles.
        for child in children {
            let _ = free_tree(core::ptr::without_provenance_mut(child));
        }
    }
    inserted
}

/// Frees a branch with its children; nothing is freed while one of them is in use.
pub(crate) fn free_tree(branch: *mut Opaque) -> Result<()> {
    let mut all = Vec::new();
    try_push(&mut all, branch.addr(), KeptBranch::NAME)?;
    let mut next = 0;
    while let Some(handle) = all.get(next) {
        let kept = read::<KeptBranch>(core::ptr::without_provenance(*handle), 1)?;
        for child in &kept.children {
            try_push(&mut all, *child, KeptBranch::NAME)?;
        }
        next += 1;
    }
    free_all::<KeptBranch>(&all, 1)
}
