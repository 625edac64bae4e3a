"""Branches leave the process: files, pickles and tables have the same bits, and figures show them."""

import hashlib
import os
import pickle
import subprocess
import sys
import tempfile
import warnings

os.environ.setdefault("MPLBACKEND", "Agg")

import numpy as np

from common import bits, check, close, finish, hbvib, oscillator, raises, ring_damper, solve

READ = """
import hashlib, pickle, sys
sys.path.append({folder!r})
import hbvib
from common import bits
branch = pickle.load(open({name!r}, "rb")) if {name!r}.endswith("pickle") else hbvib.load({name!r})
more = [repr(branch.reduction), repr(branch.energy(0)), repr(branch.slip(3).tolist()), branch.status.name]
print(hashlib.sha256(bits(branch) + "".join(more).encode()).hexdigest())
"""


def digest(branch):
    more = [repr(branch.reduction), repr(branch.energy(0)), repr(branch.slip(3).tolist()), branch.status.name]
    return hashlib.sha256(bits(branch) + "".join(more).encode()).hexdigest()


HERE = os.path.dirname(os.path.abspath(__file__))
branch = solve(ring_damper(), at=[1310.0])
mode = oscillator().nonlinear_mode((-2, 1), at=[-1.0])
with tempfile.TemporaryDirectory() as folder:
    names = [os.path.join(folder, name) for name in ("branch.npz", "branch.pickle")]
    branch.save(names[0])
    with open(names[1], "wb") as file:
        pickle.dump(branch, file)
    for name in names:
        text = subprocess.run(
            [sys.executable, "-c", READ.format(folder=HERE, name=name)], capture_output=True, text=True, check=True
        ).stdout
        check(f"{os.path.basename(name)} has the same bits in another process", text.strip() == digest(branch), text)
    check("nothing else is left in the folder", sorted(os.listdir(folder)) == ["branch.npz", "branch.pickle"])

    saved = hbvib.load(names[0])
    check("special points are saved", all((a == b).all() for a, b in zip(saved.at(0), branch.at(0))))
    peak = branch.peaks().point[0]
    close("motions in time follow from harmonics", saved.time_history(peak, 0), branch.time_history(peak, 0), 1e-12)
    check("a part of the harmonics", (saved.harmonics(peak, 1, 2) == branch.harmonics(peak, 1, 2)).all())
    check("fields are read-only", not saved.omega.flags.writeable)
    check("a saved branch is saved again", pickle.loads(pickle.dumps(saved)).omega.tobytes() == branch.omega.tobytes())
    close("loops follow from harmonics and model", saved.loop(peak, 0).force, branch.loop(peak, 0).force, 1e-9)
    raises("syntheses need the solution", NotImplementedError, saved.synthesis, ring_damper(), words="solve again")
    raises("a point that is not there", IndexError, saved.energy, saved.stored)
    raises("a request that is not there", IndexError, saved.at, 1)
    raises("fields of modes are not in a response", ValueError, saved.field, "damping_ratio")

    name = os.path.join(folder, "mode")
    mode.save(name, harmonics=False)
    back = hbvib.load(name)
    check("a file has the very name that was given", os.path.exists(name))
    check("a mode is a mode", back.is_mode and back.mode_info == mode.mode_info and repr(back) == repr(mode).replace(
        "hbvib.Branch", "hbvib.SavedBranch"), repr(back))
    check("points of a mode", back.mode_point(2) == mode.mode_point(2) and not len(back.limit_cycles().point))
    raises("harmonics that were left out", NotImplementedError, back.harmonics, 0, words="no harmonics")
    with open(name, "w") as file:
        file.write("no archive")
    raises("another file is refused by name", ValueError, hbvib.load, name, words=name)
    raises("a file that is not there", FileNotFoundError, hbvib.load, name + "2")
    np.savez(os.path.join(folder, "other.npz"), a=1)
    raises("another archive is refused", ValueError, hbvib.load, os.path.join(folder, "other.npz"), words="other.npz")

# Tables.
table = branch.to_dataframe()
check("a row a point", table.index.name == "point" and len(table) == len(branch))
check("columns are fields", {"omega", "amplitude", "slip_fraction_0", "error_estimate"} <= set(table.columns), table.columns)
check("values are the same", (table["amplitude"].to_numpy() == branch.amplitude).all())
check("status goes along", table.attrs["status"] == "OK" and table.attrs["message"] == "")
check("a mode has its fields", {"damping_ratio", "modal_amplitude"} <= set(mode.to_dataframe().columns))
dataset = branch.to_xarray()
check("a dataset over points and contacts", dict(dataset.sizes) == dict(point=len(branch), contact=1))
check("its coordinate is the frequency", (dataset["omega"].to_numpy() == branch.omega).all())
check("that of a mode is the amplitude", "log10_amplitude" in mode.to_xarray().coords)

