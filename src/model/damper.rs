//! Dampers under the platforms of blades: a rigid body on two or more faces, pressed outward by its centrifugal force.
//!
//! Axes of the damper: x along the wheel towards the next sector, y outward, z along the axis of rotation. A face at the angle φ
//! has the normal (sin φ, cos φ, 0) towards the platform and slides along (cos φ, −sin φ, 0) and z: platforms on the side of the
//! next sector have φ > 0, those on the other one φ < 0 (Panning, Sextro & Popp, International Journal of Rotating Machinery 9,
//! 2003, 219 to 228).

use crate::contact::Contact;
use crate::contact::described::relative_motion::Frame;
use crate::contact::described::rigid_point::RigidPoint;
use crate::contact::forms::constants::Constant;
use crate::error::{Result, fail, try_push, try_vec};
use crate::linalg::sparse_storage::matrix_view::{MatrixView, Part, Storage, Values};
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use std::ops::Range;

const CONTEXT: &str = "a damper";

/// Most points of contact of a face.
/// Kind: cap.
const DAMPER_MOST_POINTS: usize = 10_000;

/// A face of a damper on a platform.
#[derive(Clone, Copy, Debug)]
pub struct DamperFace {
    /// Degrees of freedom of the platform along x, y and z of the damper; `None` is the ground.
    pub dofs: [Option<usize>; 3],
    /// The platform belongs to sector s + offset (cyclic models).
    pub sector_offset: i64,
    /// Angle φ between the platform and the direction along the wheel in radians, negative on the side of the previous sector.
    pub angle: f64,
    /// Angle in radians by which the axes of `dofs` are turned about z against the axes of the damper.
    pub turn: f64,
    /// Middle of the face from the centre of mass; without effect on a cylinder.
    pub centre: [f64; 3],
    /// Width across z, over which points are spread; without effect on a cylinder.
    pub width: f64,
    /// Points across z and along it, each of an equal share.
    pub points: [usize; 2],
    /// Tangential and normal stiffness of the whole face.
    pub stiffness: [f64; 2],
    /// Friction coefficient of the face.
    pub mu: f64,
    /// Gap along the normal between face and platform.
    pub gap: f64,
}

impl Default for DamperFace {
    fn default() -> Self {
        Self {
            dofs: [None; 3],
            sector_offset: 0,
            angle: 0.0,
            turn: 0.0,
            centre: [0.0; 3],
            width: 0.0,
            points: [1; 2],
            stiffness: [0.0; 2],
            mu: 0.0,
            gap: 0.0,
        }
    }
}

/// A damper under the platforms of blades, as a rigid body.
#[derive(Clone, Copy, Debug)]
pub struct Damper<'a> {
    /// 3: motions along x and y and the roll about z; 6: three translations and the rotations about x, y and z.
    pub motions: usize,
    /// Mass of the damper.
    pub mass: f64,
    /// Moments of inertia about x, y and z through the centre of mass; zeros: the values of a solid cylinder of this
    /// radius and length.
    pub inertia: [f64; 3],
    /// Radius of a cylinder, whose faces are lines; 0: the faces have their centres and widths.
    pub radius: f64,
    /// Length along z, over which points are spread.
    pub length: f64,
    /// Distance of the centre of mass from the axis of rotation: the force mass·orbit·Ω² acts outward.
    pub orbit: f64,
    /// Stiffness between the ground and each translation, and each rotation.
    pub support: [f64; 2],
    /// Damping constants between the ground and each translation, and each rotation.
    pub support_damping: [f64; 2],
    /// Faces of the damper on platforms.
    pub faces: &'a [DamperFace],
}

impl Default for Damper<'_> {
    fn default() -> Self {
        Self {
            motions: 3,
            mass: 0.0,
            inertia: [0.0; 3],
            radius: 0.0,
            length: 0.0,
            orbit: 0.0,
            support: [0.0; 2],
            support_damping: [0.0; 2],
            faces: &[],
        }
    }
}

/// Degrees of freedom and contacts of a damper in its model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DamperPlace {
    /// Degrees of freedom of the damper's motions, after all others: x, y, roll; or x, y, z and the rotations about
    /// these.
    pub dofs: Range<usize>,
    /// Indices of the damper's contacts: face after face, points across z first, then along it.
    pub contacts: Range<usize>,
}

/// Adds a damper under platforms.
pub(crate) fn add_damper(target: &mut Model, damper: &Damper<'_>) -> Result<DamperPlace> {
    let inertia = damper.checked()?;
    let mut model = target.try_clone()?;
    let first = model.ndof();
    model.extend(damper.motions)?;
    let translations = if damper.motions == 3 { 2 } else { 3 };
    for i in 0..damper.motions {
        let is_turn = usize::from(i >= translations);
        let inertia = match (i >= translations, damper.motions) {
            (false, _) => damper.mass,
            (true, 3) => inertia[2],
            (true, _) => inertia[i - 3],
        };
        for (which, value) in [
            (MatrixKind::Mass, inertia),
            (MatrixKind::Stiffness, damper.support[is_turn]),
            (MatrixKind::Damping, damper.support_damping[is_turn]),
        ] {
            add_on_diagonal(&mut model, which, first + i, value)?;
        }
    }
    if damper.mass * damper.orbit != 0.0 {
        model.add_centrifugal(first + 1, damper.mass * damper.orbit)?;
    }
    let contacts = model.contacts().len();
    for (i, face) in damper.faces.iter().enumerate() {
        damper
            .add_face(face, first, &mut model)
            .map_err(|e| e.at(format_args!("faces[{i}]")))?;
    }
    *target = model;
    Ok(DamperPlace {
        dofs: first..target.ndof(),
        contacts: contacts..target.contacts().len(),
    })
}

