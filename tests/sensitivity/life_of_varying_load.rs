//! A life ends in few vibrations at every accuracy, where a step seems to meet the end of a motion that goes on.

use crate::common::harmonics;
use crate::common::models::{self, dense, tridiagonal};
use hbvib::{Contact, Duty, Hooks, LifeFollow, LifeOptions, Model, Status, Wear, life};
use num_complex::Complex64;

/// Eight masses in a row of random springs, three damped modes, and friction under a load that varies.
fn chain() -> Model {
    let mass = [
        1.612_643_771_670_002_4,
        0.574_079_741_977_433_9,
        1.782_391_961_531_740_7,
        1.162_754_616_457_23,
        1.149_422_178_515_114_6,
        1.435_025_005_775_723,
        1.392_858_558_222_064,
        1.921_111_325_794_843_1,
    ];
    let diagonal = [
        1.505_810_481_083_630_6,
        3.134_039_451_274_672_3,
        3.016_947_436_447_24,
        2.161_911_733_597_484_7,
        2.833_606_496_444_405,
        2.505_949_215_333_778_6,
        2.632_800_966_686_117_4,
        1.981_816_557_693_739,
    ];
    let beside = [
        -1.202_914_409_219_289_2,
        -1.584_911_784_600_276_3,
        -0.856_687_107_378_346,
        -0.891_720_978_749_391_5,
        -1.381_311_412_052_617_5,
        -0.759_671_893_006_127_7,
        -1.688_054_872_397_650_7,
    ];
    let mut model = dense(&models::diagonal(&mass), &tridiagonal(&diagonal, &beside)).build();
    model
        .set_modal_damping(&[
            0.020_601_757_872_865_386,
            0.028_677_251_333_449_113,
            0.017_844_979_316_314_798,
        ])
        .unwrap();
    let (stiffness, mu) = (
        (0.966_426_353_538_110_8, 0.466_045_249_470_124_8),
        0.382_667_195_488_870_5,
    );
    let friction = Contact::friction_2d([Some(2), Some(6)], [None; 2], stiffness, mu, 0.554_286_590_664_334_3);
    model.add_contact(&friction).unwrap();
    let force = Complex64::new(0.283_586_466_271_479_75, -0.068_718_308_597_853_69);
    model.add_force(3, 1, force).unwrap();
    model
}

#[test]
fn a_life_ends_at_every_accuracy() {
    let model = chain();
    let duties = [Duty {
        omega: 0.525_563_249_660_678_1,
        force: 1.0,
        share: 1.0,
    }];
    let wear = [Wear {
        contact: 0,
        rate: 0.121_213_383_423_849_41,
        area: 1.0,
    }];
    let solver = harmonics(5);
    let depth = |tolerance: f64| {
        let options = LifeOptions {
            wear: &wear,
            follow: LifeFollow::Duties(&duties),
            cycles: &[50.0, 100.0],
            tolerance,
            ..LifeOptions::default()
        };
        let found = life(&model, &solver, &options, &mut Hooks::default()).unwrap();
        assert_eq!(found.status, Status::Ok, "{tolerance:e}");
        // At 1e-8 rounding of the work decides: 600 to 2,050 for 16 structures that differ by 1e-9.
        let most = if tolerance < 1e-6 { 4000 } else { 200 };
        assert!(found.solutions <= most, "{} at {tolerance:e}", found.solutions);
        found.points[1].depths[0]
    };
    let truth = depth(1e-8);
    for tolerance in [1e-3, 3e-4, 1e-4, 5e-5, 3e-5, 2e-5, 1e-5, 3e-6] {
        let error = (depth(tolerance) - truth).abs() / truth;
        assert!(error <= 5.0 * tolerance, "{error:e} at {tolerance:e}");
    }
}
