//! Contacts from two lists of nodes give those of the same pairs by hand, and nodes that do not match are named.

use std::path::{Path, PathBuf};
use std::process::Output;

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../hbvib-io/tests/data")
}

fn hbvib(verb: &str, name: &str, job: &str) -> Output {
    crate::common::hbvib(verb, ("node_lists", name), job).0
}

fn printed(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// The ring damper with these contacts instead of its own.
fn ring_damper(contacts: &str) -> String {
    let model = crate::common::ring_damper();
    format!(
        "{model}{contacts}\n[[force]]\ndof = 0\nvalue = 5.0\n[forced]\nfrom_hz = 205.0\nto_hz = 225.0\nharmonics = 5\n"
    )
}

#[test]
fn matched_nodes_with_areas_are_the_same_contacts_as_pairs() {
    let contact = |a: i64, b: i64, area: f64| {
        let (kt, preload) = (2e7 * area, 300.0 * area);
        format!("[[contact]]\nkind = 'jenkins'\na = [{a}]\nb = [{b}]\nkt = {kt:?}\nmu = 0.3\npreload = {preload:?}\n")
    };
    let by_hand = ring_damper(&(contact(2, 3, 1.5) + &contact(1, 0, 0.25)));
    let by_nodes = ring_damper(
        "[[contact]]\nkind = 'jenkins'\nkt = 2e7\nmu = 0.3\npreload = 300.0\n[contact.nodes]\n\
         a = [[2], [1]]\nb = [[0], [3]]\nareas = [1.5, 0.25]\nlargest_distance = 0.1\n\
         a_coordinates = [[1, 0, 0], [0, 0, 2]]\nb_coordinates = [[0.05, 0, 2], [1, 0.01, 0]]\n",
    );
    let (one, other) = (hbvib("run", "hand", &by_hand), hbvib("run", "nodes", &by_nodes));
    assert!(
        one.status.success() && other.status.success(),
        "{}",
        printed(&other.stderr)
    );
    let text = printed(&one.stdout);
    assert!(text.contains("of 2 contacts") && text.contains("peak"), "{text}");
    assert_eq!(text, printed(&other.stdout));
}

#[test]
fn numbers_of_a_finite_element_mesh_name_the_nodes() {
    let folder = data();
    let folder = folder.display();
    // Nodes 3 and 5, and 4 and 6, lie on the two faces of the sector.
    let job = |b: &str, largest: f64| {
        format!(
            "[model]\nmatrices = '{folder}/sector.sti'\n[[contact]]\nkind = 'friction_3d'\nnormal = [0, -1, 0]\n\
             kt = 1e3\nkn = 1e3\nmu = 0.3\npreload = 1.0\n[contact.nodes]\na = [3, 5]\nb = [{b}]\n\
             coordinates = '{folder}/sector.inp'\nlargest_distance = {largest:?}\nareas = [2e-6]\n[forced]\nfrom_hz = 1.0\nto_hz = 2.0\n"
        )
    };
    let output = hbvib("check", "mesh", &job("6, 4", 10.0));
    assert!(output.status.success(), "{}", printed(&output.stderr));
    assert!(printed(&output.stdout).contains(" 2 contacts"));
    for (name, job, words) in [
        (
            "far",
            job("6, 4", 1e-6),
            &["[[contact]] 1", "a[0] (node ", "within 0.000001"][..],
        ),
        (
            "unknown",
            job("99999", 10.0),
            &["b[0]: node 99999 is not in", "sector.inp"],
        ),
    ] {
        let output = hbvib("check", name, &job);
        let errors = printed(&output.stderr);
        assert_eq!(output.status.code(), Some(1));
        for word in words {
            assert!(errors.contains(word), "{errors} lacks {word}");
        }
    }
}

#[test]
fn separate_files_name_the_nodes_and_must_agree() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("node_lists");
    std::fs::create_dir_all(&folder).unwrap();
    let matrix = |name: &str, nodes: [i64; 2]| {
        let rows: Vec<String> = (0..6)
            .map(|i| format!("{0},{1}, {0},{1}, 2.0", nodes[i / 3], i % 3 + 1))
            .collect();
        let path = folder.join(name);
        std::fs::write(&path, rows.join("\n") + "\n").unwrap();
        path.display().to_string()
    };
    let stiffness = matrix("two_STIF1.mtx", [10, 11]);
    let job = |mass: &str| {
        format!(
            "model.stiffness = '{stiffness}'\nmodel.mass = '{mass}'\n\
             [[contact]]\nkind = 'friction_3d'\nnormal = [0, -1, 0]\nkt = 1.0\nkn = 1.0\nmu = 0.3\npreload = 1.0\n\
             [contact.nodes]\na = [10]\nb = [11]\na_coordinates = [[0, 0, 0]]\nb_coordinates = [[0, 1e-3, 0]]\n\
             largest_distance = 1e-2\n[forced]\nfrom_hz = 1.0\nto_hz = 2.0\n"
        )
    };
    let output = hbvib("check", "agree", &job(&matrix("two_MASS1.mtx", [11, 10])));
    assert!(output.status.success(), "{}", printed(&output.stderr));
    assert!(
        printed(&output.stdout).contains("6 degrees of freedom") && printed(&output.stdout).contains(" 1 contact,")
    );
    let output = hbvib("check", "differ", &job(&matrix("other_MASS1.mtx", [10, 12])));
    assert_eq!(output.status.code(), Some(1));
    assert!(printed(&output.stderr).contains("other_MASS1.mtx: names other nodes"));
}

/// Degrees of freedom of both sides by node and direction are those by number; the ground is no side at all, or -1.
#[test]
fn sides_are_named_by_node_and_direction() {
    let folder = data();
    let folder = folder.display();
    let job = |sides: &str| {
        format!(
            "[model]\nmatrices = '{folder}/sector.sti'\n[[contact]]\nkind = 'friction_3d'\nnormal = [0, -1, 0]\n\
             kt = 1e3\nkn = 1e3\nmu = 0.3\npreload = 1.0\n{sides}"
        )
    };
    for (name, numbers, names) in [
        ("ground", "a = [0, 1, 2]\n", "a = ['3.1', '3.2', '3.3']\n"),
        (
            "pair",
            "a = [0, 1, 2, 3, 4, 5]\nb = [-1, -1, -1, 6, 7, 8]\n",
            "a = ['3.1', 1, '3.3', '4.1', '4.2', '4.3']\nb = [-1, -1, -1, '5.1', '5.2', '5.3']\n",
        ),
    ] {
        let [one, other] = [numbers, names].map(|sides| hbvib("modes", name, &job(sides)));
        assert!(other.status.success(), "{}", printed(&other.stderr));
        assert_eq!(printed(&one.stdout), printed(&other.stdout));
        let free = hbvib("modes", name, &job("a = ['6.1', '6.2', '6.3']\n"));
        assert_ne!(printed(&one.stdout), printed(&free.stdout));
    }
    let output = hbvib("modes", "unknown", &job("a = ['3.1', '3.2', '99.3']\n"));
    assert!(
        printed(&output.stderr).contains("a[2]: dof = \"99.3\""),
        "{}",
        printed(&output.stderr)
    );
}
