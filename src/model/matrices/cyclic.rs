//! Waves on a cyclic structure, with the sign convention of their phase.
//!
//! In the wave of engine order EO sector s + 1 lags: x_{s+1,h} = e^{−ihφ} x_{s,h}, φ = 2π·EO/N with the signed EO.
//! Harmonic h therefore belongs to nodal diameter h·EO mod N, and its matrices are A_h = A₀ + A₁ e^{−ihφ} + A₋₁
//! e^{+ihφ} (Thomas 1979, doi:10.1002/nme.1620140107; Wildheim 1979, doi:10.1115/1.3424673).

use crate::error::{Result, fail};
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::sparse::{Columns, Csc, Form, Symmetry};
use crate::model::few_motions::reduced_wave::WaveKey;
use crate::model::matrices::influence::AeroForm;
use crate::model::matrices::part_of_turn::lag;
use crate::model::matrices::speed::Speed;
use crate::model::matrices::structure::{MatrixKind, Structure};
use crate::model::matrices::wave::Wave;
use num_complex::Complex64;

/// Relative deviation from a Hermitian matrix that is rounding.
/// Kind: rounding.
const CYCLIC_HERMITIAN: f64 = 1e-10;

/// Matrices of a speed Ω = pω that is tied to the frequency: Z_h = … + ω² p²K₁ + ihω² pG.
#[derive(Clone, Debug)]
pub struct Tied {
    /// p²K₁, the stiffness by the speed, over ω².
    pub stiffness: Csc,
    /// pG, the gyroscopic matrix, over ω.
    pub gyroscopic: Csc,
}

impl Structure {
    /// Residue h·EO mod N of a harmonic, in 0 .. N.
    fn residue(&self, harmonic: i64) -> usize {
        let n = self.sectors() as i128;
        (i128::from(harmonic) * i128::from(self.engine_order())).rem_euclid(n) as usize
    }

    /// Key of the wave of a harmonic: waves with equal keys have equal matrices, or conjugate ones if `true` is
    /// returned.
    pub(crate) fn wave_key(&self, harmonic: usize) -> (WaveKey, bool) {
        let mean = harmonic == 0;
        let residue = self.residue(harmonic as i64);
        let (diameter, backward) = self.fold(residue as i64);
        if self.has_conjugate_waves() {
            return (WaveKey { diameter, mean: false }, backward);
        }
        // Blocks that are complex themselves belong to one sense of travel.
        let key = WaveKey {
            diameter: residue,
            mean,
        };
        (key, false)
    }

    /// Signed nodal diameter h·EO mod N of a harmonic of the wave, −N/2 < d ≤ N/2.
    pub fn diameter_of(&self, harmonic: usize) -> i64 {
        self.signed_diameter(self.residue(harmonic as i64) as i64)
    }

    /// The lowest harmonic above 0 in which all sectors move alike: n·EO is a multiple of N only for multiples n of
    /// it. 1 for a plain structure.
    pub fn in_step(&self) -> usize {
        let (mut divisor, mut rest) = (self.sectors(), self.residue(1));
        while rest != 0 {
            (divisor, rest) = (rest, divisor % rest);
        }
        self.sectors() / divisor
    }

    /// Phase factor e^{−i·offset·hφ}: motion of sector s + offset over that of sector s, exact at quarter turns.
    #[must_use]
    pub fn phase(&self, harmonic: usize, offset: i64) -> Complex64 {
        self.wave_phase(self.residue(harmonic as i64) as i64, offset)
    }

    /// Phase factor e^{−2πi·diameter·offset/N} for the wave of `diameter` waves per turn.
    pub fn wave_phase(&self, diameter: i64, offset: i64) -> Complex64 {
        let n = self.sectors() as i128;
        self.lag((i128::from(diameter) * i128::from(offset)).rem_euclid(n) as usize)
    }

    /// Residue d mod N in 0 .. N of a nodal diameter.
    fn residue_of(&self, diameter: i64) -> usize {
        diameter.rem_euclid(self.sectors() as i64) as usize
    }

