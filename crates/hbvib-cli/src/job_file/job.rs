//! A job file: its keys are the fields of these structs, and others are refused with the nearest known one.

use crate::job_file::job_damper::DamperPart;
use crate::job_file::job_faces::FacesPart;
use crate::job_file::job_files::check_files;
use crate::job_file::job_fit::{DataPart, FitPart};
use crate::job_file::job_life::LifePart;
use crate::job_file::job_motion::{ModalPart, MotionPart, UnitsPart};
use crate::job_file::job_passages::{MissionPart, RunUpPart};
use crate::job_file::job_residual::{ModeBandPart, ResidualPart};
use crate::job_file::job_response::ResponsePart;
use crate::job_file::job_solutions::SolutionsPart;
use crate::job_file::job_static::StaticPart;
use crate::job_file::job_studies::{BandPart, CampbellPart, MapPart, StudyPart, TornadoPart, WheelPart};
use crate::job_file::job_surfaces::SurfacesPart;
use crate::job_file::job_words::AbsentName;
use crate::job_file::job_words::Amplitude;
use crate::job_file::job_words::DofName;
use crate::job_file::job_words::KindName;
use crate::job_file::job_words::NodeList;
use crate::job_file::job_words::SideDof;
use crate::job_file::nearest_name::hint;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// A job.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Job {
    pub model: ModelPart,
    #[serde(default)]
    pub contact: Vec<ContactPart>,
    /// Dampers under platforms, behind all contacts.
    #[serde(default)]
    pub damper: Vec<DamperPart>,
    #[serde(default)]
    pub force: Vec<ForcePart>,
    #[serde(default)]
    pub unbalance: Vec<UnbalancePart>,
    /// Responses that [forced] watches; the first one leads its amplitude and peaks.
    #[serde(default)]
    pub response: Vec<ResponsePart>,
    pub forced: Option<ForcedPart>,
    pub mode: Option<ModePart>,
    pub solutions: Option<SolutionsPart>,
    pub verify: Option<VerifyPart>,
    pub campbell: Option<CampbellPart>,
    pub study: Option<StudyPart>,
    pub map: Option<MapPart>,
    pub tornado: Option<TornadoPart>,
    pub band: Option<BandPart>,
    pub residual: Option<ResidualPart>,
    pub mode_band: Option<ModeBandPart>,
    pub wheel: Option<WheelPart>,
    pub life: Option<LifePart>,
    pub run_up: Option<RunUpPart>,
    pub mission: Option<MissionPart>,
    pub fit: Option<FitPart>,
    /// Data of tests, which [fit] explains.
    #[serde(default)]
    pub data: Vec<DataPart>,
    pub restart: Option<RestartPart>,
    #[serde(default)]
    pub output: OutputPart,
    /// Folder of the job file, on which all paths depend.
    #[serde(skip)]
    pub folder: PathBuf,
    /// The text of the job.
    #[serde(skip)]
    pub text: String,
}

/// An unbalance that rotates with the frequency of the response.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UnbalancePart {
    pub dof_x: usize,
    pub dof_y: usize,
    /// Mass times eccentricity.
    pub m_e: f64,
    #[serde(default)]
    pub phase: f64,
}

