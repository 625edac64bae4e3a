//! Friction in a plane: elastic Coulomb friction of two coupled tangential directions under a normal
//! load that varies and may vanish.
//!
//! With the normal motion y = side a − side b the load is N = max(n₀ − kn·y, 0), which acts on y as
//! −N. The tangential force f, a vector, is the state:
//!
//! > stick f' = kt·x',  slip f' = kt·(x' − γ e) with f = μN e and γ ≥ 0,  open f = 0.
//!
//! Slip goes along the force (the circle |f| = μN is the limit, and the slip velocity γ e is normal to
//! it). The motion between two samples is taken as linear and followed exactly, see
//! friction_3d_step.rs, so that the force is of second order in the distance of samples and its
//! derivative is that of the discrete force. The place of a slider that sticks through the period is in
//! friction_3d_stuck.rs. The normal force, which has no memory, has exact harmonics.

mod friction_3d_path;
mod friction_3d_period;
mod friction_3d_slip;
mod friction_3d_stuck;

use crate::contact::forms::constants::{Constant, Role, load, named_constants, needs_stiffness, slip_limit};
use crate::contact::forms::coupled_search::CoupledSearch;
use crate::contact::forms::force_derivative::{Combination, ForceDerivative};
use crate::contact::forms::law::{ContactLaw, Form, Law, LawInTime, PlaneFriction, VaryingNormalLoad};
use crate::contact::forms::linearisation::Range;
use crate::contact::forms::onset::{Onset, slider_in_plane};
use crate::contact::forms::piece::{CoupledPiece, Piece};
use crate::contact::forms::plane_path::{PlanePath, Repetition};
use crate::contact::laws::friction_2d::{ScaledFriction2d, check_normal_stiffness, under_varying_load};
use crate::error::{Result, fail};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use std::sync::Arc;

/// Friction in a plane in the caller's units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction3d {
    /// Tangential stiffness of both directions, force per length, at least 0.
    pub kt: f64,
    /// Normal stiffness, force per length, above 0; 0 without a degree of freedom along n.
    pub kn: f64,
    /// Friction coefficient, at least 0.
    pub mu: f64,
    /// Normal load at rest where the gap is 0, force, at least 0.
    pub preload: f64,
    /// Closing at which a contact without preload begins to press, of any sign; 0 without a degree of freedom along n.
    pub gap: f64,
    /// Place of the slider before any motion along t1 and t2.
    pub slider: [f64; 2],
}

named_constants!(
    Friction3d, 4, Kt => kt, Kn => kn, Mu => mu, Preload => preload, Gap => gap, Slider(0) => slider[0], Slider(1) => slider[1]
);

impl Friction3d {
    /// The law of a contact that can move along n or not.
    pub(super) fn on(&self, has_normal: bool) -> PlaneContact {
        PlaneContact { law: *self, has_normal }
    }
}

/// Friction in a plane of a contact whose load varies, if it can move along n, or is constant.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaneContact {
    law: Friction3d,
    has_normal: bool,
}

impl PlaneContact {
    /// n₀
    fn load(&self) -> f64 {
        load(self.law.kn, self.law.preload, self.law.gap)
    }

    fn slip_limit(&self) -> f64 {
        slip_limit(self.law.mu, self.law.preload)
    }
}

impl ContactLaw for PlaneContact {
    fn name(&self) -> &'static str {
        "friction contact"
    }

    fn check(&self) -> Result<()> {
        let c = &self.law;
        if self.has_normal {
            return check_normal_stiffness(c.kn, c.kt, c.preload);
        }
        if c.kn != 0.0 || c.gap != 0.0 {
            return fail!(
                Argument,
                "contact: kn = {}, gap = {}, need 0 for friction without a degree of freedom along n",
                c.kn,
                c.gap
            );
        }
        Ok(())
    }

    fn places(&self) -> &'static [usize] {
        if self.has_normal { &[0, 1, 2] } else { &[0, 1] }
    }

    fn check_stiffness(&self) -> Result<()> {
        let c = &self.law;
        if self.has_normal {
            needs_stiffness(Constant::Kn, c.kn)
        } else {
            needs_stiffness(Constant::Kt, c.kt)
        }
    }

    fn role(&self) -> Role {
        let c = &self.law;
        if c.kn == 0.0 && (c.kt == 0.0 || self.slip_limit() == 0.0) {
            Role::Inert
        } else {
            Role::Active
        }
    }

    fn stiffness_at_small_motion(&self, k: usize, l: usize) -> f64 {
        if (self.law.mu == 0.0 && k < 2) || k != l || self.load() <= 0.0 {
            0.0
        } else {
            self.stiffness(k)
        }
    }

    fn stiffness(&self, k: usize) -> f64 {
        let c = &self.law;
        if self.has_normal && k == 2 { c.kn } else { c.kt }
    }

    fn is_spring(&self) -> bool {
        false
    }

    fn largest_force(&self) -> f64 {
        if self.law.kn == 0.0 {
            self.slip_limit()
        } else {
            f64::INFINITY
        }
    }

    fn is_preloaded(&self) -> bool {
        let is_pressed = self.law.kn > 0.0 && self.load() >= 0.0;
        self.role() == Role::Active && (is_pressed || self.law.slider.iter().any(|w| *w != 0.0))
    }

    fn by_constant(&self, constant: Constant) -> Option<ForceDerivative> {
        let c = &self.law;
        if self.has_normal {
            return under_varying_load(constant, c);
        }
        match constant {
            Constant::Kt => Some(ForceDerivative::by_factor(c.kt, Combination::BY_TANGENTIAL)),
            Constant::Mu => Some(ForceDerivative::by_factor(c.mu, Combination::BY_LIMIT)),
            Constant::Preload => Some(ForceDerivative::by_factor(c.preload, Combination::BY_LIMIT)),
            Constant::Slider(k) => Some(ForceDerivative::tangential(Combination::of_slider(k))),
            _ => None,
        }
    }

    fn normal_load(&self, y: f64) -> f64 {
        let c = &self.law;
        if self.has_normal {
            (self.load() - c.kn * y).max(0.0)
        } else {
            c.preload
        }
    }

    fn law(&self, length: f64) -> Result<Arc<dyn Law>> {
        let c = &self.law;
        Ok(Arc::new(ScaledFriction3d {
            kt: c.kt,
            kn: c.kn,
            mu: c.mu,
            load: self.load() / length,
            has_normal: self.has_normal,
            slider: c.slider.map(|w| w / length),
        }))
    }

    fn in_time(&self) -> Result<LawInTime> {
        fail!(
            Unsupported,
            "friction in a plane is not integrated in time, friction in one direction is"
        )
    }
}

