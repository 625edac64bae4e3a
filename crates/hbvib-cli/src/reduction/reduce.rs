//! The verb `reduce`: a model of a job by either method, written as a superelement, with its error.

use crate::building::build::{built, read_matrices};
use crate::building::built::Built;
use crate::job_file::job::Job;
use crate::job_file::job_faces::MatchingName;
use crate::job_file::job_words::DofName;
use crate::print;
use crate::reduction::pencil::Modes;
use crate::reduction::reduced_basis::Basis;
use crate::texts::arguments::{MethodName, ReduceArguments};
use crate::texts::convert::format_of;
use crate::texts::events;
use crate::texts::outcome::Outcome;
use hbvib::{ContactState, Interrupt};
use hbvib_io::{Dof, Format, Matrices};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Frequency up to which errors are told over the highest one of [forced].
const ABOVE: f64 = 1.5;

/// Direction of a mode in user elements, which need one: none of a translation or rotation.
const OTHER: i64 = 7;

/// Number of modes that is tried first.
const FIRST: usize = 20;

/// Frequencies that are compared.
const COMPARED: usize = 10;

/// Keys with degrees of freedom.
const NUMBERED: [&str; 7] = ["a", "b", "dof", "dofs", "dof_x", "dof_y", "response_dof"];

/// Keys of [model] whose files the reduced one replaces.
const MATRICES: [&str; 5] = ["matrices", "stiffness", "mass", "damping", "structural"];

/// Reduces the model of a job.
///
/// # Errors
/// A sentence.
pub fn reduce(of: &ReduceArguments) -> Outcome<u8> {
    let job = Job::read(&of.job)?;
    refuse(&job)?;
    let format = format_of(of.format.as_deref(), &of.output)?;
    let full = built(&job)?;
    let kept = kept(&job, &full, &of.keep)?;
    let found = read_matrices(&job)?;
    let mut basis = Basis::new(of.method, &found, &kept, &full.fixed)?;
    let limit = range(&job, &full)?;
    let reference = Reference::of(&full, limit)?;
    let mut told = match (of.modes, of.up_to_hz) {
        (None, None) => None,
        (count, up_to) => {
            basis.set_modes(count.map_or(Modes::UpTo(up_to.unwrap_or(limit)), Modes::Count))?;
            Some(reference.error(&job, &basis, (&found, &kept), &full)?)
        }
    };
    let mut count = FIRST;
    while told.is_none() {
        basis.set_modes(Modes::Count(count))?;
        let error = reference.error(&job, &basis, (&found, &kept), &full)?;
        let enough = error.gap.is_none_or(|gap| gap <= of.tolerance);
        if enough || basis.is_complete {
            told = Some(error);
        }
        count *= 2;
    }
    let told = told.map_or(String::new(), |error| error.sentence);
    let direction = if format == Format::UserElement { OTHER } else { 0 };
    let reduced = matrices_of(&basis, &found, &kept, direction)?;
    let mut files = Vec::new();
    let folder = of.output.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    })
    .map_err(|e| format!("{}: cannot be made: {e}", folder.display()))?;
    files.extend(hbvib_io::write(&of.output, &reduced, format).map_err(|e| e.to_string())?);
    let mut text = format!(
        "{} of {} degrees of freedom: {} kept, {} modes with these {}{}\n",
        basis.order(),
        full.model.ndof(),
        basis.kept(),
        basis.mode_hz.len(),
        interface(of.method),
        basis
            .mode_hz
            .last()
            .map_or(String::new(), |hertz| format!(", up to {hertz:.4} Hz")),
    );
    text += &told;
    let table = of.output.with_extension("dofs.csv");
    fs::write(&table, numbering(&full, &kept, &basis, interface(of.method)))
        .map_err(|e| format!("{}: cannot be written: {e}", table.display()))?;
    files.push(table);
    // Formats with names serve the same job.
    let has_names = matches!(format, Format::Dmig | Format::UserElement | Format::Npz);
    if has_names && !full.nodes.numbers().is_empty() && !has_numbers(&job) {
        let own = of.output.with_extension("toml");
        fs::write(&own, job_text(&job, of.output.file_name())?)
            .map_err(|e| format!("{}: cannot be written: {e}", own.display()))?;
        files.push(own);
    } else {
        text += "this format, model or job has no names of nodes: a job names the degrees of freedom of the table\n";
    }
    for path in files {
        events::wrote(&path);
        let _ = writeln!(text, "wrote {}", path.display());
    }
    print(&text)?;
    Ok(0)
}