    /// Phase factor e^{−2πi·residue/N} between neighbouring sectors.
    fn lag(&self, residue: usize) -> Complex64 {
        lag(residue, self.sectors())
    }

    /// Whether a contact with this sector offset stays within one sector.
    pub(crate) fn same_sector(&self, offset: i64) -> bool {
        i128::from(offset).rem_euclid(self.sectors() as i128) == 0
    }

    /// The matrix of harmonic `harmonic` of the wave. The damping includes Rayleigh and modal damping, ΩG at a fixed
    /// speed and aerodynamic forces per velocity, the structural matrix ηK; the mean has the real part of complex matrices, and no
    /// structural damping.
    ///
    /// # Errors
    /// `Argument` when the nodal diameter of the harmonic was not given; `OutOfMemory`.
    pub fn wave_matrix(&self, which: MatrixKind, harmonic: usize) -> Result<Csc> {
        self.residue_matrix(which, self.residue(harmonic as i64), harmonic == 0, true)
    }

    /// The damping matrix of a wave without modal damping.
    pub(crate) fn damping_beside_modes(&self, wave: Wave) -> Result<Csc> {
        let (residue, real) = self.residue_of_wave(wave);
        self.residue_matrix(MatrixKind::Damping, residue, real, false)
    }

    /// The modal damping matrix that a wave has, or that of the other sense, to be conjugated.
    pub(crate) fn modal_damping_of_wave(&self, wave: Wave) -> Option<(&KeptMatrix, Form)> {
        self.of_residue(&self.modal_damping, self.residue_of_wave(wave).0)
    }

    /// Residue of a wave, and whether it has the real part of complex matrices alone, as the mean.
    fn residue_of_wave(&self, wave: Wave) -> (usize, bool) {
        match wave {
            Wave::Harmonic(h) => (self.residue(h as i64), h == 0),
            Wave::Diameter(d) => (self.residue_of(d), false),
        }
    }

    /// The matrix of the wave in which sector s + 1 lags by 2π·diameter/N.
    ///
    /// # Errors
    /// As [`Self::wave_matrix`].
    pub fn diameter_matrix(&self, which: MatrixKind, diameter: i64) -> Result<Csc> {
        self.residue_matrix(which, self.residue_of(diameter), false, true)
    }

    /// The matrix of a residue: the real part of complex ones if `real`, with the damping of modes if `with_modes`.
    fn residue_matrix(&self, which: MatrixKind, residue: usize, real: bool, with_modes: bool) -> Result<Csc> {
        let (of_mass, of_stiffness) = match which {
            MatrixKind::Damping => self.rayleigh,
            // No stress follows a mean strain by a phase.
            MatrixKind::Structural if real => return Csc::zero(self.ndof()),
            MatrixKind::Structural => (0.0, self.loss_factor),
            MatrixKind::Mass | MatrixKind::Stiffness | MatrixKind::Gyroscopic | MatrixKind::StiffnessSpeed2 => {
                (0.0, 0.0)
            }
        };
        let speed = match (which, self.speed) {
            (MatrixKind::Damping, Speed::Fixed(speed)) if self.has(MatrixKind::Gyroscopic) => speed,
            _ => 0.0,
        };
        let modal = match which {
            MatrixKind::Damping if with_modes => self.modal_damping_of(residue, real)?,
            _ => None,
        };
        let aero = match which {
            MatrixKind::Damping => self.aero_matrix(AeroForm::Velocity, residue, real)?,
            _ => None,
        };
        let given = self.given(which, residue, real)?;
        if of_mass == 0.0 && of_stiffness == 0.0 && modal.is_none() && speed == 0.0 && aero.is_none() {
            return Ok(given);
        }
        let mut terms = Vec::with_capacity(6);
        terms.push((Complex64::ONE, &given, Form::Plain));
        let (mass, stiffness, gyroscopic);
        if of_mass != 0.0 {
            mass = self.given(MatrixKind::Mass, residue, real)?;
            terms.push((of_mass.into(), &mass, Form::Plain));
        }
        if of_stiffness != 0.0 {
            stiffness = self.elastic(self.given(MatrixKind::Stiffness, residue, real)?)?;
            terms.push((of_stiffness.into(), &stiffness, Form::Plain));
        }
        if speed != 0.0 {
            gyroscopic = self.given(MatrixKind::Gyroscopic, residue, real)?;
            terms.push((speed.into(), &gyroscopic, Form::Plain));
        }
        for added in [&modal, &aero].into_iter().flatten() {
            terms.push((Complex64::ONE, added, Form::Plain));
        }
        Csc::sum(self.ndof(), &terms)
    }

