//! Several masses or contacts: masses of very different size, equal frequencies, equal contacts, contacts that do not
//! move.

use super::Case;
use super::one_mass::{at, by_default, in_time, rubbing, structure};
use crate::common::models::{dense, oscillator};
use crate::common::{all_harmonics, harmonics, solve_at};
use hbvib::{Contact, Model, Status};

/// Two degrees of freedom from M, C and K, column-major.
fn two(mass: [f64; 4], damping: [f64; 4], stiffness: [f64; 4], forces: [f64; 2]) -> Model {
    dense(&mass, &stiffness)
        .damping(&damping)
        .forces(forces.into_iter().enumerate().map(|(dof, force)| (dof, 1, force)))
        .build()
}

fn diagonal(a: f64, b: f64) -> [f64; 4] {
    [a, 0.0, 0.0, b]
}

fn rubbing_at(model: &mut Model, dof: usize, other: Option<usize>) {
    model.add_contact(&Contact::jenkins(dof, other, 1.0, 1.0, 0.3)).unwrap();
}

pub fn ill_conditioned_mass(case: &Case) {
    assert_eq!(case.param("M").as_str(), Some("diag(1,1e-14)"));
    assert_eq!(case.param("C").as_str(), Some(".02K"));
    let rows = case.param("K").as_array().unwrap();
    let k: Vec<f64> = rows.iter().flat_map(super::list).collect();
    let k: [f64; 4] = k.try_into().unwrap();
    let forces: [f64; 2] = case.numbers("F").try_into().unwrap();
    let of = |light: f64| {
        let mut model = two(diagonal(1.0, light), k.map(|k| 0.02 * k), k, forces);
        rubbing_at(&mut model, 0, None);
        model
    };
    let (h, w) = (case.harmonics(), case.number("w"));
    for (light, name) in [(1e-14, "x"), (0.0, "xM0")] {
        let wanted = super::list(case.reference(&[name]));
        let x = at(&of(light), w, h);
        for dof in 0..2 {
            case.meets(
                &format!("|X_1| of dof {dof}, light mass {light:e}"),
                h,
                x[2 + dof].norm(),
                wanted[dof],
            );
        }
    }
    case.tells_of_the_reference(&["ok"]);
    // The light mass follows the heavy one, whose own problem is that of one mass.
    let mut one = oscillator(1.0, 1.0).damping(&[0.02]).force(0, 1, forces[0]).build();
    rubbing_at(&mut one, 0, None);
    let truth = in_time(&one, w)[1].norm();
    case.near("|X_1| of both", by_default(&of(1e-14), w)[2].norm(), truth);
}

pub fn many_contacts(case: &Case) {
    let (h, w, count) = (case.harmonics(), case.number("w"), case.number("count"));
    let one = rubbing(case, case.number("fc"), &[(1, case.number("F"))]);
    let mut many = structure(case);
    many.add_force(0, 1, case.number("F").into()).unwrap();
    for _ in 0..count as usize {
        let contact = Contact::jenkins(0, None, case.number("kt") / count, 1.0, case.number("fc") / count);
        many.add_contact(&contact).unwrap();
    }
    let most = case.wanted("iters");
    for (model, name) in [(&one, "nc1"), (&many, "nc100")] {
        let branch = solve_at(model, &harmonics(h), w);
        case.meets(name, h, all_harmonics(&branch, 0)[1].norm(), case.wanted(name));
        let iterations = branch.newton_iterations()[0];
        case.holds(
            &format!("{iterations} iterations, the reference took {most}"),
            iterations <= most,
        );
    }
    case.near("|X_1|", by_default(&many, w)[1].norm(), in_time(&one, w)[1].norm());
}

pub fn close_frequencies(case: &Case) {
    assert_eq!(case.param("K").as_str(), Some("diag(1,1+1e-10)"));
    let forces: [f64; 2] = case.numbers("F").try_into().unwrap();
    let mut model = two(
        diagonal(1.0, 1.0),
        diagonal(0.02, 0.02),
        diagonal(1.0, 1.0 + 1e-10),
        forces,
    );
    rubbing_at(&mut model, 0, None);
    rubbing_at(&mut model, 1, None);
    let (h, w) = (case.harmonics(), case.number("w"));
    let wanted = super::list(case.reference(&["x"]));
    let x = at(&model, w, h);
    let default = by_default(&model, w);
    let truth = in_time(&model, w);
    for dof in 0..2 {
        case.meets(&format!("|X_1| of dof {dof}"), h, x[2 + dof].norm(), wanted[dof]);
        case.near(
            &format!("|X_1| of dof {dof}"),
            default[2 + dof].norm(),
            truth[2 + dof].norm(),
        );
    }
    let difference = |x: f64, y: f64| y / x - 1.0;
    case.meets(
        "1 + the relative difference of the two",
        h,
        1.0 + difference(x[2].norm(), x[3].norm()),
        1.0 + difference(wanted[0], wanted[1]),
    );
}

/// Two structures whose contact does not move: tied to the ground by a spring of 1e30, or between masses that move
/// alike. The linear response is wanted, without force in the contact.
pub fn no_relative_motion(case: &Case) {
    let tie = case.number("tie");
    let w = 1.1;
    let linear = |k: f64| 0.2 / num_complex::Complex64::new(k - w * w, 0.02 * w).norm();
    // Dof 1 stands still, so that dof 0 has its two springs of 1 to the ground.
    let held = |tie: f64| {
        two(
            diagonal(1.0, 1.0),
            diagonal(0.02, 0.02),
            [2.0, -1.0, -1.0, 1.0 + tie],
            [0.2, 0.0],
        )
    };
    let mut tied = held(tie);
    rubbing_at(&mut tied, 1, None);
    let mut alike = two(diagonal(1.0, 1.0), diagonal(0.02, 0.02), diagonal(1.0, 1.0), [0.2, 0.2]);
    rubbing_at(&mut alike, 0, Some(1));
    for (name, model, wanted) in [("tied", &tied, linear(2.0)), ("alike", &alike, linear(1.0))] {
        for h in [1, 9, 31] {
            let branch = solve_at(model, &harmonics(h), w);
            let x = all_harmonics(&branch, 0);
            case.within(&format!("{name}, |X_1|"), Some(h), x[2].norm(), wanted, 1e-12);
            let y = if name == "tied" { x[3] } else { x[2] - x[3] };
            case.within(&format!("{name}, |Y_1|"), Some(h), y.norm(), 0.0, 1e-15);
            let slips = crate::common::slip(&branch, 0);
            case.holds(&format!("{name}, H {h}, the contact does not slip"), slips == 0.0);
        }
        case.near(&format!("{name}, |X_1|"), by_default(model, w)[2].norm(), wanted);
    }
    // A contact of a degree of freedom with itself has no motion by its description, and is refused.
    let refused = tied
        .add_contact(&Contact::jenkins(0, Some(0), 1.0, 1.0, 0.3))
        .unwrap_err();
    case.status(refused.message(), refused.status, Status::Argument);
}