/// Matrices and symmetry.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelPart {
    /// One file with all matrices (CalculiX, OP4).
    pub matrices: Option<PathBuf>,
    pub stiffness: Option<PathBuf>,
    pub mass: Option<PathBuf>,
    pub damping: Option<PathBuf>,
    /// D of structural damping iD in harmonics above 0.
    pub structural: Option<PathBuf>,
    /// G of the gyroscopic forces, skew-symmetric.
    pub gyroscopic: Option<PathBuf>,
    /// K1 of the stiffness K + speed^2 K1.
    pub stiffness_speed2: Option<PathBuf>,
    /// Matrices at two speeds, which give the stiffness K + speed^2 K1 in place of matrices.
    #[serde(default)]
    pub at_speed: Vec<AtSpeedPart>,
    /// The stiffness holds stresses of a static load, so that rotations as a whole meet forces.
    #[serde(default)]
    pub prestressed: bool,
    /// Coupling to the next sector.
    pub coupling_stiffness: Option<PathBuf>,
    pub coupling_mass: Option<PathBuf>,
    pub coupling_gyroscopic: Option<PathBuf>,
    pub coupling_stiffness_speed2: Option<PathBuf>,
    /// C += alpha M + beta K
    pub rayleigh: Option<[f64; 2]>,
    /// Structural damping i loss_factor K in harmonics above 0.
    pub loss_factor: Option<f64>,
    /// Damping ratios of the lowest natural modes without contacts, of each nodal diameter.
    #[serde(default)]
    pub modal_damping: Vec<f64>,
    /// Speed of rotation, rad per time unit.
    pub speed: Option<f64>,
    /// Speed over the frequency of the response, instead: 1 / EO.
    pub speed_per_omega: Option<f64>,
    #[serde(default = "one")]
    pub sectors: usize,
    #[serde(default)]
    pub engine_order: i64,
    #[serde(default)]
    pub fixed: Vec<usize>,
    /// Positions and sets of nodes: lines of number, x, y, z, or an Abaqus or CalculiX mesh with *NODE and *NSET.
    pub mesh: Option<PathBuf>,
    pub faces: Option<FacesPart>,
    /// Nodes of the mesh, or directions of a node, that the matrices do not have.
    #[serde(default)]
    pub absent: AbsentName,
    pub expected: Option<ExpectedPart>,
}

/// Stiffness and mass of the structure under the loads of a speed.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AtSpeedPart {
    /// Speed of rotation, rad per time unit.
    pub speed: f64,
    /// File with stiffness and mass.
    pub matrices: PathBuf,
}

/// Values that the finite-element program tells; others, by more than a hundredth, are warnings.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedPart {
    /// Mass of a translation, of the nodes that the matrices have.
    pub total_mass: Option<f64>,
    /// Lowest natural frequency without contacts in the nodal diameter of the engine order, for check.
    pub first_hz: Option<f64>,
}

/// A contact, or one for each pair of two lists.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactPart {
    /// Name for the outputs.
    pub name: Option<String>,
    pub kind: KindName,
    /// Degrees of freedom of side a: one number, those of the directions, or a list of them, one for each pair; or their names, as
    /// "33.2".
    #[serde(default)]
    pub a: Vec<SideDof>,
    /// Those of side b; -1 is the ground.
    #[serde(default)]
    pub b: Vec<SideDof>,
    /// Instead of a and b: two lists of nodes that are matched by their distance.
    pub nodes: Option<NodesPart>,
    /// Instead of a and b: faces of the mesh on both sides, which need not match.
    pub surfaces: Option<SurfacesPart>,
    /// Preload and gap of each pair from a static step.
    #[serde(rename = "static")]
    pub at_rest: Option<StaticPart>,
    /// Constant forces hold the preload at rest, as stresses do that the matrices do not tell; with a static step they always do.
    #[serde(default)]
    pub balanced: bool,
    #[serde(default)]
    pub sector_offset: i64,
    #[serde(default)]
    pub kt: f64,
    #[serde(default)]
    pub kn: f64,
    #[serde(default)]
    pub mu: f64,
    #[serde(default)]
    pub preload: f64,
    /// Growth of the preload with the square of the speed.
    #[serde(default)]
    pub per_speed2: f64,
    #[serde(default)]
    pub gap: f64,
    #[serde(default)]
    pub cubic: f64,
    #[serde(default)]
    pub velocity: f64,
    /// From side b to side a.
    pub normal: Option<[f64; 3]>,
    /// Accepts a normal that the positions of the pairs contradict, as where meshes overlap.
    #[serde(default)]
    pub any_normal: bool,
    pub tangent: Option<[f64; 3]>,
}

