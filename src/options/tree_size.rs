//! Size of the tree of branches beside one that was asked for.

use crate::error::{Result, fail};

/// Generations and branches where an option is 0, and their largest numbers.
/// Kind: fixed.
const DEPTH: usize = 3;
const MOST_BRANCHES: usize = 32;
/// Largest numbers of generations and branches.
/// Kind: cap.
const TREE_SIZE_LARGEST: (usize, usize) = (8, 10_000);

/// Largest numbers of generations and of branches, with defaults in place of zeros.
pub(crate) fn size_of_tree(depth: usize, most: usize) -> (usize, usize) {
    let value = |given: usize, default| if given == 0 { default } else { given };
    (value(depth, DEPTH), value(most, MOST_BRANCHES))
}

/// Refuses a tree that is too large, and a size for one that is not sought: `largest` is the largest value of the
/// option `branches`.
///
/// # Errors
/// `Argument`, naming the field, its value and its range.
pub(super) fn check_tree(branches: usize, largest: usize, depth: usize, most: usize) -> Result<()> {
    if branches > largest {
        return fail!(Argument, "branches = {branches}, needs 0 .. {largest}");
    }
    for (name, value, largest) in [
        ("branch_depth", depth, TREE_SIZE_LARGEST.0),
        ("most_branches", most, TREE_SIZE_LARGEST.1),
    ] {
        if value > largest {
            return fail!(Argument, "{name} = {value}, needs 0 (automatic) .. {largest}");
        }
        if value > 0 && branches == 0 {
            return fail!(
                Argument,
                "{name} = {value} with branches = 0, needs 0: no branches are sought; or branches of 1 and more"
            );
        }
    }
    Ok(())
}
