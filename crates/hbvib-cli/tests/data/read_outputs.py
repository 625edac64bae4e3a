"""Reads the outputs of a run of the cover plate with other programs (scipy, meshio, pyuff) and an own reader of .frd, and compares
them with the harmonics of response.npz. usage: read_outputs.py FOLDER"""

import pathlib
import sys
import xml.etree.ElementTree as ElementTree

import meshio
import numpy as np
import pyuff
from scipy.io import netcdf_file

folder = pathlib.Path(sys.argv[1])
sectors, engine_order, phases = 24, 3, 8


def near(a, b, relative):
    scale = np.abs(b).max()
    assert scale > 0
    assert np.abs(np.asarray(a) - b).max() <= relative * scale, (np.abs(np.asarray(a) - b).max(), scale)


# The mesh and the names of rows, read here again.
positions, bricks, section = {}, {}, ""
for line in (folder / "mesh.inp").read_text().splitlines():
    if line.startswith("*"):
        section = line.upper()
        continue
    words = line.replace(",", " ").split()
    if section.startswith("*NODE"):
        positions[int(words[0])] = [float(w) for w in words[1:4]]
    elif section.startswith("*ELEMENT"):
        bricks.setdefault("words", []).extend(int(w) for w in words)
bricks = np.array(bricks["words"]).reshape(-1, 21)
names = [tuple(int(w) for w in line.split(".")) for line in (folder / "matrices.dof").read_text().split()]
numbers = sorted(positions)
place = {n: i for i, n in enumerate(numbers)}
x = np.array([positions[n] for n in numbers])
saved = np.load(folder / "response.npz")
motion = np.zeros(saved["harmonics"].shape[:2] + (len(numbers), 3), complex)
for row, (node, direction) in enumerate(names):
    motion[:, :, place[node], direction - 1] = saved["harmonics"][:, :, row]
hertz = saved["omega"] / (2 * np.pi)

# NetCDF: all harmonics of all points, to the last bit.
with netcdf_file(folder / "response.nc", mmap=False) as file:
    of = {name: np.array(variable[...]) for name, variable in file.variables.items() if name != "contact_name"}
    assert list(of["node"]) == numbers and file.variables["x"].units == b"m"
    assert file.variables["frequency"].units == b"Hz" and file.variables["displacement_real"].units == b"m"
    assert file.variables["displacement_real"].dimensions == ("point", "harmonic", "node", "direction")
    assert file.response_dof == b"510.3"
    assert b"".join(file.variables["contact_name"][0]).rstrip(b"\0") == b"rim[0]"
assert (of["displacement_real"] + 1j * of["displacement_imag"] == motion).all()
assert (np.stack([of["x"], of["y"], of["z"]], axis=1) == x).all()
assert np.allclose(of["frequency"], hertz, rtol=1e-15) and (of["amplitude"] == saved["amplitude"]).all()
assert (of["slip_fraction"] == saved["slip_fraction"]).all() and of["slip_fraction"].max() > 0
assert (of["has_rows"] == [n in {node for node, _ in names} for n in numbers]).all() and of["has_rows"].min() == 0

# VTU: two requested points, which lie beside the curve; the harmonics of each are in a file of their own, and the phases follow.
count, tip = len(numbers), place[510]
series = ElementTree.parse(folder / "motion.pvd").getroot()[0]
assert len(series) == 2 * phases
loops = [line.split(",") for line in (folder / "loop.csv").read_text().splitlines()[1:]]
assert len(loops) == 2 * phases
rim = place[int((folder / "rim.txt").read_text())]
states, all_shapes = set(), []
for point in (0, 1):
    grid = meshio.read(folder / f"motion/motion_{point}_harmonics.vtu")
    assert len(grid.points) == sectors * count
    assert (grid.points[:count] == x).all()
    [cells] = grid.cells
    assert cells.type == "hexahedron20" and len(cells.data) == sectors * len(bricks)
    assert (np.array(numbers)[cells.data[: len(bricks)]] == bricks[:, 1:]).all()
    shapes = [grid.point_data["harmonic_0_real"] + 0j]
    for h in (1, 2, 3):
        if f"harmonic_{h}_real" in grid.point_data:
            shapes.append(grid.point_data[f"harmonic_{h}_real"] + 1j * grid.point_data[f"harmonic_{h}_imag"])
        else:
            shapes.append(0 * shapes[0])
    shapes = np.array(shapes)
    all_shapes.append(shapes)
    # Between its neighbours on the curve, which is smooth.
    hz = float(loops[point * phases][0])
    order = np.argsort(hertz)
    between = np.interp(hz, hertz[order], saved["amplitude"][order])
    assert abs(abs(shapes[1, tip, 2]) / between - 1) < 0.02, (abs(shapes[1, tip, 2]), between)
    share = grid.point_data["slip_share"].max()
    assert abs(share - 1) < 1e-12 if point else 0 < share < 1 - 1e-12, share
    for k in range(phases):
        entry = series[point * phases + k]
        assert abs(float(entry.get("timestep")) - point - k / phases) < 1e-12
        grid = meshio.read(folder / entry.get("file"))
        expected = sum((u * np.exp(2j * np.pi * h * k / phases)).real for h, u in enumerate(shapes))
        near(grid.point_data["displacement"], expected, 1e-12)
        # Nodes of neighbours at one place are one node of the wheel.
        keys = {}
        for i, at in enumerate(np.round(grid.points / 1e-7).astype(int)):
            keys.setdefault(tuple(at), []).append(i)
        doubled = [same for same in keys.values() if len(same) > 1]
        assert len(doubled) > 100
        u = grid.point_data["displacement"]
        for same in doubled:
            assert np.abs(u[same] - u[same[0]]).max() < 1e-9 * np.abs(u).max()
        # The state and the forces of a node are those of its loop.
        loop = loops[point * phases + k]
        state = grid.point_data["contact_state"]
        states |= set(state)
        assert ["", "stick", "slip", "open"][state[rim]] == loop[-1]
        forces = [float(w) for w in loop[5:8]]
        near(grid.point_data["contact_friction_force"][rim], np.hypot(*forces[:2]), 1e-9)
        near(grid.point_data["contact_normal_force"][rim], abs(forces[2]), 1e-9)
        # The wave of three diameters repeats after a third of the wheel, and its eighths are neighbours.
        third = sectors // 3 * count
        force = grid.point_data["contact_normal_force"]
        near(force[third : 2 * third], force[:third], 1e-9)
        if k > 0:
            near(force[count : 2 * count], before, 1e-9)
        before = force[:count]
