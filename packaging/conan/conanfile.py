"""Conan 2: conan create packaging/conan. Needs cargo, as no recipe of Rust does it."""
import os
import re

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.files import copy, load


class Hbvib(ConanFile):
    name = "hbvib"
    description = "Harmonic balance of vibrating structures with friction contacts"
    license = "MIT OR Apache-2.0"
    topics = ("vibration", "harmonic-balance", "friction", "nonlinear-modes")
    package_type = "shared-library"
    settings = "os", "arch", "compiler", "build_type"

    @property
    def _root(self):
        return os.path.join(self.recipe_folder, "..", "..")

    def set_version(self):
        self.version = re.search(r'(?m)^version = "([^"]+)"', load(self, os.path.join(self._root, "Cargo.toml"))).group(1)

    def export_sources(self):
        for pattern in ("src/*", "crates/*", "include/*", "examples/install*", "build.rs", "cbindgen.toml", "Cargo.*", "LICENSE-*",
                        "benches/*", "tests/Cargo.toml", "tests/units/*", "docs/statuses.md", "docs/theory.md", "README.md"):
            copy(self, pattern, self._root, self.export_sources_folder)

    def validate(self):
        if self.settings.os != "Linux" or self.settings.arch not in ("x86_64", "armv8"):
            raise ConanInvalidConfiguration("the recipe installs on 64-bit Linux alone")

    def package_id(self):
        # A plain C interface, always optimised.
        self.info.settings.rm_safe("compiler")
        self.info.settings.rm_safe("build_type")

    def build(self):
        self.run("cargo build --release --lib", cwd=self.source_folder)
        self.run("cargo build --release --lib -p hbvib-io", cwd=self.source_folder)

    def package(self):
        self.run(f'sh examples/install.sh "{self.package_folder}"', cwd=self.source_folder)

    def package_info(self):
        self.cpp_info.libs = ["hbvib"]
        self.cpp_info.set_property("cmake_file_name", "hbvib")
        self.cpp_info.set_property("cmake_target_name", "hbvib::hbvib")
        self.cpp_info.set_property("pkg_config_name", "hbvib")
