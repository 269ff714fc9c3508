"""Spack recipe: in a repository of your own, as packages/rhegma/package.py; see `spack create --help`."""

from spack.package import *


class Rhegma(MesonPackage):
    """Three-dimensional dynamic fracture and fragmentation of brittle solids."""

    license("BSD-3-Clause")
    version("main", branch="main")

    variant("tests", default=False, description="build the tests")
    variant("bench", default=False, description="build the microbenchmark rhegma-bench")
    variant("single", default=False, description="fields and kernels in single precision")

    depends_on("c", type="build")
    depends_on("meson@1.0:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("mpi")
    depends_on("hdf5+mpi")
    depends_on("metis@5:")
    depends_on("libfyaml")
    depends_on("muparser")
    depends_on("cmocka", when="+tests", type="build")
    depends_on("python@3.11:", type="run")
    depends_on("py-numpy", type="run")
    depends_on("py-matplotlib", type="run")
    depends_on("py-h5py", type="run")
    depends_on("py-plotly", type="run")
    depends_on("py-pyyaml", type="run")

    def meson_args(self):
        truth = {True: "true", False: "false"}
        return [
            f"-Dtests={truth['+tests' in self.spec]}",
            f"-Dbench={truth['+bench' in self.spec]}",
            "-Dgmsh=disabled",
            f"-Dprecision={'single' if '+single' in self.spec else 'double'}",
        ]
