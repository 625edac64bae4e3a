//! Nastran bulk data with DMIG, as EXTSEOUT(DMIGPCH) and MATRIX punch: small, large and free fields; real and complex numbers.
//! Other entries of the file are passed over.
//!
//! A row needs its number: blank fields are zeros only where a complex number has its other part. Nothing counts the rows, so that a
//! file cut off at the end of a line cannot be told; one cut off within a line is refused.

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
    /// The last field ends at its last column: nothing can follow in it.
    is_full: bool,
}

fn card(lines: &Lines) -> Result<Option<Card>> {
    let line = lines.text().split('$').next().unwrap_or("");
    if line.trim().is_empty() {
        return Ok(None);
    }
    let mut is_full = false;
    let fields: Vec<&str> = if line.contains(',') {
        line.split(',').map(str::trim).collect()
    } else if line.contains('\t') {
        return lines.fail("holds tabs, needs fields of 8 or 16 columns, or commas");
    } else {
        let line = line.get(..line.len().min(LINE)).unwrap_or(line);
        let head = line.get(..8.min(line.len())).unwrap_or("");
        let width = if head.contains('*') { 16 } else { 8 };
        is_full = line.len() > 8 && (line.len() - 8).is_multiple_of(width);
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
        is_full,
    }))
}

/// Field `i` of a list unless it is blank.
fn filled(fields: &[String], i: usize) -> Option<&str> {
    fields.get(i).map(String::as_str).filter(|text| !text.is_empty())
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

/// The part of a matrix that lines continue.
enum Open {
    Nothing,
    Head,
    Column {
        matrix: usize,
        column: u32,
        line: usize,
        rows: usize,
    },
}

impl Open {
    fn add(&mut self, count: usize) {
        if let Self::Column { rows, .. } = self {
            *rows += count;
        }
    }

    /// A column of a square matrix without rows has lost them.
    fn close(&self, lines: &Lines, all: &[Found]) -> Result<()> {
        match self {
            Self::Column {
                matrix, line, rows: 0, ..
            } if !all[*matrix].rectangular => {
                let name = &all[*matrix].name;
                lines.fail_at(*line, format_args!("a column of {name} without rows"))
            }
            _ => Ok(()),
        }
    }
}

/// Refuses a file that ends within the last number of a row, or before it.
fn refuse_cut(lines: &Lines, card: &Card, entries: &[String], is_complex: bool) -> Result<()> {
    if !lines.is_unended() {
        return Ok(());
    }
    let last = entries.chunks(4).next_back().unwrap_or(&[]);
    let needed = if is_complex { 3 } else { 2 };
    if filled(last, needed).is_none() {
        return lines.fail("the file ends before the number of a row; end the line if it is whole");
    }
    if card.is_full {
        return Ok(());
    }
    lines.refuse_cut_number()
}

/// Rows of a line, of which each has four fields: node, direction, and one or two numbers. Returns how many there are.
fn take(lines: &Lines, (one, numbered): (&mut Found, &mut Numbered), column: u32, entries: &[String]) -> Result<usize> {
    let mut count = 0;
    for row in entries.chunks(4) {
        match filled(row, 0) {
            // The name of the line that follows.
            Some(word) if word.starts_with(['+', '*']) => continue,
            None if row.iter().all(String::is_empty) => continue,
            _ => {}
        }
        let place = numbered.number(lines, point(lines, (filled(row, 0), filled(row, 1)), "row")?)?;
        let value = number(lines, one, (filled(row, 2), filled(row, 3)))?;
        one.matrix.push(lines, place, column, value)?;
        count += 1;
    }
    Ok(count)
}

/// The number of a row. A blank part of a complex one is zero, as all real fields of bulk data are; a real matrix has no second part.
fn number(lines: &Lines, one: &Found, (first, second): (Option<&str>, Option<&str>)) -> Result<(f64, f64)> {
    if !one.matrix.is_complex {
        let imaginary = real(lines, second.or(Some("0")), "imaginary part")?;
        if imaginary != 0.0 {
            return lines.fail(format_args!(
                "an imaginary part of {imaginary} in {}, whose type is real: needs type 3 or 4 in its first entry, or the number in \
                 the field before",
                one.name
            ));
        }
        return Ok((real(lines, first, "value")?, 0.0));
    }
    let first = if second.is_some() { first.or(Some("0")) } else { first };
    let first = real(lines, first, "value")?;
    let second = real(lines, second.or(Some("0")), "imaginary part")?;
    if one.polar {
        let angle = second.to_radians();
        return Ok((first * angle.cos(), first * angle.sin()));
    }
    Ok((first, second))
}

/// The matrices of a file, with nodes and directions in ascending order.
///
/// # Errors
/// The line and reason.
pub(crate) fn matrices(lines: &mut Lines) -> Result<Matrices> {
    let mut all: Vec<Found> = Vec::new();
    let mut numbered = Numbered::default();
    let mut open = Open::Nothing;
    while lines.advance()? {
        let Some(card) = card(lines)? else { continue };
        let entries = if card.name.is_empty() {
            &card.fields[..]
        } else if card.name != "DMIG" {
            if lines.is_unended() && "DMIG*".starts_with(lines.text().trim_end()) {
                return lines.fail("the file ends within the name of an entry");
            }
            open.close(lines, &all)?;
            open = Open::Nothing;
            continue;
        } else {
            open.close(lines, &all)?;
            let Some(name) = filled(&card.fields, 0).map(str::to_ascii_uppercase) else {
                return lines.fail("the name of the matrix is missing");
            };
            if filled(&card.fields, 1) == Some("0") && !all.iter().any(|one| one.name == name) {
                all.push(head(lines, name, &card.fields)?);
                if all.len() > MOST {
                    return lines.fail(format_args!("more than {MOST} matrices"));
                }
                if lines.is_unended() {
                    return lines.fail("the file ends with the first entry of a matrix, before its columns");
                }
                open = Open::Head;
                continue;
            }
            let Some(at) = all.iter().position(|one| one.name == name) else {
                return lines.fail(format_args!(
                    "a column of {name} before its first entry, DMIG,{name},0,..."
                ));
            };
            if let Some(word) = filled(&card.fields, 3) {
                return lines.fail(format_args!("field 5 of a column is {word:?}, needs to be blank"));
            }
            let place = point(lines, (filled(&card.fields, 1), filled(&card.fields, 2)), "column")?;
            open = Open::Column {
                matrix: at,
                column: numbered.number(lines, place)?,
                line: lines.number(),
                rows: 0,
            };
            card.fields.get(4..).unwrap_or(&[])
        };
        let count = match &open {
            Open::Nothing => continue,
            Open::Head if entries.iter().all(String::is_empty) => continue,
            Open::Head => return lines.fail("rows before their column, DMIG with the name, node and direction"),
            Open::Column { matrix, column, .. } => {
                refuse_cut(lines, &card, entries, all[*matrix].matrix.is_complex)?;
                take(lines, (&mut all[*matrix], &mut numbered), *column, entries)?
            }
        };
        open.add(count);
    }
    open.close(lines, &all)?;
    if all.is_empty() {
        return lines.fail(
            "Nastran bulk data without DMIG: needs the matrices as DMIG (EXTSEOUT(DMIGPCH)) or as OP4 (DMIGOP4)",
        );
    }
    finished(lines, all, numbered)
}

fn head(lines: &Lines, name: String, fields: &[String]) -> Result<Found> {
    let form = whole(lines, filled(fields, 2), "form")?;
    let kind = whole(lines, filled(fields, 3), "type")?;
    if !matches!(form, 1 | 2 | 6 | 9) {
        return lines.fail(format_args!("{name}: form = {form}, needs 1, 2, 6 or 9"));
    }
    if !(1..=4).contains(&kind) {
        return lines.fail(format_args!("{name}: type = {kind}, needs 1 .. 4"));
    }
    let polar = filled(fields, 5).map_or(Ok(0), |word| whole(lines, Some(word), "polar"))?;
    Ok(Found {
        name,
        symmetric: form == 6,
        rectangular: matches!(form, 2 | 9),
        polar: polar > 0 && kind > 2,
        matrix: Matrix::empty((0, 0), Symmetry::General, kind > 2),
    })
}

fn point(lines: &Lines, (node, direction): (Option<&str>, Option<&str>), what: &str) -> Result<Dof> {
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
    if let (true, Some(one)) = (dofs.is_empty(), square.first()) {
        return lines.fail(format_args!("{} has no columns", one.name));
    }
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
