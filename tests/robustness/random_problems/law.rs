//! Contacts of all laws as the tests know them: what the library is told of each, and the force in time
//! by a march of the tests' own, which shares nothing with the library.

use super::random::Random;
use crate::common::rest::{Disc, nearest_of_many};
use hbvib::{Constant, Contact, ContactKind, Polynomial, Table};

/// A law with its constants.
#[derive(Clone, Debug)]
pub enum Law {
    Jenkins {
        kt: f64,
        limit: f64,
    },
    /// Directions: along the surface, along the normal.
    Friction2d {
        kt: f64,
        kn: f64,
        mu: f64,
        load: f64,
    },
    /// Directions: both along the surface, and the normal unless the load is constant.
    Plane {
        kt: f64,
        kn: f64,
        mu: f64,
        load: f64,
        normal: bool,
    },
    Unilateral {
        kn: f64,
        gap: f64,
        preload: f64,
    },
    Cubic {
        k: f64,
        k3: f64,
    },
    Tanh {
        limit: f64,
        velocity: f64,
    },
    Table {
        x: Vec<f64>,
        f: Vec<f64>,
    },
    Polynomial {
        spring: [f64; 3],
        damper: [f64; 3],
    },
}

/// Names of the laws, in the order of [`Law::number`].
pub const LAWS: [&str; 9] = [
    "Jenkins",
    "friction 2D",
    "friction 3D",
    "unilateral gap",
    "unilateral load",
    "cubic",
    "tanh",
    "table",
    "polynomial",
];

/// Sizes from which those of laws follow: a stiffness, a force and a frequency of the structure.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    pub stiffness: f64,
    pub force: f64,
    pub omega: f64,
    pub damping_ratio: f64,
}

impl Law {
    /// A law of the given number with random constants; `normal` tells whether there is a degree of freedom
    /// along a normal.
    pub fn random(number: usize, sizes: Sizes, normal: bool, random: &mut Random) -> Self {
        let k = sizes.stiffness * random.decade(-2.0, 3.0);
        let limit = sizes.force * random.decade(-2.0, 1.0);
        let length = sizes.force / sizes.stiffness;
        let kn = sizes.stiffness * random.decade(-2.0, 3.0);
        let mu = random.within(0.1, 1.0);
        match number {
            0 => Self::Jenkins { kt: k, limit },
            // A preload, or now and then a gap at rest.
            1 | 2 => {
                let gap = normal && random.happens(0.25);
                let load = if gap {
                    -kn * length * random.decade(-1.0, 1.0)
                } else {
                    limit / mu
                };
                if number == 1 {
                    Self::Friction2d { kt: k, kn, mu, load }
                } else {
                    Self::Plane {
                        kt: k,
                        kn,
                        mu,
                        load,
                        normal,
                    }
                }
            }
            3 => Self::Unilateral {
                kn,
                gap: length * random.decade(-1.0, 1.0),
                preload: 0.0,
            },
            4 => Self::Unilateral {
                kn,
                gap: 0.0,
                preload: limit,
            },
            // Softening stays bounded: the cubic term is a hundredth of the stiffness at the amplitude of a
            // resonance on a tenth of it, which is the least that the structures have, under two forces.
            5 if random.happens(0.25) => {
                let largest = 20.0 * length / (2.0 * sizes.damping_ratio + 0.01);
                let k3 = -0.01 * sizes.stiffness / largest.powi(2);
                Self::Cubic {
                    k: 0.0,
                    k3: k3 * random.share(),
                }
            }
            5 => Self::Cubic {
                k: if random.happens(0.5) { 0.0 } else { k },
                k3: kn / length.powi(2),
            },
            6 => Self::Tanh {
                limit,
                velocity: sizes.omega * length * random.decade(-1.5, 0.5),
            },
            7 => {
                // Rising lines through points on both sides of rest, sometimes with a force at rest.
                let count = 3 + random.below(4);
                let mut x = -length * random.decade(-1.0, 1.0);
                let (mut places, mut forces) = (Vec::new(), Vec::new());
                let mut f = 0.0;
                for _ in 0..count {
                    places.push(x);
                    forces.push(f);
                    let step = length * random.decade(-1.0, 0.7);
                    x += step;
                    f += sizes.stiffness * random.decade(-2.0, 2.0) * step;
                }
                let table = Table::new(&places, &forces).unwrap();
                let rest = if random.happens(0.5) {
                    table.force(0.0)
                } else {
                    table.force(0.0) - limit
                };
                for f in &mut forces {
                    *f -= rest;
                }
                Self::Table { x: places, f: forces }
            }
            _ => {
                let (cubic, share) = (kn / length.powi(2), random.within(-0.9, 0.9));
                // Rising: the square stays below the mean of its neighbours.
                let square = share * (3.0 * k * cubic).sqrt();
                let speed = sizes.omega * length;
                Self::Polynomial {
                    spring: [k, square, cubic],
                    damper: [
                        sizes.force / speed * random.decade(-3.0, 0.0),
                        0.0,
                        sizes.force / speed.powi(3) * random.decade(-3.0, 0.0),
                    ],
                }
            }
        }
    }

