//! A quantity that a study, a map or a tornado changes.

use crate::building::built::Built;
use crate::job_file::job_studies::ParameterName;
use crate::job_file::job_words::DofName;
use crate::texts::outcome::Outcome;
use hbvib::{Constant, MatrixKind, MatrixView, Model, Parameter, Part, Speed, Storage, Values};
use std::fmt::Write;

/// The keys of a quantity.
pub struct Keys<'a> {
    pub parameter: ParameterName,
    pub contact: Option<usize>,
    pub dofs: &'a [DofName],
}

/// A quantity of a model.
pub struct Varied {
    kind: Kind,
    label: String,
}

enum Kind {
    Own(Parameter<'static>),
    /// A diagonal matrix that is added.
    Added(MatrixKind, Diagonal),
}

/// Ones on the diagonal of a matrix, as compressed columns.
struct Diagonal {
    order: usize,
    offsets: Vec<i64>,
    dofs: Vec<i64>,
    ones: Vec<f64>,
}

impl Varied {
    /// The quantity that the keys name.
    ///
    /// # Errors
    /// A sentence: keys that exclude each other, a degree of freedom or constant that the model does not have.
    pub fn new(keys: &Keys<'_>, built: &Built) -> Outcome<Self> {
        let mut label = format!("{:?}", keys.parameter).to_lowercase();
        let constant = constant(keys.parameter);
        if keys.contact.is_some() && constant.is_none() {
            return Err("contact needs a constant of a contact as parameter".into());
        }
        if let Some(contact) = keys.contact {
            let _ = write!(label, " of contact {contact}");
        }
        let kind = match (constant, matrix(keys.parameter)) {
            (_, Some(which)) if !keys.dofs.is_empty() => {
                let diagonal = Diagonal::new(keys.dofs, built)?;
                let _ = write!(label, " on dof {}", listed(&diagonal.dofs));
                Kind::Added(which, diagonal)
            }
            _ if !keys.dofs.is_empty() => return Err("dofs needs mass, damping or stiffness as parameter".into()),
            (Some(constant), _) => Kind::Own(Parameter::Contact {
                constant,
                contact: keys.contact,
            }),
            (None, Some(which)) => Kind::Own(Parameter::Factor { which }),
            (None, None) if keys.parameter == ParameterName::Speed => Kind::Own(Parameter::Speed),
            (None, None) => Kind::Own(Parameter::Force),
        };
        let varied = Self { kind, label };
        varied.parameter().check(&built.model).map_err(|e| e.to_string())?;
        Ok(varied)
    }

    /// Its name in tables and figures.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// The parameter of the library.
    pub fn parameter(&self) -> Parameter<'_> {
        match &self.kind {
            Kind::Own(parameter) => *parameter,
            Kind::Added(which, diagonal) => Parameter::Direction {
                which: *which,
                direction: diagonal.view(),
            },
        }
    }

    /// Its value in the model, which is not zero.
    ///
    /// # Errors
    /// A sentence: contacts with different values, a value of zero.
    pub fn value(&self, model: &Model) -> Outcome<f64> {
        let value = match self.parameter() {
            Parameter::Force | Parameter::Factor { .. } => 1.0,
            Parameter::Direction { .. } => 0.0,
            Parameter::Speed => match model.speed() {
                Speed::Fixed(speed) => speed,
                Speed::PerOmega(_) => 0.0,
            },
            Parameter::Contact {
                constant,
                contact: Some(id),
            } => of_contact(model, constant, id),
            Parameter::Contact {
                constant,
                contact: None,
            } => {
                let has = |id: &usize| {
                    let contact = Some(*id);
                    Parameter::Contact { constant, contact }.check(model).is_ok()
                };
                let mut values = (0..model.contacts().len()).filter(has);
                let first = values.next().map_or(0.0, |id| of_contact(model, constant, id));
                if let Some(other) = values.find(|&id| of_contact(model, constant, id).to_bits() != first.to_bits()) {
                    return Err(format!(
                        "{}: contacts have different values, {first} and {} of contact {other}; name a contact or a value",
                        self.label,
                        of_contact(model, constant, other)
                    ));
                }
                first
            }
        };
        if value == 0.0 {
            return Err(format!(
                "{}: it is 0 in the model, of which no share is a change; name a value",
                self.label
            ));
        }
        Ok(value)
    }
}

impl Diagonal {
    fn new(names: &[DofName], built: &Built) -> Outcome<Self> {
        let order = built.model.ndof();
        let mut dofs = Vec::new();
        for name in names {
            let dof = built.nodes.dof(name)?;
            if dof >= order {
                return Err(format!("dofs: {dof}, but the model has {order} degrees of freedom"));
            }
            dofs.push(dof as i64);
        }
        dofs.sort_unstable();
        if dofs.is_sorted_by(|a, b| a < b) {
            let offsets = (0..=order).map(|j| dofs.partition_point(|&dof| dof < j as i64) as i64);
            return Ok(Self {
                order,
                offsets: offsets.collect(),
                ones: vec![1.0; dofs.len()],
                dofs,
            });
        }
        let twice = dofs.iter().zip(&dofs[1..]).find(|(a, b)| a == b).map_or(0, |(a, _)| *a);
        Err(format!("dofs: {twice} is named twice"))
    }

    fn view(&self) -> MatrixView<'_> {
        MatrixView {
            rows: self.order,
            cols: self.order,
            storage: Storage::Csc {
                col_ptr: &self.offsets,
                row_idx: &self.dofs,
            },
            values: Values::Real(&self.ones),
            part: Part::Full,
            index_base: 0,
        }
    }
}

fn constant(name: ParameterName) -> Option<Constant> {
    Some(match name {
        ParameterName::Preload => Constant::Preload,
        ParameterName::Mu => Constant::Mu,
        ParameterName::Kt => Constant::Kt,
        ParameterName::Kn => Constant::Kn,
        ParameterName::Gap => Constant::Gap,
        _ => return None,
    })
}

fn matrix(name: ParameterName) -> Option<MatrixKind> {
    Some(match name {
        ParameterName::Mass => MatrixKind::Mass,
        ParameterName::Damping => MatrixKind::Damping,
        ParameterName::Stiffness => MatrixKind::Stiffness,
        _ => return None,
    })
}

/// A constant of a contact; its normal load and gap are those at rest.
fn of_contact(model: &Model, constant: Constant, id: usize) -> f64 {
    let (preload, _, gap) = model.given_load(id).unwrap_or_default();
    match constant {
        Constant::Preload => preload,
        Constant::Gap => gap,
        _ => model
            .contacts()
            .get(id)
            .map_or(0.0, |contact| contact.constant(constant)),
    }
}

/// The first numbers of a list.
fn listed(dofs: &[i64]) -> String {
    const SHOWN: usize = 3;
    let shown: Vec<String> = dofs.iter().take(SHOWN).map(i64::to_string).collect();
    let more = if dofs.len() > SHOWN { " ..." } else { "" };
    shown.join(" ") + more
}