/// Two lists of nodes, each node of a matched with the nearest one of b.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NodesPart {
    pub a: NodeList,
    pub b: NodeList,
    /// x, y, z of each node of a.
    #[serde(default)]
    pub a_coordinates: Vec<[f64; 3]>,
    #[serde(default)]
    pub b_coordinates: Vec<[f64; 3]>,
    /// File with the positions of these nodes, instead of model.mesh.
    pub coordinates: Option<PathBuf>,
    /// Largest distance of a pair.
    pub largest_distance: f64,

    /// Area of each node of a, or one for all: kt, kn and cubic are then given per area, and preload is a pressure.
    #[serde(default)]
    pub areas: Vec<f64>,
}

/// A force Re(value exp(i harmonic omega t)).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ForcePart {
    pub dof: DofName,
    #[serde(default = "one")]
    pub harmonic: usize,
    pub value: Amplitude,
}

/// A forced response.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ForcedPart {
    pub from_hz: f64,
    pub to_hz: f64,
    #[serde(default)]
    pub at_hz: Vec<f64>,
    /// A fixed highest harmonic, instead of a tolerance.
    pub harmonics: Option<usize>,
    pub tolerance: Option<f64>,
    pub response_dof: Option<DofName>,
    #[serde(default)]
    pub estimate_error: bool,
    /// Holds the tolerance for the norm of all responses instead of for each.
    #[serde(default)]
    pub together: bool,
    /// Stability of each point: unstable stretches are dashed in figures.
    pub stability: Option<WavesName>,
    /// Free sliders of each point: contacts that stick through the period and change the response, with its derivatives by their
    /// places.
    #[serde(default)]
    pub freedom: bool,
}

/// Perturbations of which stability is told.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum WavesName {
    Wave,
    Wheel,
}

/// A nonlinear mode.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModePart {
    #[serde(default)]
    pub index: usize,
    pub log10_from: f64,
    pub log10_to: f64,
    pub harmonics: Option<usize>,
    pub tolerance: Option<f64>,
    pub response_dof: Option<DofName>,
    #[serde(default)]
    pub estimate_error: bool,
}

/// Points of a branch.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum PointsName {
    /// The highest peak, or the highest point where there is no peak.
    #[default]
    HighestPeak,
    Peaks,
    /// The solutions at at_hz.
    Requested,
}

/// Method that finds a steady state in time.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum MethodName {
    #[default]
    Shooting,
    Marching,
}

/// Comparison of points of the forced response with integration in time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VerifyPart {
    #[serde(default)]
    pub points: PointsName,
    #[serde(default)]
    pub method: MethodName,
    /// Largest change of a steady state over one period, relative.
    pub tolerance: Option<f64>,
    pub max_periods: Option<usize>,
    /// Largest distance, relative to the motion in time, at which both are the same solution.
    pub same_within: Option<f64>,
    pub csv: Option<PathBuf>,
}

/// A response of the same job that was stopped, and goes on.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RestartPart {
    /// File of [output], npz; the new one may have its name.
    pub from: PathBuf,
}

/// Files that are written.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputPart {
    pub csv: Option<PathBuf>,
    pub npz: Option<PathBuf>,
    /// SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
    /// Slip fraction of each contact over frequency, CSV.
    pub slip_csv: Option<PathBuf>,
    /// The same as a figure, a row for each contact.
    pub slip_figure: Option<PathBuf>,
    /// Motion of the mesh over the period at points of the curve, for ParaView: a list of times (.pvd) beside a folder with its name.
    pub vtu: Option<PathBuf>,
    /// Universal file: nodes (2411), the response over frequency (58), shapes at points of the curve (55).
    pub uff: Option<PathBuf>,
    /// All harmonics of all points by node and direction, with units (NetCDF).
    pub netcdf: Option<PathBuf>,
    /// Shapes at points of the curve, for CalculiX and what reads its results.
    pub frd: Option<PathBuf>,
    /// One page of HTML with figures and tables, which needs no network.
    pub report: Option<PathBuf>,
    /// Points and times of vtu, uff, frd and modal.
    #[serde(default)]
    pub motion: MotionPart,
    pub modal: Option<ModalPart>,
    #[serde(default)]
    pub units: UnitsPart,
    #[serde(default)]
    pub hysteresis: Vec<HysteresisPart>,
}