    /// One matrix as the caller gave it, without derived parts, for the wave in which sector s + 1 lags by
    /// 2π·diameter/N.
    pub(crate) fn given_of_diameter(&self, which: MatrixKind, diameter: usize) -> Result<Csc> {
        self.given(which, diameter % self.sectors(), false)
    }

    /// The modal damping matrix for the wave in which sector s + 1 lags by 2π·diameter/N.
    pub(crate) fn modal_damping_of_diameter(&self, diameter: usize) -> Result<Csc> {
        match self.modal_damping_of(diameter % self.sectors(), false)? {
            Some(matrix) => Ok(matrix),
            None => Csc::zero(self.ndof()),
        }
    }

    /// Ω²K₁ of the wave at a fixed speed; `None` where it is zero.
    ///
    /// # Errors
    /// As [`Self::wave_matrix`].
    pub fn stiffness_of_speed(&self, wave: Wave) -> Result<Option<Csc>> {
        let Speed::Fixed(speed) = self.speed else {
            return Ok(None);
        };
        if speed == 0.0 || !self.has(MatrixKind::StiffnessSpeed2) {
            return Ok(None);
        }
        let mut matrix = self.of_wave(MatrixKind::StiffnessSpeed2, wave)?;
        for v in &mut matrix.values {
            *v *= speed * speed;
        }
        Ok(Some(matrix))
    }

    /// K of the wave with what acts like it: Ω²K₁ at a fixed speed and aerodynamic forces per displacement.
    ///
    /// # Errors
    /// As [`Self::wave_matrix`].
    pub fn acting_stiffness(&self, wave: Wave) -> Result<Csc> {
        let own = self.of_wave(MatrixKind::Stiffness, wave)?;
        let added = [
            self.stiffness_of_speed(wave)?,
            self.aero_of_wave(AeroForm::Displacement, wave)?,
        ];
        if added.iter().all(Option::is_none) {
            return Ok(own);
        }
        let mut terms = Vec::with_capacity(3);
        terms.push((Complex64::ONE, &own, Form::Plain));
        terms.extend(added.iter().flatten().map(|a| (Complex64::ONE, a, Form::Plain)));
        Csc::sum(self.ndof(), &terms)
    }

    /// The matrix −A of the aerodynamic influence in a wave, on the left-hand side; `None` without influence.
    pub fn aero_of_wave(&self, form: AeroForm, wave: Wave) -> Result<Option<Csc>> {
        match wave {
            Wave::Harmonic(h) => self.aero_matrix(form, self.residue(h as i64), h == 0),
            Wave::Diameter(d) => self.aero_matrix(form, self.residue_of(d), false),
        }
    }

    /// ΩG of the wave at a fixed speed; `None` where it is zero.
    ///
    /// # Errors
    /// As [`Self::wave_matrix`].
    pub fn gyroscopic_at_speed(&self, wave: Wave) -> Result<Option<Csc>> {
        let Speed::Fixed(speed) = self.speed else {
            return Ok(None);
        };
        if !self.is_gyroscopic() {
            return Ok(None);
        }
        let mut matrix = self.of_wave(MatrixKind::Gyroscopic, wave)?;
        for v in &mut matrix.values {
            *v *= speed;
        }
        Ok(Some(matrix))
    }

