//! The report of `check` on a model beside its matrices: centre of mass, rigid motions, frequencies of each diameter, faces, and
//! contacts at rest. The same facts are lines of text and JSON.

use crate::building::built::Built;
use crate::job_file::job::Job;
use crate::static_steps::static_contacts::at_rest;
use crate::texts::counted::counted;
use hbvib::{Constant, ContactState, Interrupt};
use serde::Serialize;
use std::f64::consts::TAU;
use std::path::Path;

/// Rows that are named.
const NAMED: usize = 10;

/// Frequencies of a diameter.
const LISTED: usize = 3;

/// Degrees of freedom times diameters up to which all diameters are computed.
const ALL_DIAMETERS: usize = 50_000;

/// Degrees of freedom up to which contacts at rest are computed.
const AT_REST: usize = 20_000;

/// Facts about a model.
#[derive(Debug, Serialize)]
pub struct ModelReport {
    pub job: String,
    pub degrees_of_freedom: usize,
    pub sectors: usize,
    pub engine_order: i64,
    pub forces: usize,
    /// Along x, y and z, of one sector.
    pub mass: Option<[f64; 3]>,
    pub centre_of_mass: Option<[f64; 3]>,
    pub rows_without_mass: Rows,
    pub frequencies: Vec<Frequencies>,
    pub faces: Vec<FacePair>,
    pub contacts: Vec<ContactEntry>,
    pub facts: Vec<String>,
    pub warnings: Vec<String>,
}

/// Rows, the first of them by name.
#[derive(Debug, Serialize)]
pub struct Rows {
    pub count: usize,
    pub first: Vec<String>,
}

/// Natural frequencies of a nodal diameter.
#[derive(Debug, Serialize)]
pub struct Frequencies {
    pub diameter: i64,
    pub rigid_motions: usize,
    pub free_hz: Vec<f64>,
    pub stuck_hz: Vec<f64>,
}

/// A pair of nodes of the faces.
#[derive(Debug, Serialize)]
pub struct FacePair {
    pub left: i64,
    pub right: i64,
    /// Distance of the right node from the image of the left one.
    pub distance: f64,
}

/// The contacts of an entry of the job.
#[derive(Debug, Serialize)]
pub struct ContactEntry {
    pub name: String,
    pub law: String,
    /// From side b to side a.
    pub normal: Option<[f64; 3]>,
    pub pairs: Vec<Pair>,
}

/// A contact.
#[derive(Debug, Serialize)]
pub struct Pair {
    /// Degrees of freedom by node and direction, or by number.
    pub a: Vec<String>,
    pub b: Vec<String>,
    pub area: Option<f64>,
    /// Gap of the law, and distance of the nodes in the mesh.
    pub gap: f64,
    pub distance: Option<f64>,
    /// At rest, under constant loads and preload.
    pub normal_force: Option<f64>,
    pub friction_force: Option<f64>,
    pub closed: Option<bool>,
}

impl ModelReport {
    /// The report; what cannot be computed is a warning.
    pub fn of(path: &Path, job: &Job, built: &Built) -> Self {
        let model = &built.model;
        let structure = model.structure();
        let mut warnings = Vec::new();
        let frequencies = frequencies(built, &mut warnings);
        let total = &built.report.total_mass;
        let empty: Vec<usize> = (0..built.moved_mass.len())
            .filter(|row| built.moved_mass[*row] == 0.0)
            .collect();
        let mut report = Self {
            job: path.display().to_string(),
            degrees_of_freedom: model.ndof(),
            sectors: structure.sectors(),
            engine_order: structure.engine_order(),
            forces: model.excitation().forces().len(),
            mass: <[f64; 3]>::try_from(&total[..]).ok(),
            centre_of_mass: centre_of_mass(built),
            rows_without_mass: Rows {
                count: empty.len(),
                first: empty.iter().take(NAMED).map(|row| built.nodes.name_of(*row)).collect(),
            },
            contacts: contacts(job, built, &frequencies, &mut warnings),
            frequencies,
            faces: built
                .face_pairs
                .iter()
                .map(|(left, right, distance)| FacePair {
                    left: *left,
                    right: *right,
                    distance: *distance,
                })
                .collect(),
            facts: Vec::new(),
            warnings,
        };
        report.facts = report.lines();
        report
    }