/// Adds a number to an entry of the diagonal of a matrix, in every wave.
fn add_on_diagonal(model: &mut Model, which: MatrixKind, dof: usize, value: f64) -> Result<()> {
    let n = model.ndof();
    let mut starts = try_vec(n + 1, 0, CONTEXT)?;
    starts[dof + 1..].fill(1);
    let entry = MatrixView {
        rows: n,
        cols: n,
        storage: Storage::Csc {
            col_ptr: &starts,
            row_idx: &[dof as i64],
        },
        values: Values::Real(&[value]),
        part: Part::Symmetric,
        index_base: 0,
    };
    model.add_direction(which, &entry, 1.0)
}

impl Damper<'_> {
    /// Checks all numbers, and returns the moments of inertia.
    fn checked(&self) -> Result<[f64; 3]> {
        if self.motions != 3 && self.motions != 6 {
            return fail!(Argument, "motions = {}, needs 3 or 6", self.motions);
        }
        let [x, y, z] = self.inertia;
        let named = [
            ("mass", self.mass),
            ("inertia[0]", x),
            ("inertia[1]", y),
            ("inertia[2]", z),
            ("radius", self.radius),
            ("length", self.length),
            ("orbit", self.orbit),
            ("support[0]", self.support[0]),
            ("support[1]", self.support[1]),
            ("support_damping[0]", self.support_damping[0]),
            ("support_damping[1]", self.support_damping[1]),
        ];
        for (name, value) in named {
            if !value.is_finite() {
                return fail!(NotFinite, "{name} = {value}, needs a finite number >= 0");
            }
            if value < 0.0 {
                return fail!(Argument, "{name} = {value}, needs a number >= 0");
            }
        }
        if self.mass == 0.0 {
            return fail!(Argument, "mass = 0, needs a number > 0");
        }
        let square = self.radius * self.radius;
        let across = self.mass * (3.0 * square + self.length * self.length) / 12.0;
        let solid = [across, across, 0.5 * self.mass * square];
        let inertia = if self.inertia.iter().all(|x| *x == 0.0) {
            solid
        } else {
            self.inertia
        };
        let needed = if self.motions == 3 { &inertia[2..] } else { &inertia[..] };
        if needed.contains(&0.0) {
            return fail!(
                Argument,
                "inertia = {inertia:?}, needs numbers > 0 for the rotations of the damper, or radius and length of a cylinder"
            );
        }
        if self.faces.is_empty() {
            return fail!(Argument, "a damper without faces, needs at least one");
        }
        Ok(inertia)
    }

    /// Adds the contacts of a face.
    fn add_face(&self, face: &DamperFace, first: usize, model: &mut Model) -> Result<()> {
        for (name, value) in [("angle", face.angle), ("width", face.width)] {
            if !value.is_finite() {
                return fail!(NotFinite, "{name} = {value}, needs a finite number");
            }
        }
        let (sine, cosine) = face.angle.sin_cos();
        let across = [cosine, -sine, 0.0];
        let is_line = self.radius > 0.0;
        let planar = self.motions == 3;
        let counts = [
            if is_line { 1 } else { face.points[0] },
            if planar { 1 } else { face.points[1] },
        ];
        let count = counts[0].saturating_mul(counts[1]);
        if count == 0 || count > DAMPER_MOST_POINTS {
            return fail!(
                Argument,
                "points = {} x {}, needs 1 .. {DAMPER_MOST_POINTS} in all",
                counts[0],
                counts[1]
            );
        }
        let middle = if is_line {
            [self.radius * sine, self.radius * cosine, 0.0]
        } else {
            face.centre
        };
        let place = |i: usize, count: usize| (i as f64 + 0.5) / count as f64 - 0.5;
        let share = 1.0 / count as f64;
        let frame = Frame::new([-sine, -cosine, 0.0], Some(across))?;
        let mut contacts = Vec::new();
        for i in 0..counts[0] {
            for j in 0..counts[1] {
                let (u, w) = (face.width * place(i, counts[0]), self.length * place(j, counts[1]));
                let arm = [
                    middle[0] + u * across[0],
                    middle[1] + u * across[1],
                    if planar { 0.0 } else { middle[2] + w },
                ];
                let rotations = if planar {
                    [None, None, Some(first + 2)]
                } else {
                    [3, 4, 5].map(|i| Some(first + i))
                };
                let stiffness = (face.stiffness[0] * share, face.stiffness[1] * share);
                let law = if planar {
                    Contact::friction_2d([None; 2], [None; 2], stiffness, face.mu, 0.0)
                } else {
                    Contact::friction_3d([None; 3], [None; 3], stiffness, face.mu, 0.0)
                };
                let contact = Contact {
                    dof_a: [Some(first), Some(first + 1), (!planar).then_some(first + 2)],
                    dof_b: face.dofs,
                    frame: Some(frame),
                    sector_offset: face.sector_offset,
                    rigid: Some(RigidPoint {
                        rotations,
                        arm,
                        turn: face.turn,
                    }),
                    ..law
                };
                let contact = contact.with(Constant::Gap, face.gap)?;
                try_push(&mut contacts, contact, CONTEXT)?;
            }
        }
        model.add_contacts(&contacts).map(|_| ())
    }
}
