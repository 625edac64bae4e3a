//! The verb `init`: a first job from matrices, or from a mesh whose matrices CalculiX makes.

use crate::meshes::mesh::Mesh;
use crate::print;
use crate::static_steps::calculix_run::made;
use crate::static_steps::ccx_deck::{Material, deck};
use crate::texts::arguments::InitArguments;
use crate::texts::init_job::{Choices, Written, text};
use crate::texts::outcome::Outcome;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Writes the job.
///
/// # Errors
/// A sentence.
pub fn init(of: &InitArguments) -> Outcome<u8> {
    if of.stiffness.is_none() && of.matrices.is_none() && of.mesh.is_none() {
        return Err("needs --stiffness and --mass, --matrices, or --mesh".into());
    }
    if of.output.exists() && !of.overwrite {
        return Err(format!(
            "{} is there: --output names another file, --overwrite replaces it",
            of.output.display()
        ));
    }
    let folder = of.output.parent().unwrap_or(Path::new(""));
    if !folder.as_os_str().is_empty() {
        fs::create_dir_all(folder).map_err(|e| format!("{}: cannot be made: {e}", folder.display()))?;
    }
    let mesh = match &of.mesh {
        Some(path) => Some(Mesh::read(path)?),
        None => None,
    };
    let mut told = String::new();
    let matrices = match (&of.matrices, &of.stiffness, &mesh) {
        (None, None, Some(mesh)) => Some(by_calculix(of, mesh, folder, &mut told)?),
        (matrices, ..) => matrices.clone(),
    };
    let mut files = String::new();
    for (key, path) in [
        ("matrices", &matrices),
        ("stiffness", &of.stiffness),
        ("mass", &of.mass),
        ("damping", &of.damping),
        ("mesh", &of.mesh),
    ] {
        if let Some(path) = path {
            let _ = writeln!(files, "{key} = {}", quoted(&from_folder(path, folder)?)?);
        }
    }
    let choices = Choices {
        files,
        has_mesh: mesh.is_some(),
        sectors: of.sectors,
        engine_order: of.engine_order,
        faces: faces(of, mesh.as_ref())?,
        clamped: mesh.is_some(),
        contacts: of.contact.iter().map(|pair| sides(pair)).collect::<Outcome<_>>()?,
    };
    let Written { text, built, first_hz } = text(&choices, folder)?;
    fs::write(&of.output, text).map_err(|e| format!("{}: cannot be written: {e}", of.output.display()))?;
    built.warn(false)?;
    let _ = write!(
        told,
        "wrote {0}: {1} degrees of freedom, first natural frequency {first_hz:.6} Hz\n\
         next: hbvib check {0}, then hbvib run {0}\n",
        of.output.display(),
        built.model.ndof()
    );
    print(&told)?;
    Ok(0)
}

/// The matrices that CalculiX makes of a mesh, unless they are there and newer.
fn by_calculix(of: &InitArguments, mesh: &Mesh, folder: &Path, told: &mut String) -> Outcome<PathBuf> {
    let stem = mesh.path().file_stem().unwrap_or_default().to_string_lossy();
    let job = format!("{stem}_matrices");
    let (input, stiffness) = (folder.join(format!("{job}.inp")), folder.join(format!("{job}.sti")));
    let material = Material {
        young: of.young,
        poisson: of.poisson,
        density: of.density,
    };
    let wanted = deck(mesh, material, &of.fixed)?;
    if made(&of.ccx, (&input, &wanted), &stiffness)? {
        let _ = writeln!(told, "{} {job} made {}", of.ccx, stiffness.display());
    }
    Ok(stiffness)
}

/// Sets of the faces of a sector.
fn faces(of: &InitArguments, mesh: Option<&Mesh>) -> Outcome<Option<[String; 2]>> {
    let Some(mesh) = mesh.filter(|_| of.sectors > 1) else {
        return Ok(None);
    };
    for set in [&of.left, &of.right] {
        if mesh.set(set).is_none() {
            let known: Vec<&str> = mesh.set_names().into_iter().map(|(name, _)| name).collect();
            return Err(format!(
                "--sectors {} needs the sets of both faces: there is no set {set} in {} ({}); --left and --right name them",
                of.sectors,
                mesh.path().display(),
                known.join(", ")
            ));
        }
    }
    Ok(Some([of.left.clone(), of.right.clone()]))
}

fn sides(pair: &str) -> Outcome<(String, String)> {
    let both = pair.split_once(':').filter(|(a, b)| !a.is_empty() && !b.is_empty());
    let (a, b) = both.ok_or_else(|| format!("--contact {pair}: needs two sets of nodes as A:B"))?;
    Ok((a.to_owned(), b.to_owned()))
}

/// A path as seen from the folder of the job.
fn from_folder(path: &Path, folder: &Path) -> Outcome<PathBuf> {
    if folder.as_os_str().is_empty() || path.is_absolute() {
        return Ok(path.to_owned());
    }
    let whole = |path: &Path| fs::canonicalize(path).map_err(|e| format!("{}: cannot be read: {e}", path.display()));
    let (path, folder) = (whole(path)?, whole(folder)?);
    Ok(path.strip_prefix(&folder).map_or(path.clone(), Path::to_owned))
}

/// A path as text of TOML.
fn quoted(path: &Path) -> Outcome<String> {
    let text = path
        .to_str()
        .ok_or_else(|| format!("{}: needs a name in UTF-8", path.display()))?;
    serde_json::to_string(text).map_err(|e| e.to_string())
}
