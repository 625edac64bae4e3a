//! Rest position of the slider of friction in a plane, by a test of all candidates: the common point of all discs
//! nearest to 0 is 0, the nearest point of one of them, or one where two circles meet.

/// Centre and radius.
pub type Disc = ([f64; 2], f64);

/// Distance of `w` from the disc; negative inside.
pub fn outside(w: [f64; 2], (x, radius): Disc) -> f64 {
    (w[0] - x[0]).hypot(w[1] - x[1]) - radius
}

/// The point of all `discs` nearest to 0, to within `tolerance`.
fn nearest(discs: &[Disc], tolerance: f64) -> Option<[f64; 2]> {
    let mut best: Option<[f64; 2]> = None;
    let size = |w: [f64; 2]| w[0].hypot(w[1]);
    let mut consider = |w: [f64; 2]| {
        if best.is_none_or(|best| size(w) < size(best)) && discs.iter().all(|d| outside(w, *d) <= tolerance) {
            best = Some(w);
        }
    };
    consider([0.0; 2]);
    for (i, &(x, r)) in discs.iter().enumerate() {
        let share = 1.0 - r / size(x);
        consider(x.map(|x| share * x));
        for &(y, s) in &discs[..i] {
            // w − x has the length r and the angle α to y − x, with the side s opposite to it.
            let [dx, dy] = [y[0] - x[0], y[1] - x[1]];
            let distance = dx.hypot(dy);
            let cos = (r * r + distance * distance - s * s) / (2.0 * r * distance);
            if cos.abs() <= 1.0 {
                for angle in [cos.acos(), -cos.acos()].map(|a| dy.atan2(dx) + a) {
                    consider([x[0] + r * angle.cos(), x[1] + r * angle.sin()]);
                }
            }
        }
    }
    best
}

/// The same for many discs: starts with few and adds the most violated one.
pub fn nearest_of_many(discs: &[Disc], tolerance: f64) -> Option<[f64; 2]> {
    let mut few: Vec<Disc> = Vec::new();
    loop {
        let w = nearest(&few, tolerance)?;
        let worst = discs
            .iter()
            .copied()
            .max_by(|a, b| outside(w, *a).total_cmp(&outside(w, *b)))?;
        if outside(w, worst) <= tolerance {
            return Some(w);
        }
        if few.len() > 60 {
            return None;
        }
        few.push(worst);
    }
}
