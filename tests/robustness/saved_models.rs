//! Saved models: every part of a model comes back to the bit, damaged bytes are refused, and no bytes at all break the loader.

use crate::common::laws::{cases, shaken, structure};
use crate::common::{BASE, Blisk, all_harmonics, harmonics, solve_at, sweep};
use hbvib::{
    Contact, ContactKind, Frame, Iwan, MatrixKind, MatrixView, Model, Monomial, Part, Polynomial, SectorDescription,
    SectorFrame, Speed, Spring, Status, Table, Values,
};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::time::Instant;

/// A rotor with every kind of damping, loads that depend on its speed, unbalance and springs.
fn rotor(speed: Speed) -> Model {
    let mut model = structure();
    let set = |model: &mut Model, kind, values: [f64; 9], part| {
        model
            .set_matrix(kind, &MatrixView::dense(3, &values).part(part))
            .unwrap();
    };
    let diagonal = |a, b, c| [a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c];
    set(
        &mut model,
        MatrixKind::Structural,
        diagonal(0.01, 0.02, 0.0),
        Part::Full,
    );
    let skew = [0.0, 0.3, 0.0, -0.3, 0.0, 0.0, 0.0, 0.0, 0.0];
    set(&mut model, MatrixKind::Gyroscopic, skew, Part::Full);
    set(
        &mut model,
        MatrixKind::StiffnessSpeed2,
        diagonal(0.1, 0.1, -0.05),
        Part::Full,
    );
    model.set_rayleigh(0.01, 1e-3).unwrap();
    model.set_loss_factor(0.002).unwrap();
    let spring = Spring {
        dof_a: Some(0),
        dof_b: None,
        sector_offset: 0,
        stiffness: 0.25,
    };
    model.add_spring(&spring).unwrap();
    model.set_modal_damping(&[0.01, 0.02]).unwrap();
    model.add_contact(&Contact::jenkins(0, Some(1), 2.0, 0.5, 0.4)).unwrap();
    let pressed = Contact::friction_2d([Some(0), Some(2)], [None; 2], (2.5, 1.5), 0.4, 1.0);
    model.add_contact(&pressed).unwrap();
    model.set_speed(speed).unwrap();
    model.set_preload_at_speed(0, 0.3, 0.05).unwrap();
    model.set_preload_at_speed(1, 0.7, 0.1).unwrap();
    model.add_unbalance(0, 1, 0.2, 0.4).unwrap();
    model.add_force(2, 3, Complex64::new(0.1, -0.0)).unwrap();
    model
}

/// Contacts of every law but those of the caller, with their constants at odd values.
fn laws() -> Model {
    let mut model = structure();
    for case in cases() {
        if case.contact.kind.user().is_none() {
            model.add_contact(&case.contact).unwrap();
        }
    }
    let frame = Frame::new([0.3, -1.0, 2.0], None).unwrap();
    let node = [Some(0), Some(1), Some(2)];
    let turned = Contact {
        frame: Some(frame),
        ..Contact::friction_3d(node, [None; 3], (2.5, 1.5), 0.4, 0.5)
    };
    model.add_contact(&turned).unwrap();
    model
        .add_contact(&Contact::jenkins(0, None, 1.0, 0.3, f64::INFINITY))
        .unwrap();
    let terms = [
        Monomial {
            direction: 0,
            coefficient: 0.1,
            displacements: &[1, 2],
            velocities: &[],
        },
        Monomial {
            direction: 1,
            coefficient: -0.2,
            displacements: &[0, 1],
            velocities: &[2, 0],
        },
    ];
    let coupled = Polynomial::new(2, &terms).unwrap();
    model
        .add_contact(&Contact::over(vec![2, 0], ContactKind::Polynomial(coupled)))
        .unwrap();
    let joint = Iwan {
        slip_force: 1.0,
        stiffness: 2.0,
        chi: -0.5,
        beta: 0.1,
    };
    let between = Contact::jenkins(1, Some(2), 0.0, 0.0, 0.0);
    model.add_iwan(&between, &joint, 5).unwrap();
    for (dof, h, value) in shaken() {
        model.add_force(dof, h, value).unwrap();
    }
    model.add_force(0, 0, 0.3.into()).unwrap();
    model
}

