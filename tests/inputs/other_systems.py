"""Python names that Windows and macOS lack, from the type checker's own list, and a Python without these names."""

import ast
import importlib.util
import json
import os
import subprocess
import sys
from functools import cache
from pathlib import Path

SYSTEMS = ("win32", "darwin")
# What else is so on a system: the OpenGL that Mesa's drivers then have.
ITS_OWN = {"darwin": {"MESA_GL_VERSION_OVERRIDE": "4.1", "MESA_GLSL_VERSION_OVERRIDE": "410"}}
# An encoder with its twin, and a gate.
ENCODER = """vec2 mine_encode(vec3 n, vec3 view) { return n.xy / (abs(n.x) + abs(n.y) + abs(n.z)); }
vec3 mine_decode(vec2 e, vec3 view) { return normalize(vec3(e, 1.0 - abs(e.x) - abs(e.y))); }
"""
TWIN = """from normalbench.encodings.vec import Vec2, Vec3, normalize
def encode(n, view):
    s = abs(n.x) + abs(n.y) + abs(n.z)
    return Vec2(n.x / s, n.y / s)
def decode(e, view):
    return normalize(Vec3(e.x, e.y, 1.0 - abs(e.x) - abs(e.y)))
"""
GATE = '[[gate]]\ntable = "quality"\nencoding = "octahedral"\nstorage = "rg8"\nangle_max_deg = "at most 1"\n'
START = "from normalbench.bench.door.cli.start import program; program()"
# The program as `start` begins it, but that it does all commands.
ONE_AFTER_THE_OTHER = """
import json, sys
from normalbench.bench.door.cli import app, start

def each():
    for words in json.loads(sys.argv.pop()):
        sys.argv = ["normalbench", *words]
        print(f"{words[0]} ended with {app.main()}", file=sys.stderr, flush=True)

app.program = each
start.program()
"""


@cache
def _stubs():
    """Return typeshed's folder of the standard library, as the type checker ships it."""
    return Path(importlib.util.find_spec("basedpyright").origin).parent / "dist" / "typeshed-fallback" / "stdlib"


@cache
def lacking(module, system):
    """Return the names of a module of the standard library that Linux has and another system lacks."""
    body = _body(module)
    return frozenset(_names(body, "linux")) - frozenset(_names(body, system))


@cache
def is_gone(module, system):
    """Whether a system lacks all that a module defines."""
    body = _body(module)
    own = [{*_names(body, host)} - {*_names(body, host, ast.Import, ast.ImportFrom)} for host in ("linux", system)]
    return bool(own[0]) and not own[1]


@cache
def _body(module):
    path = _stubs() / f"{module.replace('.', '/')}.pyi"
    path = path if path.exists() else path.with_suffix("") / "__init__.pyi"
    return ast.parse(path.read_text(encoding="utf-8")).body if path.exists() else []


def _names(body, system, *kinds):
    """Yield the names that statements define if `sys.platform` is a system, only of these kinds if any are given."""
    for node in body:
        match node:
            case ast.If(test=test):
                yield from _names(node.body if _holds(test, system) else node.orelse, system, *kinds)
            case _ if kinds and not isinstance(node, kinds):
                continue
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                yield name
            case ast.AnnAssign(target=ast.Name(id=name)):
                yield name
            case ast.Assign(targets=targets):
                yield from (target.id for target in targets if isinstance(target, ast.Name))
            case ast.ImportFrom(names=names) | ast.Import(names=names):
                yield from (alias.asname or alias.name for alias in names)


def _holds(test, system):
    """Whether a condition on `sys.platform` and `sys.version_info` holds; any other condition holds."""
    if isinstance(test, ast.BoolOp):
        return (all if isinstance(test.op, ast.And) else any)(_holds(value, system) for value in test.values)
    text = ast.unparse(test)
    if not text.startswith(("sys.platform", "sys.version_info")):
        return True
    return eval(text, {"sys": type("sys", (), {"platform": system, "version_info": sys.version_info})})


def on(system, folder, *commands, before=""):
    """Run the command line on an emulated system; every process that it starts lacks what the system lacks.

    Args:
        folder: an empty folder, for the module that Python loads at its start.
        commands: the words of one command, or several commands: one process runs these in turn and reports how each
            ended.
        before: code that the process runs before anything else.
    """
    names = [name for name in sys.stdlib_module_names if not name.startswith("_")]
    gone = [name for name in names if is_gone(name, system)]
    hidden = {name: sorted(absent) for name in names if name not in gone and (absent := lacking(name, system))}
    told = {"system": system, "gone": gone, "lacking": hidden}
    folder.mkdir(exist_ok=True)
    (folder / "lacking.json").write_text(json.dumps(told))
    (folder / "sitecustomize.py").write_text(Path(__file__).with_name("hiding.py").read_text())
    ours = {"PYTHONPATH": str(folder), "PYTHONWARNDEFAULTENCODING": "1", "PYTHONIOENCODING": "cp1252:strict"}
    words = commands[0] if len(commands) == 1 else [json.dumps(commands)]
    return subprocess.run(
        [sys.executable, "-c", before + (START if len(commands) == 1 else ONE_AFTER_THE_OTHER), *words],
        capture_output=True,
        encoding="cp1252",
        env=os.environ | ours | ITS_OWN.get(system, {}),
        cwd=folder,
        timeout=300,
    )


def write_examples(folder):
    """Write an encoder with its twin, and a gate, as files."""
    for name, text in {"mine.glsl": ENCODER, "mine.py": TWIN, "gates.toml": GATE}.items():
        (folder / name).write_text(text)