    /// p²K₁ and pG of the wave where the speed is pω; `None` where nothing depends on it.
    ///
    /// # Errors
    /// As [`Self::wave_matrix`].
    pub fn tied_to_frequency(&self, wave: Wave) -> Result<Option<Tied>> {
        let Speed::PerOmega(p) = self.speed else {
            return Ok(None);
        };
        if p == 0.0 || !(self.has(MatrixKind::StiffnessSpeed2) || self.has(MatrixKind::Gyroscopic)) {
            return Ok(None);
        }
        let mut stiffness = self.of_wave(MatrixKind::StiffnessSpeed2, wave)?;
        let mut gyroscopic = self.of_wave(MatrixKind::Gyroscopic, wave)?;
        for v in &mut stiffness.values {
            *v *= p * p;
        }
        for v in &mut gyroscopic.values {
            *v *= p;
        }
        Ok(Some(Tied { stiffness, gyroscopic }))
    }

    /// Matrix M_h of the inertia −h²ω²M_h, with the terms of a speed tied to the frequency, which grow with ω², too:
    /// M − p²K₁/h² − ipG/h. A nodal diameter is taken as one of the fundamental; for the mean the matrix is M.
    ///
    /// # Errors
    /// As [`Self::wave_matrix`].
    pub fn inertia(&self, wave: Wave) -> Result<Csc> {
        let mass = self.of_wave(MatrixKind::Mass, wave)?;
        let h = match wave {
            Wave::Harmonic(0) => return Ok(mass),
            Wave::Harmonic(h) => h as f64,
            Wave::Diameter(_) => 1.0,
        };
        let Some(tied) = self.tied_to_frequency(wave)? else {
            return Ok(mass);
        };
        let terms = [
            (Complex64::ONE, &mass, Form::Plain),
            (Complex64::new(-1.0 / (h * h), 0.0), &tied.stiffness, Form::Plain),
            (Complex64::new(0.0, -1.0 / h), &tied.gyroscopic, Form::Plain),
        ];
        Csc::sum(self.ndof(), &terms)
    }

    /// Matrix of one kind for a wave.
    ///
    /// # Errors
    /// As [`Self::wave_matrix`].
    pub fn of_wave(&self, which: MatrixKind, wave: Wave) -> Result<Csc> {
        match wave {
            Wave::Harmonic(h) => self.wave_matrix(which, h),
            Wave::Diameter(d) => self.diameter_matrix(which, d),
        }
    }

    /// Modal damping matrix of a residue; `None` without such damping, or without modes of this diameter.
    fn modal_damping_of(&self, residue: usize, real: bool) -> Result<Option<Csc>> {
        let Some((matrix, form)) = self.of_residue(&self.modal_damping, residue) else {
            return Ok(None);
        };
        let mut matrix = Csc::sum(self.ndof(), &[(Complex64::ONE, matrix, form)])?;
        if real {
            for v in &mut matrix.values {
                v.im = 0.0;
            }
        }
        Ok(Some(matrix))
    }