/// A wheel of complex matrices by nodal diameter.
fn waves() -> Model {
    let mut model = Model::cyclic(2, 5).unwrap();
    model.set_wave(-1);
    for diameter in 0..3 {
        let d = f64::from(u8::try_from(diameter).unwrap());
        let c = |re, im| Complex64::new(re, im);
        let mass = [c(1.0, 0.0), c(0.1, 0.05 * d), c(0.1, -0.05 * d), c(1.5, 0.0)];
        let stiffness = [c(3.0 + d, 0.0), c(-0.5, 0.2 * d), c(-0.5, -0.2 * d), c(4.0, 0.0)];
        for (kind, values) in [(MatrixKind::Mass, mass), (MatrixKind::Stiffness, stiffness)] {
            let view = MatrixView {
                values: Values::Complex(&values),
                ..MatrixView::dense(2, &[0.0; 4])
            };
            model.set_diameter(kind, diameter, &view).unwrap();
        }
    }
    model.set_rayleigh(0.02, 0.001).unwrap();
    let mut contact = Contact::jenkins(0, Some(1), 1.0, 0.5, 0.2);
    contact.sector_offset = 1;
    model.add_contact(&contact).unwrap();
    model.add_force(0, 1, Complex64::new(0.3, 0.1)).unwrap();
    model
}

/// A sector with faces of 3 nodes, a skew axis, coupled damping and a fixed degree of freedom.
fn faces(frame: SectorFrame) -> Model {
    let side = |first: usize| [Some(first), Some(first + 1), Some(first + 2)];
    let (left, right) = (side(0), side(6));
    let mut model = Model::sector(&SectorDescription {
        ndof: 9,
        sectors: 7,
        engine_order: 3,
        components: 3,
        left: &left,
        right: &right,
        fixed: &[4],
        frame,
        axis: [0.3, -0.7, 1.9],
        forward: false,
        coordinates: None,
    })
    .unwrap();
    let mut k = vec![0.0; 81];
    for i in 0..9 {
        for j in 0..9 {
            let (x, y) = (i as f64, j as f64);
            k[9 * i + j] = if i == j { 9.0 + x } else { -1.0 / (1.0 + (x - y).abs()) };
        }
    }
    let m: Vec<f64> = (0..81).map(|e| if e % 10 == 0 { 1.0 } else { 0.0 }).collect();
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(9, &m)).unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(9, &k))
        .unwrap();
    let mut c = k.iter().map(|v| 0.01 * v).collect::<Vec<_>>();
    c[1] += 0.02;
    let c = MatrixView::dense(9, &c).part(Part::General);
    model.set_matrix(MatrixKind::Damping, &c).unwrap();
    model.add_contact(&Contact::jenkins(3, Some(5), 2.0, 0.4, 1.0)).unwrap();
    model.add_force(3, 1, 0.5.into()).unwrap();
    model
}

/// Models, and an angular frequency at which each is solved.
fn models() -> Vec<(&'static str, Model, f64)> {
    let mut fixed = structure();
    fixed.fix(&[1]).unwrap();
    fixed.add_force(0, 1, 1.0.into()).unwrap();
    let table = Table::new(&[-1.0, 0.0, 0.3], &[-0.5, 0.0, 0.4]).unwrap();
    fixed
        .add_contact(&Contact::between(0, None, ContactKind::Table(table)))
        .unwrap();
    vec![
        ("ring damper", BASE.sector(), TAU * 208.85),
        (
            "wheel",
            Blisk {
                engine_order: -3,
                ..BASE
            }
            .full_wheel(),
            TAU * 208.85,
        ),
        ("rotor", rotor(Speed::Fixed(0.7)), 1.7),
        ("rotor with a tied speed", rotor(Speed::PerOmega(0.5)), 1.7),
        ("laws", laws(), 1.7),
        ("waves", waves(), 1.9),
        ("faces", faces(SectorFrame::Cartesian), 3.0),
        ("cylindrical faces", faces(SectorFrame::Cylindrical), 3.0),
        ("fixed", fixed, 1.7),
        ("wheel of faces", faces(SectorFrame::Cartesian).wheel().unwrap(), 3.0),
    ]
}

#[test]
fn every_part_of_a_model_comes_back_and_solves_to_the_same_bits() {
    for (name, model, omega) in models() {
        let bytes = model.save().unwrap();
        let loaded = Model::load(&bytes).unwrap();
        // All fields, those that are added later included.
        assert_eq!(format!("{model:?}"), format!("{loaded:?}"), "{name}");
        assert_eq!(loaded.save().unwrap(), bytes, "{name}");
        let solver = harmonics(5);
        let [own, other] = [&model, &loaded].map(|model| solve_at(model, &solver, omega));
        let bits = |x: Vec<Complex64>| {
            x.iter()
                .flat_map(|z| [z.re.to_bits(), z.im.to_bits()])
                .collect::<Vec<_>>()
        };
        assert_eq!(bits(all_harmonics(&own, 0)), bits(all_harmonics(&other, 0)), "{name}");
        // It can be changed like any other.
        let mut changed = loaded;
        changed.set_loss_factor(0.01).unwrap();
        assert_ne!(changed.save().unwrap(), bytes, "{name}");
    }
    let model = BASE.sector();
    let loaded = Model::load(&model.save().unwrap()).unwrap();
    let solver = hbvib::SolverOptions::default();
    let [own, other] = [&model, &loaded].map(|model| sweep(model, &solver, TAU * 207.0, TAU * 211.0, &[]));
    assert_eq!(format!("{:?}", own.peaks()), format!("{:?}", other.peaks()));
}

