//! The relative motions of a contact: the degrees of freedom of its two sides.

use crate::error::{Result, fail};

/// Most degrees of freedom that move side a, a point of a rigid body; and side b, a node.
/// Kind: fixed.
pub const TERMS_A: usize = 6;
pub const TERMS_B: usize = 3;

/// One side of a relative motion, Σ coefficient · x of a degree of freedom; empty is the ground. Side b has three at most.
pub type Side = [Option<(usize, f64)>; TERMS_A];

/// A relative motion y, side a minus side b.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Direction {
    /// Side a.
    pub a: Side,
    /// Side b.
    pub b: Side,
}

impl Direction {
    /// The motion of one degree of freedom over another; `None` is the ground.
    #[must_use]
    pub fn between(a: Option<usize>, b: Option<usize>) -> Self {
        let side = |dof: Option<usize>| {
            let mut side = [None; TERMS_A];
            side[0] = dof.map(|d| (d, 1.0));
            side
        };
        Self { a: side(a), b: side(b) }
    }

    /// A key that differs between different directions, and orders them.
    #[must_use]
    pub fn key(&self) -> [Option<(usize, u64)>; 2 * TERMS_A] {
        let mut key = [None; 2 * TERMS_A];
        for (k, term) in key.iter_mut().zip(self.a.iter().chain(&self.b)) {
            *k = term.map(|(dof, c)| (dof, c.to_bits()));
        }
        key
    }
}

/// Directions of a contact in the axes of its three degrees of freedom per side: unit vectors t1, t2
/// and n, each normal to the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    axes: [[f64; 3]; 3],
}

/// Largest |t·n| of unit vectors that counts as orthogonal: the rounding of a mesh file.
/// Kind: rounding.
const RELATIVE_MOTION_SQUARE: f64 = 1e-6;

impl Frame {
    /// Directions from a normal and, if it matters, a first tangent; both of any length. Without a
    /// tangent it lies in the plane of the normal and the axis that is farthest from it.
    ///
    /// # Errors
    /// `NotFinite`; `Argument` for a vector of length zero or a tangent that is not orthogonal to the
    /// normal, naming it.
    pub fn new(normal: [f64; 3], tangent: Option<[f64; 3]>) -> Result<Self> {
        let n = unit("normal", normal)?;
        let t = if let Some(tangent) = tangent {
            let t = unit("tangent", tangent)?;
            let skew = dot(t, n);
            if skew.abs() > RELATIVE_MOTION_SQUARE {
                return fail!(
                    Argument,
                    "tangent is not orthogonal to normal: cosine {skew:.3e}, needs at most {RELATIVE_MOTION_SQUARE:e}"
                );
            }
            t
        } else {
            let mut axis = [0.0; 3];
            let far = (1..3).fold(0, |far, i| if n[i].abs() < n[far].abs() { i } else { far });
            axis[far] = 1.0;
            axis
        };
        // The part of the tangent orthogonal to the normal.
        let along = dot(t, n);
        let t1 = unit(
            "tangent",
            [t[0] - along * n[0], t[1] - along * n[1], t[2] - along * n[2]],
        )?;
        let t2 = [
            n[1] * t1[2] - n[2] * t1[1],
            n[2] * t1[0] - n[0] * t1[2],
            n[0] * t1[1] - n[1] * t1[0],
        ];
        Ok(Self { axes: [t1, t2, n] })
    }

    /// The axes t1, t2 and n.
    pub(crate) fn axes(&self) -> &[[f64; 3]; 3] {
        &self.axes
    }

    /// The frame of three axes whose products differ by at most `accuracy` from those of orthogonal unit vectors.
    pub(crate) fn of_axes(axes: [[f64; 3]; 3], accuracy: f64) -> Option<Self> {
        let near = |i: usize, j: usize| {
            let product = if i == j { 1.0 } else { 0.0 };
            (dot(axes[i], axes[j]) - product).abs() <= accuracy
        };
        (0..3).all(|i| (0..=i).all(|j| near(i, j))).then_some(Self { axes })
    }

    /// The same directions in axes that are turned by an angle about the third one.
    pub(crate) fn seen_from(&self, turn: f64) -> Self {
        if turn == 0.0 {
            return *self;
        }
        let (s, c) = turn.sin_cos();
        Self {
            axes: self.axes.map(|[x, y, z]| [c * x + s * y, c * y - s * x, z]),
        }
    }

    /// One side's motion along t1, t2 or n (0, 1 or 2). Degrees of freedom without share are left out.
    #[must_use]
    #[doc(hidden)]
    pub fn side(&self, dofs: [Option<usize>; 3], direction: usize) -> Side {
        let mut side = [None; TERMS_A];
        for ((s, dof), &c) in side.iter_mut().zip(dofs).zip(&self.axes[direction]) {
            *s = dof.filter(|_| c != 0.0).map(|d| (d, c));
        }
        side
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector scaled to length 1; its largest component is divided out first, so that nothing overflows.
fn unit(name: &str, v: [f64; 3]) -> Result<[f64; 3]> {
    if let Some(i) = v.iter().position(|x| !x.is_finite()) {
        return fail!(NotFinite, "{name}[{i}] = {}, needs a finite number", v[i]);
    }
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if largest == 0.0 {
        return fail!(Argument, "{name} is zero, needs a direction");
    }
    let v = v.map(|x| x / largest);
    let length = dot(v, v).sqrt();
    Ok(v.map(|x| x / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_orthonormal_and_right_handed_for_vectors_of_any_length() {
        for normal in [[0.0, 0.0, 3.0], [1e-200, 2e-200, -5e-201], [1.0, -1.0, 1e8]] {
            let frame = Frame::new(normal, None).unwrap();
            for i in 0..3 {
                for j in 0..3 {
                    let expected = if i == j { 1.0 } else { 0.0 };
                    assert!((dot(frame.axes[i], frame.axes[j]) - expected).abs() < 1e-15);
                }
            }
            let [t1, t2, n] = frame.axes;
            let triple = t1[0] * (t2[1] * n[2] - t2[2] * n[1]) - t1[1] * (t2[0] * n[2] - t2[2] * n[0])
                + t1[2] * (t2[0] * n[1] - t2[1] * n[0]);
            assert!((triple - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn directions_that_span_no_frame_are_refused_by_name() {
        let refusal = |n, t| Frame::new(n, t).unwrap_err().to_string();
        assert!(refusal([0.0; 3], None).contains("normal is zero"));
        assert!(refusal([0.0, f64::NAN, 1.0], None).contains("normal[1] = NaN"));
        assert!(refusal([0.0, 0.0, 1.0], Some([0.0; 3])).contains("tangent is zero"));
        let skew = refusal([0.0, 0.0, 1.0], Some([1.0, 0.0, 0.1]));
        assert!(skew.contains("not orthogonal") && skew.contains("9.950e-2"), "{skew}");
    }
}
