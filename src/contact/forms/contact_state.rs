//! The state of a contact at one time of a motion: stick, slip or open.

/// State of a contact at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It sticks, or presses. Laws without states (springs but the unilateral one, regularised friction,
    /// laws of the caller) and contacts that are linear at any motion are always in this state.
    Stick,
    /// It slips: the force is at the slip limit.
    Slip,
    /// It is open: without force.
    Open,
}
