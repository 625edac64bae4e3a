//! The linear structure as bytes: the map of its degrees of freedom, its matrices, its damping and its speed.

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::error::{Result, try_push, try_vec};
use crate::model::matrices::blocks::Blocks;
use crate::model::matrices::degree_map::DegreeMap;
use crate::model::matrices::sector_faces::{Faces, SectorDescription, SectorFrame};
use crate::model::matrices::speed::Speed;
use crate::model::matrices::structure::{KINDS, Structure};
use crate::model::saved::saved_matrix;
use std::sync::Arc;

const CONTEXT: &str = "a loaded structure";

/// Largest deviation of the length of the axis from 1.
/// Kind: rounding.
const SAVED_STRUCTURE_UNIT: f64 = 1e-9;

/// Writes the structure as bytes.
pub(crate) fn save_to(structure: &Structure, out: &mut ByteWriter<'_>) {
    out.count(structure.degrees.given());
    out.count(structure.sectors);
    out.i64(structure.engine_order);
    save_degrees(&structure.degrees, out);
    for blocks in structure.blocks.iter() {
        for block in [&blocks.own, &blocks.next, &blocks.previous] {
            saved_matrix::save(block.as_ref(), out);
        }
        saved_matrix::save_list(&blocks.diameters, out);
    }
    for value in [structure.rayleigh.0, structure.rayleigh.1, structure.loss_factor] {
        out.f64(value);
    }
    let (per_omega, speed) = match structure.speed {
        Speed::Fixed(speed) => (false, speed),
        Speed::PerOmega(p) => (true, p),
    };
    out.bool(per_omega);
    out.f64(speed);
    saved_matrix::save_list(&structure.modal_damping, out);
}

/// Reads a structure from bytes.
pub(crate) fn load_from(input: &mut ByteReader<'_>) -> Result<Structure> {
    let (given, sectors) = (input.count()?, input.count()?);
    let mut structure = Structure::new(given, sectors)?;
    structure.engine_order = input.i64()?;
    structure.degrees = load_degrees(&structure, input)?;
    let n = structure.ndof();
    // Residues of all nodal diameters, or of those that are not negative.
    let diameters = [sectors / 2 + 1, sectors];
    let mut all: [Blocks; KINDS] = Default::default();
    for blocks in &mut all {
        *blocks = Blocks {
            own: saved_matrix::load(n, input)?,
            next: saved_matrix::load(n, input)?,
            previous: saved_matrix::load(n, input)?,
            diameters: saved_matrix::load_list(n, diameters, input)?,
        };
        let coupled = blocks.next.is_some() || blocks.previous.is_some();
        if (coupled && sectors == 1) || ((coupled || blocks.own.is_some()) && !blocks.diameters.is_empty()) {
            return Err(input.damaged("blocks of a matrix contradict each other"));
        }
    }
    structure.blocks = Arc::new(all);
    structure.rayleigh = (input.finite()?, input.finite()?);
    structure.loss_factor = input.finite()?;
    if structure.loss_factor < 0.0 {
        return Err(input.damaged("the loss factor is negative"));
    }
    structure.speed = match (input.bool()?, input.finite()?) {
        (false, speed) => Speed::Fixed(speed),
        (true, p) => Speed::PerOmega(p),
    };
    structure.modal_damping = saved_matrix::load_list(n, diameters, input)?;
    Ok(structure)
}

pub(crate) fn save_degrees(degrees: &DegreeMap, out: &mut ByteWriter<'_>) {
    let Some(fixed) = degrees.fixed() else {
        out.bool(false);
        return;
    };
    out.bool(true);
    for &fixed in fixed {
        out.bool(fixed);
    }
    let of_wheel = degrees.faces_of_wheel();
    let Some(faces) = degrees.faces().or(of_wheel.map(|(faces, _)| faces)) else {
        out.bool(false);
        return;
    };
    out.bool(true);
    // A plain structure with faces is a whole wheel.
    if let Some((faces, of_sector)) = of_wheel {
        out.count(faces.sectors);
        out.count(of_sector);
    }
    out.count(faces.components);
    out.bool(faces.frame == SectorFrame::Cylindrical);
    out.bool(faces.forward);
    for x in faces.axis {
        out.f64(x);
    }
    out.count(faces.left.len());
    for dof in faces.left.iter().chain(&faces.right) {
        out.optional(*dof);
    }
}

fn load_degrees(structure: &Structure, input: &mut ByteReader<'_>) -> Result<DegreeMap> {
    let ndof = structure.degrees.given();
    if !input.bool()? {
        return Ok(DegreeMap::identity(ndof));
    }
    if ndof > input.left() {
        return Err(input.damaged("marks of fixed degrees of freedom are missing"));
    }
    let mut fixed = try_vec(ndof, false, CONTEXT)?;
    for fixed in &mut fixed {
        *fixed = input.bool()?;
    }
    if !input.bool()? {
        return DegreeMap::new(fixed, None);
    }
    if structure.sectors > 1 {
        let faces = load_faces(structure, ndof, structure.sectors, input)?;
        return DegreeMap::new(fixed, Some(faces));
    }
    let (sectors, of_sector) = (input.count()?, input.count()?);
    if sectors < 2 || of_sector.checked_mul(sectors).is_none_or(|all| all > ndof) {
        return Err(input.damaged("the sectors of a wheel are more than its degrees of freedom"));
    }
    let faces = load_faces(structure, of_sector, sectors, input)?;
    DegreeMap::of_wheel(fixed, faces, of_sector)
}

fn load_faces(structure: &Structure, ndof: usize, sectors: usize, input: &mut ByteReader<'_>) -> Result<Faces> {
    let components = input.count()?;
    let frame = if input.bool()? {
        SectorFrame::Cylindrical
    } else {
        SectorFrame::Cartesian
    };
    let forward = input.bool()?;
    let axis = [input.finite()?, input.finite()?, input.finite()?];
    // As it was stored, not made to a unit vector again: that could change its last bit.
    if (axis.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() > SAVED_STRUCTURE_UNIT {
        return Err(input.damaged("the axis is no unit vector"));
    }
    let count = input.entries(16)?;
    let mut sides = [Vec::new(), Vec::new()];
    for side in &mut sides {
        for _ in 0..count {
            try_push(side, input.optional()?, CONTEXT)?;
        }
    }
    let description = SectorDescription {
        ndof,
        sectors,
        engine_order: structure.engine_order,
        components,
        left: &sides[0],
        right: &sides[1],
        fixed: &[],
        frame,
        axis,
        forward,
        coordinates: None,
    };
    Faces::about(&description, axis)
}
