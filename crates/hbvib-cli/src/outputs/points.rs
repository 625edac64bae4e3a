//! Points of a branch that a job names.

use crate::job_file::job::PointsName;
use crate::job_file::job_motion::ShapesName;
use hbvib::{Branch, Special};

/// The points, in the order in which the branch has them. Without a peak the highest point of the curve is the
/// highest peak.
pub fn chosen(branch: &Branch, which: PointsName) -> Vec<Special> {
    match which {
        PointsName::Peaks => branch.peaks().to_vec(),
        PointsName::Requested => (0..)
            .map(|i| branch.at(i))
            .take_while(|solutions| !solutions.is_empty())
            .flatten()
            .copied()
            .collect(),
        PointsName::HighestPeak => {
            let highest =
                |all: &mut dyn Iterator<Item = Special>| all.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
            highest(&mut branch.peaks().iter().copied())
                .or_else(|| highest(&mut curve(branch)))
                .into_iter()
                .collect()
        }
    }
}

/// The points whose shapes a job names.
pub fn shapes(branch: &Branch, which: ShapesName) -> Vec<Special> {
    match which {
        ShapesName::HighestPeak => chosen(branch, PointsName::HighestPeak),
        ShapesName::Peaks => chosen(branch, PointsName::Peaks),
        ShapesName::Requested => chosen(branch, PointsName::Requested),
        ShapesName::All => curve(branch).collect(),
    }
}

/// All points of the curve.
fn curve(branch: &Branch) -> impl Iterator<Item = Special> {
    (0..branch.points()).map(|point| Special {
        point,
        omega: branch.omega()[point],
        amplitude: branch.amplitude()[point],
    })
}
