"""Writing results down: a label and a hexadecimal number a line, and all that a branch returns."""

import warnings

import numpy as np

import hbvib

warnings.simplefilter("ignore", hbvib.StoppedEarly)

#: The cases by their names "group/name": functions of a Record.
CASES = {}


def case(group):
    """Registers a function as a case; its name is that of the function."""

    def register(function):
        name = f"{group}/{function.__name__}"
        assert name not in CASES, name
        CASES[name] = function
        return function

    return register


def cases(group, members):
    """Registers a function for several cases, each with an argument of its own."""

    def register(function):
        for name, argument in members.items():
            full = f"{group}/{name}"
            assert full not in CASES, full
            CASES[full] = lambda record, argument=argument: function(record, argument)
        return function

    return register


class Record:
    """Writes what belongs to one case."""

    def __init__(self, label, stream):
        self.label, self.stream = label, stream

    def part(self, name):
        """The same with a longer label."""
        return Record(f"{self.label}/{name}", self.stream)

    def sentence(self, name, text):
        print("sentence", f"{self.label}/{name}", text.replace("\n", " "), file=self.stream)

    def write(self, name, value):
        """A number, complex number, array, tuple of fields, or None."""
        label = f"{self.label}/{name}"
        if value is None:
            print(label, "none", file=self.stream)
        elif hasattr(value, "_asdict"):
            for field, entry in value._asdict().items():
                self.write(f"{name}.{field}", entry)
        elif isinstance(value, (np.ndarray, tuple, list, range)):
            array = np.asarray(value)
            print(f"{label}.shape", "x".join(str(n) for n in array.shape), file=self.stream)
            for index in np.ndindex(array.shape):
                place = ",".join(str(i) for i in index)
                self._number(f"{label}[{place}]", array[index])
        else:
            self._number(label, value)

    def _number(self, label, value):
        if isinstance(value, (complex, np.complexfloating)):
            print(f"{label}.re", float(value.real).hex(), file=self.stream)
            print(f"{label}.im", float(value.imag).hex(), file=self.stream)
        elif isinstance(value, (bool, int, np.integer, np.bool_)):
            print(label, int(value), file=self.stream)
        else:
            print(label, float(value).hex(), file=self.stream)

    def attempt(self, name, function, *arguments, **keywords):
        """Result of a call; where it is refused, its status and sentence are written and None is returned."""
        try:
            return function(*arguments, **keywords)
        except hbvib.Error as error:
            print(f"{self.label}/{name}.status", hbvib.Status(error.status).name, file=self.stream)
            print(f"{self.label}/{name}.argument", error.argument, file=self.stream)
            self.sentence(f"{name}.error", error.sentence)
            return None
        except TypeError as error:  # before the library sees it
            self.sentence(f"{name}.error", str(error))
            return None

    def solve(self, name, function, *arguments, points=5, dofs=None, loops=True, log=False, **keywords):
        """Calls a solve and writes all of its branch; the progress of the steps as well. Returns the branch."""
        inner = self.part(name)
        steps, lines = [], []
        keywords["progress"] = steps.append
        if log:
            keywords.update(log=lambda level, text: lines.append(f"{level.name} {text}"), log_level="debug")
        branch = inner.attempt("solve", function, *arguments, **keywords)
        inner.write("steps", [[s.point, s.newton_iterations] for s in steps] or None)
        inner.write("progress", [[s.parameter, s.amplitude, s.residual, s.step, s.fraction_done] for s in steps] or None)
        for i, line in enumerate(lines):
            inner.sentence(f"log[{i}]", line)
        if branch is not None:
            inner.branch(branch, len(np.atleast_1d(keywords.get("at", []))), points, dofs, loops)
        return branch

    def branch(self, branch, wanted=0, points=5, dofs=None, loops=True):
        """All fields of a branch, and of `points` of its points and its first special points everything else."""
        print(f"{self.label}/status", branch.status.name, file=self.stream)
        self.sentence("message", branch.message)
        self.write("points", len(branch))
        self.write("stored", branch.stored)
        self.write("reduction", branch.reduction)
        for field in hbvib.Field:
            self.write(field.name, self.attempt(field.name, branch.field, field))
        self.write("peaks", branch.peaks())
        self.write("folds", branch.folds())
        for i in range(wanted):
            self.write(f"at{i}", branch.at(i))
        info = self.attempt("mode_info", lambda: branch.mode_info)
        self.write("mode_info", info)
        chosen = sorted({int(i) for i in np.linspace(0, len(branch) - 1, min(points, len(branch)))})
        chosen += range(len(branch), min(branch.stored, len(branch) + 3))
        for point in chosen:
            self.point(branch, point, dofs, info is not None, loops)

    def point(self, branch, point, dofs, mode, loops):
        inner = self.part(f"point{point}")
        if dofs is None:
            inner.write("harmonics", inner.attempt("harmonics", branch.harmonics, point))
        else:
            for dof in dofs:
                inner.write(f"harmonics_of_{dof}", inner.attempt("harmonics", branch.harmonics, point, dof, 1))
        inner.write("slip", inner.attempt("slip", branch.slip, point))
        inner.write("energy", inner.attempt("energy", branch.energy, point))
        if mode:
            inner.write("mode_point", branch.mode_point(point))
        for dof in [0] if dofs is None else dofs:
            inner.write(f"history_of_{dof}", branch.time_history(point, dof, 16))
        for contact in range(min(branch.reduction.contacts, 6) if loops else 0):
            summary = inner.attempt(f"summary{contact}", branch.summary, point, contact)
            if summary is None:
                continue
            inner.write(f"summary{contact}", summary)
            for direction in range(summary.directions):
                name = f"loop{contact}_{direction}"
                inner.write(name, inner.attempt(name, branch.loop, point, contact, direction, 16))


def chain(n, stiffness=1.0, mass=1.0, damping=0.02, ground=1.0):
    """Matrices of masses in a row, the first one held by a spring to the ground; damping is that part of K."""
    k = stiffness * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    k[n - 1, n - 1] = stiffness
    k[0, 0] = stiffness + ground
    return dict(mass=mass * np.eye(n), damping=damping * k, stiffness=k)
