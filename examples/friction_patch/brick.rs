//! Matrices of a rectangular brick with eight nodes and trilinear shape functions.
//!
//! Trilinear functions alone cannot bend: in a state of pure bending they shear, and a mesh of one element over the
//! height would be several times too stiff. The quadratic functions 1 − ξ², 1 − η², 1 − ζ² that vanish at the nodes
//! (Wilson et al. 1973) correct this; they are internal to the element and are condensed out. A rectangular brick
//! passes the patch test without modification.
//!
//! Corner c lies at the end (c >> k) & 1 of edge k; its degrees of freedom are 3c + k.

/// Isotropic elastic material.
#[derive(Clone, Copy, Debug)]
pub struct Material {
    /// Young's modulus, Pa.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density, kg/m³.
    pub density: f64,
}

/// Degrees of freedom of the corners, and with those of the inner functions.
pub const CORNERS: usize = 24;
const ALL: usize = CORNERS + 9;

/// A matrix of one element.
pub type Matrix = [[f64; CORNERS]; CORNERS];

/// End of edge k at which corner c lies, −1 or 1.
fn end(c: usize, k: usize) -> f64 {
    if (c >> k) & 1 == 1 { 1.0 } else { -1.0 }
}

/// Gradients of the eight shape functions and the three inner ones at the natural coordinates `at`.
fn gradients(size: [f64; 3], at: [f64; 3]) -> [[f64; 3]; 11] {
    let mut gradients = [[0.0; 3]; 11];
    for (c, gradient) in gradients.iter_mut().enumerate() {
        for (k, g) in gradient.iter_mut().enumerate() {
            let by_natural = match c.checked_sub(8) {
                None => {
                    let others = (0..3).filter(|&o| o != k);
                    end(c, k) / 8.0 * others.map(|o| 1.0 + end(c, o) * at[o]).product::<f64>()
                }
                Some(inner) if inner == k => -2.0 * at[k],
                Some(_) => 0.0,
            };
            *g = by_natural * 2.0 / size[k];
        }
    }
    gradients
}

/// Strains xx, yy, zz, xy, yz, zx of a motion along k with a gradient.
fn strains(gradient: [f64; 3], k: usize) -> [f64; 6] {
    let mut strains = [0.0; 6];
    strains[k] = gradient[k];
    // Shear of the planes (k, k + 1) and (k − 1, k).
    strains[3 + k] = gradient[(k + 1) % 3];
    strains[3 + (k + 2) % 3] = gradient[(k + 2) % 3];
    strains
}

/// Stiffness of a brick with edges along x, y, z: 2 × 2 × 2 Gauss points, inner functions condensed.
pub fn stiffness(size: [f64; 3], material: &Material) -> Matrix {
    let Material { young, poisson, .. } = *material;
    let shear = young / (2.0 * (1.0 + poisson));
    let lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let volume: f64 = size.iter().product();
    let mut full = [[0.0; ALL]; ALL];
    for point in 0..8 {
        let at = [0, 1, 2].map(|k| end(point, k) / 3.0_f64.sqrt());
        let gradients = gradients(size, at);
        let of = |i: usize| strains(gradients[i / 3], i % 3);
        for (i, row) in full.iter_mut().enumerate() {
            let e = of(i);
            // Stresses of a unit of motion i: 2G ε + λ tr ε on the diagonal, G γ off the diagonal.
            let trace = e[0] + e[1] + e[2];
            let stress: [f64; 6] = std::array::from_fn(|s| {
                if s < 3 {
                    2.0 * shear * e[s] + lame * trace
                } else {
                    shear * e[s]
                }
            });
            for (j, k) in row.iter_mut().enumerate() {
                let work: f64 = stress.iter().zip(of(j)).map(|(s, e)| s * e).sum();
                *k += work * volume / 8.0;
            }
        }
    }
    for p in (CORNERS..ALL).rev() {
        let eliminated = full[p];
        for row in &mut full[..p] {
            let factor = row[p] / eliminated[p];
            for (k, e) in row[..p].iter_mut().zip(&eliminated) {
                *k -= factor * e;
            }
        }
    }
    std::array::from_fn(|i| std::array::from_fn(|j| full[i][j]))
}

/// Consistent mass of the same brick: the product of [2 1; 1 2]/6 over its edges.
pub fn mass(size: [f64; 3], material: &Material) -> Matrix {
    let whole = material.density * size.iter().product::<f64>();
    let share = |a: usize, b: usize| {
        let edges = (0..3).map(|k| if (a ^ b) >> k & 1 == 0 { 1.0 / 3.0 } else { 1.0 / 6.0 });
        whole * edges.product::<f64>()
    };
    std::array::from_fn(|i| std::array::from_fn(|j| if i % 3 == j % 3 { share(i / 3, j / 3) } else { 0.0 }))
}