/// State of the kept degrees of freedom in the modes.
fn interface(method: MethodName) -> &'static str {
    match method {
        MethodName::CraigBampton => "fixed",
        MethodName::FreeInterface => "free",
    }
}

/// Whether the job gives degrees of freedom by number: these are rows of the whole model.
fn has_numbers(job: &Job) -> bool {
    fn any(value: &toml::Value) -> bool {
        match value {
            toml::Value::Integer(_) => true,
            toml::Value::Array(all) => all.iter().any(any),
            _ => false,
        }
    }
    fn in_part(part: &toml::Value) -> bool {
        match part {
            toml::Value::Array(all) => all.iter().any(in_part),
            toml::Value::Table(keys) => NUMBERED.iter().any(|key| keys.get(*key).is_some_and(any)),
            _ => false,
        }
    }
    let Ok(whole) = job.text.parse::<toml::Table>() else {
        return false;
    };
    whole.values().any(in_part)
}

/// Refuses models that are not reduced.
fn refuse(job: &Job) -> Outcome<()> {
    let part = &job.model;
    if !part.at_speed.is_empty() {
        return Err("[[model.at_speed]] is not reduced; matrices at one speed are".into());
    }
    if !job.damper.is_empty() {
        return Err("[[damper]] is not reduced: reduce the job without it, and add it to the reduced one".into());
    }
    if part
        .faces
        .as_ref()
        .is_some_and(|faces| faces.matching == MatchingName::Projected)
    {
        return Err("[model.faces]: matching = \"projected\" is not reduced".into());
    }
    for (key, path) in [
        ("gyroscopic", &part.gyroscopic),
        ("stiffness_speed2", &part.stiffness_speed2),
        ("coupling_stiffness", &part.coupling_stiffness),
        ("coupling_mass", &part.coupling_mass),
        ("coupling_gyroscopic", &part.coupling_gyroscopic),
        ("coupling_stiffness_speed2", &part.coupling_stiffness_speed2),
    ] {
        if path.is_some() {
            return Err(format!(
                "[model], {key}: is not reduced; a sector needs both faces in [model.faces]"
            ));
        }
    }
    Ok(())
}

/// Degrees of freedom that stay: those of faces, contacts, forces, responses and of the arguments.
fn kept(job: &Job, full: &Built, more: &[String]) -> Outcome<Vec<usize>> {
    let model = &full.model;
    let mut kept: BTreeSet<usize> = full.face_dofs.iter().copied().collect();
    for contact in model.contacts() {
        kept.extend(contact.dof_a.iter().chain(&contact.dof_b).flatten());
        kept.extend(&contact.dofs);
    }
    kept.extend(model.excitation().forces().iter().map(|force| force.dof));
    kept.extend(job.unbalance.iter().flat_map(|one| [one.dof_x, one.dof_y]));
    let responses = job.response.iter().flat_map(|part| &part.dofs);
    let analyses = [
        job.forced.as_ref().and_then(|part| part.response_dof.as_ref()),
        job.mode.as_ref().and_then(|part| part.response_dof.as_ref()),
    ];
    for name in responses.chain(analyses.into_iter().flatten()) {
        kept.insert(full.nodes.dof(name)?);
    }
    for name in more {
        let name = name
            .parse()
            .map_or_else(|_| DofName::Node(name.clone()), DofName::Number);
        kept.insert(full.nodes.dof(&name).map_err(|e| format!("--keep: {e}"))?);
    }
    // Relative motions of surfaces need both sides.
    if let Some(relative) = &full.nodes.relative {
        let others: Vec<usize> = kept
            .iter()
            .flat_map(|row| relative.weights(*row))
            .map(|(row, _)| *row as usize)
            .collect();
        kept.extend(others);
    }
    for row in &full.fixed {
        kept.remove(row);
    }
    if kept.is_empty() {
        return Err("the job names no contact, force or response: --keep names what stays".into());
    }
    Ok(kept.into_iter().collect())
}