    /// Lines of text.
    fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if let Some([x, y, z]) = self.centre_of_mass {
            lines.push(format!("centre of mass: [{x:.6e}, {y:.6e}, {z:.6e}]"));
        }
        if self.rows_without_mass.count > 0 {
            lines.push(format!(
                "{} without mass in a translation: {}{}",
                counted(self.rows_without_mass.count, "row"),
                self.rows_without_mass.first.join(", "),
                if self.rows_without_mass.count > NAMED {
                    ", ..."
                } else {
                    ""
                }
            ));
        }
        for of in &self.frequencies {
            let listed = |all: &[f64]| all.iter().map(|f| format!("{f:.6}")).collect::<Vec<_>>().join(", ");
            let rigid = match of.rigid_motions {
                0 => String::new(),
                n => format!("; {} left without contacts", counted(n, "rigid motion")),
            };
            lines.push(format!(
                "diameter {}: free {} Hz; stuck {} Hz{rigid}",
                of.diameter,
                listed(&of.free_hz),
                listed(&of.stuck_hz)
            ));
        }
        if !self.faces.is_empty() {
            let farthest = self.faces.iter().max_by(|a, b| a.distance.total_cmp(&b.distance));
            let told = farthest.map_or(String::new(), |pair| {
                format!(
                    ", the farthest {:.3e} apart: {} and {}",
                    pair.distance, pair.left, pair.right
                )
            });
            lines.push(format!("faces: {} of nodes{told}", counted(self.faces.len(), "pair")));
        }
        lines.extend(self.contacts.iter().map(ContactEntry::line));
        lines
    }
}

impl ContactEntry {
    fn line(&self) -> String {
        let mut parts = vec![format!(
            "contact {}: {} of {}",
            self.name,
            counted(self.pairs.len(), "pair"),
            self.law
        )];
        if let Some([x, y, z]) = self.normal {
            parts.push(format!("normal [{x}, {y}, {z}]"));
        }
        let all = |of: fn(&Pair) -> Option<f64>| self.pairs.iter().filter_map(of).collect::<Vec<_>>();
        let range = |values: &[f64]| {
            let (low, high) = values
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
            if high - low <= 1e-9 * high.abs() {
                format!("{high:.4e}")
            } else {
                format!("{low:.4e} to {high:.4e}")
            }
        };
        let areas = all(|pair| pair.area);
        if !areas.is_empty() {
            parts.push(format!("area {:.6e} in all", areas.iter().sum::<f64>()));
        }
        let distances = all(|pair| pair.distance);
        if !distances.is_empty() {
            parts.push(format!("nodes {} apart", range(&distances)));
        }
        let gaps = all(|pair| Some(pair.gap));
        if gaps.iter().any(|gap| *gap != 0.0) {
            parts.push(format!("gap {}", range(&gaps)));
        }
        let forces = all(|pair| pair.normal_force);
        if !forces.is_empty() {
            let closed = self.pairs.iter().filter(|pair| pair.closed == Some(true)).count();
            parts.push(format!(
                "at rest normal force {}, {:.4e} in all, friction force {}; {closed} closed, {} open",
                range(&forces),
                forces.iter().sum::<f64>(),
                range(&all(|pair| pair.friction_force)),
                forces.len() - closed
            ));
        }
        parts.join(", ")
    }
}

/// The first moment of the mass that moves along x, over that mass.
fn centre_of_mass(built: &Built) -> Option<[f64; 3]> {
    let mesh = built.nodes.mesh.as_ref()?;
    let (mut mass, mut moment) = (0.0, [0.0; 3]);
    for node in built.nodes.numbers() {
        let row = usize::try_from(built.nodes.rows_of(node)[0]).ok();
        let Some(moved) = row.and_then(|row| built.moved_mass.get(row)) else {
            continue;
        };
        let Ok(x) = mesh.position(node) else {
            // Internal nodes of elements carry no mass.
            if *moved == 0.0 {
                continue;
            }
            return None;
        };
        mass += moved;
        for (sum, x) in moment.iter_mut().zip(x) {
            *sum += moved * x;
        }
    }
    (mass > 0.0).then(|| moment.map(|sum| sum / mass))
}

