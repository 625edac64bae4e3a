"""The module covers the header, and finds the library or says why it does not."""

import ctypes.util
import os
import re
import shutil
import subprocess
import sys
import tempfile

from common import check, finish, hbvib, raises

HERE = os.path.dirname(os.path.abspath(__file__))
MODULE = os.path.dirname(os.path.abspath(hbvib.__file__))
with open(os.path.join(HERE, "../../../include/hbvib.h")) as file:
    HEADER = re.sub(r"//[^\n]*|/\*.*?\*/", "", file.read(), flags=re.S)

# Every function, with the kinds of its arguments.
kinds = {"int64_t": "l", "int32_t": "i", "hbvib_status": "i", "double": "d", "size_t": "z"}
declared = re.findall(r"(?m)^[a-z][\w ]*?[ *](hbvib_\w+)\(([^;]*?)\);", HEADER)
check("the header's functions were found", len(declared) >= 71, len(declared))
for name, text in declared:
    wanted = []
    for argument in [] if text.strip() == "void" else text.split(","):
        kind, pointer = re.match(r"\s*(?:const )?(\w+) ?(\**)", argument).groups()
        struct = kind.replace("hbvib_", "")
        if not pointer:
            wanted.append(kinds[kind])
        elif kind in ("hbvib_model", "hbvib_branch", "hbvib_batch") and pointer == "*":
            wanted.append("h")
        else:
            wanted.append(struct if kind in hbvib.structs else "p")
    check(f"{name} has the header's arguments", hbvib._library._ARGUMENTS.get(name) == wanted, wanted)
    check(f"{name} is reachable", callable(getattr(hbvib.lib, name, None)))

# Every struct and every constant.
structs = re.findall(r"\}\s*(hbvib_\w+);", re.sub(r"typedef enum \{.*?\}[^;]*;", "", HEADER, flags=re.S))
check("every struct in the header's order", structs == list(hbvib.structs), set(structs) ^ set(hbvib.structs))
PREFIXES = dict(
    LifeFollow="LIFE_",
    LifeEvent="LIFE_",
    ContactState="CONTACTS_",
    State="STATE_",
    DampingForm="DAMPING_",
    ModeMultiple="MODE_",
    SynthesisFlag="SYNTHESIS_",
    LogLevel="LOG_",
    Phase="PHASE_",
    Flexibility="FLEXIBILITY_",
    Stability="STABILITY_",
    Waves="WAVES_",
    Measure="MEASURE_",
    Reading="READING_",
    Block="BLOCK_",
    Bifurcation="BIFURCATION_",
    MultiplierClass="MULTIPLIER_",
    Grazing="GRAZING_",
    ParameterKind="PARAMETER_",
    Scaling="SCALING_",
    Quantity="OF_",
    Derivative="DERIVATIVE_",
    Follow="FOLLOW_",
    BandOf="BAND_",
    ModeBandOf="MODE_BAND_",
    DataKind="DATA_",
    Scale="SCALE_",
    Suspicion="SUSPICION_",
    AeroForm="AERO_",
    Mistuning="MISTUNING_",
    FlexibilityWay="FLEXIBILITY_WAY_",
)
ours = {"HBVIB_GROUND": hbvib.GROUND, "HBVIB_DIAMETER_OF_ENGINE_ORDER": hbvib.DIAMETER_OF_ENGINE_ORDER}
for title in (
    "Status Storage Scalar Part MatrixKind Block SectorFrame ContactKind ContactState State Tangent Field DampingForm "
    "ModeMultiple SynthesisFlag LogLevel Phase SteadyMethod Flexibility Stability Waves Bifurcation MultiplierClass Grazing "
    "ParameterKind Scaling Quantity Derivative Follow BandOf ModeBandOf DataKind Scale Suspicion AeroForm Mistuning FlexibilityWay Measure "
    "Component Reading LifeFollow LifeEvent"
).split():
    for name, value in getattr(hbvib, title).__members__.items():
        ours[f"HBVIB_{PREFIXES.get(title, '')}{name}"] = int(value)
theirs = {name: int(value) for name, value in re.findall(r"\b(HBVIB_\w+) = (-?\d+)", HEADER)}
check("every constant has the header's value", ours == theirs, set(ours.items()) ^ set(theirs.items()))
check("the version is the library's", hbvib.__version__.encode() == hbvib.lib.hbvib_version_string())


def imported(module=MODULE, **environment):
    """The output of an interpreter that imports a copy of the module."""
    kept = {key: value for key, value in os.environ.items() if key not in ("HBVIB_LIBRARY", "PYTHONPATH")}
    run = subprocess.run(
        [sys.executable, "-c", "import hbvib; print(hbvib.lib._name)"],
        capture_output=True,
        text=True,
        env=dict(kept, PYTHONPATH=os.path.dirname(module), **environment),
    )
    return run.stdout.strip() + run.stderr.strip().rpartition("\n")[2]


path = os.path.realpath(hbvib.lib._name) if os.path.exists(hbvib.lib._name) else hbvib.lib._name
check("HBVIB_LIBRARY names the file", imported(HBVIB_LIBRARY=path) == path)
said = imported(HBVIB_LIBRARY="/nowhere/libhbvib.so")
check(
    "a wrong HBVIB_LIBRARY is an ImportError with its path",
    "ImportError" in said and "/nowhere/libhbvib.so" in said,
    said,
)
said = imported(HBVIB_LIBRARY="")
check("an empty HBVIB_LIBRARY is an ImportError", "ImportError" in said, said)
other = ctypes.util.find_library("m")
if other:
    raises("another library is refused by what it lacks", OSError, hbvib._library._open, other, words="has no function")
version, hbvib._library._VERSION = hbvib._library._VERSION, (hbvib._library._VERSION[0], hbvib._library._VERSION[1] + 1)
raises("a library of another version is refused", OSError, hbvib._library._open, path, words=f"is version {hbvib.__version__}")
hbvib._library._VERSION = version

with tempfile.TemporaryDirectory() as prefix:
    prefix = os.path.realpath(prefix)
    for folder in ("share/hbvib", "lib", "alone"):
        os.makedirs(os.path.join(prefix, folder))
    installed = shutil.copytree(MODULE, os.path.join(prefix, "share/hbvib/hbvib"))
    file = f"libhbvib.so.{version[0]}.{version[1]}"
    os.symlink(path, os.path.join(prefix, "lib", file))
    check("an installed module finds its prefix", imported(installed) == os.path.join(prefix, "lib", file))
    alone = shutil.copytree(MODULE, os.path.join(prefix, "alone/hbvib"))
    os.remove(os.path.join(prefix, "lib", file))
    if not ctypes.util.find_library("hbvib"):
        said = imported(alone)
        check("where nothing is found, ImportError names the places", "ImportError" in said and prefix in said, said)
    os.symlink(path, os.path.join(alone, file))
    check("a library beside the module comes first", imported(alone) == os.path.join(alone, file))

finish(150)