/// All matrices on the basis, with names of nodes: modes have numbers after the last node.
fn matrices_of(basis: &Basis, found: &Matrices, kept: &[usize], direction: i64) -> Outcome<Matrices> {
    let on = |name: &str, a: &Option<hbvib_io::Matrix>| a.as_ref().map(|a| basis.reduced(name, a)).transpose();
    let mut dofs: Vec<Dof> = Vec::new();
    if found.dofs.len() == found.stiffness.as_ref().map_or(0, |a| a.rows) && !found.dofs.is_empty() {
        dofs.extend(kept.iter().map(|row| found.dofs[*row]));
        let last = found.dofs.iter().map(|(node, _)| *node).max().unwrap_or(0);
        dofs.extend((1..=basis.mode_hz.len() as i64).map(|k| (last + k, direction)));
    }
    Ok(Matrices {
        stiffness: on("stiffness", &found.stiffness)?,
        mass: on("mass", &found.mass)?,
        damping: on("damping", &found.damping)?,
        structural: on("structural", &found.structural)?,
        dofs,
        others: Vec::new(),
    })
}

/// Row of the reduced matrices for each kept degree of freedom and mode.
fn numbering(full: &Built, kept: &[usize], basis: &Basis, interface: &str) -> String {
    let mut text = format!("row,degree_of_freedom,name,{interface}_mode_hz\n");
    for (row, dof) in kept.iter().enumerate() {
        let _ = writeln!(text, "{row},{dof},{},", full.nodes.name_of(*dof));
    }
    for (k, hertz) in basis.mode_hz.iter().enumerate() {
        let _ = writeln!(text, "{},,mode {},{hertz:.10e}", kept.len() + k, k + 1);
    }
    text
}

/// The job with the reduced matrices in place of its own.
fn job_text(job: &Job, file: Option<&std::ffi::OsStr>) -> Outcome<String> {
    let file = file.and_then(|name| name.to_str()).ok_or("names no file")?;
    let whole = fs::canonicalize(if job.folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        &job.folder
    });
    let folder = whole.map_err(|e| e.to_string())?;
    let mut text = String::from("# The job on its reduced model, written by hbvib reduce.\n");
    let mut section = String::new();
    for line in job.text.lines() {
        let bare = line.trim();
        if bare.starts_with('[') {
            bare.clone_into(&mut section);
        }
        let key = bare.split(['=', ' ']).next().unwrap_or("");
        let key = key
            .strip_prefix("model.")
            .filter(|_| section.is_empty())
            .unwrap_or(if section == "[model]" { key } else { "" });
        match key {
            _ if MATRICES.contains(&key) => continue,
            "fixed" => continue,
            "mesh" => {
                let mesh = job.model.mesh.as_ref().map(|mesh| folder.join(mesh));
                let mesh = serde_json::to_string(&mesh).map_err(|e| e.to_string())?;
                let _ = writeln!(text, "{}mesh = {mesh}", if section.is_empty() { "model." } else { "" });
            }
            _ => {
                let _ = writeln!(text, "{}", own_result(line, &section, file));
            }
        }
        if section == "[model]" && bare.starts_with("[model]") {
            let _ = writeln!(text, "matrices = {file:?}");
        }
    }
    if !text.contains(&format!("matrices = {file:?}")) {
        text = format!("model.matrices = {file:?}\n{text}");
    }
    Ok(text)
}

/// Keys of files that a job writes.
const RESULTS: [&str; 10] = [
    "csv",
    "npz",
    "figure",
    "slip_csv",
    "slip_figure",
    "vtu",
    "uff",
    "netcdf",
    "frd",
    "report",
];

/// A line of the job with its file of results named after the reduced model, so that those of the whole one stay.
fn own_result(line: &str, section: &str, model: &str) -> String {
    let key = line.split('=').next().unwrap_or("").trim();
    let key = key.strip_prefix("output.").unwrap_or(key);
    let is_result = RESULTS.contains(&key) && section != "[model]" && !section.starts_with("[[data");
    let stem = Path::new(model).file_stem().and_then(|stem| stem.to_str());
    let (Some((before, rest)), Some(stem), true) = (line.split_once('"'), stem, is_result) else {
        return line.to_string();
    };
    let end = rest.find('"').unwrap_or(rest.len());
    let name = rest[..end].rfind(['/', '\\']).map_or(0, |at| at + 1);
    format!("{before}\"{}{stem}_{}", &rest[..name], &rest[name..])
}

