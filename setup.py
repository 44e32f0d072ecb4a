"""The module's shared object is built by CMake; the rest of the wheel is setuptools' as pyproject.toml says.

BELTRAMI_BUILD names the build folder of CMake; where it does not, that of `./run build` is used if it is there, so that
nothing is compiled twice and nothing fetched. CMAKE_ARGS has further options for CMake.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = Path(__file__).resolve().parent


def version() -> str:
    """The one that CMakeLists.txt gives the project."""
    return re.search(r"project\(beltrami VERSION ([0-9.]+)", (HERE / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


class CMakeBuild(build_ext):
    def build_extension(self, extension: Extension) -> None:
        built_before = (HERE / "build" / "build.ninja").exists()
        folder = Path(os.environ.get("BELTRAMI_BUILD", HERE / "build" if built_before else HERE / "build" / "wheel")).resolve()
        options = shlex.split(os.environ.get("CMAKE_ARGS", "")) + ["-DBELTRAMI_PYTHON=ON", f"-DPYTHON_EXECUTABLE={sys.executable}"]
        if not (folder / "build.ninja").exists():
            options += ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DBELTRAMI_TESTS=OFF", "-DBELTRAMI_EXAMPLES=OFF"]
        subprocess.run(["cmake", "-S", str(HERE), "-B", str(folder), *options], check=True)
        subprocess.run(["cmake", "--build", str(folder), "--target", "beltrami_python"], check=True)
        wanted = Path(self.get_ext_fullpath(extension.name))
        wanted.parent.mkdir(parents=True, exist_ok=True)
        (built,) = (folder / "python" / "beltrami").glob("_core*.so")
        shutil.copyfile(built, wanted)


setup(version=version(), ext_modules=[Extension("beltrami._core", sources=[])], cmdclass={"build_ext": CMakeBuild})
