//! The motion in coordinates of modes of a finite-element program: against least squares by numpy, and stresses from modal ones against
//! those of the whole motion.

use crate::common::{command, empty_folder, printed, root, run};
use std::path::{Path, PathBuf};

/// The beam of bricks with a contact and a force, its modes as arrays and as a universal file, and a job for each of them.
const MODES: &str = "
import numpy as np, scipy.linalg as sl, pyuff
names = [tuple(int(w) for w in line.split('.')) for line in open('beam.dof').read().split()]; n = len(names)
def triangle(name):
    a = np.loadtxt(name); full = np.zeros((n, n)); i, j = a[:, 0].astype(int) - 1, a[:, 1].astype(int) - 1
    np.add.at(full, (i, j), a[:, 2]); return full + full.T - np.diag(np.diag(full))
K, M = triangle('beam.sti'), triangle('beam.mas')
phi = sl.eigh(K, M)[1].T
rng = np.random.default_rng(5)
np.savez('all.npz', shapes=phi)
np.savez('mixed.npz', shapes=rng.standard_normal((6, 6)) @ phi[:6] + 1j * phi[6:12])
np.savez('twice.npz', shapes=phi[[0, 1, 0]])
np.savez('short.npz', shapes=phi[:2, 1:])
nodes = sorted({node for node, _ in names})
def write(name, nodes):
    for k in range(8):
        at = {name: value for name, value in zip(names, phi[k])}
        r = [np.array([at.get((node, d), 0.0) for node in nodes]) for d in (1, 2, 3)]
        pyuff.UFF(name).write_sets(dict(type=55, model_type=1, analysis_type=2, data_ch=2, spec_data_type=8, data_type=2, r1=r[0], r2=r[1],
            r3=r[2], node_nums=np.array(nodes), load_case=1, mode_n=k + 1, freq=1.0, modal_m=1.0, modal_damp_vis=0.0, modal_damp_his=0.0,
            n_data_per_node=3, id1='mode', id2='NONE', id3='NONE', id4='NONE', id5='NONE'), 'add' if k else 'overwrite')
write('modes.uff', nodes); write('fewer.uff', nodes[1:])
";

const READ: &str = "
import csv, sys, numpy as np, scipy.linalg as sl
exec(open('modes.py').read().split('phi =')[0])
name, digits = sys.argv[1], float(sys.argv[2])
if name == 'modes.uff':
    import pyuff
    sets = pyuff.UFF(name).read_sets(); shapes = np.zeros((len(sets), n))
    for shape, one in zip(shapes, sets):
        for place, node in enumerate(one['node_nums']):
            for d in (1, 2, 3):
                if (int(node), d) in names: shape[names.index((int(node), d))] = one[f'r{d}'][place].real
else: shapes = np.load(name)['shapes']
file = np.load('response.npz'); x = file['harmonics']
rows = list(csv.DictReader(open('modal.csv'))); k = len(shapes)
assert len(rows) >= len(x) and {int(r['harmonic']) for r in rows} == {0, 1}
L = np.linalg.cholesky(M); A = L.T @ shapes.T
# A stress of an element is a linear function of the motion.
S = np.random.default_rng(7).standard_normal((4, n))
worst = [0.0, 0.0]; place = -1
for r in rows:
    h = int(r['harmonic']); place += h == 0 or rows[0]['harmonic'] == '1'
    assert abs(float(r['frequency_hz']) * 2 * np.pi / file['omega'][place] - 1) < 1e-14
    q = np.array([float(r[f're_{i}']) + 1j * float(r[f'im_{i}']) for i in range(1, k + 1)])
    z = x[place, h]; own = np.linalg.lstsq(A, L.T @ z, rcond=None)[0]
    assert np.abs(q - own).max() < digits * np.abs(own).max(), (np.abs(q - own).max(), np.abs(own).max())
    rest = z - shapes.T @ own; energy = lambda a, z: (z.conj() @ a @ z).real
    for a, told in ((M, 'mass_lacking'), (K, 'stiffness_lacking')):
        share = np.sqrt(abs(energy(a, rest)) / energy(a, z))
        assert abs(float(r[told]) - share) < max(10 * digits, 1e-6) * max(share, 1e-2), (told, r[told], share)
        worst[a is K] = max(worst[a is K], float(r[told]))
    stress = S @ z; modal = (S @ shapes.T) @ q
    if k == n: assert np.abs(modal - stress).max() < 1e-8 * np.abs(stress).max()
print(len(rows), k, *worst)
";

fn prepared() -> PathBuf {
    let folder = empty_folder("modal_coordinates", "beam");
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for file in ["beam.sti", "beam.mas", "beam.dof", "beam.inp"] {
        std::fs::copy(data.join(file), folder.join(file)).unwrap();
    }
    std::fs::write(folder.join("modes.py"), MODES).unwrap();
    folder
}

fn job(modes: &str) -> String {
    format!(
        "[model]\nmatrices = \"beam.sti\"\nmesh = \"beam.inp\"\nrayleigh = [0.0, 1e-6]\n[[contact]]\nkind = \"friction_3d\"\n\
         normal = [0, -1, 0]\nkt = 1e6\nkn = 1e6\nmu = 0.3\npreload = 1.0\n[contact.nodes]\na = [2]\nb = [8]\n\
         largest_distance = 1.0\n[[force]]\ndof = \"6.3\"\nvalue = 1.0\n[forced]\nfrom_hz = 2500.0\nto_hz = 4500.0\n\
         harmonics = 1\nresponse_dof = \"6.3\"\n[output]\nnpz = \"response.npz\"\nmotion.points = \"all\"\n\
         modal = {{ modes = \"{modes}\", csv = \"modal.csv\" }}\n"
    )
}

#[test]
fn modal_coordinates_give_the_stresses_of_the_whole_motion() {
    let folder = prepared();
    let own = root().join(".venv/bin/python");
    let python = if own.exists() { own } else { "python3".into() };
    run(&python, &["modes.py"], &folder);
    for (modes, digits) in [("all.npz", "1e-9"), ("mixed.npz", "1e-8"), ("modes.uff", "1e-8")] {
        std::fs::write(folder.join("job.toml"), job(modes)).unwrap();
        run(env!("CARGO_BIN_EXE_hbvib"), &["run", "job.toml"], &folder);
        let told = run(&python, &["-c", READ, modes, digits], &folder);
        let numbers: Vec<f64> = told.split_whitespace().map(|x| x.parse().unwrap()).collect();
        let [_, count, mass, stiffness] = numbers[..] else {
            panic!("{told}")
        };
        println!("{modes}: {count} modes, lacking {mass:.1e} of the mass, {stiffness:.1e} of the stiffness");
        // The whole basis leaves nothing, few modes lack what contact and force press.
        let complete = modes == "all.npz";
        assert!(complete == (stiffness < 1e-7), "{modes}: {told}");
        assert!(mass < stiffness || complete, "{told}");
    }
    std::fs::copy(folder.join("response.npz"), folder.join("before.npz")).unwrap();
    for (modes, words) in [
        ("twice.npz", "mode 3 is a sum of those before it"),
        ("short.npz", "needs (modes, "),
        ("fewer.uff", "which moves"),
        ("beam.inp", "needs a line with -1"),
        ("before.npz", "has no array shapes"),
    ] {
        std::fs::write(folder.join("job.toml"), job(modes)).unwrap();
        let output = command(&["run", "job.toml"], &folder);
        let errors = printed(&output.stderr);
        let told = output.status.code() == Some(1) && errors.contains("[output.modal]") && errors.contains(words);
        assert!(told, "{modes}: {errors}");
    }
}
