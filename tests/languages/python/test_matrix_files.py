"""Matrices from files as models: a pair of Abaqus with internal nodes and 1e36 on fixed nodes, an external superelement as OP4,
matrices that are told, and motions that grow."""
import os
import tempfile
import warnings

import numpy as np

import hbvib.io
from common import check, finish, hbvib, raises

folder = tempfile.mkdtemp()


def write(name, text):
    path = os.path.join(folder, name)
    with open(path, "w") as file:
        file.write(text)
    return path


def eigenvalues(k, m):
    """Square roots of those of (K, M), M diagonal."""
    s = 1 / np.sqrt(np.diag(m))
    return np.sqrt(np.linalg.eigvalsh(s[:, None] * k * s))


# Nodes 1 to 4 in a row with an internal node −1 between 2 and 3; node 1 is fixed by 1e36.
springs = [(1, 2, 1000.0), (2, 3, 1000.0), (2, -1, 500.0), (-1, 3, 500.0), (3, 4, 1000.0)]
labels = [-1, 1, 2, 3, 4]
k = np.zeros((5, 5))
for a, b, stiffness in springs:
    i, j = labels.index(a), labels.index(b)
    k[[i, j], [i, j]] += stiffness
    k[[i, j], [j, i]] -= stiffness
free = [2, 3, 4]
condensed = k[np.ix_(free, free)] - np.outer(k[free, 0], k[0, free]) / k[0, 0]
right = eigenvalues(condensed, np.eye(3))
k[1, 1] = 1e36
for name, form in (("nodes and directions", "%d,1, %d,1, %.17g\n"), ("labels", "%d %d %.17g\n")):
    lines = "".join(form % (labels[i], labels[j], k[i, j]) for i in range(5) for j in range(i + 1) if k[i, j])
    stiffness = write("job_STIF1.mtx", lines)
    mass = write("job_MASS1.mtx", "".join(form % (n, n, 1.0) for n in (2, 3, 4)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = hbvib.io.read(stiffness=stiffness, mass=mass)
    check(f"{name}: rows are those of the stiffness",
          found.dofs[:, 0].tolist() == labels and found.mass.shape == (5, 5) and found.mass.nnz == 3)
    check(f"{name}: fixed rows are told", any("fixed by a diagonal" in line for line in found.facts))
    omega = hbvib.Model(mass=found.mass, stiffness=found.stiffness).linear_modes(3).omega
    check(f"{name}: frequencies are those without the fixed node", np.allclose(omega, right, rtol=1e-12, atol=0))

# A response with friction beside the penalty is that without the fixed row.
k = 1e4 * (2 * np.eye(4) - np.eye(4, k=1) - np.eye(4, k=-1))
k[3, 3] = 1e4
peaks = []
for kept in (slice(0, 4), slice(1, 4)):
    own = k.copy()
    if kept.start == 0:
        own[0, 0] = 1e36
    n = kept.stop - kept.start
    model = hbvib.Model(mass=np.eye(n), stiffness=own[kept, kept], rayleigh=(0, 1e-5))
    model.add_contact("jenkins", n - 1, kt=5e3, mu=0.3, preload=10)
    model.add_force(n - 3, 2.0)
    peaks.append(model.forced_response((20, 250), response_dof=n - 1).peaks())
check("a response beside a penalty has as many peaks", len(peaks[0].omega) == len(peaks[1].omega) > 2)
check("a response beside a penalty has the peaks without the row", np.allclose(peaks[0].omega, peaks[1].omega, rtol=1e-9)
      and np.allclose(peaks[0].amplitude, peaks[1].amplitude, rtol=1e-9))

# Motions that grow.
model = hbvib.Model(mass=np.eye(3), stiffness=np.diag([-4.0, 1, 9]))
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    omega = model.linear_modes(3).omega
    damped = model.damped_modes(3)
check("a motion that grows has a frequency below zero", np.allclose(omega, [-2, 1, 3]))
check("a motion that grows is a damped mode", np.allclose(damped.eigenvalue, [2, 1j, 3j]) and damped.damping_ratio[0] == -1)
check("motions that grow are told", [one.category for one in told] == [RuntimeWarning] * 2
      and "grows as 2 per time unit" in str(told[0].message))
rng = np.random.default_rng(5)
a = rng.standard_normal((300, 300))
k = a @ a.T + 300 * np.eye(300)
values, vectors = np.linalg.eigh(k)
k -= (values[0] + 4) * np.outer(vectors[:, 0], vectors[:, 0])
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    omega = hbvib.Model(mass=np.eye(300), stiffness=(k + k.T) / 2).linear_modes(4).omega
expected = np.linalg.eigvalsh(k)[:4]
check("one of 300 motions grows", np.allclose(omega, np.sign(expected) * np.sqrt(np.abs(expected)), rtol=1e-9))

# Sizes name the matrix.
for given, words in ((dict(mass=np.eye(3), stiffness=np.eye(2)), "stiffness is 2 x 2, needs 3 x 3"),
                     (dict(mass=np.eye(2), stiffness=np.eye(2), damping=np.eye(3)), "damping is 3 x 3, needs 2 x 2")):
    try:
        hbvib.Model(**given)
    except hbvib.ArgumentError as error:
        check(words, words in str(error))
    else:
        check(words, False)

# Matrices that are told, and refused where the caller wants that.
path = write("k.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 2\n2 2 -1\n")
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    found = hbvib.io.read(path)
check("a negative diagonal is a warning", len(found.warnings) == 1
      and [one.category for one in told] == [hbvib.io.SuspiciousMatrices])

# A file whose last number may lack digits is read, and told.
path = write("cut.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 2\n2 2 1")
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    found = hbvib.io.read(path)
check("a number that may be cut off is a warning", len(told) == 1 and "cut.mtx, line 4" in found.warnings[0]
      and "may be cut off" in str(told[0].message) and found.stiffness.toarray().tolist() == [[2, 0], [0, 1]])

# K(1 + i eta) is symmetric, which the caller says; the sentence names how.
lossy = np.array([[3.0, -1.0], [-1.0, 3.0]]) * (1 + 0.02j)
path = os.path.join(folder, "lossy.npz")
hbvib.io.write(path, stiffness=lossy, mass=np.eye(2))
found = hbvib.io.read(path)
raises("a stiffness with loss is no Hermitian one", hbvib.ArgumentError, hbvib.Model, mass=found.mass, stiffness=found.stiffness,
       words='diagonal of a Hermitian matrix is real; the matrix is complex symmetric: say SYMMETRIC if that is meant, part="symmetric"')
model = hbvib.Model(mass=found.mass)
model.set_matrix("stiffness", found.stiffness, part="symmetric")
model.add_force(0, 1)
x = model.forced_response(1.0).harmonics(0)[1]
check("part says it", np.allclose(x, np.linalg.solve(lossy - np.eye(2), [1, 0]), rtol=1e-12), x)
finish(17)
