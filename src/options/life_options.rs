//! Options of a life with wear.

/// A contact that wears: its worn depth grows per cycle by h′ = αE/A with the work E of a cycle.
#[derive(Clone, Copy, Debug)]
pub struct Wear {
    /// Index of the contact, whose law must have a normal load.
    pub contact: usize,
    /// Wear rate α: worn volume per work.
    pub rate: f64,
    /// Area A of the contact.
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
        /// First angular frequency of the range.
        omega_start: f64,
        /// Last angular frequency of the range.
        omega_stop: f64,
    },
}

/// Options of a life under wear.
#[derive(Clone, Copy, Debug)]
pub struct LifeOptions<'a> {
    /// Contacts that wear, with their rates.
    pub wear: &'a [Wear],
    /// Static stiffness S between the normals of these contacts, n × n, symmetric: their loads are N = N₀ − S h.
    /// Empty: the normal stiffness of each contact alone, which its law must then have.
    pub stiffness: &'a [f64],
    /// Vibration that wears the contacts.
    pub follow: LifeFollow<'a>,
    /// Numbers of cycles at which the state is requested, in ascending order; the last one is the end of the life.
    pub cycles: &'a [f64],
    /// Worn depths at the beginning, one for each contact; empty: 0.
    pub worn: &'a [f64],
    /// Allowed error of the loads, relative to the largest load of a contact at the beginning, and relative error of
    /// the amplitude.
    pub tolerance: f64,
    /// Amplitude whose crossing is reported as an event; 0: none.
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
