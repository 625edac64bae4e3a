//! Nastran bulk data with DMIG, as EXTSEOUT(DMIGPCH) and MATRIX punch: small, large and free fields; real and complex numbers.
//! Other entries of the file are passed over.

use crate::Result;
use crate::lines::Lines;
use crate::matrix::{Dof, Matrices, Matrix, Symmetry};
use crate::numbered::Numbered;
use crate::numbers::{real, whole};
use crate::op4_parts::Parts;

/// Most matrices of a file.
const MOST: usize = 1000;

/// Columns of a line in fixed fields.
const LINE: usize = 72;

/// Whether a text holds an entry of DMIG.
pub(crate) fn is_dmig(text: &str) -> bool {
    text.lines().any(is_entry)
}

fn is_entry(line: &str) -> bool {
    let word = line.get(..4).unwrap_or("");
    word.eq_ignore_ascii_case("DMIG") && line.as_bytes().get(4).is_none_or(|c| b" *,\t".contains(c))
}

/// Fields of a line after the name of its entry.
struct Card {
    /// Empty for a continuation.
    name: String,
    fields: Vec<String>,
}

fn card(lines: &Lines) -> Result<Option<Card>> {
    let line = lines.text().split('$').next().unwrap_or("");
    if line.trim().is_empty() {
        return Ok(None);
    }
    let fields: Vec<&str> = if line.contains(',') {
        line.split(',').map(str::trim).collect()
    } else if line.contains('\t') {
        return lines.fail("holds tabs, needs fields of 8 or 16 columns, or commas");
    } else {
        let line = line.get(..line.len().min(LINE)).unwrap_or(line);
        let head = line.get(..8.min(line.len())).unwrap_or("");
        let width = if head.contains('*') { 16 } else { 8 };
        let mut all = vec![head.trim()];
        let mut start = 8;
        while let Some(rest) = line.get(start..).filter(|rest| !rest.is_empty()) {
            all.push(rest.get(..width.min(rest.len())).unwrap_or(rest).trim());
            start += width;
        }
        all
    };
    let name = fields[0].trim_end_matches('*').to_ascii_uppercase();
    let continued = name.is_empty() || name.starts_with(['+', '*']);
    Ok(Some(Card {
        name: if continued { String::new() } else { name },
        fields: fields[1..].iter().map(|field| (*field).to_owned()).collect(),
    }))
}

/// A matrix with its entries by degrees of freedom.
struct Found {
    name: String,
    /// Symmetric: one triangle is listed.
    symmetric: bool,
    rectangular: bool,
    polar: bool,
    matrix: Matrix,
}

/// The matrices of a file, with nodes and directions in ascending order.
///
/// # Errors
/// The line and reason.
pub(crate) fn matrices(lines: &mut Lines) -> Result<Matrices> {
    let mut all: Vec<Found> = Vec::new();
    let mut numbered = Numbered::default();
    // The matrix and column that lines continue.
    let mut open: Option<(usize, u32)> = None;
    while lines.advance()? {
        let Some(card) = card(lines)? else { continue };
        let field = |i: usize| card.fields.get(i).map(String::as_str).filter(|text| !text.is_empty());
        let entries = if card.name.is_empty() {
            &card.fields[..]
        } else if card.name != "DMIG" {
            open = None;
            continue;
        } else {
            let Some(name) = field(0).map(str::to_ascii_uppercase) else {
                return lines.fail("the name of the matrix is missing");
            };
            if field(1) == Some("0") && !all.iter().any(|one| one.name == name) {
                all.push(head(lines, name, &card.fields)?);
                if all.len() > MOST {
                    return lines.fail(format_args!("more than {MOST} matrices"));
                }
                open = None;
                continue;
            }
            let Some(at) = all.iter().position(|one| one.name == name) else {
                return lines.fail(format_args!(
                    "a column of {name} before its first entry, DMIG,{name},0,..."
                ));
            };
            open = Some((at, numbered.number(lines, point(lines, field(1), field(2), "column")?)?));
            card.fields.get(4..).unwrap_or(&[])
        };
        let Some((at, column)) = open else { continue };
        let one = &mut all[at];
        // A row has four fields: node, direction, and one or two numbers.
        for row in entries.chunks(4) {
            let field = |i: usize| row.get(i).map(String::as_str).filter(|text| !text.is_empty());
            if field(0).is_none_or(|word| word.starts_with('+')) {
                continue;
            }
            let row = numbered.number(lines, point(lines, field(0), field(1), "row")?)?;
            let first = real(lines, field(2).or(Some("0")), "value")?;
            let second = real(
                lines,
                field(3).filter(|_| one.matrix.is_complex).or(Some("0")),
                "imaginary part",
            )?;
            let value = if one.polar {
                let angle = second.to_radians();
                (first * angle.cos(), first * angle.sin())
            } else {
                (first, second)
            };
            one.matrix.push(lines, row, column, value)?;
        }
    }
    if all.is_empty() {
        return lines.fail(
            "Nastran bulk data without DMIG: needs the matrices as DMIG (EXTSEOUT(DMIGPCH)) or as OP4 (DMIGOP4)",
        );
    }
    finished(lines, all, numbered)
}

