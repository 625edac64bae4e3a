//! A mesh: positions of its nodes, sets of them, and elements.

use crate::meshes::inp_cards::expanded;
use crate::meshes::mesh_elements::{Element, Shape};
use crate::texts::outcome::Outcome;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};

/// Positions and sets of nodes, and elements between them.
#[derive(Debug, Default)]
pub struct Mesh {
    path: PathBuf,
    positions: HashMap<i64, [f64; 3]>,
    /// By names in capital letters.
    sets: HashMap<String, Vec<i64>>,
    elements: Vec<Element>,
    /// Numbers of the elements of sets, by names in capital letters.
    element_sets: HashMap<String, Vec<i64>>,
    /// Words of an element whose lines go on.
    open: Vec<i64>,
}

/// Where the lines of a mesh belong.
enum Section {
    /// To nodes, and to a set.
    Nodes(Option<String>),
    /// To a set, whose lines may be ranges.
    Set(String, bool),
    /// To a set of elements, whose lines may be ranges.
    ElementSet(String, bool),
    /// To elements of a shape, and to a set of them.
    Elements(Shape, Option<String>),
    Other,
}

impl Mesh {
    /// Reads a mesh with the files that it includes, or lines of number, x, y and z.
    ///
    /// # Errors
    /// A sentence that names the file and the line.
    pub fn read(path: &Path) -> Outcome<Self> {
        let said = |e: String| format!("{}: {e}", path.display());
        let text = expanded(path)?;
        let mut mesh = Self::parse(&text).map_err(said)?;
        path.clone_into(&mut mesh.path);
        Ok(mesh)
    }

    fn parse(text: &str) -> Outcome<Self> {
        let mut mesh = Self::default();
        let mut section = Section::Nodes(None);
        for (k, line) in text.lines().enumerate() {
            let line = line.trim();
            if line.is_empty() || line.starts_with("**") || line.starts_with('#') {
                continue;
            }
            if let Some(keyword) = line.strip_prefix('*') {
                mesh.finish_element().map_err(|e| format!("line {}: {e}", k + 1))?;
                section = keyword_section(keyword);
                continue;
            }
            let words: Vec<&str> = line.split([',', ' ', '\t']).filter(|word| !word.is_empty()).collect();
            match &section {
                Section::Nodes(set) => mesh.add_node(&words, set.as_deref()),
                Section::Set(name, ranges) => mesh.add_to_set(&words, name, *ranges),
                Section::ElementSet(name, ranges) => mesh.add_to_element_set(&words, name, *ranges),
                Section::Elements(shape, set) => mesh.add_element(&words, *shape, set.as_deref()),
                Section::Other => Ok(()),
            }
            .map_err(|e| format!("line {}: {e}", k + 1))?;
        }
        mesh.finish_element()?;
        mesh.sets_of_elements();
        Ok(mesh)
    }

    fn add_to_element_set(&mut self, words: &[&str], set: &str, ranges: bool) -> Outcome<()> {
        let mut found = Vec::new();
        for word in words {
            match word.parse() {
                Ok(number) => found.push(number),
                Err(_) => found.extend(
                    self.element_sets
                        .get(&word.to_uppercase())
                        .into_iter()
                        .flatten()
                        .copied(),
                ),
            }
        }
        if let (true, &[first, last, ref step @ ..]) = (ranges, &found[..]) {
            let step = step.first().copied().unwrap_or(1);
            if step <= 0 {
                return Err("needs first, last and step of a range of elements".into());
            }
            let within = |number: &i64| (first..=last).contains(number) && number.abs_diff(first) % step as u64 == 0;
            found = self.elements.iter().map(|e| e.number).filter(within).collect();
        }
        self.element_sets.entry(set.to_owned()).or_default().extend(found);
        Ok(())
    }

    /// A set of elements is that of their nodes, too, unless there is one of nodes with its name.
    fn sets_of_elements(&mut self) {
        let place: HashMap<i64, usize> = self.elements.iter().enumerate().map(|(i, e)| (e.number, i)).collect();
        let mut all: HashMap<String, Vec<usize>> = HashMap::new();
        for (i, element) in self.elements.iter().enumerate() {
            if let Some(set) = &element.set {
                all.entry(set.clone()).or_default().push(i);
            }
        }
        for (name, numbers) in &self.element_sets {
            all.entry(name.clone())
                .or_default()
                .extend(numbers.iter().filter_map(|n| place.get(n)));
        }
        for (name, elements) in all {
            let nodes: BTreeSet<i64> = elements
                .iter()
                .flat_map(|i| &self.elements[*i].nodes)
                .copied()
                .collect();
            self.sets.entry(name).or_insert_with(|| nodes.into_iter().collect());
        }
    }