assert states == {0, 1, 2}, states

# UFF: nodes, responses and shapes.
uff = pyuff.UFF(str(folder / "response.uff"))
sets = uff.read_sets()
kinds = [one["type"] for one in sets]
assert kinds[0] == 2411 and kinds.count(58) >= 2 and kinds.count(55) >= 2, kinds
near(np.stack([sets[0][k] for k in "xyz"], axis=1), x, 1e-15)
assert [int(n) for n in sets[0]["grid_global" if "grid_global" in sets[0] else "node_nums"]] == numbers
first = [one for one in sets if one["type"] == 58 and one["id1"].endswith("harmonic 1")][0]
near(first["x"], hertz, 1e-9)
near(first["data"], motion[:, 1, tip, 2], 1e-11)
assert (first["rsp_node"], first["rsp_dir"], first["func_type"]) == (510, 3, 12)
for one in sets:
    if one["type"] == 55:
        h = int(one["id1"].split()[-1])
        shapes = all_shapes[0 if one["id2"].startswith("927") else 1]
        nodes = [place[int(n)] for n in one["node_nums"]]
        assert len(nodes) == len({node for node, _ in names})
        for d, key in enumerate(("r1", "r2", "r3")):
            got = np.asarray(one[key])
            assert np.abs(got - shapes[h, nodes, d]).max() < 1e-5 * np.abs(shapes[h]).max()

# .frd, read here.
blocks, part, nodes, elements = [], "", {}, {}
for line in (folder / "response.frd").read_text().splitlines():
    key = line[:3]
    if line.startswith("    2C"):
        part = "nodes"
        assert int(line[24:36]) == len(numbers)
    elif line.startswith("    3C"):
        part = "elements"
        assert int(line[24:36]) == len(bricks)
    elif line.startswith("  100C"):
        part = "values"
        blocks.append((float(line[12:24]), {}))
        assert int(line[24:36]) == len(numbers)
    elif key == " -4":
        blocks[-1] = (line[5:13].strip(), *blocks[-1])
    elif key == " -1" and part == "elements":
        element, kind = int(line[3:13]), int(line[13:18])
        elements[element] = []
        assert kind == 4
    elif key == " -2":
        elements[element] += [int(line[i : i + 10]) for i in range(3, len(line), 10)]
    elif key == " -1":
        of_line = [float(line[i : i + 12]) for i in (13, 25, 37)]
        (nodes if part == "nodes" else blocks[-1][2])[int(line[3:13])] = of_line
near(np.array([nodes[n] for n in numbers]), x, 1e-5)
for brick in bricks:
    corners = elements[brick[0]]
    # Middles of upright edges come before those of the top.
    assert corners == [*brick[1:13], *brick[17:21], *brick[13:17]]
found = {}
for name, frequency, values in blocks:
    found.setdefault(name, []).append((frequency, np.array([values[n] for n in numbers])))
assert len(found["DISP"]) == len(found["DISPI"]) + 2, "the mean has no imaginary part"
near(found["DISP"][1][1], all_shapes[0][1, :count].real, 1e-5)
near(found["DISPI"][0][1], all_shapes[0][1, :count].imag, 1e-5)
near(found["DISP"][1][0], 927.0, 1e-5)
print("all read")
