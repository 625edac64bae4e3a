"""Builds the library for a wheel; hatchling calls it (pyproject.toml)."""

import json
import shutil
import subprocess
import sysconfig
import tempfile
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class Library(BuildHookInterface):
    """Puts the shared library beside the module, where the module searches first."""

    def initialize(self, version, build_data):
        library = built(self.root)
        # The wheel holds a copy without internal symbols, if strip is available.
        self.scratch = tempfile.mkdtemp()
        copy = Path(self.scratch, library.name)
        shutil.copy(library, copy)
        if shutil.which("strip"):
            subprocess.run(["strip", "--strip-unneeded", str(copy)], check=True)
        build_data["pure_python"] = False
        # Tag: any Python 3, no Python ABI, this platform.
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["tag"] = f"py3-none-{platform}"
        build_data["force_include"][str(copy)] = f"hbvib/{library.name}"
        build_data["force_include"][str(Path(self.root, "include", "hbvib.py"))] = "hbvib/__init__.py"

    def finalize(self, version, build_data, artifact_path):
        shutil.rmtree(self.scratch, ignore_errors=True)


def built(root):
    """The shared library as cargo has built it."""
    command = ["cargo", "build", "--release", "--lib", "--message-format=json-render-diagnostics"]
    output = subprocess.run(command, cwd=root, check=True, stdout=subprocess.PIPE, text=True).stdout
    files = []
    for line in output.splitlines():
        message = json.loads(line)
        if message.get("reason") == "compiler-artifact" and "cdylib" in message["target"]["kind"]:
            files += message["filenames"]
    shared = [Path(file) for file in files if Path(file).suffix in (".so", ".dylib", ".dll")]
    if len(shared) != 1:
        raise RuntimeError(f"cargo built no single shared library: {files}")
    return shared[0]