    /// Adds words of an element: its number and its nodes, on one line or several.
    fn add_element(&mut self, words: &[&str], shape: Shape, set: Option<&str>) -> Outcome<()> {
        for word in words {
            let number = word
                .parse()
                .map_err(|_| format!("{word:?} is no number of an element or node"))?;
            self.open.push(number);
            if self.open.len() == 1 + shape.nodes() {
                let all = std::mem::take(&mut self.open);
                self.elements.push(Element {
                    number: all[0],
                    shape,
                    nodes: all[1..].to_vec(),
                    set: set.map(str::to_owned),
                });
            }
        }
        Ok(())
    }

    /// Refuses an element that has too few nodes.
    fn finish_element(&self) -> Outcome<()> {
        match self.open.first() {
            None => Ok(()),
            Some(number) => Err(format!("element {number} has too few nodes: {}", self.open.len() - 1)),
        }
    }

    fn add_node(&mut self, words: &[&str], set: Option<&str>) -> Outcome<()> {
        let bad = || "needs number, x, y, z of a node".to_owned();
        let [number, position @ ..] = words else {
            return Err(bad());
        };
        if position.len() != 3 {
            return Err(bad());
        }
        let number: i64 = number.parse().map_err(|_| bad())?;
        let mut x = [0.0; 3];
        for (x, word) in x.iter_mut().zip(position) {
            *x = word.parse().map_err(|_| bad())?;
        }
        if !x.iter().all(|x: &f64| x.is_finite()) {
            return Err(format!("the position of node {number} is not finite"));
        }
        if self.positions.insert(number, x).is_some() {
            return Err(format!("node {number} comes twice"));
        }
        if let Some(set) = set {
            self.sets.entry(set.to_owned()).or_default().push(number);
        }
        Ok(())
    }

    fn add_to_set(&mut self, words: &[&str], set: &str, ranges: bool) -> Outcome<()> {
        let mut found = Vec::new();
        if ranges {
            let numbers: Vec<i64> = words.iter().map_while(|word| word.parse().ok()).collect();
            let (first, last, step) = match (numbers.len() == words.len(), &numbers[..]) {
                (true, &[first, last]) => (first, last, 1),
                (true, &[first, last, step]) if step > 0 => (first, last, step),
                _ => return Err("needs first, last and step of a range of nodes".into()),
            };
            let step = usize::try_from(step).map_err(|e| e.to_string())?;
            // Numbers that are no nodes are left out, so that a range is no longer than the mesh.
            let mut within: Vec<i64> = self
                .positions
                .keys()
                .copied()
                .filter(|n| (first..=last).contains(n))
                .collect();
            within.sort_unstable();
            found.extend(within.into_iter().filter(|n| n.abs_diff(first) % step as u64 == 0));
        } else {
            for word in words {
                match word.parse() {
                    Ok(number) => found.push(number),
                    Err(_) => match self.set(word) {
                        Some(other) => found.extend(other),
                        None => return Err(format!("{word:?} is no number of a node and no set before it")),
                    },
                }
            }
        }
        let set = self.sets.entry(set.to_owned()).or_default();
        for number in found {
            if !set.contains(&number) {
                set.push(number);
            }
        }
        Ok(())
    }

    /// Numbers of the nodes of a set.
    pub fn set(&self, name: &str) -> Option<&[i64]> {
        self.sets.get(&name.to_uppercase()).map(Vec::as_slice)
    }

    /// Position of a node.
    ///
    /// # Errors
    /// A sentence.
    pub fn position(&self, number: i64) -> Outcome<[f64; 3]> {
        let at = self.positions.get(&number).copied();
        at.ok_or_else(|| format!("node {number} is not in {}", self.path.display()))
    }

    /// Elements in the order of the file: those that fill space, where there are any; else all.
    pub fn drawn(&self) -> Vec<&Element> {
        let solid = self.elements.iter().any(|element| element.shape.is_solid());
        let shown = |element: &&Element| !solid || element.shape.is_solid();
        self.elements.iter().filter(shown).collect()
    }

    /// The largest number of a node.
    pub fn last_number(&self) -> i64 {
        self.positions.keys().copied().max().unwrap_or(0)
    }

    /// Whether all elements that are known fill space.
    pub fn is_solid(&self) -> bool {
        self.elements.iter().all(|element| element.shape.is_solid())
    }

    /// Names of the sets of nodes in capital letters, with the number of nodes, in order.
    pub fn set_names(&self) -> Vec<(&str, usize)> {
        let mut names: Vec<(&str, usize)> = self.sets.iter().map(|(name, set)| (name.as_str(), set.len())).collect();
        names.sort_unstable();
        names
    }

