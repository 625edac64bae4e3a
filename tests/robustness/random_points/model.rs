//! Random chains of masses with light attachments and contacts of every law.

use super::caller::{Dahl, Drag};
use crate::common::peers::structure;
use crate::random_problems::random::Random;
use hbvib::{Constant, Contact, ContactKind, ContactState, Iwan, Model, Polynomial, Table, User};
use std::sync::Arc;

/// The laws of the contacts.
pub const LAWS: [&str; 12] = [
    "Jenkins",
    "friction 2D",
    "friction 3D",
    "unilateral gap",
    "unilateral load",
    "cubic",
    "tanh",
    "table",
    "polynomial",
    "Iwan",
    "caller",
    "caller with states",
];

/// A model with the frequency at which it is solved.
pub struct Case {
    pub number: u64,
    pub model: Model,
    pub masses: usize,
    pub contacts: usize,
    /// Which laws it has.
    pub laws: [bool; LAWS.len()],
    pub omega: f64,
}

/// A chain: masses, springs between neighbours and to the ground, attachments.
struct Chain {
    n: usize,
    mass: Vec<f64>,
    stiffness: Vec<f64>,
}

impl Chain {
    /// 3 to 9 masses, fixed at the first; up to two of them are light and hang on another one.
    fn random(unit: (f64, f64), random: &mut Random) -> Self {
        let n = 3 + random.below(7);
        let light = random.below(3).min(n - 2);
        let mut chain = Self {
            n,
            mass: vec![0.0; n * n],
            stiffness: vec![0.0; n * n],
        };
        for i in 0..n {
            let (size, on) = if i < n - light {
                (1.0, i.checked_sub(1))
            } else {
                (random.decade(-3.5, -1.5), Some(random.below(n - light)))
            };
            chain.mass[i * (n + 1)] = unit.1 * size * random.decade(-0.3, 0.3);
            // A light part hangs softly: its frequency is of the order of those of the chain.
            let k = unit.0 * size * random.decade(-0.3, if size < 1.0 { 1.0 } else { 0.5 });
            chain.couple(i, on, k);
        }
        chain
    }

    fn couple(&mut self, a: usize, b: Option<usize>, k: f64) {
        self.stiffness[a * (self.n + 1)] += k;
        if let Some(b) = b {
            self.stiffness[b * (self.n + 1)] += k;
            self.stiffness[a * self.n + b] -= k;
            self.stiffness[b * self.n + a] -= k;
        }
    }

    /// Stiffness at a degree of freedom.
    fn at(&self, dof: usize) -> f64 {
        self.stiffness[dof * (self.n + 1)]
    }
}

impl Case {
    pub fn random(seed: u64, number: u64) -> Self {
        let mut random = Random::of(seed, number);
        let random = &mut random;
        let (stiffness, mass, force) = (
            random.decade(0.0, 8.0),
            random.decade(-3.0, 3.0),
            random.decade(-3.0, 4.0),
        );
        let chain = Chain::random((stiffness, mass), random);
        let n = chain.n;
        let frequency = (stiffness / mass).sqrt();
        let ratio = random.decade(-3.5, -1.3);
        let of_mass = random.share();
        let (alpha, beta) = (of_mass * ratio * frequency, (1.0 - of_mass) * ratio / frequency);
        let damping: Vec<f64> = (chain.mass.iter().zip(&chain.stiffness))
            .map(|(m, k)| 2.0 * (alpha * m + beta * k))
            .collect();
        let mut model = structure(&chain.mass, &damping, &chain.stiffness);
        // Pressed contacts share the masses that move along their normals.
        let normals = [random.below(n), random.below(n)];
        let kinds: Vec<usize> = (0..=random.below(3)).map(|_| random.below(LAWS.len())).collect();
        let contacts = 2 + random.below(9);
        let mut laws = [false; LAWS.len()];
        for _ in 0..contacts {
            let kind = kinds[random.below(kinds.len())];
            laws[kind] = true;
            let place = Place::random(&chain, normals[random.below(2)], (force, frequency), random);
            add(kind, &place, &mut model, random);
        }
        model.add_force(random.below(n), 1, force * random.phase()).unwrap();
        if random.happens(0.2) {
            let third = force * random.share() * random.phase();
            model.add_force(random.below(n), 3, third).unwrap();
        }
        if random.happens(0.2) {
            let constant = force * random.within(-1.0, 1.0);
            model.add_force(random.below(n), 0, constant.into()).unwrap();
        }
        let natural = model.linear_modes(0, ContactState::Free).unwrap().omega;
        let omega = natural[random.below(n.min(4))] * random.decade(-0.6, 0.2);
        Self {
            number,
            model,
            masses: n,
            contacts,
            laws,
            omega,
        }
    }

