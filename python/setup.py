# SPDX-License-Identifier: BSL-1.0
"""The wheel: the compiled module for any x86-64 and for those with AVX2, and the libraries that it needs, in one file.

The libraries are those of this machine, under names of their own, beside the module, which searches for them only there.
"""
import hashlib
import os
import platform
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
FOLDER = os.environ.get("NYSALT_WHEEL_FOLDER", os.path.join(ROOT, "build", "wheel"))
# What every Linux with Python has: the runtime of C and C++.
EVERYWHERE = re.compile(r"^(ld-linux.*|lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s))\.so\b")
# Folders of the package by the processor; nysalt/__init__.py chooses.
PROCESSORS = {"": [], "avx2": ["-mavx2"]}


def version():
    with open(os.path.join(ROOT, "include", "nysalt", "version.hpp")) as header:
        return re.search(r'version = "([^"]*)"', header.read()).group(1)


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def needed_by(library):
    return re.findall(r"\(NEEDED\).*\[(.*)\]", output_of("readelf", "-d", library))


def found_libraries(module):
    """Where the loader finds what a module needs, directly or not, by name."""
    return dict(re.findall(r"^\s*(\S+) => (/\S+)", output_of("ldd", module), re.MULTILINE))


class with_cmake(build_ext):
    def build_extension(self, extension):
        package = os.path.dirname(os.path.abspath(self.get_ext_fullpath(extension.name)))
        libraries = os.path.join(package, "libraries")
        for folder, flags in PROCESSORS.items():
            module = self.compiled(folder or "baseline", flags)
            to = os.path.join(package, folder)
            os.makedirs(to, exist_ok=True)
            copy = shutil.copy(module, to)
            subprocess.run(["strip", "--strip-unneeded", copy], check=True)
            self.take_along(copy, libraries, os.path.relpath(libraries, to))
            if folder:
                open(os.path.join(to, "__init__.py"), "w").close()

    def compiled(self, name, flags):
        build = os.path.join(FOLDER, name)
        subprocess.run(
            ["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "--log-level=WARNING", "-D", "CMAKE_BUILD_TYPE=Release",
             "-D", "CMAKE_CXX_FLAGS=" + " ".join(flags), "-D", "CMAKE_CXX_VISIBILITY_PRESET=hidden",
             "-D", "CMAKE_VISIBILITY_INLINES_HIDDEN=ON", "-D", "NYSALT_BUILD_TESTS=OFF", "-D", "NYSALT_BUILD_EXAMPLES=OFF",
             "-D", "NYSALT_WITH_MPI=OFF", "-D", "NYSALT_WITH_HDF5=OFF"], check=True, stdout=subprocess.DEVNULL)
        subprocess.run(["cmake", "--build", build, "--target", "nysalt_python", "--parallel", str(os.cpu_count()), "--",
                        "--quiet"], check=True)
        folder = os.path.join(build, "python", "nysalt")
        (module,) = [one for one in os.listdir(folder) if one.startswith("_nysalt.") and one.endswith(".so")]
        return os.path.join(folder, module)

    def take_along(self, module, libraries, way):
        """Copies all libraries that are not everywhere, and has the module and the copies need these copies."""
        os.makedirs(libraries, exist_ok=True)
        found = found_libraries(module)
        names = {}
        for name, path in found.items():
            if EVERYWHERE.match(name):
                continue
            with open(path, "rb") as content:
                mark = hashlib.sha256(content.read()).hexdigest()[:8]
            names[name] = re.sub(r"\.so\b", f"-{mark}.so", name, count=1)
            copy = os.path.join(libraries, names[name])
            if not os.path.exists(copy):
                shutil.copyfile(path, copy)
                os.chmod(copy, 0o755)
        def redirect(file, way):
            for name in needed_by(file):
                if name in names:
                    subprocess.run(["patchelf", "--replace-needed", name, names[name], file], check=True)
            subprocess.run(["patchelf", "--force-rpath", "--set-rpath", way, file], check=True)
            stray = [name for name in needed_by(file) if not EVERYWHERE.match(name) and name not in names.values()]
            if stray:
                sys.exit(f"wheel: {file} needs {', '.join(stray)}, which no machine has to have")
        redirect(module, f"$ORIGIN/{way}")
        for name, copy in names.items():
            file = os.path.join(libraries, copy)
            if name not in needed_by(file) and output_of("patchelf", "--print-soname", file).strip() != copy:
                subprocess.run(["patchelf", "--set-soname", copy, file], check=True)
                redirect(file, "$ORIGIN")


setup(
    version=version(),
    packages=["nysalt"],
    package_data={"nysalt": ["py.typed", "__init__.pyi"]},
    ext_modules=[Extension("nysalt._nysalt", sources=[])],
    cmdclass={"build_ext": with_cmake},
    options={"bdist_wheel": {"plat_name": "manylinux_{}_{}".format(
        platform.libc_ver()[1].replace(".", "_"), platform.machine())}},
    zip_safe=False,
)