/// Friction in a plane in the units of a solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledFriction3d {
    /// kt, tangential stiffness of both directions, ≥ 0.
    pub kt: f64,
    /// kn, normal stiffness, ≥ 0; without normal motion it has no effect.
    pub kn: f64,
    /// μ, friction coefficient, ≥ 0 and finite.
    pub mu: f64,
    /// n₀, normal load at y = 0, of any sign; infinite, without normal direction, sticks for ever.
    pub load: f64,
    /// Whether the normal motion y is the third direction; if not, the load is constant.
    pub has_normal: bool,
    /// Place of the slider before any motion.
    pub slider: [f64; 2],
}

impl Law for ScaledFriction3d {
    fn directions(&self) -> usize {
        if self.has_normal { 3 } else { 2 }
    }

    fn is_odd(&self) -> bool {
        !self.has_normal && self.slider.iter().all(|w| *w == 0.0)
    }

    fn form(&self) -> Form<'_> {
        Form::PlaneFriction(self)
    }

    /// Under a constant load as for one direction, the diagonal of both for the plane; with a gap at
    /// rest the closing over the gap.
    fn linearisation_scale(&self, ranges: &[Range], _reference: f64) -> f64 {
        match ranges {
            [x1, x2] => self.kt * f64::hypot(x1.size(), x2.size()) / (self.mu * self.load),
            ranges => self.kn * (ranges[2].half - ranges[2].mean).max(0.0) / -self.load,
        }
    }

    fn onset(&self, rest: &[f64], motion: &[Complex64]) -> Onset {
        let load = if self.has_normal {
            self.load_at(rest[2])
        } else {
            self.load
        };
        let (closing, of_limit) = if self.has_normal && self.kn > 0.0 {
            let closing = Onset::of_closing(load / self.kn, motion[2]);
            (closing, self.mu * self.kn * motion[2])
        } else {
            (Onset::NEVER, Complex64::ZERO)
        };
        if load < 0.0 || self.kt == 0.0 || self.mu == 0.0 {
            return closing;
        }
        let force = [0, 1].map(|i| self.kt * (rest[i] - self.slider[i]));
        let vibrating = [self.kt * motion[0], self.kt * motion[1]];
        closing.with_slider(slider_in_plane(force, self.mu * load, vibrating, of_limit))
    }
}

impl PlaneFriction for ScaledFriction3d {
    fn path(&self, motion: &[f64], normal: &[Piece], path: &mut PlanePath, interrupt: &Interrupt<'_>) -> Result<()> {
        path.load((self.kt, self.slider), self.limit(), motion);
        if self.kt == 0.0 || self.mu == 0.0 {
            path.repetition = Repetition::FromNothing;
            return Ok(());
        }
        friction_3d_period::find(normal, path, interrupt)
    }

    fn stiffness(&self) -> f64 {
        self.kt
    }

    fn slider(&self) -> [f64; 2] {
        self.slider
    }

    fn limit(&self) -> [f64; 2] {
        let by_y = if self.has_normal { -self.mu * self.kn } else { 0.0 };
        [self.mu * self.load, by_y]
    }

    fn normal(&self) -> Option<&dyn VaryingNormalLoad> {
        if self.has_normal { Some(self) } else { None }
    }
}

/// The normal force alone: friction in one direction without tangential stiffness.
impl VaryingNormalLoad for ScaledFriction3d {
    fn coupled_pieces(
        &self,
        set: &HarmonicSet,
        motion: &[f64],
        search: &mut CoupledSearch,
        normal: &mut Vec<Piece>,
        tangential: &mut Vec<CoupledPiece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let law = ScaledFriction2d {
            kt: 0.0,
            kn: self.kn,
            mu: self.mu,
            load: self.load,
            slider: 0.0,
        };
        law.coupled_pieces(set, motion, search, normal, tangential, interrupt)
    }

    fn load_at(&self, y: f64) -> f64 {
        self.load - self.kn * y
    }
}
