//! A model as bytes: a mark, the version of the format, the length, the model and a checksum. Everything that decides
//! about results is in them; a loaded model solves to the same bits.
//!
//! Little-endian: mark (8 bytes), version (4), 0 (4), length L of the model (8), the model (L), checksum of all
//! bytes before it (8). Version 2 adds the aerodynamic influence, version 3 the places of sliders, version 4 rigid bodies and
//! centrifugal forces, version 5 whole wheels, version 6 digests of their sectors; a model without is written
//! as an earlier version.

use crate::byte_stream::{ByteReader, ByteWriter, checksum};
use crate::contact::Contact;
use crate::contact::described::saved_contact;
use crate::contact::forms::constants::Constant;
use crate::error::{Result, fail, try_push, try_vec};
use crate::model::excitation::{Excitation, Force};
use crate::model::few_motions::reduced_wave::KeptWaves;
use crate::model::matrices::speed::{Speed, SpeedLoad};
use crate::model::matrices::spring::Spring;
use crate::model::matrices::structure::{MAX_SECTORS, Structure};
use crate::model::mechanical_model::Model;
use crate::model::wheels::sector_digest::SectorDigest;
use num_complex::Complex64;

/// First bytes of a saved model. A file transfer in text mode would change some of them.
const MARK: [u8; 8] = *b"\x89HBVIB\r\n";

/// Version of the format.
/// Kind: fixed.
const VERSION: u32 = 6;

/// Bytes before the model.
/// Kind: fixed.
const HEAD: usize = 24;

/// Bytes after it.
/// Kind: fixed.
const TAIL: usize = 8;

const CONTEXT: &str = "a loaded model";

/// The model as bytes, for [`Model::load`].
pub(crate) fn save(model: &Model) -> Result<Vec<u8>> {
    let mut bytes = try_vec(model.save_into(&mut [])?, 0, "the saved model")?;
    model.save_into(&mut bytes)?;
    Ok(bytes)
}

/// Writes the model into a buffer and returns its length in bytes.
pub(crate) fn save_into(model: &Model, buffer: &mut [u8]) -> Result<usize> {
    let mut out = ByteWriter::new(buffer);
    out.bytes(&MARK);
    out.u32(
        match (has_bodies(model), has_places(model), model.structure.has_aero()) {
            _ if model.structure.sector.is_some() => VERSION,
            _ if model.structure.wheel.is_some() => 5,
            (true, _, _) => 4,
            (false, true, _) => 3,
            (false, false, true) => 2,
            (false, false, false) => 1,
        },
    );
    out.u32(0);
    // The length is known at the end.
    out.count(0);
    content_to(model, &mut out)?;
    let length = out.position();
    if let Some(place) = buffer.get_mut(HEAD - 8..HEAD) {
        place.copy_from_slice(&((length - HEAD) as u64).to_le_bytes());
    }
    if let Some((text, tail)) = buffer.split_at_mut_checked(length)
        && let Some(tail) = tail.get_mut(..TAIL)
    {
        tail.copy_from_slice(&checksum(text).to_le_bytes());
    }
    Ok(length + TAIL)
}

/// The model from bytes that [`Model::save`] made.
pub(crate) fn load(bytes: &[u8]) -> Result<Model> {
    let (model, version) = content(bytes).map_err(|e| e.at(format_args!("saved model")))?;
    let mut input = ByteReader::new(model);
    let loaded = content_from(&mut input, version).and_then(|loaded| match input.left() {
        0 => Ok(loaded),
        left => fail!(Argument, "damaged: {left} bytes follow its end"),
    });
    loaded.map_err(|e| e.at(format_args!("saved model")))
}

fn content_to(model: &Model, out: &mut ByteWriter<'_>) -> Result<()> {
    model.structure.save_to(out);
    out.count(model.contacts.len());
    for (i, contact) in model.contacts.iter().enumerate() {
        saved_contact::save_to(contact, out).map_err(|e| e.at(format_args!("contact {i}")))?;
    }
    out.count(model.springs.len());
    for spring in &model.springs {
        out.optional(spring.dof_a);
        out.optional(spring.dof_b);
        out.i64(spring.sector_offset);
        out.f64(spring.stiffness);
    }
    out.count(model.excitation.forces().len());
    for force in model.excitation.forces() {
        out.count(force.dof);
        out.count(force.harmonic);
        out.f64(force.value.re);
        out.f64(force.value.im);
        out.bool(force.per_omega2);
    }
    out.count(model.speed_loads.len());
    for load in &model.speed_loads {
        out.count(load.contact);
        for value in [load.preload, load.gap, load.per_speed2] {
            out.f64(value);
        }
    }
    let has_bodies = has_bodies(model) || model.structure.wheel.is_some();
    let has_places = has_places(model) || has_bodies;
    if has_places {
        out.bool(model.structure.has_aero());
    }
    if model.structure.has_aero() {
        model.save_aero(out);
    }
    if has_places {
        for contact in &model.contacts {
            for place in contact.slider() {
                out.f64(place);
            }
        }
    }
    if has_bodies {
        for contact in &model.contacts {
            saved_contact::rigid_to(contact, out);
        }
        for force in model.excitation.forces() {
            out.f64(force.per_speed2);
        }
    }
    if let Some((sectors, engine_order)) = model.structure.wheel {
        out.count(sectors);
        out.i64(engine_order);
    }
    if let Some(sector) = &model.structure.sector {
        for part in [sector.degrees, sector.matrices, sector.damping, sector.springs] {
            out.i64(part.cast_signed());
        }
        out.i64(sector.engine_order);
    }
    Ok(())
}

