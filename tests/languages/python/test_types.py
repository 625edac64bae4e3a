"""Types: examples and every program of the book pass mypy --strict and, in tests/deep.sh, pyright, mistakes do not, and
the defaults that editors show are those of the library."""

import ctypes
import glob
import inspect
import json
import os
import re
import subprocess
import sys
import tempfile

from common import THOROUGH, check, finish, hbvib

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../.."))
PACKAGE = os.path.dirname(os.path.abspath(hbvib.__file__))

# Defaults in the text of the types, and in the signatures that help() shows.
STRUCTS = dict(
    SolverOptions="hbvib_solver_options",
    TimeOptions="hbvib_time_options",
    VerifyOptions="hbvib_verify_options",
    FloquetOptions="hbvib_floquet_options",
    SynthesisOptions="hbvib_synthesis_options",
    ContactConstants="hbvib_contact",
)
USERS = dict(
    SolverOptions=(hbvib.Model.forced_response, hbvib.Model.nonlinear_mode),
    TimeOptions=(hbvib.Model.time_response,),
    VerifyOptions=(hbvib.Model.verify,),
    FloquetOptions=(hbvib.Model.floquet,),
    SynthesisOptions=(hbvib.Branch.synthesis, hbvib.Branch.synthesis_peaks),
)
for title, name in STRUCTS.items():
    kind, struct = getattr(hbvib, title), hbvib.structs[name]()
    getattr(hbvib.lib, name + "_init")(struct, ctypes.sizeof(struct))
    told = dict(re.findall(r"(?ms)^    (\w+)   .*?Default:\s+(.*?)\.$", kind.__doc__))
    check(f"{title} tells the default of every field", told.keys() == kind.__annotations__.keys(), told)
    for field, text in told.items():
        default = getattr(struct, field)
        default = tuple(default) if isinstance(default, ctypes.Array) else default
        check(f"{title}.{field} has the default of the library", json.loads(
            text.replace("(", "[").replace(")", "]")) == (list(default) if isinstance(default, tuple) else default), text)
        for function in USERS.get(title, ()):
            shown = inspect.signature(function).parameters[field].default
            check(f"{function.__name__} shows it for {field}", shown == default, shown)
            check(f"{function.__name__} explains {field}", re.search(rf"\b{field}   ", function.__doc__) is not None)
    # Arrays that results give, and what the arguments of calls tell.
    hidden = {"struct_size", "reserved", "kind", "dof_a", "dof_b", "method", "omega", "harmonics", "start", "start_len", "places", "places_len"}
    fields = {field for field, _ in struct._fields_} - hidden - {"samples", "waves", "refine"}
    check(f"{title} has the fields of its struct", fields <= set(kind.__annotations__), fields)

MISTAKES = '''import hbvib

model = hbvib.Model(mass=1, stiffness=1)
model.add_contact("jenkins", 0, kt=1, preload=1)  # no mu
model.add_contact("jenkin", 0, kt=1, mu=0.3, preload=1)
model.forced_response((0.8, 1.6), tolerence=1e-3)
branch = model.forced_response((0.8, 1.6))
branch.amplitud
hbvib.evaluate_contact("cubic", [0, 1], kt=1)  # no cubic
number: str = branch.peaks().omega
branch.energy(0).friction
model.nonlinear_mode((-2.0, 1.0), damping_form=3.5)
model.nonlinear_mode((-2.0, 1.0), damping_form="mas")
'''


def output(folder, *command):
    environment = dict(os.environ, MYPYPATH=os.path.dirname(PACKAGE), PYTHONPATH=os.path.dirname(PACKAGE))
    run = subprocess.run([sys.executable, "-m", *command], cwd=folder, capture_output=True, text=True, env=environment)
    return run.stdout + run.stderr


with tempfile.TemporaryDirectory() as folder:
    pages = [os.path.join(ROOT, "README.md"), *sorted(glob.glob(os.path.join(ROOT, "docs/**/*.md"), recursive=True))]
    programs = {}
    for page in pages:
        with open(page, encoding="utf-8") as file:
            for number, block in enumerate(re.findall(r"(?ms)^```python\n(.*?)^```", file.read())):
                programs[re.sub(r"\W", "_", os.path.relpath(page, ROOT)) + f"_{number}.py"] = block
    for path in glob.glob(os.path.join(ROOT, "examples/python/*.py")):
        with open(path, encoding="utf-8") as file:
            programs[os.path.basename(path)] = file.read()
    check("programs were found", len(programs) >= 10, programs.keys())
    programs["mistakes.py"] = MISTAKES
    for name, block in programs.items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(block)
    names = sorted(programs)
    lines = [k for k, line in enumerate(MISTAKES.splitlines(), 1) if k > 3 and not line.startswith("branch =")]

    def findings(text, pattern):
        """Lines of the file of mistakes, and what was said of other files."""
        found = re.findall(pattern, text, re.M)
        return sorted({int(line) for name, line in found if name == "mistakes.py"}), [
            line for line in text.splitlines() if " error" in line and "mistakes.py" not in line and ".py:" in line
        ]

    with open(os.path.join(folder, "mypy.ini"), "w", encoding="utf-8") as file:
        # Packages that hbvib imports on use alone, and whose results have no types of theirs.
        file.write("[mypy]\n[mypy-xarray.*,matplotlib.*,pandas.*,scipy.*,tqdm.*]\nfollow_imports = skip\n")
    text = output(folder, "mypy", "--strict", "--no-error-summary", "--cache-dir", "cache", PACKAGE, *names)
    told, others = findings(text, r"(\w+\.py):(\d+): error")
    check("mypy --strict has nothing to say about package, examples and book", not others, others)
    check("mypy finds every mistake", told == lines, text)

    if THOROUGH:
        with open(os.path.join(folder, "pyrightconfig.json"), "w", encoding="utf-8") as file:
            json.dump(dict(include=names, extraPaths=[os.path.dirname(PACKAGE)], pythonVersion="3.9",
                           reportMissingModuleSource="none"), file)
        text = output(folder, "pyright", "--pythonpath", sys.executable)
        told, others = findings(text, r"(\w+\.py):(\d+):\d+ - error")
        check("pyright has nothing to say about examples and book", " errors, 0 warnings" in text and not others, text)
        check("pyright finds every mistake", told == lines, text)

finish(110 if THOROUGH else 108)