    pub fn name(&self) -> String {
        let has = LAWS.iter().zip(self.laws).filter(|(_, has)| *has);
        let laws: Vec<&str> = has.map(|(law, _)| *law).collect();
        format!(
            "{}: {} masses, {} contacts ({})",
            self.number,
            self.masses,
            self.contacts,
            laws.join(", ")
        )
    }
}

/// Degrees of freedom of a contact and the sizes that give its constants.
struct Place {
    /// Along the surface: one, and another.
    a: usize,
    second: usize,
    normal: usize,
    b: Option<usize>,
    /// Stiffness of the structure there.
    stiffness: f64,
    force: f64,
    length: f64,
    omega: f64,
}

impl Place {
    fn random(chain: &Chain, normal: usize, (force, omega): (f64, f64), random: &mut Random) -> Self {
        let n = chain.n;
        let a = (normal + 1 + random.below(n - 1)) % n;
        let second = (0..n).find(|&i| i != a && i != normal).unwrap();
        let b = Some(random.below(n)).filter(|&b| b != a && b != normal && b != second && random.happens(0.4));
        let stiffness = b.map_or(chain.at(a), |b| chain.at(a).min(chain.at(b)));
        Self {
            a,
            second,
            normal,
            b,
            stiffness,
            force: force * (stiffness / chain.at(0)).min(1.0).sqrt(),
            length: force / chain.at(0),
            omega,
        }
    }
}

/// Adds a contact of a law with random constants.
fn add(kind: usize, place: &Place, model: &mut Model, random: &mut Random) {
    let &Place {
        a,
        second,
        normal,
        b,
        stiffness,
        force,
        length,
        omega,
    } = place;
    let k = stiffness * random.decade(-1.5, 1.0);
    let kn = stiffness * random.decade(-1.5, 1.0);
    let limit = force * random.decade(-1.5, 0.5);
    let mu = random.within(0.1, 0.8);
    let gap = length * random.decade(-1.0, 0.5);
    let contact = match kind {
        0 => Contact::jenkins(a, b, k, 1.0, limit),
        1 => Contact::friction_2d([Some(a), Some(normal)], [b, None], (k, kn), mu, limit / mu),
        2 => {
            let sides = [Some(a), Some(second), Some(normal)];
            Contact::friction_3d(sides, [b, None, None], (k, kn), mu, limit / mu)
        }
        3 => Contact::unilateral(Some(a), b, kn, gap),
        4 => Contact::unilateral(Some(a), b, kn, 0.0)
            .with(Constant::Preload, limit)
            .unwrap(),
        5 => Contact::cubic(a, b, k, 0.3 * kn / length.powi(2)),
        6 => Contact::regularised(a, b, 1.0, limit, omega * length * random.decade(-1.5, 0.5)),
        7 => {
            let soft = 0.3 * random.share();
            let x = [-3.0, -1.0, 0.5, 1.0].map(|x| x * gap);
            let f = [-1.0 - 2.0 * soft, -1.0, 0.5, 0.5 + 2.0 * random.share()].map(|f| f * k * gap);
            Contact::between(a, b, ContactKind::Table(Table::new(&x, &f).unwrap()))
        }
        8 => {
            let speed = omega * length;
            // Rising: the square stays below the mean of its neighbours.
            let cubic = 0.3 * kn / length.powi(2);
            let square = random.within(-0.9, 0.9) * (3.0 * k * cubic).sqrt();
            let damper = [0.1 * random.share() * k / omega, 0.0, 0.1 * limit / speed.powi(3)];
            let law = Polynomial::scalar(&[k, square, cubic], &damper).unwrap();
            Contact::between(a, b, ContactKind::Polynomial(law))
        }
        9 => {
            let joint = Iwan {
                slip_force: limit,
                stiffness: k,
                chi: -random.within(0.1, 0.9),
                beta: random.decade(-2.0, 0.0),
            };
            model
                .add_iwan(&Contact::jenkins(a, b, 0.0, 0.0, 0.0), &joint, 8)
                .unwrap();
            return;
        }
        10 => {
            let law = Drag {
                stiffness: k,
                length: gap,
                damping: 0.1 * k / omega,
                speed: omega * gap,
            };
            Contact::between(a, b, ContactKind::User(User::new(Arc::new(law), 1, 0).unwrap()))
        }
        _ => {
            let law = Dahl {
                stiffness: k,
                length: limit / k,
            };
            let user = User {
                states: 1,
                velocity: false,
                odd: true,
                ..User::new(Arc::new(law), 1, 0).unwrap()
            };
            Contact::between(a, b, ContactKind::User(user))
        }
    };
    model.add_contact(&contact).unwrap();
}