/// Hysteresis loops of one contact.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HysteresisPart {
    /// Name of a contact; without a name its number, from 1.
    pub contact: String,
    /// Number of the pair, from 0, where the contact has several.
    #[serde(default)]
    pub pair: usize,
    #[serde(default)]
    pub points: PointsName,
    /// Times of a period.
    #[serde(default = "samples")]
    pub samples: usize,
    pub csv: Option<PathBuf>,
    /// SVG or, where its name ends with .png, PNG.
    pub figure: Option<PathBuf>,
}

fn one() -> usize {
    1
}

fn samples() -> usize {
    256
}

impl Job {
    /// Reads a job.
    ///
    /// # Errors
    /// A sentence with file and line; the nearest known key for one that is unknown.
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: cannot be read: {e}", path.display()))?;
        let job = Self::parse(&text, path.parent().unwrap_or(Path::new("")));
        let job = job.map_err(|e| format!("{}: {e}", path.display()))?;
        check_files(&text, path, &job.folder).map_err(|e| format!("{}: {e}", path.display()))?;
        let model = &job.model;
        if model.engine_order != 0 && model.sectors == 1 && model.faces.is_none() {
            return Err(format!(
                "{}: [model]: engine_order = {} without sectors has no meaning: needs sectors, the number of them",
                path.display(),
                model.engine_order
            ));
        }
        if job.forced.is_some() && job.mode.is_some() {
            return Err(format!(
                "{}: names two analyses: needs one of [forced] and [mode]",
                path.display()
            ));
        }
        if job.solutions.is_some() && job.forced.is_none() && job.mode.is_none() {
            return Err(format!("{}: [solutions] needs [forced] or [mode]", path.display()));
        }
        if job.verify.is_some() && job.forced.is_none() {
            return Err(format!("{}: [verify] needs [forced]", path.display()));
        }
        if job.restart.is_some() && job.forced.is_none() {
            return Err(format!("{}: [restart] needs [forced]", path.display()));
        }
        if !job.response.is_empty() && job.forced.is_none() {
            return Err(format!("{}: [[response]] needs [forced]", path.display()));
        }
        if !job.data.is_empty() && job.fit.is_none() {
            return Err(format!("{}: [[data]] needs [fit]", path.display()));
        }
        if job.response.is_empty() && job.forced.as_ref().is_some_and(|part| part.together) {
            return Err(format!("{}: [forced]: together needs [[response]]", path.display()));
        }
        Ok(job)
    }

    /// A job from its text, with the folder on which its paths depend.
    ///
    /// # Errors
    /// A sentence with the line; the nearest known key for one that is unknown.
    pub fn parse(text: &str, folder: &Path) -> Result<Self, String> {
        let job: Result<Self, _> = toml::from_str(text);
        let mut job = job.map_err(|e| format!("{}{}", e.to_string().trim_end(), hint(e.message())))?;
        folder.clone_into(&mut job.folder);
        text.clone_into(&mut job.text);
        Ok(job)
    }

    /// Refuses a job that names no analysis.
    ///
    /// # Errors
    /// A sentence.
    pub fn needs_analysis(&self, path: &Path) -> Result<(), String> {
        let named = [
            self.forced.is_some(),
            self.mode.is_some(),
            self.campbell.is_some(),
            self.study.is_some(),
            self.map.is_some(),
            self.tornado.is_some(),
            self.band.is_some(),
            self.residual.is_some(),
            self.mode_band.is_some(),
            self.wheel.is_some(),
            self.life.is_some(),
            self.run_up.is_some(),
            self.mission.is_some(),
            self.fit.is_some(),
        ];
        if !named.contains(&true) {
            return Err(format!(
                "{}: names no analysis: needs [forced], [mode], [campbell], [study], [map], [tornado], [band], [residual], \
                 [mode_band], [wheel], [life], [run_up], [mission] or [fit]",
                path.display()
            ));
        }
        Ok(())
    }

    /// A path of the job.
    pub fn path(&self, path: &Path) -> PathBuf {
        self.folder.join(path)
    }
}
