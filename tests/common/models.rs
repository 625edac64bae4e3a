//! The models that tests share: an oscillator, chains, plates, sectors and any structure of dense matrices, built in one expression.
//!
//! `oscillator(1.0, 1.0).damping(&[0.02]).slider(0, 0.2, 0.1, 1.0).force(0, 1, 0.1).build()` is a mass on a spring that rubs on the ground.
//! Contacts and forces have the order of their calls. A number that the library refuses ends the test.

use hbvib::{Contact, Frame, MatrixKind, MatrixView, Model, Part, SectorDescription, SectorFrame, Speed, Spring};
use num_complex::Complex64;
use std::borrow::Borrow;
use std::f64::consts::FRAC_1_SQRT_2;

/// A model under construction.
pub struct Structure {
    n: usize,
    model: Model,
}

/// Mass `m` on a spring `k` to the ground.
pub fn oscillator(m: f64, k: f64) -> Structure {
    dense(&[m], &[k])
}

/// A plain structure from column-major M and K.
pub fn dense(mass: &[f64], stiffness: &[f64]) -> Structure {
    Structure::plain(mass.len().isqrt()).mass(mass).stiffness(stiffness)
}

/// Masses in a row: spring i holds mass i on the side of the one before, the first and the last spring end at the ground. A last spring of
/// 0 leaves the end free.
pub fn chain(mass: &[f64], springs: &[f64]) -> Structure {
    assert_eq!(springs.len(), mass.len() + 1);
    dense(&diagonal(mass), &chain_stiffness(springs))
}

/// Unit masses between unit springs; both ends are held.
pub fn unit_chain(n: usize) -> Structure {
    chain(&vec![1.0; n], &vec![1.0; n + 1])
}

/// n springs of `k`, and none behind the last mass.
pub fn free_end(n: usize, k: f64) -> Vec<f64> {
    let mut springs = vec![k; n + 1];
    springs[n] = 0.0;
    springs
}

/// Masses on springs to the ground of their own, coupled in a row.
pub fn coupled(mass: &[f64], ground: &[f64], between: &[f64]) -> Structure {
    dense(&diagonal(mass), &coupled_stiffness(ground, between))
}

/// Unit masses on a square grid, a spring of 1 between neighbours and at the clamped edges.
pub fn plate(side: usize) -> Structure {
    let n = side * side;
    let mut k = diagonal(&vec![4.0; n]);
    for i in 0..n {
        for (step, has_next) in [(1, (i + 1) % side != 0), (side, i + side < n)] {
            if has_next {
                k[i * n + i + step] = -1.0;
                k[(i + step) * n + i] = -1.0;
            }
        }
    }
    dense(&diagonal(&vec![1.0; n]), &k)
}

/// K of a chain: K_ii = k_i + k_{i+1}, K_{i−1,i} = −k_i.
pub fn chain_stiffness(springs: &[f64]) -> Vec<f64> {
    let n = springs.len() - 1;
    let own: Vec<f64> = (0..n).map(|i| springs[i] + springs[i + 1]).collect();
    tridiagonal(&own, &springs[1..n].iter().map(|k| -k).collect::<Vec<_>>())
}

/// K of masses on springs of their own, coupled in a row: K_ii = (g_i + k_{i−1}) + k_i, K_{i,i+1} = −k_i.
pub fn coupled_stiffness(ground: &[f64], between: &[f64]) -> Vec<f64> {
    let spring = |i: Option<usize>| i.and_then(|i| between.get(i)).copied().unwrap_or(0.0);
    let own = |(i, g): (usize, &f64)| (g + spring(i.checked_sub(1))) + spring(Some(i));
    let own: Vec<f64> = ground.iter().enumerate().map(own).collect();
    tridiagonal(&own, &between.iter().map(|k| -k).collect::<Vec<_>>())
}

/// A diagonal matrix, dense.
pub fn diagonal(values: &[f64]) -> Vec<f64> {
    tridiagonal(values, &vec![0.0; values.len().saturating_sub(1)])
}

/// A symmetric matrix of a diagonal and the entries beside it, dense.
pub fn tridiagonal(own: &[f64], beside: &[f64]) -> Vec<f64> {
    let n = own.len();
    let mut a = vec![0.0; n * n];
    for (i, own) in own.iter().enumerate() {
        a[i * (n + 1)] = *own;
    }
    for (i, beside) in beside.iter().enumerate() {
        a[i * (n + 1) + 1] = *beside;
        a[(i + 1) * (n + 1) - 1] = *beside;
    }
    a
}

/// Adds a spring between two degrees of freedom to a column-major matrix of order n.
pub fn add_spring(a: &mut [f64], n: usize, (i, j): (usize, usize), k: f64) {
    for (p, q, k) in [(i, i, k), (j, j, k), (i, j, -k), (j, i, -k)] {
        a[q * n + p] += k;
    }
}

/// A face of a damper that moves by `u` along the platform and by `v` outward: friction on a plane at 45°, on the side +1 or −1, against
/// the ground or a blade.
pub fn damper_face([u, v]: [usize; 2], side: f64, blade: Option<usize>, [kt, kn, mu]: [f64; 3]) -> Contact {
    let r = FRAC_1_SQRT_2;
    Contact {
        dof_a: [Some(u), Some(v), None],
        dof_b: [blade, None, None],
        frame: Some(Frame::new([side * r, -r, 0.0], Some([side * r, r, 0.0])).unwrap()),
        ..Contact::friction_2d([None; 2], [None; 2], (kt, kn), mu, 0.0)
    }
}