/// Frequency up to which the error is told: half above that of [forced], or the third natural one.
fn range(job: &Job, full: &Built) -> Outcome<f64> {
    if let Some(forced) = &job.forced {
        return Ok(ABOVE * forced.from_hz.max(forced.to_hz));
    }
    let model = &full.model;
    let structure = model.structure();
    let wave = structure.signed_diameter(structure.engine_order());
    let modes = model.lowest_modes(wave, ContactState::Stuck, 3.min(structure.ndof()));
    let modes = modes.map_err(|e| e.to_string())?;
    Ok(ABOVE * modes.omega.last().map_or(0.0, |w| w / TAU))
}

/// Natural frequencies of the whole model, with which those of reduced ones are compared.
struct Reference {
    limit: f64,
    /// Nodal diameter, stuck contacts, number of rigid motions that are left out, and frequencies.
    found: Vec<(i64, bool, usize, Vec<f64>)>,
}

/// The error of a reduced model.
struct Told {
    /// Largest relative difference; `None` where it is not known.
    gap: Option<f64>,
    sentence: String,
}

impl Reference {
    fn of(full: &Built, limit: f64) -> Outcome<Self> {
        let structure = full.model.structure();
        let wave = structure.signed_diameter(structure.engine_order());
        let mut diameters = vec![0];
        if wave != 0 {
            diameters.push(wave);
        }
        let mut found = Vec::new();
        for diameter in diameters {
            let rigid = full
                .model
                .rigid_modes(diameter, &Interrupt::none())
                .map_err(|e| e.to_string())?;
            for stuck in [false, true] {
                found.push((diameter, stuck, rigid, frequencies(full, (diameter, stuck), COMPARED)?));
            }
        }
        Ok(Self { limit, found })
    }

    /// The largest difference of a frequency up to the limit, of the first one at least.
    fn error(&self, job: &Job, basis: &Basis, (found, kept): (&Matrices, &[usize]), full: &Built) -> Outcome<Told> {
        if full.nodes.numbers().is_empty() || has_numbers(job) {
            return Ok(Told {
                gap: None,
                sentence: "the error is not told: it needs matrices that name nodes, and a job that does\n".into(),
            });
        }
        // The reduced model as a job would read it.
        let name = format!(".hbvib_{}.npz", std::process::id());
        let file = job.path(Path::new(&name));
        let written = matrices_of(basis, found, kept, 0).and_then(|reduced| {
            hbvib_io::write(&file, &reduced, Format::Npz).map_err(|e| e.to_string())?;
            built(&Job::parse(&job_text(job, Some(name.as_ref()))?, &job.folder)?)
        });
        let _ = fs::remove_file(&file);
        let reduced = written.map_err(|e| format!("the reduced model: {e}"))?;
        let mut worst = (0.0_f64, 0.0, 0, false);
        let mut all = 0;
        for (diameter, stuck, rigid, whole) in &self.found {
            let own = frequencies(&reduced, (*diameter, *stuck), COMPARED)?;
            // Rigid motions have no frequency; stuck contacts may hold them, or not.
            let first = if *stuck { 0 } else { *rigid };
            let pairs = whole.iter().zip(&own).skip(first);
            for (_, (a, b)) in pairs.enumerate().filter(|(k, (a, _))| *k == 0 || **a <= self.limit) {
                let gap = (b / a - 1.0).abs();
                let vibrates = *a > 1e-6 * self.limit;
                all += usize::from(vibrates);
                if vibrates && gap > worst.0 {
                    worst = (gap, *a, *diameter, *stuck);
                }
            }
        }
        let (gap, hertz, diameter, stuck) = worst;
        let state = if stuck { "stuck" } else { "free" };
        Ok(Told {
            gap: Some(gap),
            sentence: format!(
                "error of the {all} natural frequencies up to {:.4} Hz: at most {gap:.2e}, at {hertz:.4} Hz of diameter {diameter} with \
                 {state} contacts\n",
                self.limit
            ),
        })
    }
}

/// The lowest natural frequencies, Hz.
fn frequencies(of: &Built, (diameter, stuck): (i64, bool), count: usize) -> Outcome<Vec<f64>> {
    let state = if stuck { ContactState::Stuck } else { ContactState::Free };
    let count = count.min(of.model.structure().ndof());
    let modes = of.model.lowest_modes(diameter, state, count);
    let modes = modes.map_err(|e| format!("natural frequencies of diameter {diameter}: {e}"))?;
    Ok(modes.omega.iter().map(|w| w / TAU).collect())
}
