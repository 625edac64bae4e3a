//! Motion of every node of a mesh from the harmonics of the degrees of freedom.

use crate::building::built::Built;
use crate::job_file::job::Job;
use crate::job_file::job_faces::FrameName;
use crate::meshes::positions::turned;
use crate::texts::outcome::Outcome;
use hbvib::{Branch, Contact, State};
use hbvib_io::RelativeCoordinates;
use num_complex::Complex64;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Nodes whose motion is written, in the order of the files of results.
pub struct Places {
    /// Number of each node.
    pub numbers: Vec<i64>,
    /// Position of each node; empty where no mesh is known.
    pub at: Vec<[f64; 3]>,
    /// Rows of each node along x, y and z; -1 where the matrices have none.
    rows: Vec<[i64; 3]>,
    /// Place of each number.
    place: HashMap<i64, usize>,
    /// Directions of rows are radius, circumference and axis at each node.
    cylindrical: bool,
    axis: [f64; 3],
    /// Sense in which the next sector follows.
    direction: f64,
    sectors: usize,
    engine_order: i64,
    /// Motions of contacts between surfaces, which are relative to others.
    relative: Option<RelativeCoordinates>,
}

impl Places {
    /// All nodes of the mesh that elements use or that have rows; without a mesh the nodes that the matrices name.
    ///
    /// # Errors
    /// A sentence where neither names nodes.
    pub fn of(job: &Job, built: &Built) -> Outcome<Self> {
        let nodes = &built.nodes;
        let named = nodes.numbers();
        if named.is_empty() {
            return Err(
                "the matrices name no nodes: needs those of CalculiX, Abaqus or Nastran, whose rows have names".into(),
            );
        }
        let mut numbers = named;
        if let Some(mesh) = &nodes.mesh {
            // Internal nodes of elements are in no mesh.
            numbers.retain(|number| mesh.position(*number).is_ok());
            numbers.extend(mesh.drawn().into_iter().flat_map(|element| &element.nodes));
            numbers.sort_unstable();
            numbers.dedup();
        }
        let mut at = Vec::new();
        if let Some(mesh) = &nodes.mesh {
            for number in &numbers {
                at.push(mesh.position(*number)?);
            }
        }
        let faces = job.model.faces.as_ref();
        let cylindrical = faces.is_some_and(|faces| faces.frame == FrameName::Cylindrical);
        if cylindrical && at.is_empty() {
            return Err("directions of a cylindrical frame need the positions of a mesh in [model]".into());
        }
        Ok(Self {
            rows: numbers.iter().map(|number| nodes.rows_of(*number)).collect(),
            place: numbers.iter().enumerate().map(|(i, number)| (*number, i)).collect(),
            numbers,
            at,
            cylindrical,
            axis: faces.map_or([0.0, 0.0, 1.0], |faces| faces.axis),
            direction: faces.map_or(1.0, |faces| faces.direction as f64),
            sectors: job.model.sectors,
            engine_order: job.model.engine_order,
            relative: nodes.relative.clone(),
        })
    }

    /// Refuses nodes without positions.
    ///
    /// # Errors
    /// A sentence.
    pub fn needs_mesh(&self) -> Outcome<()> {
        if self.at.is_empty() {
            return Err("needs the positions of a mesh: mesh = \"wheel.inp\" in [model]".into());
        }
        Ok(())
    }

    /// Place of a node.
    pub fn place(&self, number: i64) -> Option<usize> {
        self.place.get(&number).copied()
    }

    /// Whether a node has a row; others are fixed, or follow others by a constraint.
    pub fn moves(&self, i: usize) -> bool {
        self.rows[i].iter().any(|row| *row >= 0)
    }

    /// Motion of each node along x, y and z, from one harmonic of all degrees of freedom.
    pub fn motion(&self, x: &[Complex64]) -> Vec<[Complex64; 3]> {
        let mut recovered = x.to_vec();
        if let Some(relative) = &self.relative {
            relative.recover(&mut recovered);
        }
        let x = recovered;
        let of = |row: i64| usize::try_from(row).ok().and_then(|row| x.get(row)).copied();
        let all = self.rows.iter().enumerate();
        all.map(|(i, rows)| {
            let u = rows.map(|row| of(row).unwrap_or_default());
            if self.cylindrical { self.in_space(i, u) } else { u }
        })
        .collect()
    }

    /// Motion along radius, circumference and axis as one along x, y and z.
    fn in_space(&self, i: usize, u: [Complex64; 3]) -> [Complex64; 3] {
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let n = self.axis.map(|a| a / dot(self.axis, self.axis).sqrt());
        let x = self.at[i];
        let along = dot(x, n);
        let across = [0, 1, 2].map(|k| x[k] - along * n[k]);
        let radius = dot(across, across).sqrt();
        if radius == 0.0 {
            return u;
        }
        let r = across.map(|x| x / radius);
        let t = [
            n[1] * r[2] - n[2] * r[1],
            n[2] * r[0] - n[0] * r[2],
            n[0] * r[1] - n[1] * r[0],
        ];
        [0, 1, 2].map(|k| u[0] * r[k] + u[1] * t[k] + u[2] * n[k])
    }

    /// Number of sectors.
    pub fn sectors(&self) -> usize {
        self.sectors
    }

