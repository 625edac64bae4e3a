"""Results have types: no public attribute or result is Any for mypy --strict or, in tests/deep.sh, pyright strict, but where another package has no
types; names of members that checkers accept are those of the enumerations."""

import inspect
import json
import os
import re
import subprocess
import sys
import tempfile
import typing

from common import THOROUGH, check, finish, hbvib, raises

from hbvib import _choices

PACKAGE = os.path.dirname(os.path.abspath(hbvib.__file__))

# Objects of pandas, xarray, matplotlib and scipy, which may be absent or have no types; constants of a contact read back, numbers
# and directions, of which its kind decides.
UNTYPED = {
    "Contact.constants",
    "WheelPeaks.plot", "WheelQuantile.plot", "WheelStudy.plot", "WheelStudy.plot_patterns", "WorstPattern.plot",
    "BandCurve.plot", "CampbellResponse.plot", "Life.plot", "Branch.plot", "Branch.plot_loop", "Branch.to_dataframe", "Branch.to_xarray", "Model.plot_campbell", "Model.plot_interference",
    "Model.matrix", "io.Matrices.damping", "io.Matrices.mass", "io.Matrices.stiffness", "io.Matrices.structural",
}
UNTYPED |= {name.replace("Branch.", "SavedBranch.") for name in UNTYPED}


def is_untyped(annotation):
    return re.search(r"\bAny\b|\bnp\.ndarray\b(?!\[)|\bobject\b", str(annotation)) is not None


public = [(name, getattr(hbvib, name)) for name in hbvib.__all__ if name not in ("lib", "structs")]
public += [("io." + name, getattr(hbvib.io, name)) for name in hbvib.io.__all__]
seen, arrays = 0, []
for title, value in public:
    if inspect.isfunction(value):
        seen += 1
        check(f"{title} has a result of some type", title in UNTYPED or not is_untyped(value.__annotations__["return"]))
    for base in value.__mro__[:-1] if inspect.isclass(value) else ():
        if not base.__module__.startswith("hbvib"):
            continue
        for name, annotation in vars(base).get("__annotations__", {}).items():
            if not name.startswith("_"):
                seen += 1
                check(f"{title}.{name} has a type", f"{title}.{name}" in UNTYPED or not is_untyped(annotation), annotation)
        for name, member in vars(base).items():
            member = member.__func__ if isinstance(member, (classmethod, staticmethod)) else member
            if name.startswith("_") and name not in ("__enter__", "__len__"):
                continue
            if isinstance(member, property) and type(member) is not property:
                arrays.append(f"{title}.{name}")  # a field: its type is that of the descriptor
            function = member.fget if type(member) is property else member
            if inspect.isfunction(function):
                seen += 1
                told = inspect.signature(function).return_annotation
                check(f"{title}.{name} has a result of some type", told is not inspect.Signature.empty
                      and (f"{title}.{name}" in UNTYPED or not is_untyped(told)), told)
check("all were seen", seen > 300 and len(arrays) >= 2 * 21, (seen, len(arrays)))

# Names of members.
for name, kind in vars(_choices).items():
    choices = typing.get_args(kind) if not isinstance(kind, type) else ()
    members = [choice for choice in choices if isinstance(choice, type) and choice is not int]
    if len(members) != 1:
        continue
    told = {text for choice in choices for text in typing.get_args(choice)}
    names = {member.name.lower() for member in members[0]}
    if members[0] is hbvib.ContactKind:
        names -= {"table", "polynomial", "caller_law"}  # read back only
    check(f"{name} has the names of {members[0].__name__}", told == names, told ^ names)