# And back: a table that was not changed is the branch, in all that its file would hold.


def same_branch(name, back, wanted):
    check(f"{name}: the same fields, special points and energies", digest(back) == digest(wanted))
    check(f"{name}: peaks, folds and what else lies beside the curve", all(
        (a == b).all() for a, b in zip([*back.peaks(), *back.folds(), *back.at(0)], [*wanted.peaks(), *wanted.folds(), *wanted.at(0)])))
    check(f"{name}: shown as it was", repr(back).replace("Saved", "") == repr(wanted), repr(back))


stable = solve(ring_damper(), at=[1310.0], stability="wave", freedom=1)
table = pickle.loads(pickle.dumps(stable.to_dataframe()))
check("a field of contacts in two directions is in the table", {"d_amplitude_by_place_0_t1", "slip_fraction_0"} <= set(table.columns))
back = hbvib.from_dataframe(table)
check("a table gives every field to the bit", all(
    back.field(name).tobytes() == values.tobytes() for name, values in hbvib._tables.fields(stable).items()))
check("and peaks, energies, slip of stored points", (back.peaks().omega == stable.peaks().omega).all()
      and back.energy(back.stored - 1) == stable.energy(stable.stored - 1) and back.plot() is not None)
raises("harmonics are in no table", NotImplementedError, back.harmonics, 0, words="no harmonics")
same_branch("a dataset with harmonics", hbvib.from_xarray(branch.to_xarray(harmonics=True)), branch)
again = hbvib.from_xarray(hbvib.from_xarray(branch.to_xarray(harmonics=True)).to_xarray(harmonics=True))
same_branch("there and back twice", again, branch)
close("loops follow from its harmonics and model", again.loop(peak, 0).force, branch.loop(peak, 0).force, 1e-9)
back = hbvib.from_dataframe(mode.to_dataframe())
check("a mode comes back", back.is_mode and back.mode_info == mode.mode_info and back.mode_point(1) == mode.mode_point(1)
      and repr(back).replace("Saved", "") == repr(mode), repr(back))
with tempfile.TemporaryDirectory() as folder:
    name = os.path.join(folder, "branch.nc")
    branch.to_xarray(harmonics=True).to_netcdf(name, engine="scipy")
    import xarray

    with xarray.open_dataset(name, engine="scipy") as read:
        same_branch("through NetCDF", hbvib.from_xarray(read.load()), branch)
    name = os.path.join(folder, "branch.csv")
    branch.to_dataframe().to_csv(name)
    import pandas

    plain = hbvib.from_dataframe(pandas.read_csv(name, index_col="point", engine="python"))
check("through CSV fields have the same bits", (plain.amplitude == branch.amplitude).all() and (plain.slip_fraction == branch.slip_fraction).all())
check("and are all that there is", "peak" not in repr(plain) and f"{len(branch)} points" in repr(plain), repr(plain))
for call in (plain.peaks, plain.folds, plain.turns, plain.bifurcations):
    raises("what a table lacks is refused in words", NotImplementedError, call, words="fields alone")
raises("energies, too", NotImplementedError, plain.energy, 0, words="no energy")
raises("and the size of the problem", NotImplementedError, lambda: plain.reduction, words="table")
check("a figure is drawn without peaks", len(plain.plot().lines[0].get_xdata()) == len(branch))
check("it goes to a table again", hbvib.from_dataframe(plain.to_dataframe()).omega.tobytes() == branch.omega.tobytes())
part = hbvib.from_dataframe(branch.to_dataframe().iloc[3:])
check("a part is no longer the branch", len(part) == len(branch) - 3, len(part))
raises("so that no peak is told of another curve", NotImplementedError, part.peaks, words="fields alone")
scaled = branch.to_dataframe()
scaled["amplitude"] *= 1000
raises("nor of other units", NotImplementedError, hbvib.from_dataframe(scaled).peaks, words="fields alone")
raises("another table is refused by what it lacks", ValueError, hbvib.from_dataframe, table[["omega"]], words="no amplitude")