/// Frequencies of all diameters, or of 0 and that of the engine order where all would take long.
fn frequencies(built: &Built, warnings: &mut Vec<String>) -> Vec<Frequencies> {
    let model = &built.model;
    let structure = model.structure();
    if structure.ndof() > AT_REST {
        return Vec::new();
    }
    let least = if model.has_equal_senses() { 0 } else { i64::MIN };
    let mut diameters: Vec<i64> = structure.all_diameters().filter(|d| *d >= least).collect();
    if structure.ndof() * diameters.len() > ALL_DIAMETERS {
        let signed = structure.signed_diameter(structure.engine_order());
        let wave = if least == 0 { signed.abs() } else { signed };
        diameters.retain(|d| *d == 0 || *d == wave);
    }
    let count = LISTED.min(structure.ndof());
    let mut all = Vec::new();
    for diameter in diameters {
        let hertz = |state| -> hbvib::Result<Vec<f64>> {
            Ok(model
                .lowest_modes(diameter, state, count)?
                .omega
                .iter()
                .map(|w| w / TAU)
                .collect())
        };
        let found = (
            model.rigid_modes(diameter, &Interrupt::none()),
            hertz(ContactState::Free),
            hertz(ContactState::Stuck),
        );
        match found {
            (Ok(rigid_motions), Ok(free_hz), Ok(stuck_hz)) => all.push(Frequencies {
                diameter,
                rigid_motions,
                free_hz,
                stuck_hz,
            }),
            (Err(e), ..) | (_, Err(e), _) | (.., Err(e)) => warnings.push(format!("diameter {diameter}: {e}")),
        }
    }
    all
}

/// Contacts by entry, with their forces at rest below the first frequency.
fn contacts(job: &Job, built: &Built, frequencies: &[Frequencies], warnings: &mut Vec<String>) -> Vec<ContactEntry> {
    let model = &built.model;
    let lowest = frequencies.iter().flat_map(|of| &of.stuck_hz).filter(|f| **f > 0.0);
    let lowest = lowest.copied().fold(f64::INFINITY, f64::min);
    let rest = if model.ndof() <= AT_REST && lowest.is_finite() {
        at_rest(built, 0.3 * TAU * lowest).unwrap_or_else(|e| {
            warnings.push(format!("contacts at rest: {e}"));
            Vec::new()
        })
    } else {
        Vec::new()
    };
    let name = |dofs: &[Option<usize>; 3]| dofs.iter().flatten().map(|dof| built.nodes.name_of(*dof)).collect();
    let position = |dofs: &[Option<usize>; 3]| {
        dofs.iter()
            .flatten()
            .find_map(|dof| built.nodes.position_of(*dof as i64))
    };
    let entries = built.names.iter().zip(&job.contact);
    entries
        .map(|((entry, range), part)| ContactEntry {
            name: entry.clone(),
            law: model
                .contacts()
                .get(range.start)
                .map_or("", |contact| contact.law_name())
                .to_owned(),
            normal: part.normal,
            pairs: range
                .clone()
                .map(|id| {
                    let contact = &model.contacts()[id];
                    let both = position(&contact.dof_a).zip(position(&contact.dof_b));
                    let rest = rest.get(id);
                    Pair {
                        a: name(&contact.dof_a),
                        b: name(&contact.dof_b),
                        area: built.areas.get(id).copied().flatten(),
                        gap: contact.constant(Constant::Gap),
                        distance: both.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])),
                        normal_force: rest.map(|rest| rest.normal),
                        friction_force: rest.map(|rest| rest.tangential),
                        closed: rest.map(|rest| !rest.open),
                    }
                })
                .collect(),
        })
        .collect()
}
