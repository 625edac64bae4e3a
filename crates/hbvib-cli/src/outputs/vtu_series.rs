//! Motion of the mesh for ParaView: a VTU file for each time of the period, one with the harmonics, and the list of the times (.pvd).

use crate::building::built::Built;
use crate::job_file::job_motion::MotionPart;
use crate::outputs::files::Files;
use crate::outputs::node_motion::{ContactField, Places, harmonics};
use crate::outputs::vtu::{Cell, Grid};
use crate::texts::outcome::Outcome;
use hbvib::{Branch, Special};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Number of the cell of one point in VTK.
const VERTEX: u8 = 1;

/// Writes the series of all points, and its list last.
///
/// # Errors
/// A sentence: no mesh, those of the library.
pub fn write(
    (list, part): (&Path, &MotionPart),
    (places, built): (&Places, &Built),
    (branch, points): (&Branch, &[Special]),
    files: &mut Files<'_>,
) -> Outcome<()> {
    places.needs_mesh()?;
    let stem = list.file_stem().ok_or("names no file")?.to_string_lossy().into_owned();
    let folder = PathBuf::from(&stem);
    let sectors = if part.wheel { places.sectors() } else { 1 };
    let mut grid = grid(places, built, sectors);
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (number, special) in points.iter().enumerate() {
        let hertz = special.omega / TAU;
        let motion = harmonics(places, branch, special.point)?;
        let field = ContactField::of(places, built, branch, (special.point, part.phases * sectors))?;
        let name = |end: &str| folder.join(format!("{stem}_{number}_{end}.vtu"));
        for phase in 0..part.phases {
            grid.clear();
            identity(&mut grid, places, sectors);
            at_phase(&mut grid, places, (&motion, &field), (phase, part.phases, sectors));
            let path = name(&format!("{phase:03}"));
            files.write_part(&list.with_file_name(&path), &|path| grid.write(path));
            let _ = writeln!(
                text,
                "<DataSet timestep=\"{}\" group=\"{hertz:.6} Hz\" part=\"0\" file=\"{}\"/>",
                number as f64 + phase as f64 / part.phases as f64,
                path.display().to_string().replace('\\', "/")
            );
        }
        grid.clear();
        identity(&mut grid, places, sectors);
        over_period(&mut grid, places, (&motion, &field), sectors);
        files.write_part(&list.with_file_name(name("harmonics")), &|path| grid.write(path));
    }
    text += "</Collection>\n</VTKFile>\n";
    files.write(Some(list), &|path| fs::write(path, &text).map_err(|e| e.to_string()));
    Ok(())
}

/// Points and cells of all sectors.
fn grid(places: &Places, built: &Built, sectors: usize) -> Grid {
    let mut grid = Grid::default();
    let count = places.numbers.len();
    let elements = built.nodes.mesh.as_ref().map_or(Vec::new(), |mesh| mesh.drawn());
    for sector in 0..sectors {
        grid.points
            .extend(places.at.iter().flat_map(|x| places.turned(*x, sector)));
        let first = sector * count;
        if elements.is_empty() {
            grid.cells.extend((0..count).map(|i| Cell {
                kind: VERTEX,
                points: vec![first + i],
            }));
        }
        for element in &elements {
            let points: Option<Vec<usize>> = element.nodes.iter().map(|node| places.place(*node)).collect();
            grid.cells.extend(points.map(|points| Cell {
                kind: element.shape.vtk(),
                points: points.into_iter().map(|i| first + i).collect(),
            }));
        }
    }
    grid
}

/// Numbers of the nodes, and which of them have rows.
fn identity(grid: &mut Grid, places: &Places, sectors: usize) {
    let all = || (0..sectors).flat_map(|_| 0..places.numbers.len());
    grid.integers("node", all().map(|i| places.numbers[i]));
    grid.integers("has_rows", all().map(|i| places.moves(i).into()));
}

/// Motion, state and forces at one time.
fn at_phase(
    grid: &mut Grid,
    places: &Places,
    (motion, field): (&[Vec<[Complex64; 3]>], &ContactField),
    (phase, phases, sectors): (usize, usize, usize),
) {
    let count = places.numbers.len();
    let mut displacement = Vec::with_capacity(3 * count * sectors);
    let mut state = vec![0_i64; count * sectors];
    let (mut normal, mut tangential) = (vec![0.0; count * sectors], vec![0.0; count * sectors]);
    let steps = phases * sectors;
    for sector in 0..sectors {
        let all = places.at_phase(motion, phase as f64 / phases as f64, sector);
        displacement.extend(all.into_iter().flatten());
        let lag = if sectors > 1 { places.lag(phases, sector) } else { 0 };
        let step = (phase * sectors + steps - lag) % steps;
        for (i, place) in field.places.iter().enumerate() {
            let at = sector * count + place;
            state[at] = field.state[step][i].into();
            normal[at] = field.normal[step][i];
            tangential[at] = field.tangential[step][i];
        }
    }
    grid.reals("displacement", 3, &displacement);
    if !field.places.is_empty() {
        grid.integers("contact_state", state.into_iter());
        grid.reals("contact_normal_force", 1, &normal);
        grid.reals("contact_friction_force", 1, &tangential);
    }
}

/// Real and imaginary part of each harmonic, and shares of slip and opening.
fn over_period(
    grid: &mut Grid,
    places: &Places,
    (motion, field): (&[Vec<[Complex64; 3]>], &ContactField),
    sectors: usize,
) {
    for (h, x) in motion.iter().enumerate() {
        let is_zero = x.iter().flatten().all(|z| *z == Complex64::ZERO);
        if is_zero && h != 1 {
            continue;
        }
        let lag = |sector: usize| {
            let share = places.lag(1, sector) as f64 / places.sectors() as f64;
            Complex64::cis(-TAU * h as f64 * share)
        };
        let part = |of: fn(Complex64) -> f64| -> Vec<f64> {
            let all = (0..sectors).flat_map(|s| x.iter().map(move |u| (s, u)));
            all.flat_map(|(s, u)| places.turned(u.map(|u| of(u * lag(s))), s))
                .collect()
        };
        grid.reals(&format!("harmonic_{h}_real"), 3, &part(|z| z.re));
        if h > 0 {
            grid.reals(&format!("harmonic_{h}_imag"), 3, &part(|z| z.im));
        }
    }
    if field.places.is_empty() {
        return;
    }
    let count = places.numbers.len();
    for (name, shares) in [("slip_share", &field.slip_share), ("open_share", &field.open_share)] {
        let mut all = vec![0.0; count * sectors];
        for sector in 0..sectors {
            for (place, share) in field.places.iter().zip(shares) {
                all[sector * count + place] = *share;
            }
        }
        grid.reals(name, 1, &all);
    }
}