    /// The matrix of a residue in a list by residues; or the matrix of the other sense, to be conjugated.
    fn of_residue<'a>(&self, list: &'a [Option<KeptMatrix>], residue: usize) -> Option<(&'a KeptMatrix, Form)> {
        let at = |residue: usize| list.get(residue).and_then(Option::as_ref);
        let other = (self.sectors() - residue) % self.sectors();
        let own = at(residue).map(|a| (a, Form::Plain));
        own.or_else(|| at(other).map(|a| (a, Form::Conjugated)))
    }

    /// Refuses to conjugate a stiffness that does not follow from real matrices of the sectors: for a loss K(1 + iη),
    /// where A(−d) = A(d)ᵀ, the imaginary part would drive the backward wave.
    fn check_backward(&self, which: MatrixKind, diameter: i64, matrix: &KeptMatrix) -> Result<()> {
        let which = match which {
            MatrixKind::Structural if self.loss_of_stiffness => MatrixKind::Stiffness,
            MatrixKind::Stiffness | MatrixKind::StiffnessSpeed2
                if !matrix.is_real()
                    && matrix.worst_pair(Symmetry::Hermitian).2 > CYCLIC_HERMITIAN * matrix.max_abs() =>
            {
                which
            }
            _ => return Ok(()),
        };
        fail!(
            Unsupported,
            "{} of nodal diameter {} is complex and not Hermitian, and that of the backward wave of this diameter, {diameter}, does not \
             follow from it: give the matrix of diameter {diameter} too, or a loss K(1 + i eta) as loss factor, or as structural matrix \
             eta K",
            which.name(),
            -diameter
        )
    }

    /// Entry (p, p) of the matrix of a harmonic, without its assembly and without Rayleigh damping.
    pub fn wave_diagonal(&self, which: MatrixKind, harmonic: usize, p: usize) -> Complex64 {
        let blocks = &self.blocks[which as usize];
        let residue = self.residue(harmonic as i64);
        let entry = |a: &Option<KeptMatrix>| a.as_ref().map_or(Complex64::ZERO, |a| a.get(p, p));
        let sum = if blocks.diameters.is_empty() {
            let lag = self.lag(residue);
            let previous = if blocks.previous.is_some() {
                &blocks.previous
            } else {
                &blocks.next
            };
            entry(&blocks.own) + lag * entry(&blocks.next) + lag.conj() * entry(previous)
        } else {
            match self.of_residue(&blocks.diameters, residue) {
                Some((a, Form::Plain)) => a.get(p, p),
                Some((a, _)) => a.get(p, p).conj(),
                None => Complex64::ZERO,
            }
        };
        if harmonic == 0 { sum.re.into() } else { sum }
    }

    fn given(&self, which: MatrixKind, residue: usize, real: bool) -> Result<Csc> {
        let n = self.ndof();
        let blocks = &self.blocks[which as usize];
        let mut sum = if blocks.diameters.is_empty() {
            let lag = self.lag(residue);
            let mut terms = Vec::with_capacity(3);
            if let Some(own) = &blocks.own {
                terms.push((Complex64::ONE, own, Form::Plain));
            }
            if let Some(next) = &blocks.next {
                terms.push((lag, next, Form::Plain));
            }
            match (&blocks.previous, &blocks.next) {
                (Some(previous), _) => terms.push((lag.conj(), previous, Form::Plain)),
                (None, Some(next)) => terms.push((lag.conj(), next, Form::Transposed)),
                (None, None) => {}
            }
            Csc::sum(n, &terms)?
        } else {
            let diameter = self.signed_diameter(residue as i64);
            let Some((matrix, form)) = self.of_residue(&blocks.diameters, residue) else {
                return fail!(
                    Argument,
                    "the matrices of nodal diameter {diameter} are needed for this wave or a carried harmonic, but were not given"
                );
            };
            if form == Form::Conjugated {
                self.check_backward(which, diameter, matrix)?;
            }
            Csc::sum(n, &[(Complex64::ONE, matrix, form)])?
        };
        if real {
            for v in &mut sum.values {
                v.im = 0.0;
            }
        }
        Ok(sum)
    }
}

#[cfg(test)]
mod tests {
    use crate::model::Model;
    use num_complex::Complex64;

    #[test]
    fn harmonics_fold_onto_nodal_diameters() {
        let mut model = Model::cyclic(1, 24).unwrap();
        model.set_wave(2);
        let diameters: Vec<i64> = [1, 3, 5, 7, 9, 11, 13, 12]
            .iter()
            .map(|&h| model.structure().diameter_of(h))
            .collect();
        assert_eq!(diameters, [2, 6, 10, -10, -6, -2, 2, 0]);
        model.set_wave(-2);
        assert_eq!(model.structure().diameter_of(1), -2);
        assert_eq!(model.structure().fold(-2), (2, true));
        model.set_wave(12);
        assert_eq!(model.structure().diameter_of(1), 12);
        assert_eq!(model.structure().phase(1, 1), -Complex64::ONE);
        for (engine_order, in_step) in [(0, 1), (2, 12), (-2, 12), (5, 24), (12, 2), (24, 1), (20, 6)] {
            model.set_wave(engine_order);
            assert_eq!(model.structure().in_step(), in_step);
        }
    }
}