# Checkers tell the types of what a user writes.
EXPRESSIONS = {
    "model.linear_modes(1).omega": "float64",
    "model.damped_modes(1).eigenvalue": "complex128",
    "model.matrix('mass')": "float64",
    "model.contact(0).kind": "ContactKind",
    "branch.field('omega')": "float64",
    "branch.harmonics(0)": "complex128",
    "branch.slip(0)": "float64",
    "branch.time_history(0, 0)": "float64",
    "branch.peaks().point": "signedinteger",
    "branch.at(0).amplitude": "float64",
    "branch.reduction.unknowns": "int",
    "branch.energy(0).friction_loss": "float",
    "branch.status": "Status",
    "branch.stored": "int",
    "hbvib.load('file').amplitude": "float64",
    "batch.peak_amplitude": "float64",
    "batch.branch(0)": "Branch",
    "model.sensitivity(branch, 0, hbvib.Parameter('mu'))": "Sensitivities",
    "hbvib.Parameter('mu').kind": "ParameterKind",
    "model.verify(branch, 0).info.distance": "float",
    "model.floquet(branch, 0).multipliers": "complex128",
    "entered": "Model",
}
EXPRESSIONS.update({name.replace("SavedBranch.", "saved.").replace("Branch.", "branch."): "float64" for name in arrays})
PROGRAM = """import hbvib

model = hbvib.Model(mass=1.0, stiffness=1.0)
branch = model.forced_response((0.8, 1.6))
saved = hbvib.load("file")
batch = model.batch((0.8, 1.6), hbvib.Parameter("mu"), [1.0])
with hbvib.Model(1) as entered:
    pass
"""
FIRST = PROGRAM.count("\n") + 1
PROGRAM += "".join(f"reveal_type({expression})\n" for expression in EXPRESSIONS)


def output(folder, *command):
    environment = dict(os.environ, MYPYPATH=os.path.dirname(PACKAGE), PYTHONPATH=os.path.dirname(PACKAGE))
    run = subprocess.run([sys.executable, "-m", *command], cwd=folder, capture_output=True, text=True, env=environment)
    return run.stdout + run.stderr


with tempfile.TemporaryDirectory() as folder:
    with open(os.path.join(folder, "program.py"), "w", encoding="utf-8") as file:
        file.write(PROGRAM)
    with open(os.path.join(folder, "mypy.ini"), "w", encoding="utf-8") as file:
        file.write("[mypy]\n[mypy-xarray.*,matplotlib.*,pandas.*,scipy.*,tqdm.*]\nfollow_imports = skip\n")
    with open(os.path.join(folder, "pyrightconfig.json"), "w", encoding="utf-8") as file:
        json.dump(dict(include=["program.py"], extraPaths=[os.path.dirname(PACKAGE)], pythonVersion="3.9",
                       typeCheckingMode="strict"), file)
    checkers = [
        ("mypy", ("mypy", "--strict", "--cache-dir", "cache", "program.py"),
         r'program\.py:(\d+): note: Revealed type is "(.*)"'),
        ("pyright", ("pyright", "--pythonpath", sys.executable),
         r'program\.py:(\d+):\d+ - information: Type of "[^"]*" is "(.*)"'),
    ]
    for checker, command, pattern in checkers if THOROUGH else checkers[:1]:
        text = output(folder, *command)
        found = {int(line): told for line, told in re.findall(pattern, text)}
        check(f"{checker} has no error", re.search(r"\berror:|- error", text) is None, text)
        for line, (expression, wanted) in enumerate(EXPRESSIONS.items(), FIRST):
            told = found.get(line, "nothing")
            # An array may have any number of dimensions, which is part of its type.
            rest = re.sub(r"int64", "signedinteger", told)
            rest = re.sub(r"tuple\[(Any|int), \.\.\.\]|ndarray\[Any, |_?AnyShape", "", rest)
            is_told = wanted in rest and re.search(r"\b(Any|Unknown)\b", rest) is None
            check(f"{checker} knows {expression}", is_told, told)

# A number that is not whole is named.
wheel = hbvib.Model.cyclic(1, sectors=8, mass=1, stiffness=3)
for name, call in (
    ("engine_order", lambda: wheel.set_wave(0.5)),
    ("engine_order", lambda: hbvib.Model.cyclic(1, sectors=8, engine_order=0.5, mass=1, stiffness=3)),
    ("engine_order", lambda: wheel.campbell([0.0, 1.0], 1, engine_orders=[0.5])),
    ("sectors", lambda: hbvib.Model.cyclic(1, sectors=8.5, mass=1, stiffness=3)),
    ("diameter", lambda: wheel.linear_modes(1, diameter=0.5)),
    ("count", lambda: wheel.linear_modes(0.5)),
    ("harmonic", lambda: wheel.add_force(0, 1, harmonic=0.5)),
    ("dof", lambda: wheel.add_force(0.5, 1)),
    ("max_points", lambda: wheel.forced_response((1, 2), max_points=0.5)),
):
    raises(f"{name} is named", TypeError, call, words=f"{name} = ")

finish(450)
