//! The paper's blisk, forced at the blade tips: units, floating and massless ring, aliased engine orders, veering.

use super::Case;
use super::one_mass::{answer, at, by_default, in_time};
use crate::common::models::Structure;
use crate::common::{B1, B2, Blisk, D, NDOF, R, SECTORS, harmonics};
use hbvib::{Contact, MatrixKind, Model, SolverOptions};
use std::f64::consts::TAU;

/// Changes of a case: ring mass, engine order, units of mass and length in SI units.
#[derive(Clone, Copy)]
pub struct Change {
    ring_mass: f64,
    engine_order: i64,
    units: (f64, f64),
}

/// The blisk of a case without force and damping.
pub fn unforced(case: &Case, change: Change) -> Model {
    assert_eq!(case.param("model").as_str(), Some("model.json"));
    let blisk = Blisk {
        ring_mass: Some(change.ring_mass),
        engine_order: change.engine_order,
        units: (change.units.0, change.units.1, 1.0),
        ..crate::common::BASE
    };
    let a = blisk.matrices();
    let mut model = Structure::cyclic(a.n, SECTORS)
        .mass(&a.mass)
        .stiffness(&a.own)
        .next(MatrixKind::Stiffness, &a.next)
        .wave(change.engine_order)
        .build();
    let kt = case.number("kt") * change.units.1;
    model
        .add_contact(&Contact::jenkins(D, Some(R), kt, 1.0, case.number("fc")))
        .unwrap();
    model
}

fn changed(case: &Case, change: Change) -> Model {
    let mut model = unforced(case, change);
    model.set_rayleigh(0.0, case.number("beta")).unwrap();
    model.add_force(B2, 1, case.number("F").into()).unwrap();
    model
}

fn engine_order(case: &Case) -> i64 {
    case.param("EO").as_i64().unwrap()
}

/// The change of a case of one engine order in SI units.
pub fn plain(case: &Case) -> Change {
    Change {
        ring_mass: case.number("m_r"),
        engine_order: engine_order(case),
        units: (1.0, 1.0),
    }
}

/// |X_1| of a degree of freedom at the case's H and by default options, at the case's frequency.
fn fundamental(case: &Case, model: &Model) -> ([f64; NDOF], [f64; NDOF]) {
    let w = TAU * case.number("f_Hz");
    let of = |x: Vec<num_complex::Complex64>| [B2, B1, D, R].map(|dof| x[NDOF + dof].norm());
    (of(at(model, w, case.harmonics())), of(by_default(model, w)))
}

pub fn units(case: &Case) {
    let h = case.harmonics();
    let model = changed(case, plain(case));
    let (x, default) = fundamental(case, &model);
    for (i, name) in ["absx_b2", "absx_b1", "absx_d", "absx_r"].into_iter().enumerate() {
        case.meets(name, h, x[i], case.wanted(name));
    }
    let units = case.numbers("units");
    let other = changed(
        case,
        Change {
            units: (units[0], units[1]),
            ..plain(case)
        },
    );
    let (millimetres, _) = fundamental(case, &other);
    for i in 0..NDOF {
        case.meets(
            &format!("dof {i}, millimetres over metres"),
            h,
            millimetres[i] * units[1] / x[i],
            1.0,
        );
    }
    case.tells_of_the_reference(&["ratio_dev"]);
    let truth = in_time(&model, TAU * case.number("f_Hz"));
    for (dof, found) in default.into_iter().enumerate() {
        case.near(&format!("dof {dof}"), found, truth[NDOF + dof].norm());
    }
}

pub fn massless_ring(case: &Case) {
    let h = case.harmonics();
    let model = changed(case, plain(case));
    let (x, default) = fundamental(case, &model);
    case.meets("absx_b2", h, x[B2], case.wanted("absx_b2"));
    case.meets("absx_r", h, x[R], case.wanted("absx_r"));
    let light = Change {
        ring_mass: case.number("light_ring"),
        ..plain(case)
    };
    let (near, _) = fundamental(case, &changed(case, light));
    let deviation = near[B2] / x[B2] - 1.0;
    let wanted = case.wanted("dev_mr1e9");
    case.meets(
        "a nearly massless ring over a massless one",
        h,
        1.0 + deviation,
        1.0 + wanted,
    );
    // Integration in time needs mass in every degree of freedom; that of the light ring is not felt. Its own motion
    // is far above all harmonics, so that H = 127 stands for the truth.
    let truth = at(&model, TAU * case.number("f_Hz"), 127);
    case.near("b2, the truth by H = 127", default[B2], truth[NDOF + B2].norm());
}