    /// Its number among [`LAWS`].
    pub fn number(&self) -> usize {
        match self {
            Self::Jenkins { .. } => 0,
            Self::Friction2d { .. } => 1,
            Self::Plane { .. } => 2,
            Self::Unilateral { preload: 0.0, .. } => 3,
            Self::Unilateral { .. } => 4,
            Self::Cubic { .. } => 5,
            Self::Tanh { .. } => 6,
            Self::Table { .. } => 7,
            Self::Polynomial { .. } => 8,
        }
    }

    /// Number of relative motions.
    pub fn directions(&self) -> usize {
        match self {
            Self::Friction2d { .. } | Self::Plane { normal: false, .. } => 2,
            Self::Plane { .. } => 3,
            _ => 1,
        }
    }

    /// The contact of the library between degrees of freedom, direction after direction.
    pub fn contact(&self, sides: &[[Option<usize>; 2]]) -> Contact {
        let [a, b] = sides[0];
        let side = |i: usize| [sides[0][i], sides[1][i]];
        let all = |i: usize| [sides[0][i], sides[1][i], sides.get(2).and_then(|s| s[i])];
        let gap = |load: f64, kn: f64| if load < 0.0 { -load / kn } else { 0.0 };
        match *self {
            Self::Jenkins { kt, limit } => Contact::jenkins(a.unwrap(), b, kt, 1.0, limit),
            Self::Friction2d { kt, kn, mu, load } => {
                Contact::friction_2d(side(0), side(1), (kt, kn), mu, load.max(0.0))
                    .with(Constant::Gap, gap(load, kn))
                    .unwrap()
            }
            Self::Plane {
                kt,
                kn,
                mu,
                load,
                normal,
            } => Contact::friction_3d(all(0), all(1), (kt, if normal { kn } else { 0.0 }), mu, load.max(0.0))
                .with(Constant::Gap, gap(load, kn))
                .unwrap(),
            Self::Unilateral { kn, gap, preload } => Contact::unilateral(a, b, kn, gap)
                .with(Constant::Preload, preload)
                .unwrap(),
            Self::Cubic { k, k3 } => Contact::cubic(a.unwrap(), b, k, k3),
            Self::Tanh { limit, velocity } => Contact::regularised(a.unwrap(), b, 1.0, limit, velocity),
            Self::Table { ref x, ref f } => {
                Contact::between(a.unwrap(), b, ContactKind::Table(Table::new(x, f).unwrap()))
            }
            Self::Polynomial { spring, damper } => {
                let law = Polynomial::scalar(&spring, &damper).unwrap();
                Contact::between(a.unwrap(), b, ContactKind::Polynomial(law))
            }
        }
    }

    /// Where the slider of friction in a plane rests if it can stick at the times given: at the point nearest to where it
    /// was before it was loaded.
    fn rest(&self, u: &[f64]) -> Option<Slider> {
        let Self::Plane {
            kt,
            kn,
            mu,
            load,
            normal,
        } = *self
        else {
            return None;
        };
        let pressure = |u: &[f64]| if normal { load - kn * u[2] } else { load };
        let d = self.directions();
        let discs: Vec<Disc> = u
            .chunks_exact(d)
            .map(|u| ([u[0], u[1]], mu * pressure(u) / kt))
            .collect();
        let closed = discs.iter().all(|(_, radius)| *radius > 0.0);
        let at = closed.then(|| nearest_of_many(&discs, 1e-12))??;
        Some(Slider { at })
    }

    /// Most periods that a march may take to become periodic.
    const PERIODS: usize = 200;

