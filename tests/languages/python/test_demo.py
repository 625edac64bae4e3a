"""python -m hbvib demo, as a new user types it: the picture and the numbers of the library, nothing overwritten."""

import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import numpy as np

from common import check, close, finish, hbvib

HERE = os.path.dirname(os.path.abspath(hbvib.__file__))


def typed(*arguments, folder):
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join([os.path.dirname(HERE), os.environ.get("PYTHONPATH", "")]))
    return subprocess.run([sys.executable, "-m", "hbvib", *arguments], cwd=folder, env=environment, capture_output=True, text=True)


with tempfile.TemporaryDirectory() as folder:
    first = typed("demo", "some/missing/folder", folder=folder)
    check("a demo answers", first.returncode == 0 and "209.9" in first.stdout, first.stdout + first.stderr)
    made = os.path.join(folder, "some/missing/folder")
    table = np.genfromtxt(os.path.join(made, "response.csv"), delimiter=",", names=True)
    stuck = table[table["force"] == 0.1]
    # Under a small force the contact sticks: the response of the linear structure, with its complex stiffness of the wave.
    wave = 2 * (1 - np.cos(2 * np.pi * 2 / 24))
    mass = np.diag([0.2, 0.3, 1.2, 0.03])
    stiffness = np.array([[2e6, -2e6, 0, 0], [-2e6, 3e6, -1e6, 0], [0, -1e6, 1.6e6 + 5e7 * wave + 5e7, -5e7],
                          [0, 0, -5e7, 2e7 * wave + 5e7]])
    damping = 1.5e-6 * (stiffness - 5e7 * np.array([[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 1, -1], [0, 0, -1, 1]]))
    omega = 2 * np.pi * stuck["frequency"]
    direct = [abs(np.linalg.solve(stiffness - w * w * mass + 1j * w * damping, [0.1, 0, 0, 0])[0]) for w in omega]
    close("its stuck response is that of the linear structure", stuck["amplitude"], direct, 1e-6)
    drawn = xml.etree.ElementTree.parse(os.path.join(made, "response.svg")).getroot()
    curves = [line for line in drawn if line.tag.endswith("polyline")]
    check("a curve for each force", len(curves) == len(set(table["force"])) == 5, len(curves))
    again = typed("demo", "some/missing/folder", folder=folder)
    check("nothing is overwritten", again.returncode == 1 and "name another one" in again.stderr, again.stderr)
    check("a word that is no command is refused", typed("dmo", folder=folder).returncode == 2)
    check("the version is told", typed("--version", folder=folder).stdout.strip() == f"hbvib {hbvib.__version__}")

finish(6)