/// Stodola's rotor on a shaft: x, y, θy and −θx, the latter two coupled by the polar inertia 0.5.
pub fn rotor() -> Structure {
    let mut gyroscopic = [0.0; 16];
    (gyroscopic[2 * 4 + 3], gyroscopic[3 * 4 + 2]) = (-0.5, 0.5);
    let stiffness = [
        1.0, 0.0, 0.4, 0.0, 0.0, 1.0, 0.0, 0.4, 0.4, 0.0, 0.8, 0.0, 0.0, 0.4, 0.0, 0.8,
    ];
    dense(&diagonal(&[1.0, 1.0, 0.3, 0.3]), &stiffness).set(MatrixKind::Gyroscopic, &gyroscopic)
}

impl Structure {
    /// n degrees of freedom without matrices.
    pub fn plain(n: usize) -> Self {
        Self::on(n, Model::new(n).unwrap())
    }

    /// One of `sectors` equal sectors.
    pub fn cyclic(n: usize, sectors: usize) -> Self {
        Self::on(n, Model::cyclic(n, sectors).unwrap())
    }

    /// A model of n degrees of freedom, to go on from.
    pub fn on(n: usize, model: Model) -> Self {
        Self { n, model }
    }

    pub fn build(self) -> Model {
        self.model
    }

    /// Any call that has no name here.
    pub fn with(mut self, change: impl FnOnce(&mut Model)) -> Self {
        change(&mut self.model);
        self
    }

    /// A symmetric matrix, column-major; skew-symmetric if it is gyroscopic.
    pub fn set(self, which: MatrixKind, values: &[f64]) -> Self {
        self.part(which, values, Part::Full)
    }

    /// A matrix whose symmetry is stated, column-major.
    pub fn part(self, which: MatrixKind, values: &[f64], part: Part) -> Self {
        let view = MatrixView::dense(self.n, values).part(part);
        self.with(|model| model.set_matrix(which, &view).unwrap())
    }

    pub fn mass(self, values: &[f64]) -> Self {
        self.set(MatrixKind::Mass, values)
    }

    pub fn damping(self, values: &[f64]) -> Self {
        self.set(MatrixKind::Damping, values)
    }

    pub fn stiffness(self, values: &[f64]) -> Self {
        self.set(MatrixKind::Stiffness, values)
    }

    /// M, C and K, column-major.
    pub fn matrices(self, [mass, damping, stiffness]: [&[f64]; 3]) -> Self {
        self.mass(mass).damping(damping).stiffness(stiffness)
    }

    /// Diagonals of M, C and K.
    pub fn diagonals(self, [mass, damping, stiffness]: [&[f64]; 3]) -> Self {
        self.matrices([&diagonal(mass), &diagonal(damping), &diagonal(stiffness)])
    }

    /// The coupling of a sector to the next one.
    pub fn next(self, which: MatrixKind, values: &[f64]) -> Self {
        let view = MatrixView::dense(self.n, values);
        self.with(|model| model.set_coupling(which, &view).unwrap())
    }

    /// The coupling of a sector to the previous one, where it is not the transpose of that to the next.
    pub fn previous(self, which: MatrixKind, values: &[f64]) -> Self {
        let view = MatrixView::dense(self.n, values);
        self.with(|model| model.set_coupling_previous(which, &view).unwrap())
    }

    /// αM + βK.
    pub fn rayleigh(self, alpha: f64, beta: f64) -> Self {
        self.with(|model| model.set_rayleigh(alpha, beta).unwrap())
    }

    pub fn loss_factor(self, eta: f64) -> Self {
        self.with(|model| model.set_loss_factor(eta).unwrap())
    }

    pub fn wave(self, engine_order: i64) -> Self {
        self.with(|model| model.set_wave(engine_order))
    }

    pub fn speed(self, speed: Speed) -> Self {
        self.with(|model| model.set_speed(speed).unwrap())
    }

    pub fn contact(self, contact: impl Borrow<Contact>) -> Self {
        self.contacts([contact])
    }

    pub fn contacts<C: Borrow<Contact>>(mut self, contacts: impl IntoIterator<Item = C>) -> Self {
        for contact in contacts {
            self.model.add_contact(contact.borrow()).unwrap();
        }
        self
    }

    pub fn springs(mut self, springs: impl IntoIterator<Item = Spring>) -> Self {
        for spring in springs {
            self.model.add_spring(&spring).unwrap();
        }
        self
    }

    /// A Jenkins element against the ground.
    pub fn slider(self, dof: usize, kt: f64, mu: f64, preload: f64) -> Self {
        self.contact(Contact::jenkins(dof, None, kt, mu, preload))
    }

    /// A force in the harmonic of a degree of freedom.
    pub fn force(self, dof: usize, harmonic: usize, value: impl Into<Complex64>) -> Self {
        self.forces([(dof, harmonic, value)])
    }

    pub fn forces<V: Into<Complex64>>(mut self, forces: impl IntoIterator<Item = (usize, usize, V)>) -> Self {
        for (dof, harmonic, value) in forces {
            self.model.add_force(dof, harmonic, value.into()).unwrap();
        }
        self
    }
}

/// A sector from its faces in cylindrical axes about z, forward, nothing fixed.
pub fn sector_of_faces(ndof: usize, sectors: usize, [left, right]: [&[Option<usize>]; 2]) -> SectorDescription<'_> {
    SectorDescription {
        ndof,
        sectors,
        engine_order: 1,
        components: 3,
        left,
        right,
        fixed: &[],
        frame: SectorFrame::Cylindrical,
        axis: [0.0, 0.0, 1.0],
        forward: true,
        coordinates: None,
    }
}
