//! Meshes: nodes, elements, faces of a sector, and pairs of nodes.

pub(crate) mod face_images;
pub(crate) mod faces;
pub(crate) mod inp_cards;
pub(crate) mod mesh;
pub(crate) mod mesh_elements;
pub(crate) mod mesh_picture;
pub(crate) mod node_match;
pub(crate) mod node_table;
pub(crate) mod normals;
pub(crate) mod positions;
pub(crate) mod surface_pairs;
