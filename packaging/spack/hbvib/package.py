"""Spack: in a repository of packages of your own; `url` or `git` is the place from which you have the sources."""
from spack.package import *


class Hbvib(Package):
    """Harmonic balance of vibrating structures with friction contacts."""

    license("MIT OR Apache-2.0", checked_by="hbvib")

    version("main", branch="main", git="file:///path/of/the/checkout")

    depends_on("rust@1.89:", type="build")
    depends_on("c", type="build")

    conflicts("platform=windows")
    conflicts("platform=darwin")

    def install(self, spec, prefix):
        sh = which("sh")
        sh("examples/install.sh", prefix)

    @run_after("install")
    @on_package_attributes(run_tests=True)
    def program(self):
        cc = Executable(spack_cc)
        cc("packaging/program.c", f"-I{self.prefix.include}", f"-L{self.prefix.lib}", f"-Wl,-rpath,{self.prefix.lib}", "-lhbvib",
           "-lm", "-o", "program")
        Executable("./program")()