fn head(lines: &Lines, name: String, fields: &[String]) -> Result<Found> {
    let field = |i: usize| fields.get(i).map(String::as_str).filter(|text| !text.is_empty());
    let form = whole(lines, field(2), "form")?;
    let kind = whole(lines, field(3), "type")?;
    if !matches!(form, 1 | 2 | 6 | 9) {
        return lines.fail(format_args!("{name}: form = {form}, needs 1, 2, 6 or 9"));
    }
    if !(1..=4).contains(&kind) {
        return lines.fail(format_args!("{name}: type = {kind}, needs 1 .. 4"));
    }
    let polar = field(5).map_or(Ok(0), |word| whole(lines, Some(word), "polar"))?;
    Ok(Found {
        name,
        symmetric: form == 6,
        rectangular: matches!(form, 2 | 9),
        polar: polar > 0 && kind > 2,
        matrix: Matrix::empty((0, 0), Symmetry::General, kind > 2),
    })
}

fn point(lines: &Lines, node: Option<&str>, direction: Option<&str>, what: &str) -> Result<Dof> {
    let node = whole(lines, node, what)?;
    let direction = whole(lines, direction.or(Some("0")), "direction")?;
    if node < 1 || !(0..=6).contains(&direction) {
        return lines.fail(format_args!(
            "{what} is {node}, direction {direction}: needs a node from 1 and a direction 0 .. 6"
        ));
    }
    Ok((node, direction))
}

fn finished(lines: &Lines, all: Vec<Found>, numbered: Numbered) -> Result<Matrices> {
    // Rectangular matrices, as those of loads, have columns that are no degrees of freedom.
    let (square, others): (Vec<Found>, Vec<Found>) = all.into_iter().partition(|one| !one.rectangular);
    let mut used = vec![false; numbered.len()];
    for at in square
        .iter()
        .flat_map(|one| one.matrix.row.iter().chain(&one.matrix.column))
    {
        used[*at as usize] = true;
    }
    let (dofs, places) = numbered.sorted(&used);
    let mut parts = Parts::default();
    for one in others {
        parts.leave_out(one.name);
    }
    for Found {
        name,
        symmetric,
        mut matrix,
        ..
    } in square
    {
        matrix.rows = dofs.len();
        matrix.columns = dofs.len();
        for at in matrix.row.iter_mut().chain(&mut matrix.column) {
            *at = places[*at as usize];
        }
        if symmetric && !matrix.lists_mirror_images() {
            matrix.symmetry = Symmetry::Symmetric;
        }
        parts.take(name, matrix.finished());
    }
    let mut found = parts.finished().or_else(|reason| lines.fail(reason))?;
    found.dofs = dofs;
    Ok(found)
}
