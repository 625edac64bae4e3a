//! Decks of CalculiX for the matrices of a prestressed sector: the static step of a deck with its cyclic symmetry and contacts, and the
//! sector without these under the displacements of that step, which are released in a perturbation that stores the matrices.

use crate::meshes::inp_cards::Card;
use crate::texts::outcome::Outcome;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// Set of the nodes whose displacements are printed.
pub const SET: &str = "HBVIB_NODES";

/// Nodes in a line of a set.
const IN_LINE: usize = 10;

/// Keywords of contact, whose stiffness would be in the matrices.
const CONTACT: [&str; 8] = [
    "CONTACT PAIR",
    "SURFACE INTERACTION",
    "SURFACE BEHAVIOR",
    "FRICTION",
    "CLEARANCE",
    "CONTACT DAMPING",
    "GAP CONDUCTANCE",
    "CHANGE CONTACT TYPE",
];

/// Keywords that ask for files.
const OUTPUT: [&str; 12] = [
    "NODE FILE",
    "NODE OUTPUT",
    "NODE PRINT",
    "EL FILE",
    "ELEMENT OUTPUT",
    "EL PRINT",
    "CONTACT FILE",
    "CONTACT OUTPUT",
    "CONTACT PRINT",
    "SECTION PRINT",
    "FACE PRINT",
    "OUTPUT",
];

/// Keywords of constraints between nodes.
const CONSTRAINTS: [&str; 6] = [
    "EQUATION",
    "MPC",
    "RIGID BODY",
    "COUPLING",
    "DISTRIBUTING COUPLING",
    "KINEMATIC COUPLING",
];

/// A deck with one static step.
pub struct StaticDeck {
    /// Cards before the steps.
    model: Vec<Card>,
    /// Cards of the static step, without those that begin and end it.
    step: Vec<Card>,
    /// The card that begins the step.
    head: Card,
}

impl StaticDeck {
    /// The deck; steps that are not static are left out. A speed takes the place of that of centrifugal loads.
    ///
    /// # Errors
    /// A sentence: no static step, several of them; nodes in local directions; a speed without a centrifugal load.
    pub fn of(cards: &[Card], speed: Option<f64>) -> Outcome<Self> {
        let first = cards.iter().position(|card| card.keyword == "STEP");
        let (model, rest) = cards.split_at(first.unwrap_or(cards.len()));
        let mut found: Vec<Self> = Vec::new();
        for step in rest.split(|card| card.keyword == "END STEP") {
            let Some((head, step)) = step.split_first().filter(|(head, _)| head.keyword == "STEP") else {
                continue;
            };
            if step.iter().any(|card| card.keyword == "STATIC") {
                found.push(Self {
                    model: model.to_vec(),
                    step: step.to_vec(),
                    head: head.clone(),
                });
            }
        }
        if found.len() > 1 {
            return Err("has several *STATIC steps, needs one with all loads".into());
        }
        let mut deck = found.pop().ok_or("has no step with *STATIC, whose loads prestress")?;
        if cards.iter().any(|card| card.keyword == "TRANSFORM") {
            return Err("has *TRANSFORM: displacements are prescribed along x, y and z alone".into());
        }
        if let Some(speed) = speed {
            deck.set_speed(speed)?;
        }
        Ok(deck)
    }

    /// Takes a speed for all centrifugal loads.
    fn set_speed(&mut self, speed: f64) -> Outcome<()> {
        let mut count = 0;
        for line in self
            .step
            .iter_mut()
            .filter(|card| card.keyword == "DLOAD")
            .flat_map(|card| &mut card.lines)
        {
            let mut words: Vec<String> = line.split(',').map(|word| word.trim().to_owned()).collect();
            if words.len() > 2 && words[1].eq_ignore_ascii_case("CENTRIF") {
                words[2] = format!("{:.10e}", speed * speed);
                *line = words.join(", ");
                count += 1;
            }
        }
        if count == 0 {
            return Err("has no CENTRIF load under *DLOAD in its static step, whose speed --speed replaces".into());
        }
        Ok(())
    }

    /// A constraint between nodes, whose displacements cannot all be prescribed.
    pub fn constraint(&self) -> Option<&str> {
        let all = self.model.iter().chain(&self.step);
        let mut found =
            all.filter(|card| CONSTRAINTS.contains(&&*card.keyword) || card.keyword == "TIE" && !is_cyclic(card));
        found.next().map(|card| card.keyword.as_str())
    }

    /// The static step as it is, which prints the displacements of some nodes.
    pub fn static_deck(&self, nodes: &BTreeSet<i64>) -> String {
        let mut text =
            String::from("** Written by hbvib prestress: the static step, whose displacements are printed.\n");
        text.extend(self.model.iter().map(Card::text));
        let _ = writeln!(text, "*NSET, NSET={SET}");
        let all: Vec<String> = nodes.iter().map(i64::to_string).collect();
        for line in all.chunks(IN_LINE) {
            let _ = writeln!(text, "{},", line.join(", "));
        }
        text += &self.head.text();
        text.extend(self.step.iter().map(Card::text));
        let _ = write!(text, "*NODE PRINT, NSET={SET}\nU\n*END STEP\n");
        text
    }

    /// The sector alone under these displacements, and the perturbation that stores its matrices.
    pub fn prestressed_deck(&self, displacements: &BTreeMap<i64, [f64; 3]>) -> String {
        let mut text = String::from(
            "** Written by hbvib prestress: the displacements of the static step are prescribed, and released.\n",
        );
        let kept = |card: &&Card| {
            !CONTACT.contains(&&*card.keyword)
                && card.keyword != "CYCLIC SYMMETRY MODEL"
                && !(card.keyword == "TIE" && is_cyclic(card))
        };
        text.extend(self.model.iter().filter(kept).map(Card::text));
        text += &self.head.text();
        let step = self
            .step
            .iter()
            .filter(kept)
            .filter(|card| !OUTPUT.contains(&&*card.keyword));
        text.extend(step.map(Card::text));
        text += "*BOUNDARY\n";
        for (node, u) in displacements {
            for (direction, u) in u.iter().enumerate() {
                // CalculiX reads numbers of at most 20 characters.
                let _ = writeln!(text, "{node}, {0}, {0}, {u:.10e}", direction + 1);
            }
        }
        text += "*END STEP\n*STEP, PERTURBATION\n*BOUNDARY, OP=NEW\n";
        for line in self
            .model
            .iter()
            .chain(&self.step)
            .filter(|card| card.keyword == "BOUNDARY")
            .flat_map(|card| &card.lines)
        {
            let places: Vec<&str> = line.split(',').take(3).map(str::trim).collect();
            let _ = writeln!(text, "{}", places.join(", "));
        }
        text += "*FREQUENCY, SOLVER=MATRIXSTORAGE\n1\n*END STEP\n";
        text
    }
}

fn is_cyclic(card: &Card) -> bool {
    card.option("CYCLIC SYMMETRY").is_some()
}