/// Whether a contact is attached to a rigid body, or a force follows the speed.
fn has_bodies(model: &Model) -> bool {
    model.contacts.iter().any(|contact| contact.rigid.is_some()) || model.excitation.has_centrifugal()
}

/// Whether some slider has an initial place.
fn has_places(model: &Model) -> bool {
    model.contacts.iter().any(Contact::is_placed)
}

fn content_from(input: &mut ByteReader<'_>, version: u32) -> Result<Model> {
    let mut model = Model {
        structure: Structure::load_from(input)?,
        kept: KeptWaves::default(),
        contacts: Vec::new(),
        springs: Vec::new(),
        excitation: Excitation::default(),
        speed_loads: Vec::new(),
    };
    for i in 0..input.entries(saved_contact::CONTACT_LEAST_BYTES)? {
        let contact = saved_contact::load_from(input)?;
        model
            .check_contact(&contact)
            .map_err(|e| e.at(format_args!("contact {i}")))?;
        try_push(&mut model.contacts, contact, CONTEXT)?;
    }
    for i in 0..input.entries(32)? {
        let spring = Spring {
            dof_a: input.optional()?,
            dof_b: input.optional()?,
            sector_offset: input.i64()?,
            stiffness: input.finite()?,
        };
        model
            .check_spring(&spring)
            .map_err(|e| e.at(format_args!("spring {i}")))?;
        try_push(&mut model.springs, spring, CONTEXT)?;
    }
    for _ in 0..input.entries(33)? {
        let force = Force {
            dof: input.count()?,
            harmonic: input.count()?,
            value: Complex64::new(input.finite()?, input.finite()?),
            per_omega2: input.bool()?,
            per_speed2: 0.0,
        };
        model.excitation.restore(model.structure.degrees().given(), force)?;
    }
    let mut loaded = try_vec(model.contacts.len(), false, CONTEXT)?;
    for _ in 0..input.entries(32)? {
        let load = SpeedLoad {
            contact: input.count()?,
            preload: input.finite()?,
            gap: input.finite()?,
            per_speed2: input.finite()?,
        };
        let contact = model.contacts.get(load.contact).filter(|c| c.without_load().is_none());
        let once = loaded
            .get_mut(load.contact)
            .is_some_and(|twice| !std::mem::replace(twice, true));
        let decreases = load.per_speed2 < 0.0 && matches!(model.structure.speed, Speed::PerOmega(_));
        if contact.is_none() || !once || decreases {
            return Err(input.damaged("a load that depends on the speed belongs to no contact"));
        }
        try_push(&mut model.speed_loads, load, CONTEXT)?;
    }
    let has_places = version >= 3;
    if version == 2 || (has_places && input.bool()?) {
        model.load_aero(input)?;
    }
    for (i, contact) in model.contacts.iter_mut().enumerate().filter(|_| has_places) {
        for k in 0..2 {
            contact.set(Constant::Slider(k), input.f64()?)?;
        }
        contact
            .check_constants()
            .map_err(|e| e.at(format_args!("contact {i}")))?;
    }
    if version >= 4 {
        for i in 0..model.contacts.len() {
            saved_contact::load_rigid(&mut model.contacts[i], input)?;
            let checked = model.check_contact(&model.contacts[i]);
            checked.map_err(|e| e.at(format_args!("contact {i}")))?;
        }
        model.excitation.load_centrifugal(|| input.finite())?;
    }
    if version >= 5 {
        let wheel = (input.count()?, input.i64()?);
        if model.structure.sectors() > 1 || !(2..=MAX_SECTORS).contains(&wheel.0) {
            return Err(input.damaged("a wheel has a number of sectors that it cannot have"));
        }
        model.structure.wheel = Some(wheel);
    }
    if version >= 6 {
        model.structure.sector = Some(SectorDigest {
            degrees: input.i64()?.cast_unsigned(),
            matrices: input.i64()?.cast_unsigned(),
            damping: input.i64()?.cast_unsigned(),
            springs: input.i64()?.cast_unsigned(),
            engine_order: input.i64()?,
        });
    }
    Ok(model)
}

/// The bytes of the model itself and the version of the format, after a check of the frame.
fn content(bytes: &[u8]) -> Result<(&[u8], u32)> {
    if bytes.len() < MARK.len() || !bytes.starts_with(&MARK) {
        return fail!(
            Argument,
            "{} bytes that do not begin with its mark: they are something else, or were changed as text is",
            bytes.len()
        );
    }
    let mut input = ByteReader::new(&bytes[MARK.len()..]);
    let incomplete = |needs: usize| {
        fail!(
            Argument,
            "incomplete: it has {} bytes, needs {needs}; save or copy it again",
            bytes.len()
        )
    };
    if bytes.len() < HEAD + TAIL {
        return incomplete(HEAD + TAIL);
    }
    let (version, reserved, length) = (input.u32()?, input.u32()?, input.count()?);
    if version > VERSION {
        return fail!(
            Unsupported,
            "its format {version} is newer than {VERSION}, the newest that this library reads; use a newer library"
        );
    }
    let needs = length.saturating_add(HEAD + TAIL);
    if needs > bytes.len() {
        return incomplete(needs);
    }
    if needs < bytes.len() {
        return fail!(Argument, "damaged: {} bytes follow its end", bytes.len() - needs);
    }
    let (text, tail) = bytes.split_at(HEAD + length);
    if checksum(text).to_le_bytes() != tail || version == 0 || reserved != 0 {
        return fail!(Argument, "damaged: its checksum is another one; save or copy it again");
    }
    Ok((&text[HEAD..], version))
}