    /// A vector or position of the first sector in another one.
    pub fn turned(&self, x: [f64; 3], sector: usize) -> [f64; 3] {
        if sector == 0 {
            return x;
        }
        turned(x, self.axis, self.direction * TAU * sector as f64 / self.sectors as f64)
    }

    /// Motion of each node at a share of the period, in a sector of the wave: sector s + 1 lags.
    pub fn at_phase(&self, harmonics: &[Vec<[Complex64; 3]>], phase: f64, sector: usize) -> Vec<[f64; 3]> {
        let lag = self.engine_order as f64 * sector as f64 / self.sectors as f64;
        let turns: Vec<Complex64> = (0..harmonics.len())
            .map(|h| Complex64::cis(TAU * h as f64 * (phase - lag)))
            .collect();
        (0..self.numbers.len())
            .map(|i| {
                let mut u = [0.0; 3];
                for (all, turn) in harmonics.iter().zip(&turns) {
                    for (u, x) in u.iter_mut().zip(&all[i]) {
                        *u += (x * turn).re;
                    }
                }
                self.turned(u, sector)
            })
            .collect()
    }

    /// Number of steps of a period by which a sector lags, of `steps` times the number of sectors.
    pub fn lag(&self, steps: usize, sector: usize) -> usize {
        let all = (steps * self.sectors) as i64;
        (self.engine_order * sector as i64 * steps as i64).rem_euclid(all) as usize
    }

    /// Places of the nodes on both sides of a contact.
    pub fn of_contact(&self, contact: &Contact, built: &Built) -> Vec<usize> {
        let sides = contact.dof_a.iter().chain(&contact.dof_b).flatten();
        let all = sides.chain(&contact.dofs);
        let mut places: Vec<usize> = all.filter_map(|dof| self.place(built.nodes.node_of(*dof)?)).collect();
        places.sort_unstable();
        places.dedup();
        places
    }
}

/// Motion of all nodes in each harmonic of a point of a branch.
///
/// # Errors
/// Those of the library.
pub fn harmonics(places: &Places, branch: &Branch, point: usize) -> Outcome<Vec<Vec<[Complex64; 3]>>> {
    let (rows, ndof) = (branch.harmonics() + 1, branch.ndof());
    let mut x = vec![Complex64::ZERO; rows * ndof];
    branch.harmonics_at(point, &mut x).map_err(|e| e.to_string())?;
    Ok(x.chunks_exact(ndof).map(|x| places.motion(x)).collect())
}

/// State of the contacts at the nodes over a period: one entry a node of a contact.
pub struct ContactField {
    /// Places of the nodes.
    pub places: Vec<usize>,
    /// 1 sticks, 2 slips, 3 is open, at each step of the period and each node.
    pub state: Vec<Vec<u8>>,
    /// Force along the normal and in the plane of the contact, likewise.
    pub normal: Vec<Vec<f64>>,
    pub tangential: Vec<Vec<f64>>,
    /// Share of the period in which the node slips, or is open.
    pub slip_share: Vec<f64>,
    pub open_share: Vec<f64>,
}

impl ContactField {
    /// Loops of all contacts of a point, at `steps` times of a period. A node of several contacts has the largest state, and the
    /// root of the sum of squares of their forces.
    ///
    /// # Errors
    /// Those of the library.
    pub fn of(places: &Places, built: &Built, branch: &Branch, (point, steps): (usize, usize)) -> Outcome<Self> {
        let contacts = built.model.contacts();
        let of: Vec<Vec<usize>> = contacts
            .iter()
            .map(|contact| places.of_contact(contact, built))
            .collect();
        let mut nodes: Vec<usize> = of.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let number: HashMap<usize, usize> = nodes.iter().enumerate().map(|(i, place)| (*place, i)).collect();
        let count = nodes.len();
        let mut field = Self {
            places: nodes,
            state: vec![vec![0; count]; steps],
            normal: vec![vec![0.0; count]; steps],
            tangential: vec![vec![0.0; count]; steps],
            slip_share: vec![0.0; count],
            open_share: vec![0.0; count],
        };
        for (id, contact) in contacts.iter().enumerate().filter(|(id, _)| !of[*id].is_empty()) {
            let one = branch
                .contact_loop(point, id, steps)
                .map_err(|e| format!("contact {id}: {e}"))?;
            let summary = branch
                .contact_summary(point, id)
                .map_err(|e| format!("contact {id}: {e}"))?;
            let along = contact.normal_direction();
            for place in &of[id] {
                let i = number[place];
                for step in 0..steps {
                    let state = match one.state[step] {
                        State::Stick => 1,
                        State::Slip => 2,
                        State::Open => 3,
                    };
                    field.state[step][i] = field.state[step][i].max(state);
                    for d in 0..one.directions {
                        let force = one.force[step * one.directions + d];
                        let of = if along == Some(d) {
                            &mut field.normal
                        } else {
                            &mut field.tangential
                        };
                        of[step][i] = of[step][i].hypot(force);
                    }
                }
                field.slip_share[i] = field.slip_share[i].max(summary.slip_share);
                field.open_share[i] = field.open_share[i].max(summary.open_share);
            }
        }
        Ok(field)
    }
}