pub fn floating_ring(case: &Case) {
    let model = changed(case, plain(case));
    let (x, default) = fundamental(case, &model);
    case.meets("absx_b2", case.harmonics(), x[B2], case.wanted("absx_b2"));
    case.meets("absx_r", case.harmonics(), x[R], case.wanted("absx_r"));
    case.tells_of_the_reference(&["ok"]);
    let truth = in_time(&model, TAU * case.number("f_Hz"));
    case.near("b2", default[B2], truth[NDOF + B2].norm());
    case.near("ring", default[R], truth[NDOF + R].norm());
}

pub fn aliased_orders(case: &Case) {
    let orders: Vec<i64> = case.numbers("EO").into_iter().map(|eo| eo as i64).collect();
    let of = |engine_order: i64| {
        changed(
            case,
            Change {
                ring_mass: case.number("m_r"),
                engine_order,
                units: (1.0, 1.0),
            },
        )
    };
    let truth = in_time(&of(orders[0]), TAU * case.number("f_Hz"))[NDOF + B2].norm();
    let (first, _) = fundamental(case, &of(orders[0]));
    for engine_order in orders {
        let (x, default) = fundamental(case, &of(engine_order));
        let wanted = case.wanted(&format!("EO{engine_order}"));
        // The stored numbers agree with each other to 1e-10; the mirror image is exact.
        case.meets(
            &format!("b2 at engine order {engine_order}"),
            case.harmonics(),
            x[B2],
            wanted,
        );
        case.meets(
            &format!("b2 at {engine_order} over the first order"),
            case.harmonics(),
            x[B2] / first[B2],
            1.0,
        );
        case.near(&format!("b2 at engine order {engine_order}"), default[B2], truth);
    }
}

pub fn veering(case: &Case) {
    let h = case.harmonics();
    let model = changed(case, plain(case));
    for f in case.numbers("f_Hz") {
        let name = |what: &str| format!("{what}{f:.1}");
        let x = at(&model, TAU * f, h);
        case.meets(
            &format!("b2 at {f} Hz"),
            h,
            x[NDOF + B2].norm(),
            case.wanted(&name("f")),
        );
        // The relative motion over that at which slip begins.
        let y = (x[NDOF + D] - x[NDOF + R]).norm() * case.number("kt") / case.number("fc");
        case.meets(&format!("slip at {f} Hz"), h, y, case.wanted(&name("slip")));
        case.tells_of_the_reference(&[&name("ok")]);
        let truth = in_time(&model, TAU * f)[NDOF + B2].norm();
        case.near(
            &format!("b2 at {f} Hz"),
            by_default(&model, TAU * f)[NDOF + B2].norm(),
            truth,
        );
    }
}

pub fn even_harmonics(case: &Case) {
    assert_eq!(case.param("with_h0").as_bool(), Some(true));
    let model = changed(case, plain(case));
    let (h, w) = (case.harmonics(), TAU * case.number("f_Hz"));
    let wanted = case.wanted("absx_b2");
    let all = |options: SolverOptions| SolverOptions {
        keep_even_harmonics: true,
        ..options
    };
    let x = answer(&model, w, &all(harmonics(h))).unwrap();
    case.meets("b2 with mean and even harmonics", h, x[NDOF + B2].norm(), wanted);
    let largest = x.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
    let even = (0..=h).step_by(2).flat_map(|h| &x[h * NDOF..(h + 1) * NDOF]);
    let drift = even.fold(0.0_f64, |m, z| m.max(z.norm())) / largest;
    case.within("mean and even harmonics", Some(h), drift, 0.0, case.rel_tol);
    let truth = in_time(&model, w)[NDOF + B2].norm();
    let x = answer(&model, w, &all(SolverOptions::default())).unwrap();
    case.near("b2 with mean and even harmonics", x[NDOF + B2].norm(), truth);
}
