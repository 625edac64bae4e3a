//! An undamped resonance forced beyond what its contacts can take: no answer, and the reason.

use super::Case;
use super::one_mass::{answer, rubbing};
use hbvib::error::Status;
use hbvib::options::SolverOptions;

pub fn beyond_capacity(case: &Case) {
    let w = case.number("w");
    let limit = case.wanted("F_limit");
    case.meets("the stored limit of the parameters", 0, case.number("F_limit"), limit);
    let forced = |force: f64| rubbing(case, case.number("fc"), &[(1, force)]);
    let model = forced(case.number("F"));
    let resonance = model.resonance(w, 1).unwrap().unwrap();
    case.meets("what the contact can take, 4 fc/pi", 1, resonance.capacity, limit);
    case.meets("the force on the motion", 1, resonance.force, case.number("F"));
    let of = |force: f64, solver: &SolverOptions| match answer(&forced(force), w, solver) {
        Ok(x) => (Status::Ok, format!("|X_1| = {}", x[1].norm())),
        Err(e) => (e.status, e.message().to_owned()),
    };
    for h in [1, 3, 9, 31, 63] {
        let (status, sentence) = of(case.number("F"), &super::common::harmonics(h));
        case.status(
            &format!("F = {}, H {h}: {sentence}", case.number("F")),
            status,
            Status::NoBoundedSolution,
        );
    }
    let (status, sentence) = of(case.number("F"), &SolverOptions::default());
    case.status(
        &format!("default options: {sentence}"),
        status,
        Status::NoBoundedSolution,
    );
    let told = sentence.contains("4.000000e-1") && sentence.contains("3.819719e-1");
    case.holds("the sentence names force and capacity", told);
    // Whatever is found below the limit, it is never called impossible; within two thirds of it there is an answer.
    for share in [0.5, 0.9, 0.99, 0.999_999, 1.0] {
        let (status, sentence) = of(share * limit, &super::common::harmonics(9));
        case.holds(
            &format!("F = {share} of the limit, {status:?}: {sentence}"),
            match share {
                s if s < 0.95 => status == Status::Ok,
                _ => status != Status::NoBoundedSolution,
            },
        );
    }
}
