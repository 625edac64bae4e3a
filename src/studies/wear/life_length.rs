//! Length of the next step of a life: from the error of the last one, and where the motion seems to end.

/// Steps in turn that may be refused.
/// Kind: cap; halves of a life down to the length of a jump are 60.
pub(crate) const LIFE_TRIES: usize = 200;

/// Count of refused steps in a row.
#[derive(Default)]
pub(crate) struct Refusals {
    /// Number of steps taken when the last one was tried.
    taken: usize,
    count: usize,
}

impl Refusals {
    /// Counts a step that is tried after `taken` steps; returns whether too many have been refused since the last one
    /// was taken.
    pub fn are_too_many(&mut self, taken: usize) -> bool {
        self.count = if taken == self.taken { self.count + 1 } else { 0 };
        self.taken = taken;
        self.count > LIFE_TRIES
    }
}

/// State of the question whether the motion ends, or a step was only too long.
#[derive(Clone, Copy)]
pub(crate) enum Doubt {
    /// A step over half of the way is tried.
    Half,
    /// The motion continued over the half: a step over the rest is tried.
    Rest,
    /// The motion ends; halving leads to the position.
    None,
}

impl Doubt {
    /// The state after another broken step.
    pub fn again(self) -> Self {
        match self {
            Self::Half => Self::Half,
            Self::Rest | Self::None => Self::None,
        }
    }

    /// The state after a step with too large an error: no other step goes as far as the one that was tried.
    pub fn too_long(doubt: Option<(f64, Self)>) -> Option<(f64, Self)> {
        doubt.map(|(other, doubt)| match doubt {
            Self::Rest => (other, Self::Half),
            doubt => (other, doubt),
        })
    }

    /// The state of the question about a motion at cycles `other`, after a step to `n`; `None` where the step reached
    /// them.
    pub fn after(self, other: f64, n: f64) -> Option<(f64, Self)> {
        let doubt = match self {
            Self::Half => Self::Rest,
            doubt => doubt,
        };
        (n < other).then_some((other, doubt))
    }
}

/// Length of the next step. The last hundredth of the rest is not left as a step of its own, which rounding would
/// spoil.
pub(crate) fn length_of(delta: f64, rest: f64, is_bounded: bool) -> f64 {
    if is_bounded {
        delta
    } else if delta >= 0.99 * rest {
        rest
    } else {
        delta.min(0.5 * rest).max(0.01 * delta)
    }
}

/// Factor for the length of the next step. It follows from the error over the tolerance (`share`), and from the ratio
/// of this length to the one before with the error there: the constant of the error continues to change as it did
/// (Gustafsson 1994, doi:10.1145/198429.198437).
pub(crate) fn growth(share: f64, power: i32, before: Option<(f64, f64)>) -> f64 {
    if share <= 0.0 {
        return 4.0;
    }
    let own = 0.9 * share.powf(-1.0 / f64::from(power));
    before.map_or(own, |(ratio, earlier)| {
        own.min(0.9 * ratio * (earlier / (share * share)).powf(0.2))
    })
}
