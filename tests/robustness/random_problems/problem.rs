//! Random structures with contacts and forces.

use super::law::{LAWS, Law, Sizes};
use super::random::Random;
use crate::common::models::dense;
use hbvib::Model;
use num_complex::Complex64;
use std::f64::consts::PI;

/// A contact: its law, and degree of freedom of side a and b for each direction.
#[derive(Clone, Debug)]
pub struct AssembledLaw {
    pub law: Law,
    pub sides: Vec<[Option<usize>; 2]>,
}

/// Properties of a problem that are known beforehand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// Every mode is damped.
    Damped,
    /// Without damping, off the resonances, under friction alone: the map y ↦ y_lin − G f(y) is bounded
    /// and has a fixed point (Brouwer).
    FrictionAlone,
    /// Without damping at the resonance of one mass, the force below 4/π times the slip limits.
    BelowCapacity,
    /// The same with a force above: a square wave of height fc carries at most 4 fc/π in its fundamental, so
    /// that there is no periodic solution.
    AboveCapacity,
}

/// A structure of n degrees of freedom with contacts and forces (degree of freedom, harmonic, value).
#[derive(Clone, Debug)]
pub struct Case {
    pub n: usize,
    pub mass: Vec<f64>,
    pub damping: Vec<f64>,
    pub stiffness: Vec<f64>,
    pub contacts: Vec<AssembledLaw>,
    pub forces: Vec<(usize, usize, Complex64)>,
    pub omega: f64,
    pub known: Known,
}

/// Damping ratio, up to 10 %.
fn damping_ratio(random: &mut Random) -> f64 {
    if random.happens(0.5) {
        random.decade(-4.0, -1.0)
    } else {
        random.within(0.001, 0.1)
    }
}

impl Case {
    /// The problem of a number under a seed.
    pub fn random(seed: u64, number: u64) -> Self {
        let mut random = Random::of(seed, number);
        // Units of any size.
        let (stiffness, mass) = (random.decade(0.0, 8.0), random.decade(-3.0, 3.0));
        let force = random.decade(-3.0, 4.0);
        if random.happens(0.05) {
            return Self::at_resonance(stiffness, mass, force, &mut random);
        }
        let n = 1 + random.below(6);
        let m: Vec<f64> = (0..n).map(|_| mass * random.decade(-0.5, 0.5)).collect();
        let mut k = vec![0.0; n * n];
        for i in 0..n {
            k[i * n + i] += stiffness * random.decade(-1.0, 0.0);
            // A chain with some links across.
            for j in 0..i {
                if j + 1 == i || random.happens(0.2) {
                    let link = stiffness * random.decade(-1.0, 0.5);
                    for (row, column, sign) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
                        k[row * n + column] += sign * link;
                    }
                }
            }
        }
        let (natural, shapes) = modes(&m, &k);
        let undamped = random.happens(0.05);
        let mut c = vec![0.0; n * n];
        let mut least = if undamped { 0.0 } else { f64::INFINITY };
        for r in 0..if undamped { 0 } else { n } {
            let ratio = damping_ratio(&mut random);
            least = least.min(ratio);
            for i in 0..n {
                for j in 0..n {
                    c[i * n + j] += 2.0 * ratio * natural[r] * m[i] * shapes[i * n + r] * shapes[j * n + r] * m[j];
                }
            }
        }
        let near = natural[random.below(n)];
        let omega = near * random.decade(0.3_f64.log10(), 3.0_f64.log10());
        let sizes = Sizes {
            stiffness,
            force,
            omega,
            damping_ratio: least,
        };
        let mut contacts = Vec::new();
        for _ in 0..=random.below(4) {
            // Friction in a plane, whose march takes a hundred times as long as the others, comes half as often.
            let number = match random.below(2 * LAWS.len() - 1) {
                _ if undamped => [0, 6][random.below(2)],
                number => number.div_ceil(2).wrapping_add(2) % LAWS.len(),
            };
            contacts.push(place(number, n, sizes, &mut random));
        }
        let mut forces = vec![(random.below(n), 1, force * random.phase())];
        if random.happens(0.4) {
            forces.push((random.below(n), 1, force * random.share() * random.phase()));
        }
        if random.happens(0.1) {
            forces.push((random.below(n), 3, force * random.share() * random.phase()));
        }
        if random.happens(0.1) {
            forces.push((random.below(n), 0, (force * random.within(-1.0, 1.0)).into()));
        }
        Self {
            n,
            mass: diagonal(&m),
            damping: c,
            stiffness: k,
            contacts,
            forces,
            omega,
            known: if undamped { Known::FrictionAlone } else { Known::Damped },
        }
    }

    /// One mass on its spring under Jenkins contacts at the resonance, without damping.
    fn at_resonance(stiffness: f64, mass: f64, force: f64, random: &mut Random) -> Self {
        let mut slip_capacity = 0.0;
        let mut contacts = Vec::new();
        for _ in 0..=random.below(4) {
            let limit = force * random.decade(-1.0, 0.5);
            slip_capacity += 4.0 * limit / PI;
            let kt = stiffness * random.decade(-2.0, 3.0);
            let sides = vec![[Some(0), None]];
            contacts.push(AssembledLaw {
                law: Law::Jenkins { kt, limit },
                sides,
            });
        }
        let bounded = random.happens(0.7);
        let share = if bounded {
            random.within(0.05, 0.95)
        } else {
            random.within(1.05, 3.0)
        };
        // Exactly at the resonance: ω² m = k to the last bit.
        let omega = (stiffness / mass).sqrt();
        Self {
            n: 1,
            mass: vec![mass],
            damping: vec![0.0],
            stiffness: vec![omega * omega * mass],
            contacts,
            forces: vec![(0, 1, share * slip_capacity * random.phase())],
            omega,
            known: if bounded {
                Known::BelowCapacity
            } else {
                Known::AboveCapacity
            },
        }
    }

    /// One mass on a spring with one contact of the law of a number, for sweeps.
    pub fn single(seed: u64, number: u64, law: usize) -> Self {
        let mut random = Random::of(seed, number);
        let ratio = random.decade(-2.5, -1.0);
        let sizes = Sizes {
            stiffness: 1.0,
            force: 1.0,
            omega: 1.0,
            damping_ratio: ratio,
        };
        // Laws along a surface get its directions, each with a mass.
        let n = match law {
            1 => 2,
            2 => 2 + random.below(2),
            _ => 1,
        };
        let law = Law::random(law, sizes, n > 2 || law == 1, &mut random);
        let sides = (0..n).map(|i| [Some(i), None]).collect();
        // The spring across is stiff, so that there is one resonance; the normal one is stiffer.
        let k: Vec<f64> = (0..n).map(|i| [1.0, 30.0, 50.0][i]).collect();
        let c: Vec<f64> = k.iter().map(|k| 2.0 * ratio * k.sqrt()).collect();
        let mut forces = vec![(0, 1, Complex64::ONE)];
        if n > 1 {
            forces.push((n - 1, 1, random.decade(-1.0, 0.5) * random.phase()));
        }
        Self {
            n,
            mass: diagonal(&vec![1.0; n]),
            damping: diagonal(&c),
            stiffness: diagonal(&k),
            contacts: vec![AssembledLaw { law, sides }],
            forces,
            omega: 1.0,
            known: Known::Damped,
        }
    }

    /// A frequency above the resonance of a single mass: beyond 3 times its own, and beyond the backbone of a
    /// hardening spring, ω² = k + ¾·k3·a², at the amplitude a = F/(cω) that the damping allows.
    pub fn top(&self) -> f64 {
        let (k, k3) = match self.contacts[0].law {
            Law::Cubic { k, k3 } => (k, k3.max(0.0)),
            Law::Polynomial { spring, .. } => (spring[0], spring[2]),
            _ => return 3.0,
        };
        let half = 0.5 * (self.stiffness[0] + k);
        let amplitude = self.force() / self.damping[0];
        1.5 * f64::max(
            2.0,
            (half + (half * half + 0.75 * k3 * amplitude.powi(2)).sqrt()).sqrt(),
        )
    }

    /// The model of the library.
    pub fn model(&self) -> Model {
        let mut model = dense(&self.mass, &self.stiffness).damping(&self.damping).build();
        for assembled in &self.contacts {
            model.add_contact(&assembled.law.contact(&assembled.sides)).unwrap();
        }
        for &(dof, harmonic, value) in &self.forces {
            model.add_force(dof, harmonic, value).unwrap();
        }
        model
    }

    /// Norm of the forces.
    pub fn force(&self) -> f64 {
        self.forces.iter().map(|f| f.2.norm_sqr()).sum::<f64>().sqrt()
    }
}

