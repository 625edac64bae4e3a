//! Elements of a mesh: their shapes, and the order of their nodes in files of results.

/// Shape of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Line2,
    Line3,
    Triangle3,
    Triangle6,
    Quadrangle4,
    Quadrangle8,
    Tetrahedron4,
    Tetrahedron10,
    Wedge6,
    Wedge15,
    Hexahedron8,
    Hexahedron20,
}

/// An element with its nodes in the order of Abaqus and CalculiX.
#[derive(Clone, Debug)]
pub struct Element {
    pub number: i64,
    pub shape: Shape,
    pub nodes: Vec<i64>,
    /// Set that its keyword names, in capital letters.
    pub set: Option<String>,
}

impl Shape {
    /// The shape of an element type of Abaqus or CalculiX; `None` for one that is not drawn, as springs and masses.
    pub fn of_type(kind: &str) -> Option<Self> {
        let kind = kind.to_ascii_uppercase();
        let digits = |start: &str| -> Option<usize> {
            let rest = kind.strip_prefix(start)?;
            let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
            rest[..end].parse().ok()
        };
        if let Some(nodes) = ["C3D", "DC3D", "F3D", "AC3D"].into_iter().find_map(digits) {
            return match nodes {
                4 => Some(Self::Tetrahedron4),
                6 => Some(Self::Wedge6),
                8 => Some(Self::Hexahedron8),
                10 => Some(Self::Tetrahedron10),
                15 => Some(Self::Wedge15),
                20 => Some(Self::Hexahedron20),
                _ => None,
            };
        }
        let flat = ["CPS", "CPE", "CAX", "M3D", "SFM3D", "STRI", "S", "R3D"];
        if let Some(nodes) = flat.into_iter().find_map(digits) {
            return match nodes {
                3 => Some(Self::Triangle3),
                6 | 65 => Some(Self::Triangle6),
                4 => Some(Self::Quadrangle4),
                8 => Some(Self::Quadrangle8),
                _ => None,
            };
        }
        match kind.as_str() {
            "T3D2" | "B31" | "B31R" | "T2D2" | "B21" => Some(Self::Line2),
            "T3D3" | "B32" | "B32R" | "T2D3" | "B22" => Some(Self::Line3),
            _ => None,
        }
    }

    /// Number of nodes.
    pub fn nodes(self) -> usize {
        match self {
            Self::Line2 => 2,
            Self::Line3 | Self::Triangle3 => 3,
            Self::Quadrangle4 | Self::Tetrahedron4 => 4,
            Self::Triangle6 | Self::Wedge6 => 6,
            Self::Quadrangle8 | Self::Hexahedron8 => 8,
            Self::Tetrahedron10 => 10,
            Self::Wedge15 => 15,
            Self::Hexahedron20 => 20,
        }
    }

    /// Whether it fills space.
    pub fn is_solid(self) -> bool {
        matches!(
            self,
            Self::Tetrahedron4
                | Self::Tetrahedron10
                | Self::Wedge6
                | Self::Wedge15
                | Self::Hexahedron8
                | Self::Hexahedron20
        )
    }

    /// Number of the cell type in VTK, whose nodes have the order of Abaqus.
    pub fn vtk(self) -> u8 {
        match self {
            Self::Line2 => 3,
            Self::Line3 => 21,
            Self::Triangle3 => 5,
            Self::Triangle6 => 22,
            Self::Quadrangle4 => 9,
            Self::Quadrangle8 => 23,
            Self::Tetrahedron4 => 10,
            Self::Tetrahedron10 => 24,
            Self::Wedge6 => 13,
            Self::Wedge15 => 26,
            Self::Hexahedron8 => 12,
            Self::Hexahedron20 => 25,
        }
    }

    /// Number of the element type in .frd files of CalculiX.
    pub fn frd(self) -> u8 {
        match self {
            Self::Hexahedron8 => 1,
            Self::Wedge6 => 2,
            Self::Tetrahedron4 => 3,
            Self::Hexahedron20 => 4,
            Self::Wedge15 => 5,
            Self::Tetrahedron10 => 6,
            Self::Triangle3 => 7,
            Self::Triangle6 => 8,
            Self::Quadrangle4 => 9,
            Self::Quadrangle8 => 10,
            Self::Line2 => 11,
            Self::Line3 => 12,
        }
    }

    /// Place in the order of Abaqus of each node in the order of .frd files: middles of upright edges come before those of the top.
    pub fn frd_order(self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.nodes()).collect();
        match self {
            Self::Hexahedron20 => order[12..20].rotate_left(4),
            Self::Wedge15 => order[9..15].rotate_left(3),
            // The middle of a line is its second node in Abaqus and its third here.
            Self::Line3 => order.swap(1, 2),
            _ => {}
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::Shape;

    #[test]
    fn types_have_their_shapes() {
        for (kind, shape) in [
            ("C3D10", Some(Shape::Tetrahedron10)),
            ("c3d20r", Some(Shape::Hexahedron20)),
            ("C3D8I", Some(Shape::Hexahedron8)),
            ("C3D15", Some(Shape::Wedge15)),
            ("CPS6", Some(Shape::Triangle6)),
            ("S4R", Some(Shape::Quadrangle4)),
            ("STRI65", Some(Shape::Triangle6)),
            ("T3D3", Some(Shape::Line3)),
            ("SPRINGA", None),
            ("MASS", None),
            ("C3D27", None),
        ] {
            assert_eq!(Shape::of_type(kind), shape, "{kind}");
        }
    }

    #[test]
    fn upright_edges_of_frd_come_before_those_of_the_top() {
        let brick = Shape::Hexahedron20.frd_order();
        assert_eq!(brick[..12], (0..12).collect::<Vec<_>>());
        assert_eq!(brick[12..], [16, 17, 18, 19, 12, 13, 14, 15]);
        assert_eq!(Shape::Wedge15.frd_order()[9..], [12, 13, 14, 9, 10, 11]);
    }
}
