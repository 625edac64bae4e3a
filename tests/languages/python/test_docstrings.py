"""Every public name is listed and explained, and the example of every docstring gives what it says."""

import doctest
import inspect
import os
import warnings

os.environ.setdefault("MPLBACKEND", "Agg")

from common import check, finish, hbvib

warnings.simplefilter("ignore", hbvib.StoppedEarly)

# Names in reach of users, and no others.
modules = {name for name, value in vars(hbvib).items() if inspect.ismodule(value)}
imported = {"annotations", "TYPE_CHECKING", "ArrayLike"} | {
    name for name, value in vars(hbvib).items() if getattr(value, "__module__", "") in ("typing", "contextlib")
}
shown = {name for name in vars(hbvib) if not name.startswith("_")} - modules - imported
check("__all__ lists what is public", shown == set(hbvib.__all__), shown ^ set(hbvib.__all__))
check("a name is listed once", len(hbvib.__all__) == len(set(hbvib.__all__)))

runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
finder = doctest.DocTestFinder(recurse=False)


def explained(name, value, needs_example):
    doc = inspect.getdoc(value)
    check(f"{name} is explained", bool(doc))
    check(f"{name} does not send the reader to the header", "see hbvib.h" not in (doc or ""), doc)
    check(f"{name} has all its options", "{options}" not in (doc or ""))
    check(f"{name} has an example", not needs_example or ">>>" in (doc or ""))
    if ">>>" in (doc or ""):
        for test in finder.find(value, name, globs={}):
            runner.run(test)


explained("the module", hbvib, True)
explained("hbvib.io", hbvib.io, False)
explained("hbvib.testing", hbvib.testing, False)
check("completion shows modules that are loaded later", {"io", "testing", "Model"} <= set(dir(hbvib)))
public = [(name, getattr(hbvib, name)) for name in hbvib.__all__] + [
    (f"{module.__name__[6:]}.{name}", getattr(module, name)) for module in (hbvib.io, hbvib.testing) for name in module.__all__]
for title, value in public:
    if inspect.isfunction(value) or inspect.isclass(value):
        explained(title, value, True)
    for base in reversed(value.__mro__[:-1]) if inspect.isclass(value) else ():
        own = vars(base) if base.__module__.startswith("hbvib") else {}
        for name, member in own.items():
            member = member.__func__ if isinstance(member, (classmethod, staticmethod)) else member
            if not name.startswith("_") and (inspect.isfunction(member) or isinstance(member, property)):
                # As a user finds it: an explanation may be that of the class above.
                is_field = name == "mode_energy" or name.upper() in hbvib.Field.__members__
                explained(f"{title}.{name}", getattr(value, name), not is_field)
check("every example gives what it says", runner.failures == 0, runner.failures)
check("all examples ran", runner.tries > 250, runner.tries)

finish(300)