    /// Path of the file, for sentences.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// The section that a keyword opens.
fn keyword_section(keyword: &str) -> Section {
    let mut words = keyword.split(',').map(str::trim);
    let word = words.next().unwrap_or("").to_uppercase();
    let (mut set, mut ranges, mut kind, mut elements) = (None, false, String::new(), None);
    for option in words {
        match option.split_once('=') {
            Some((name, value)) if name.trim().eq_ignore_ascii_case("nset") => set = Some(value.trim().to_uppercase()),
            Some((name, value)) if name.trim().eq_ignore_ascii_case("elset") => {
                elements = Some(value.trim().to_uppercase());
            }
            Some((name, value)) if name.trim().eq_ignore_ascii_case("type") => kind = value.trim().to_uppercase(),
            _ => ranges |= option.eq_ignore_ascii_case("generate"),
        }
    }
    match (word.as_str(), set) {
        ("NODE", set) => Section::Nodes(set),
        ("NSET", Some(set)) => Section::Set(set, ranges),
        ("ELSET", _) => elements.map_or(Section::Other, |set| Section::ElementSet(set, ranges)),
        ("ELEMENT", _) => Shape::of_type(&kind).map_or(Section::Other, |shape| Section::Elements(shape, elements)),
        _ => Section::Other,
    }
}

#[cfg(test)]
mod tests {
    use super::Mesh;

    #[test]
    fn nodes_of_lists_and_meshes_are_read() {
        let plain = Mesh::parse("# x y z\n3 0.5 1e-3 -2\n7,1,2,3\n").unwrap();
        assert_eq!(
            (plain.position(3), plain.position(7)),
            (Ok([0.5, 1e-3, -2.0]), Ok([1.0, 2.0, 3.0]))
        );
        let mesh =
            "*HEADING\nA wheel\n*Node, NSET=all\n 1, 0., 1., 2.\n*ELEMENT\n1, 1, 2\n*NODE PRINT\nU\n*node\n2,3,4,5\n";
        let mesh = Mesh::parse(mesh).unwrap();
        assert_eq!(
            (mesh.position(1), mesh.position(2)),
            (Ok([0.0, 1.0, 2.0]), Ok([3.0, 4.0, 5.0]))
        );
        assert_eq!((mesh.set("ALL"), mesh.set("every")), (Some(&[1][..]), None));
        for (text, line) in [
            ("1 2 3\n", "line 1"),
            ("1 2 3 4\n1 2 3 4\n", "line 2"),
            ("1 2 x 4", "line 1"),
            ("1 2 inf 4", "line 1"),
            ("*NSET, NSET=a\n1, b\n", "line 2"),
            ("*NSET, NSET=a, GENERATE\n1, 5, 0\n", "line 2"),
        ] {
            assert!(Mesh::parse(text).unwrap_err().contains(line), "{text}");
        }
    }

    #[test]
    fn elements_may_have_several_lines() {
        let mesh = "*NODE\n1,0,0,0\n*ELEMENT, TYPE=C3D10, ELSET=Wheel\n7, 1,2,3,4,5,\n6,7,8,9,10\n8,1,2,3,4,5,6,7,8,9,11\n\
                    *ELEMENT, TYPE=CPS3\n9,1,2,3\n*ELEMENT,TYPE=MASS\n10,1\n*MATERIAL,NAME=a\n";
        let mesh = Mesh::parse(mesh).unwrap();
        let drawn = mesh.drawn();
        assert_eq!(drawn.len(), 2);
        assert_eq!(
            (drawn[0].number, &drawn[0].nodes[..], drawn[0].set.as_deref()),
            (7, &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10][..], Some("WHEEL"))
        );
        assert_eq!((mesh.elements.len(), mesh.set("wheel").map(<[_]>::len)), (3, Some(11)));
        assert!(
            Mesh::parse("*ELEMENT, TYPE=C3D4\n1,1,2,3\n*NSET,NSET=a\n1\n")
                .unwrap_err()
                .contains("too few nodes")
        );
    }

    #[test]
    fn sets_have_numbers_ranges_and_other_sets() {
        let nodes = (1..=9).map(|n| format!("{n},0,0,0\n")).collect::<Vec<_>>().concat();
        let mesh = format!(
            "*NODE\n{nodes}*NSET, NSET=Tip\n4,\n*nset , generate, nset=Odd\n1, 20000000000, 2\n*NSET,NSET=Both\nTIP, odd, 2, 3\n"
        );
        let mesh = Mesh::parse(&mesh).unwrap();
        assert_eq!(mesh.set("tip"), Some(&[4][..]));
        assert_eq!(mesh.set("odd"), Some(&[1, 3, 5, 7, 9][..]));
        assert_eq!(mesh.set("both"), Some(&[4, 1, 3, 5, 7, 9, 2][..]));
    }
}