    /// Forces at equidistant times from motions and velocities, time after time, of one period that repeats,
    /// reached from a slider at rest at zero.
    pub fn march(&self, u: &[f64], v: &[f64], f: &mut [f64]) {
        let d = self.directions();
        let times = u.len() / d;
        let mut slider = Slider::default();
        let end = (times - 1) * d..times * d;
        if let Some(slider) = self.rest(u) {
            for (u, f) in u.chunks_exact(d).zip(f.chunks_exact_mut(d)) {
                let mut force = [0.0; 3];
                self.force(&mut slider.clone(), [u; 2], &[], &mut force);
                f.copy_from_slice(&force[..d]);
            }
            return;
        }
        let mut last = [f64::NAN; 2];
        for _ in 0..Self::PERIODS {
            let mut largest = 0.0_f64;
            let mut before = &u[end.clone()];
            for j in 0..times {
                let at = j * d..(j + 1) * d;
                let mut force = [0.0; 3];
                self.force(&mut slider, [before, &u[at.clone()]], &v[at.clone()], &mut force);
                largest = largest.max(slider.at[0].abs()).max(slider.at[1].abs());
                before = &u[at.clone()];
                f[at].copy_from_slice(&force[..d]);
            }
            let change = (slider.at[0] - last[0]).hypot(slider.at[1] - last[1]);
            if change <= 1e-13 * largest {
                break;
            }
            last = slider.at;
        }
    }

    /// Force at a time after the position of the slider the time before, from the motions at both times.
    fn force(&self, slider: &mut Slider, [before, u]: [&[f64]; 2], v: &[f64], f: &mut [f64; 3]) {
        match *self {
            Self::Jenkins { kt, limit } => f[..1].copy_from_slice(&slider.drag::<1>(kt, limit, &u[..1])),
            Self::Friction2d { kt, kn, mu, load } => {
                let normal = slider.press([load - kn * before[1], load - kn * u[1]], [&before[..1], &u[..1]]);
                f[..1].copy_from_slice(&slider.drag::<1>(kt, mu * normal, &u[..1]));
                f[1] = -normal;
            }
            Self::Plane {
                kt,
                kn,
                mu,
                load,
                normal,
            } => {
                let at = |u: &[f64]| if normal { load - kn * u[2] } else { load };
                let pressure = slider.press([at(before), at(u)], [&before[..2], &u[..2]]);
                f[..2].copy_from_slice(&slider.drag::<2>(kt, mu * pressure, &u[..2]));
                f[2] = -pressure;
            }
            // Side a minus side b closes the contact when it falls.
            Self::Unilateral { kn, gap, preload } => f[0] = -(preload + kn * (-u[0] - gap)).max(0.0),
            Self::Cubic { k, k3 } => f[0] = k * u[0] + k3 * u[0].powi(3),
            Self::Tanh { limit, velocity } => f[0] = limit * (v[0] / velocity).tanh(),
            Self::Table { ref x, f: ref forces } => {
                let i = x[1..x.len() - 1].iter().filter(|x| **x <= u[0]).count();
                let slope = (forces[i + 1] - forces[i]) / (x[i + 1] - x[i]);
                f[0] = forces[i] + slope * (u[0] - x[i]);
            }
            Self::Polynomial { spring, damper } => {
                let sum = |c: [f64; 3], x: f64| x * (c[0] + x * (c[1] + x * c[2]));
                f[0] = sum(spring, u[0]) + sum(damper, v[0]);
            }
        }
    }
}

/// Where the spring of friction is held.
#[derive(Clone, Copy, Debug, Default)]
struct Slider {
    at: [f64; 2],
}

impl Slider {
    /// The pressure now. At closing, which is sought on the straight line from the motion before, the
    /// slider begins without force.
    fn press(&mut self, [load_before, load]: [f64; 2], [before, u]: [&[f64]; 2]) -> f64 {
        if load_before <= 0.0 && load > 0.0 {
            let share = load_before / (load_before - load);
            for ((at, before), u) in self.at.iter_mut().zip(before).zip(u) {
                *at = before + share * (u - before);
            }
        }
        load.max(0.0)
    }

    /// The force along the surface: the spring's, back on the circle of the limit.
    fn drag<const D: usize>(&mut self, kt: f64, limit: f64, u: &[f64]) -> [f64; D] {
        let mut force = [0.0; D];
        for ((f, at), u) in force.iter_mut().zip(self.at).zip(u) {
            *f = kt * (u - at);
        }
        let size = force.iter().fold(0.0_f64, |size, f| size.hypot(*f));
        if size > limit {
            for ((f, at), u) in force.iter_mut().zip(&mut self.at).zip(u) {
                *f *= limit / size;
                *at = u - *f / kt;
            }
        }
        force
    }
}
