//! Pressures and gaps of nodes in a static step, from files.

use crate::static_steps::calculix_results::{contact_table, field};
use crate::texts::outcome::Outcome;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A node of a contact at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StaticState {
    /// Normal force per area.
    pub pressure: Option<f64>,
    /// Normal force.
    pub force: Option<f64>,
    /// Distance to the other side; zero where both touch.
    pub gap: f64,
}

/// States of all nodes of a file; nodes that it does not have in contact are left out.
///
/// # Errors
/// A sentence: no such table, a pressure below zero.
pub fn static_states(path: &Path) -> Outcome<BTreeMap<i64, StaticState>> {
    let extension = path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or("")
        .to_ascii_lowercase();
    let found = match extension.as_str() {
        "frd" => of_frd(path)?,
        "dat" => of_dat(path)?,
        "csv" | "txt" => of_csv(path)?,
        _ => {
            return Err(format!(
                "{}: needs .frd (*CONTACT FILE), .dat (*CONTACT PRINT of nodes) or .csv (node, pressure, gap)",
                path.display()
            ));
        }
    };
    for (node, state) in &found {
        let pull = [state.pressure, state.force]
            .into_iter()
            .flatten()
            .find(|force| *force < 0.0);
        if let Some(force) = pull {
            return Err(format!("{}: node {node} is pulled, by {force:e}", path.display()));
        }
    }
    if found.is_empty() {
        return Err(format!("{}: no node is in contact", path.display()));
    }
    Ok(found)
}

/// Opening and pressure of CalculiX: openings below zero are overclosures of its penalty, and zeros are no contact. Its linear penalty
/// pulls a little where the contact is open.
fn of_calculix(opening: f64, pressure: f64) -> Option<StaticState> {
    (opening != 0.0 || pressure != 0.0).then_some(StaticState {
        pressure: Some(if opening > 0.0 { pressure.max(0.0) } else { pressure }),
        force: None,
        gap: if pressure > 0.0 { 0.0 } else { opening.max(0.0) },
    })
}

fn of_frd(path: &Path) -> Outcome<BTreeMap<i64, StaticState>> {
    let field = field(path, "CONTACT")?;
    let place = |name: &str| field.components.iter().position(|component| component == name);
    let (Some(opening), Some(pressure)) = (place("COPEN"), place("CPRESS")) else {
        return Err(format!(
            "{}: needs COPEN and CPRESS of *CONTACT FILE with CDIS, CSTR; has {}",
            path.display(),
            field.components.join(", ")
        ));
    };
    let mut all = BTreeMap::new();
    for (node, values) in &field.values {
        let (Some(opening), Some(pressure)) = (values.get(opening), values.get(pressure)) else {
            return Err(format!("{}: node {node} has {} values", path.display(), values.len()));
        };
        all.extend(of_calculix(*opening, *pressure).map(|state| (*node, state)));
    }
    Ok(all)
}

fn of_dat(path: &Path) -> Outcome<BTreeMap<i64, StaticState>> {
    let openings = contact_table(path, "relative contact displacement")?;
    let pressures = contact_table(path, "contact stress")?;
    let nodes = openings.keys().chain(pressures.keys());
    let of = |node: &i64| {
        let value = |table: &BTreeMap<i64, f64>| table.get(node).copied().unwrap_or(0.0);
        Some((*node, of_calculix(value(&openings), value(&pressures))?))
    };
    Ok(nodes.filter_map(of).collect())
}

