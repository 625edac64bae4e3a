"""Builds the libraries for a wheel; hatchling calls it (pyproject.toml).

HBVIB_WHEEL_LIBRARIES names a folder with libraries that were built before, HBVIB_WHEEL_PLATFORM the platform that they
run on: manylinux.sh sets both."""

import contextlib
import json
import os
import shutil
import subprocess
import sysconfig
import tempfile
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

# Shared libraries of the wheel, and the packages of the workspace that build them.
PACKAGES = {"hbvib": "hbvib-c", "hbvib_io": "hbvib-io"}
HEADERS = ("hbvib.h", "hbvib.hpp", "hbvib_plain.h", "hbvib_io.h", "hbvib.f90")


class Library(BuildHookInterface):
    """Puts the shared libraries and headers into the package, where the modules search first."""

    def initialize(self, version, build_data):
        if version == "editable":
            raise RuntimeError("no editable installation: use PYTHONPATH=include and cargo build --release")
        files = build_data["force_include"]
        package = Path(self.root, "include", "hbvib")
        for path in [*package.glob("*.py"), package / "py.typed"]:
            files[str(path)] = f"hbvib/{path.name}"
        for name in HEADERS:
            files[str(Path(self.root, "include", name))] = f"hbvib/include/{name}"
        self.scratch = tempfile.mkdtemp()
        for library in libraries(self.root):
            # The wheel holds a copy without internal symbols, if strip is available.
            copy = Path(self.scratch, library.name)
            shutil.copy(library, copy)
            if shutil.which("strip"):
                subprocess.run(["strip", "--strip-unneeded", str(copy)], check=True)
            files[str(copy)] = f"hbvib/{library.name}"
        build_data["pure_python"] = False
        # Tag: any Python 3, no Python ABI, this platform.
        platform = os.environ.get("HBVIB_WHEEL_PLATFORM") or sysconfig.get_platform()
        build_data["tag"] = f"py3-none-{platform.replace('-', '_').replace('.', '_')}"

    def finalize(self, version, build_data, artifact_path):
        shutil.rmtree(self.scratch, ignore_errors=True)


def libraries(root):
    """The shared libraries: built before, or now by cargo."""
    built = os.environ.get("HBVIB_WHEEL_LIBRARIES")
    if built:
        found = [Path(built, f"lib{name}.so") for name in PACKAGES]
        missing = [str(path) for path in found if not path.is_file()]
        if missing:
            raise RuntimeError(f"HBVIB_WHEEL_LIBRARIES has no {', '.join(missing)}")
        return found
    tell("hbvib: compiling the libraries with Rust; this takes some minutes (pip install -v shows each step)")
    found = [compiled(root, name, package) for name, package in PACKAGES.items()]
    tell("hbvib: compiled")
    return found


def tell(sentence):
    """Writes to the terminal, because pip hides what a build writes to its output."""
    print(sentence, flush=True)
    with contextlib.suppress(OSError), open("/dev/tty", "w", encoding="utf-8") as terminal:
        print("\n" + sentence, file=terminal)


def compiled(root, name, package):
    """The shared library of a package as cargo has built it."""
    cargo = os.environ.get("CARGO", "cargo")
    command = [cargo, "build", "--release", "--lib", "-p", package, "--message-format=json-render-diagnostics"]
    try:
        output = subprocess.run(command, cwd=root, check=True, stdout=subprocess.PIPE, text=True).stdout
    except FileNotFoundError:
        raise RuntimeError("no cargo here: install Rust from https://rustup.rs, or install a wheel") from None
    files = []
    for line in output.splitlines():
        message = json.loads(line)
        if message.get("reason") == "compiler-artifact" and "cdylib" in message["target"]["kind"]:
            files += [file for file in message["filenames"] if message["target"]["name"] == name]
    shared = [Path(file) for file in files if Path(file).suffix in (".so", ".dylib", ".dll")]
    if len(shared) != 1:
        raise RuntimeError(f"cargo built no single shared library of {package}: {files}")
    return shared[0]