# Units are shown, and convert nothing.
named = ring_damper()
named.units = hbvib.Units("m", "N", "s")
shown = solve(named)
check("numbers are those without units", (shown.amplitude == branch.amplitude[: len(shown)]).all() or len(shown) != len(branch))
check("a model tells its units", repr(named).endswith("units m N s>") and "length m, force N, time s" in named._repr_html_(), repr(named))
check("a branch tells them with its numbers", "to 1325.75 rad/s" in repr(shown) and " m at omega = " in repr(shown), repr(shown))
check("axes are labelled", shown.plot().get_ylabel().endswith("/ m") and shown.plot_loop(0, 0).get_ylabel().endswith("/ N"))
check("xarray has them", shown.to_xarray()["amplitude"].attrs["units"] == "m" and shown.to_xarray()["omega"].attrs["units"] == "rad/s")
check("they stay in copies, files and tables", all(one.units == named.units for one in (
    named.clone(), shown, pickle.loads(pickle.dumps(shown)), hbvib.from_dataframe(shown.to_dataframe()))))
check("and without names nothing is shown", "units" not in ring_damper()._repr_html_() and hbvib.Units("mm").work == "")
raises("a word is no list of units", TypeError, lambda: setattr(named, "units", "mm"), words="hbvib.Units")
raises("nor are four", TypeError, lambda: setattr(named, "units", "abcd"), words="up to three")

# In one line and as HTML.
check("a branch tells range, peak and status", "omega 1300.62 to 1325.75, peak " in repr(branch) and ", OK>" in repr(branch))
check("a mode tells its damping", "largest damping ratio" in repr(mode), repr(mode))
check("one is not many", repr(hbvib.Model(1)) == "<hbvib.Model: 1 degree of freedom, 0 contacts>", repr(hbvib.Model(1)))
wheel = "<hbvib.Model: 4 degrees of freedom, 24 sectors, engine order 2, 1 contact>"
check("a wheel tells its engine order", repr(ring_damper()) == wheel, repr(ring_damper()))
check("HTML is a table", branch._repr_html_().startswith("<table>") and "peak" in branch._repr_html_())
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    stopped = solve(ring_damper(), max_points=5)
check("a stop is told", "STOPPED_MAX_POINTS: " in repr(stopped) and "max_points" in stopped._repr_html_(), repr(stopped))

# Figures.
axes = branch.plot(hertz=True, label="5 N")
x, y = axes.lines[0].get_xydata().T
check("a figure has every point of the curve", set(branch.omega / (2 * np.pi)) <= set(x))
check("and goes through the peak", y.max() == branch.peaks().amplitude.max() > branch.amplitude.max())
apart = np.abs(x - branch.peaks().omega[0] / (2 * np.pi))
check("which is put between its neighbours", (np.diff(x) > 0).all() and apart.argmin() == y.argmax())
close("peaks are marked", axes.lines[1].get_xydata()[:, 1], branch.peaks().amplitude, 0)
check("axes of a call are used", branch.plot(axes) is axes and len(axes.lines) == 4)
above, below = mode.plot()
drawn = below.lines[0].get_xydata()[:, 1]
close("damping is in per cent, with its maximum", drawn.max(), 100 * mode.mode_point(mode.peaks().point[0]).damping_ratio, 0)
loop = branch.plot_loop(peak, 0).lines[0].get_xydata()
close("a loop is closed and has the force of the contact", loop[:-1, 1], branch.loop(peak, 0).force, 0)
check("its end is its beginning", (loop[0] == loop[-1]).all())

# Bars.
drawn = subprocess.run(
    [sys.executable, "-c", "import sys; sys.path.append(sys.argv[1])\nif sys.argv[2]: sys.modules['tqdm'] = None\n"
     "from common import *; oscillator().forced_response((0.8, 1.6), progress=True)", HERE, sys.argv[0]],
    capture_output=True, text=True, check=True)
check("a line of progress without tqdm", "100 %" in drawn.stderr and drawn.stdout == "", drawn.stderr)

# Packages that are not there.
for package, call in (
    ("pandas", branch.to_dataframe), ("xarray", branch.to_xarray), ("matplotlib", branch.plot), ("matplotlib", mode.plot)
):
    kept = {name: sys.modules.pop(name) for name in list(sys.modules) if name.split(".")[0] == package}
    sys.modules[package] = None
    raises(f"{package} is named where it is not there", ImportError, call, words="pip install " + package)
    del sys.modules[package]
    sys.modules.update(kept)

finish(85)