fn of_csv(path: &Path) -> Outcome<BTreeMap<i64, StaticState>> {
    let said = |e: String| format!("{}: {e}", path.display());
    let text = fs::read_to_string(path).map_err(|e| said(format!("cannot be read: {e}")))?;
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let cut = |line: &str| -> Vec<String> {
        let words = line
            .split([',', ';', '\t'])
            .map(|word| word.trim().trim_matches('"').to_owned());
        words.collect()
    };
    let head = lines
        .next()
        .map(|(_, line)| cut(line.trim_start_matches('\u{feff}')))
        .unwrap_or_default();
    let place = |name: &str| head.iter().position(|word| word.eq_ignore_ascii_case(name));
    let (node, columns) = (place("node"), ["pressure", "force", "gap"].map(place));
    let Some(node) = node.filter(|_| columns.iter().any(Option::is_some)) else {
        return Err(said(
            "the first line needs names of columns: node, and pressure, force or gap".into(),
        ));
    };
    let mut all = BTreeMap::new();
    for (k, line) in lines {
        let said = |e: &str| said(format!("line {}: {e}", k + 1));
        let words = cut(line);
        let number: Option<i64> = words.get(node).and_then(|word| word.parse().ok());
        let number = number.ok_or_else(|| said("needs the number of a node"))?;
        let [pressure, force, gap] = columns.map(|column| {
            let word = column
                .and_then(|column| words.get(column))
                .filter(|word| !word.is_empty());
            word.map(|word| word.parse::<f64>().ok().filter(|value| value.is_finite()))
        });
        let known = |value: Option<Option<f64>>| match value {
            Some(None) => Err(said("needs finite numbers")),
            Some(value) => Ok(value),
            None => Ok(None),
        };
        let state = StaticState {
            pressure: known(pressure)?,
            force: known(force)?,
            gap: known(gap)?.unwrap_or(0.0),
        };
        if all.insert(number, state).is_some() {
            return Err(said(&format!("node {number} comes twice")));
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::{StaticState, static_states};

    fn of(name: &str, text: &str) -> Result<Vec<(i64, StaticState)>, String> {
        let path = std::env::temp_dir().join(format!("hbvib_{}_{name}", std::process::id()));
        std::fs::write(&path, text).unwrap();
        let found = static_states(&path).map(|all| all.into_iter().collect());
        std::fs::remove_file(&path).unwrap();
        found
    }

    fn state(pressure: Option<f64>, force: Option<f64>, gap: f64) -> StaticState {
        StaticState { pressure, force, gap }
    }

    #[test]
    fn tables_have_columns_in_any_order() {
        let found = of("a.csv", "\u{feff}gap;Node; \"Pressure\"\n0; 7; 2.5\n\n1e-3;3;\n").unwrap();
        assert_eq!(found, [(3, state(None, None, 1e-3)), (7, state(Some(2.5), None, 0.0))]);
        let found = of("b.csv", "node,force\n-4,12\n").unwrap();
        assert_eq!(found, [(-4, state(None, Some(12.0), 0.0))]);
        for (text, words) in [
            ("", "needs names of columns"),
            ("node,x\n1,2\n", "needs names of columns"),
            ("node,gap\nx,2\n", "line 2: needs the number of a node"),
            ("node,gap\n1,inf\n", "line 2: needs finite numbers"),
            ("node,gap\n1,0\n1,0\n", "line 3: node 1 comes twice"),
            ("node,force\n5,-1\n", "node 5 is pulled"),
            ("node,force\n", "no node is in contact"),
        ] {
            let error = of("c.csv", text).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
        assert!(of("d.xlsx", "").unwrap_err().contains(".frd (*CONTACT FILE)"));
    }

    const FRD: &str = " -4  DISP        4    1\n -5  D1          1    2    1    0\n -1        28 1.00000E+00\n -3\n\
        -4  CONTACT     6    1\n -5  COPEN       1    4    1    1\n -5  CSLIP1      1    4    2    2\n -5  CPRESS      1    4    1    2\n \
        -1        28-1.72462E-05 0.00000E+00 1.71462E+02\n -1        29 3.00000E-04 0.00000E+00 0.00000E+00\n \
        -1        30 0.00000E+00 0.00000E+00 0.00000E+00\n -3\n";

    #[test]
    fn fields_of_calculix_have_pressures_and_openings() {
        let found = of("a.frd", FRD).unwrap();
        assert_eq!(
            found,
            [
                (28, state(Some(171.462), None, 0.0)),
                (29, state(Some(0.0), None, 3e-4))
            ]
        );
        assert!(
            of("b.frd", &FRD.replace("CONTACT", "STRESS"))
                .unwrap_err()
                .contains("but DISP, STRESS")
        );
        assert!(
            of("c.frd", &FRD.replace("CPRESS", "CSTATUS"))
                .unwrap_err()
                .contains("needs COPEN and CPRESS")
        );
        assert!(
            of("d.frd", &FRD.replace("-1.72462E-05", "-1.72462E-0x"))
                .unwrap_err()
                .contains("line 9")
        );
        // Cut and changed files are errors or tables, and never a panic.
        for at in 0..FRD.len() {
            let _ = of("e.frd", &FRD[..at]);
            let mut changed = FRD.as_bytes().to_vec();
            changed[at] = changed[at].wrapping_add(37) & 0x7f;
            let _ = of("e.frd", &String::from_utf8(changed).unwrap());
        }
    }

    const DAT: &str = "\n relative contact displacement (slave node,normal,tang1,tang2) for all contact elements and time 0.1E+01\n\n\
        \x20       28 -1.724623E-05  0.000000E+00  0.000000E+00\n        29  3.0E-04  0.000000E+00  0.000000E+00\n\n \
        contact stress (slave node,press,tang1,tang2) for all contact elements and time 0.1000000E+01\n\n        28  1.714624E+02  0.0  0.0\n";

    #[test]
    fn printed_tables_of_contact_are_read() {
        let found = of("a.dat", DAT).unwrap();
        assert_eq!(
            found,
            [
                (28, state(Some(171.4624), None, 0.0)),
                (29, state(Some(0.0), None, 3e-4))
            ]
        );
        let elements = DAT.replace("slave node", "slave element+face");
        assert!(of("b.dat", &elements).unwrap_err().contains("*CONTACT FILE"));
        assert!(of("c.dat", "nothing\n").unwrap_err().contains("has no table"));
        for at in 0..DAT.len() {
            let _ = of("e.dat", &DAT[..at]);
        }
    }
}