/// A contact of the law of a number between degrees of freedom, or one and the ground.
fn place(number: usize, n: usize, sizes: Sizes, random: &mut Random) -> AssembledLaw {
    // Friction needs a degree of freedom for each direction.
    let number = match number {
        1 | 2 if n < 2 => 0,
        number => number,
    };
    let law = Law::random(number, sizes, number == 1 || n > 2, random);
    // Different degrees of freedom on side a; side b is the ground, or another where one is left.
    let mut free: Vec<usize> = (0..n).collect();
    let mut sides = Vec::new();
    for i in 0..law.directions() {
        let a = free.swap_remove(random.below(free.len()));
        let left = free.len() > law.directions() - 1 - i;
        let b = if left && random.happens(0.4) {
            Some(free.swap_remove(random.below(free.len())))
        } else {
            None
        };
        sides.push([Some(a), b]);
    }
    AssembledLaw { law, sides }
}

fn diagonal(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    let mut a = vec![0.0; n * n];
    for (i, value) in values.iter().enumerate() {
        a[i * n + i] = *value;
    }
    a
}

/// Natural frequencies, and the shapes φᵀ M φ = 1 as columns (row after row), by Jacobi's rotations.
fn modes(m: &[f64], k: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let n = m.len();
    let mut a: Vec<f64> = (0..n * n).map(|at| k[at] / (m[at / n] * m[at % n]).sqrt()).collect();
    let mut v = diagonal(&vec![1.0; n]);
    for _ in 0..30 {
        for p in 0..n {
            for q in p + 1..n {
                let angle = 0.5 * (2.0 * a[p * n + q]).atan2(a[q * n + q] - a[p * n + p]);
                let (s, c) = angle.sin_cos();
                for i in 0..n {
                    let (x, y) = (a[i * n + p], a[i * n + q]);
                    (a[i * n + p], a[i * n + q]) = (c * x - s * y, s * x + c * y);
                    let (x, y) = (v[i * n + p], v[i * n + q]);
                    (v[i * n + p], v[i * n + q]) = (c * x - s * y, s * x + c * y);
                }
                for i in 0..n {
                    let (x, y) = (a[p * n + i], a[q * n + i]);
                    (a[p * n + i], a[q * n + i]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
    }
    let natural = (0..n).map(|i| a[i * n + i].sqrt()).collect();
    for i in 0..n {
        for x in &mut v[i * n..(i + 1) * n] {
            *x /= m[i].sqrt();
        }
    }
    (natural, v)
}
