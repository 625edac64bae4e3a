"""Saved models: pickle, copies, files and other processes give a model that solves to the same bits."""

import copy
import os
import pickle
import subprocess
import sys
import tempfile

from common import bits, check, finish, hbvib, oscillator, raises, ring_damper, solve

model = ring_damper()
reference = bits(solve(model))
data = model.to_bytes()
for claim, other in (
    ("pickle", pickle.loads(pickle.dumps(model))),
    ("a deep copy", copy.deepcopy(model)),
    ("a copy", copy.copy(model)),
    ("bytes", hbvib.Model.from_bytes(data)),
    ("a bytearray", hbvib.Model.from_bytes(bytearray(data))),
    ("a view of memory", hbvib.Model.from_bytes(memoryview(data))),
):
    check(f"{claim} gives the same bits", bits(solve(other)) == reference)
    check(f"{claim} gives the same bytes", other.to_bytes() == data)
    other.add_force(0, 1.0)
    check(f"{claim} is a model of its own", model.to_bytes() == data)

with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "ring damper.hbvib")
    model.save(path)
    check("a file gives the same bits", bits(solve(hbvib.Model.load(path))) == reference)
    program = (
        "import sys; sys.path.insert(0, sys.argv[2]); from common import bits, hbvib, solve; "
        "sys.stdout.buffer.write(bits(solve(hbvib.Model.load(sys.argv[1]))))"
    )
    here = os.path.dirname(os.path.abspath(__file__))
    found = subprocess.run([sys.executable, "-c", program, path, here], stdout=subprocess.PIPE, check=True).stdout
    check("another process finds the same bits", found == reference)
    with open(path, "r+b") as file:
        file.truncate(300)
    raises("half a file", ValueError, hbvib.Model.load, path, words="incomplete: it has 300 bytes")
    raises("no file", FileNotFoundError, hbvib.Model.load, os.path.join(folder, "none"))
    raises("no folder", FileNotFoundError, model.save, os.path.join(folder, "none", "here"))

raises("text", (TypeError, ValueError), hbvib.Model.from_bytes, "text")
raises("something else", ValueError, hbvib.Model.from_bytes, b"something else", words="mark")
raises("a damaged model", ValueError, hbvib.Model.from_bytes, data[:99] + b"\0" + data[100:], words="checksum")
newer = data[:8] + b"\7" + data[9:]
raises("a newer format", NotImplementedError, hbvib.Model.from_bytes, newer, words="newer")


class Own(hbvib.Model):
    pass


own = Own.cyclic(2, sectors=3)
check("a class of the caller comes back", type(pickle.loads(pickle.dumps(own))) is Own)

forced = oscillator()
forced.add_user_force([0], lambda call: None)
raises("a user force", NotImplementedError, pickle.dumps, forced, words="contact 1: a force of the caller")
check("a copy of it shares the function", copy.deepcopy(forced).contacts == 2)

program = "import pickle, sys; sys.stdout.buffer.write(pickle.load(sys.stdin.buffer).to_bytes())"
environment = dict(os.environ, PYTHONPATH=os.path.dirname(os.path.dirname(os.path.abspath(hbvib.__file__))))
found = subprocess.run(
    [sys.executable, "-c", program], input=pickle.dumps(model), stdout=subprocess.PIPE, env=environment, check=True
)
check("a pickled model crosses processes", found.stdout == data)

finish(30)