#[test]
fn a_model_with_a_force_of_the_caller_is_refused_by_the_number_of_its_contact() {
    let mut model = structure();
    model.add_contact(&Contact::jenkins(0, Some(1), 2.0, 0.5, 0.4)).unwrap();
    let own = cases()
        .into_iter()
        .find(|case| case.contact.kind.user().is_some())
        .unwrap();
    model.add_contact(&own.contact).unwrap();
    let error = model.save().unwrap_err();
    assert_eq!(error.status, Status::Unsupported);
    assert!(
        error.message().starts_with("contact 1: a force of the caller"),
        "{error}"
    );
}

#[test]
fn bytes_that_are_no_saved_model_are_refused_with_their_reason() {
    let bytes = BASE.sector().save().unwrap();
    let refused = |bytes: &[u8], status, words: &str| {
        let error = Model::load(bytes).unwrap_err();
        assert!(
            error.status == status && error.message().contains(words),
            "{error:?}, not {words}"
        );
    };
    refused(b"", Status::Argument, "0 bytes that do not begin with its mark");
    refused(b"PK\x03\x04 another kind of file", Status::Argument, "mark");
    refused(&bytes[1..], Status::Argument, "mark");
    let newer = |place: usize, value: u8| {
        let mut bytes = bytes.clone();
        bytes[place] = value;
        bytes
    };
    refused(&newer(8, 7), Status::Unsupported, "format 7 is newer than 6");
    refused(
        &[&bytes[..], b"\n"].concat(),
        Status::Argument,
        "1 bytes follow its end",
    );
    for length in MARK..bytes.len() {
        refused(&bytes[..length], Status::Argument, "incomplete");
    }
    for (place, byte) in bytes.iter().enumerate().skip(24) {
        refused(&newer(place, byte ^ 1), Status::Argument, "checksum");
    }
}

/// Bytes of the mark.
const MARK: usize = 8;

/// A sequence of numbers that is the same in each run (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit as u64) as usize
    }
}

/// The checksum of the format, written again.
fn seal(bytes: &mut [u8]) {
    let (text, tail) = bytes.split_at_mut(bytes.len() - 8);
    let mut remainder = !0_u64;
    for byte in text {
        remainder ^= u64::from(*byte);
        for _ in 0..8 {
            let odd = remainder & 1 == 1;
            remainder >>= 1;
            if odd {
                remainder ^= 0xC96C_5795_D787_0F42;
            }
        }
    }
    tail.copy_from_slice(&(!remainder).to_le_bytes());
}

/// Changes of the bytes with a checksum that fits: no panic, and what is loaded can be saved, loaded and solved.
#[test]
fn changed_bytes_under_a_valid_checksum_are_refused_or_make_a_model() {
    let begin = Instant::now();
    let (mut refused, mut made) = (0, 0);
    let mut random = Random(20);
    let all = models();
    let saved: Vec<_> = all.iter().map(|(_, model, _)| model.save().unwrap()).collect();
    for round in 0..3000 {
        // The full wheel is the largest, and has no part of its own.
        let which = [0, 2, 3, 4, 5, 6, 7, 8, 9][round % 9];
        let mut bytes = saved[which].clone();
        for _ in 0..=random.below(3) {
            let place = 24 + random.below(bytes.len() - 32);
            match random.below(4) {
                0 => bytes[place] ^= 1 << random.below(8),
                1 => bytes[place] = [0, 1, 2, 127, 128, 255][random.below(6)],
                2 => {
                    let end = (place + 8).min(bytes.len() - 8);
                    let word = [u64::MAX, 0, 1 << 62, 0x7FF8 << 48, 0x7FE0 << 48, 3][random.below(6)].to_le_bytes();
                    bytes[place..end].copy_from_slice(&word[..end - place]);
                }
                _ => {
                    let from = 24 + random.below(bytes.len() - 32);
                    bytes[place] = bytes[from];
                }
            }
        }
        seal(&mut bytes);
        match Model::load(&bytes) {
            Err(_) => refused += 1,
            Ok(model) => {
                made += 1;
                let again = model.save().unwrap();
                assert_eq!(Model::load(&again).unwrap().save().unwrap(), again);
                if made % 20 == 0 {
                    let solver = hbvib::SolverOptions {
                        max_newton: 10,
                        ..harmonics(3)
                    };
                    let range = hbvib::ForcedOptions {
                        omega_start: all[which].2,
                        omega_stop: all[which].2,
                        ..Default::default()
                    };
                    // A solution or an error.
                    let _ = hbvib::forced_response(&model, &solver, &range, &mut hbvib::Hooks::default());
                }
            }
        }
    }
    println!("{refused} refused, {made} made a model, {:?}", begin.elapsed());
    assert!(refused > 500 && made > 250);
}
