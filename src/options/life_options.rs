//! Options of a life with wear.

/// A contact that wears: its worn depth grows per cycle by h′ = αE/A with the work E of a cycle.
#[derive(Clone, Copy, Debug)]
pub struct Wear {
    /// Number of the contact, whose law has a normal load.
    pub contact: usize,
    /// α: worn volume per work.
    pub rate: f64,
    /// A: area of the contact.
    pub area: f64,
}

/// A steady state in which a machine spends a share of its time.
#[derive(Clone, Copy, Debug)]
pub struct Duty {
    /// Angular frequency of the forces, rad per time unit.
    pub omega: f64,
    /// Factor on the forces.
    pub force: f64,
    /// Share of the time; shares are relative to their sum.
    pub share: f64,
}

/// State of vibration that wears the contacts.
#[derive(Clone, Copy, Debug)]
pub enum LifeFollow<'a> {
    /// Steady states of given frequencies and forces, one after the other so often that wear between them is small.
    Duties(&'a [Duty]),
    /// The peak of the response, the highest one within the range of angular frequency at the beginning; it is followed as the contacts
    /// wear.
    Peak {
        /// First angular frequency.
        omega_start: f64,
        /// Last angular frequency.
        omega_stop: f64,
    },
}

/// Options of a life.
#[derive(Clone, Copy, Debug)]
pub struct LifeOptions<'a> {
    /// Contacts that wear.
    pub wear: &'a [Wear],
    /// Static stiffness S between the normals of these contacts, n × n, symmetric: their loads are N = N₀ − S h. Empty: the normal
    /// stiffness of each contact by itself, which its law then has.
    pub stiffness: &'a [f64],
    /// Vibration.
    pub follow: LifeFollow<'a>,
    /// Cycles at which the state is wanted, in ascending order; the last is the end of the life.
    pub cycles: &'a [f64],
    /// Depths worn at the beginning; empty: none.
    pub worn: &'a [f64],
    /// Error that is allowed, of the loads relative to the largest load of a contact at the beginning, and of the amplitude.
    pub tolerance: f64,
    /// Amplitude whose crossing is told; 0: none.
    pub limit: f64,
    /// Largest number of steps.
    pub most_steps: usize,
}

/// Default tolerance of a life. Chosen: a hundredth of what wear rates are known to.
/// Kind: fixed.
pub const LIFE_TOLERANCE: f64 = 1e-4;

/// Default of the largest number of steps of a life.
/// Kind: cap.
pub const LIFE_MOST_STEPS: usize = 10_000;

/// Largest number of contacts that wear: the integrator factorises matrices of that order.
/// Kind: cap.
pub const MOST_WORN: usize = 2_000;

impl Default for LifeOptions<'_> {
    fn default() -> Self {
        Self {
            wear: &[],
            stiffness: &[],
            follow: LifeFollow::Duties(&[]),
            cycles: &[],
            worn: &[],
            tolerance: LIFE_TOLERANCE,
            limit: 0.0,
            most_steps: LIFE_MOST_STEPS,
        }
    }
}
