"""The structure of the code: rooms and their imports, the package list, the catalogue, and twins."""

import ast
import json
import pkgutil
import re
import subprocess
import sys
import tomllib
from functools import cache
from pathlib import Path

import pytest
from manual import PAGES
from other_systems import SYSTEMS, lacking
from tiers import TIERS, tier_of

from normalbench.bench.subjects.names import listing
from normalbench.bench.subjects.normals import normal_sets
from normalbench.bench.tables.frames import sets as frame_sets
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import (
    CURVE_ENCODINGS,
    DEPTH_ENCODINGS,
    DEPTH_NAMES,
    ENCODINGS,
    FRAME_ENCODINGS,
    LIGHT_BUFFERS,
    LIGHT_ENCODINGS,
    MOTION_ENCODINGS,
    NAMES,
)
from normalbench.encodings.storages.depth_storage import DEPTH_STORAGES
from normalbench.encodings.storages.storage import (
    CURVE_STORAGES,
    FORMATS,
    FRAME_STORAGES,
    LIGHT_STORAGES,
    MOTION_STORAGES,
    STORAGES,
)
from normalbench.gbuffer.defines.packings import PACKINGS
from normalbench.gbuffer.effects.catalogue import EFFECTS
from normalbench.gbuffer.environment.catalogue import ENVIRONMENTS
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.scenes.catalogue import SCENES

ROOT = Path(__file__).parents[1]
ROOMS = {
    "encodings": {"encodings"},
    "gbuffer": {"gbuffer", "encodings"},
    "reports": {"reports"},
    "bench": {"bench", "gbuffer", "encodings", "reports"},
}
SOURCES = [path for room in ROOMS for path in sorted((ROOT / room).rglob("*.py"))]


@cache
def imported(path: Path) -> set[str]:
    """Return every module that a file imports; relative imports are resolved from the root."""
    modules = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = path.relative_to(ROOT).parts[: -node.level] if node.level else ()
            module = ".".join([*base, *([node.module] if node.module else [])])
            modules |= {module or alias.name for alias in node.names}
    return modules


def test_rooms_import_only_permitted_rooms():
    """Imports within the package are relative."""
    wrong = []
    for path in SOURCES:
        room, modules = path.relative_to(ROOT).parts[0], imported(path)
        others = {module.split(".")[0] for module in modules} & set(ROOMS)
        by_name = {module for module in modules if module.startswith("normalbench")}
        wrong += [f"{path.relative_to(ROOT)} imports {name}" for name in sorted(others - ROOMS[room] | by_name)]
    assert not wrong, wrong


def test_only_the_opengl_folder_imports_moderngl():
    using = {path.relative_to(ROOT).parent for path in SOURCES if "moderngl" in imported(path)}
    assert using == {Path("gbuffer/gl")}, f"moderngl is imported in {sorted(using)}"


# Who draws with matplotlib: draw.py and its parts draw values; maps of the sphere and error sheets are pictures.
DRAWN_BY = {"draw.py", "labels.py", "looks.py", "plots.py", "sphere_chart.py", "pictures.py"}


def test_only_chart_renderers_use_matplotlib_and_d3():
    """All other modules describe a chart as a value."""
    charts = ROOT / "reports" / "charts"
    drawing = {path for path in SOURCES if any(name.split(".")[0] == "matplotlib" for name in imported(path))}
    assert drawing <= {charts / name for name in DRAWN_BY}
    naming = {path for path in SOURCES if re.search(r"\bd3\b|mpld3", path.read_text())}
    assert naming == {charts / "wire.py"}


# What compilers are called, and the modules that may say so: one of them has names of packages.
COMPILERS = {"cc", "c++", "g++", "gcc", "clang", "clang++", "slangc", "glslangValidator", "spirv-cross", "spirv-opt"}
NAMING = {f"bench/ground/{name}.py" for name in ("compilers/tools", "compilers/slang", "machine/systems/people")}
# Who else starts processes, and which.
STARTING = {
    "bench/ground/machine/children.py": "whatever it is asked to",
    "bench/ground/machine/systems/forks.py": "this program",
    "bench/ground/machine/systems/linux_forks.py": "this program",
    "bench/ground/machine/systems/processes.py": "whatever it is asked to",
    "bench/ground/machine/systems/walls.py": "a compiler, which is asked where its parts lie",
    "bench/keep/commit.py": "git",
    "bench/run/piped.py": "this program",
    "bench/shaders/code/run/sources.py": "what was made of a file",
    "bench/shaders/code/run/wgsl.py": "this program",
    "bench/shaders/isa/nvidia/listing.py": "a disassembler",
    "bench/shaders/isa/nvidia/tools.py": "a disassembler, which is asked for its version",
    "bench/shaders/isa/process.py": "this program",
    "bench/shaders/languages/second.py": "this program",
    "bench/shaders/languages/translated.py": "this program",
    "bench/subjects/codecs/kinds/named.py": "this program",
    "bench/subjects/codecs/user_encodings.py": "this program",
    "bench/subjects/normals/pixel_files.py": "this program",
}
STARTS = re.compile(
    r"(?:children\.|forks\.|processes\.|subprocess\.)?(?:finished|started|Popen)"
    r"|subprocess\.(?:run|call|check_\w+)|os\.(?:system|exec\w*|spawn\w*)"
)
# What makes a text that compilers may be given, or hands one to a compiler as a library.
MAKES = re.compile(r"(?:\w+\.)*(?:create_shader_module|Text|spCompile)|(?:slang|library)\.Compiled")


def calls_and_strings(path: Path) -> tuple[set[str], set[str]]:
    """Return the functions that a file calls, as written, and its strings, except arguments of `how_to_install`."""
    nodes = [*ast.walk(ast.parse(path.read_text()))]
    called = [node for node in nodes if isinstance(node, ast.Call)]
    left_out = {id(word) for node in called if ast.unparse(node.func) == "how_to_install" for word in node.args}
    strings = (node.value for node in nodes if isinstance(node, ast.Constant) and id(node) not in left_out)
    return {ast.unparse(node.func) for node in called}, {value for value in strings if isinstance(value, str)}


def test_only_one_folder_passes_text_to_compilers():
    """Only that folder starts compilers and makes their input; other modules start only the listed programs."""
    naming, starting, making = set(), set(), set()
    named = "|".join(map(re.escape, COMPILERS))
    words = re.compile(
        rf'"(?:{named})"|\b(?:finished|started|Popen|subprocess\.\w+|exec\w*|spawn\w*|system|Text)\('
        r"|create_shader_module|spCompile|\.Compiled\("
    )
    for path in (path for path in SOURCES if words.search(path.read_text())):
        name, (calls, strings) = str(path.relative_to(ROOT)), calls_and_strings(path)
        naming |= {name} if strings & COMPILERS else set()
        if path.parent != ROOT / "bench" / "ground" / "compilers":
            starting |= {name} if any(map(STARTS.fullmatch, calls)) else set()
            making |= {f"{name}: {call}" for call in calls if MAKES.fullmatch(call)}
    assert naming == NAMING
    # The wall becomes the command that it is given.
    assert starting - {"bench/ground/machine/systems/landlock.py"} == set(STARTING)
    assert making == set()


# Who takes JSON apart besides `encodings/codecs/files.py`: of each, what it reads was written by this program.
OWN_JSON = {
    "bench/door/gates/baseline.py": "rows that pytest's workers send",
    "bench/ground/machine/systems/linux_forks.py": "what a fork is asked",
    "bench/ground/output/cache.py": "the user's own cache, with a digest",
    "bench/keep/journal.py": "lines with infinite figures, which the schema judges",
    "bench/keep/plain.py": "rows on their way",
    "bench/measures/metrics/totals.py": "totals on their way",
    "bench/shaders/isa/child.py": "what a child is asked",
    "bench/tables/pick/answer.py": "a column of JSON",
    "bench/measures/recorded.py": "figures that come with the program",
    "bench/shaders/isa/driver_files.py": "files of drivers that are installed",
    "bench/shaders/isa/nvidia/child.py": "what a child is asked",
    "bench/shaders/isa/process.py": "the answer of a child",
    "bench/shaders/languages/translated.py": "the answer of a child",
    "bench/subjects/codecs/kinds/named.py": "the answer of a child",
    "bench/subjects/codecs/user_encodings.py": "the answer of a child",
    "bench/subjects/normals/pixel_files.py": "the answer of a child",
    "bench/tables/cost/recorded.py": "counts that come with the program",
    "bench/tables/pick/choices.py": "a column of the program's rows",
}


def test_one_reader_parses_json_and_toml_files():
    """The reader checks for numbers that Python would read as infinite, as NaN or not at all."""
    words = re.compile(r"\b(?:json|tomllib)\.loads?\(")
    reading = {str(path.relative_to(ROOT)) for path in SOURCES if words.search(path.read_text())}
    assert reading - {"encodings/codecs/files.py"} == set(OWN_JSON)


def test_no_folder_of_the_renderer_has_more_than_thirteen_items():
    """A pass and its shaders count as one item."""
    for folder in (path for path in (ROOT / "gbuffer").rglob("*") if path.is_dir() and path.name != "__pycache__"):
        things = {path.stem for path in folder.iterdir()} - {"__init__", "__pycache__"}
        assert len(things) <= 13, f"{folder.relative_to(ROOT)} holds {len(things)}: {', '.join(sorted(things))}"


def test_encodings_import_only_jax_numpy_and_jaxtyping_and_no_other_encoding():
    for path in (ROOT / "encodings").rglob("*.py"):
        tops = {m.split(".")[0] for m in imported(path)}
        assert tops - sys.stdlib_module_names <= {"encodings", "jax", "jaxtyping", "numpy"}, path.name
        others = [m for m in imported(path) if re.match(r"encodings\.(normals|light|depth|frame|motion)\.", m)]
        assert not others, f"{path.name} imports {others}"


def test_shape_names_are_imported_only_for_type_checkers():
    """The program runs without jaxtyping: no file imports it outside a block for type checkers."""
    wrong = [path.name for path in SOURCES if re.search(r"^(?:import|from) jaxtyping", path.read_text(), re.M)]
    assert not wrong, wrong


def test_names_of_test_files_state_their_tier():
    """With any other name a file would run in the daily tests, or not at all."""
    stems = [path.stem for path in (ROOT / "tests").rglob("*.py") if re.search(r"def test_", path.read_text())]
    plain = [stem.removesuffix("_slow").removesuffix("_nightly") for stem in stems]
    odd = re.compile(r"^(?!test_)|_(slow\w*|night\w*|tests?)$", re.IGNORECASE)
    assert [
        stem for stem, name in zip(stems, plain, strict=True) if odd.search(name) or f"{name}_nightly_slow" == stem
    ] == []


def test_names_of_test_modules_are_unique():
    """pytest imports modules by name, and reports a duplicate only if it collects both."""
    names = [path.name for path in (ROOT / "tests").rglob("test_*.py")]
    assert sorted(name for name in set(names) if names.count(name) > 1) == []


def test_the_package_list_matches_the_folders():
    """setuptools maps the four folders into normalbench; the list is explicit and must not drift."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    listed = set(project["tool"]["setuptools"]["packages"])
    files = [p for room in ROOMS for p in (ROOT / room).rglob("*") if p.is_file() and "__pycache__" not in p.parts]
    folders = {".".join(["normalbench", *p.parent.relative_to(ROOT).parts]) for p in files}
    # What `import normalbench` gives lies in a folder of bench.
    assert project["tool"]["setuptools"]["package-dir"]["normalbench"] == "bench/door/api"
    folders = folders - {"normalbench.bench.door.api"} | {"normalbench"}
    assert listed == folders
    patterns = project["tool"]["setuptools"]["package-data"]["*"]
    assert {"*" + p.suffix for p in files if p.suffix != ".py"} == set(patterns)


def test_the_version_is_the_same_everywhere():
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert re.search(r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(), re.M)[1] == version
    assert re.search(r"^## (\d\S*)", (ROOT / "CHANGELOG.md").read_text(), re.M)[1] == version


def test_python_starts_with_the_checkout_on_its_path():
    """encodings/ has the name of a standard-library package; without an __init__.py this is harmless."""
    assert not (ROOT / "encodings" / "__init__.py").exists()
    environment = {"PYTHONPATH": str(ROOT), "PATH": ""}
    done = subprocess.run([sys.executable, "-c", "pass"], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


CATALOGUES = {
    "ENCODINGS": ENCODINGS,
    "DEPTH_ENCODINGS": DEPTH_ENCODINGS,
    "FRAME_ENCODINGS": FRAME_ENCODINGS,
    "LIGHT_BUFFERS": LIGHT_BUFFERS,
    "LIGHT_ENCODINGS": LIGHT_ENCODINGS,
    "LIGHT_STORAGES": LIGHT_STORAGES,
    "MOTION_ENCODINGS": MOTION_ENCODINGS,
    "CURVE_ENCODINGS": CURVE_ENCODINGS,
    "CURVE_STORAGES": CURVE_STORAGES,
    "MOTION_STORAGES": MOTION_STORAGES,
    "STORAGES": STORAGES,
    "DEPTH_STORAGES": DEPTH_STORAGES,
    "FRAME_STORAGES": FRAME_STORAGES,
    "FORMATS": FORMATS,
    "LAYOUTS": LAYOUTS,
    "PIPELINES": PIPELINES,
    "SCENES": SCENES,
    "ENVIRONMENTS": ENVIRONMENTS,
    "NORMAL_SETS": normal_sets.NORMAL_SETS,
    "FRAME_SETS": frame_sets.FRAME_SETS,
    "PACKINGS": PACKINGS,
}


@pytest.mark.parametrize("name", CATALOGUES)
def test_a_catalogue_is_read_only(name):
    """A user's addition is a value in a list of cases, never an entry in a catalogue."""
    catalogue = CATALOGUES[name]
    with pytest.raises(TypeError):
        catalogue["mine"] = next(iter(catalogue.values()))


@pytest.mark.parametrize("name", NAMES)
def test_an_encoding_of_normals_is_complete(name):
    encoding = ENCODINGS[name]
    assert encoding.components in (1, 2, 3) and encoding.sign_bits in (0, 1)
    assert encoding.domain in ("sphere", "hemisphere", "view")
    assert not encoding.levels or len(encoding.levels) == encoding.components


@pytest.mark.parametrize("path", [ROOT / f"encodings/{name}.glsl" for name in ("shared/position", "rotation")])
def test_shared_twins_have_the_same_formula(path):
    python = set(re.findall(r"^    # (.+)$", path.with_suffix(".py").read_text(), re.M))
    assert python == set(re.findall(r"^    // (.+)$", path.read_text(), re.M)) and python


def test_no_constant_is_repeated_in_both_languages():
    """GLSL gets its constants from Python, except for small multiples of a quarter."""
    for path in ROOT.glob("*/**/*.glsl"):
        code = re.sub(r"//[^\n]*", "", path.read_text())
        for number in re.findall(r"(?<![\w.])\d+\.\d+(?:e-?\d+)?", code):
            value = float(number) * 4
            assert value == int(value) and value <= 96, f"{path.name}: {number}"


def test_the_list_command_lists_the_whole_catalogue():
    assert set(listing.NORMAL_SETS) == set(normal_sets.NORMAL_SETS)
    listed = {row["name"] for row in listing.listing(("all",))}
    there = {
        *ENCODINGS,
        *STORAGES,
        *normal_sets.NORMAL_SETS,
        *LAYOUTS,
        *PIPELINES,
        *SCENES,
        *ENVIRONMENTS,
        *LIGHT_BUFFERS,
    }
    there |= {*FRAME_ENCODINGS, *FRAME_STORAGES, *frame_sets.FRAME_SETS, *EFFECTS}
    there |= {*MOTION_ENCODINGS, *MOTION_STORAGES, *CURVE_ENCODINGS, *listing.BY_BITS}
    assert listed == there | {*DEPTH_ENCODINGS, *DEPTH_STORAGES, *listing.FILES_OF_NORMALS, *listing.FILES_OF_DEPTHS}
    assert set(listing.FRAME_SETS) == set(frame_sets.FRAME_SETS)


def test_rows_have_the_columns_of_the_table():
    from normalbench.encodings.codecs.codec import Codec

    case = quality.QualityCase(Codec(ENCODINGS["xy"], STORAGES["rg8"]), normal_sets.axes(), "jax")
    assert tuple(quality.measure(case)) == tuple(TABLES["quality"].empty())


def test_runners_do_not_compare_names_of_variants():
    """A special requirement of a variant is a field of the variant."""
    depths = (*DEPTH_NAMES, *DEPTH_STORAGES, *FRAME_ENCODINGS, *FRAME_STORAGES)
    variants = (*NAMES, *depths, *MOTION_ENCODINGS, *MOTION_STORAGES, *STORAGES, *PIPELINES, *LAYOUTS, *CURVE_ENCODINGS)
    names = "|".join(map(re.escape, {*variants, *LIGHT_BUFFERS, *LIGHT_ENCODINGS, *SCENES}))
    asks = re.compile(rf"[=!]= ([\"'])({names})\1")
    for path in SOURCES:
        if path.parts[-2] not in ("normals", "light", "depth", "frame", "motion", "curve"):
            assert not (asked := asks.search(path.read_text())), f"{path.name} asks for {asked and asked[2]}"


BENCH = ROOT / "bench"


# The storeys of bench/, from the door down: each imports those below it alone.
STOREYS = ("door", "show", "run", "keep", "tables", "measures", "subjects", "shaders", "ground")


def _modules_of_bench(path: Path) -> set[str]:
    """Return the modules of bench/ that a file imports, or names in a string for another process."""
    strings = (node.value for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Constant))
    named = {text.removeprefix("normalbench.") for text in strings if isinstance(text, str) and _is_a_module(text)}
    return {module for module in {*imported(path), *named} if module.startswith("bench.")}


def _is_a_module(text: str) -> bool:
    return bool(re.fullmatch(r"normalbench(\.\w+)+", text))


def test_no_storey_of_bench_imports_a_storey_above_it():
    """Imports inside functions, imports for type checkers and module names in strings count too."""
    wrong = []
    for path in BENCH.rglob("*.py"):
        own = path.relative_to(BENCH).parts[0]
        above = STOREYS[: STOREYS.index(own)] if own in STOREYS else ()
        imports = sorted(module for module in _modules_of_bench(path) if module.split(".")[1] in above)
        wrong += [f"{path.relative_to(ROOT)} imports {module}" for module in imports]
    assert not wrong, wrong


SEAM = BENCH / "ground" / "machine" / "systems"
# Files and variables that other systems lack.
ONLY_LINUX = re.compile(r"[\"']/(?:proc|dev|sys)/(?!null\b)|\bLD_(?:PRELOAD|LIBRARY_PATH)\b")


def test_only_one_folder_uses_system_specific_names():
    """The type checker's own stubs state which names in Python's modules are missing on Windows and macOS."""
    wrong = [f"{path.relative_to(ROOT)}: {name}" for path in SOURCES for name in only_linux(path)]
    assert not [line for line in wrong if not line.startswith(f"{SEAM.relative_to(ROOT)}/")], wrong
    assert {line.split(": ")[1] for line in wrong} > {"fcntl.flock", "os.killpg", "os.fork", "signal.SIGALRM", "/proc"}


def only_linux(path):
    """Yield the names in a file that one of the systems lacks."""
    text = path.read_text()
    yield from {match[0].strip("\"'")[:5] for match in ONLY_LINUX.finditer(text)}
    for node in ast.walk(ast.parse(text)):
        named = []
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            named = [(node.value.id, node.attr)]
        elif isinstance(node, ast.ImportFrom) and not node.level:
            named = [(node.module, alias.name) for alias in node.names]
        for module, name in named:
            if module in sys.stdlib_module_names and any(name in lacking(module, system) for system in SYSTEMS):
                yield f"{module}.{name}"


def test_text_is_written_with_the_same_line_endings_everywhere():
    """Windows would write different line endings; a file and its copy in a page are compared byte for byte."""
    wrong = [
        f"{path.relative_to(ROOT)}:{node.lineno}"
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Call)
        and ast.unparse(node.func).endswith(".write_text")
        and not any(keyword.arg == "newline" for keyword in node.keywords)
    ]
    assert not wrong, wrong


def test_a_table_imports_no_work_or_pictures_from_another_table():
    """Code that two tables share is next to their folders, or measures for one of the tables."""
    wrong = []
    for path in (BENCH / "tables").glob("*/*.py"):
        others = [module.split(".") for module in imported(path) if module.startswith("bench.tables.")]
        own = path.parent.name
        wrong += [
            f"{path.relative_to(ROOT)} imports {'.'.join(module)}" for module in others if _is_anothers(module, own)
        ]
    assert not wrong, wrong


def test_classes_of_sheets_are_defined_once():
    """Tables make the values that the page shows, so no field is copied."""
    names = ("Column", "Role", "Section", "Sheet")
    sheets = [
        (node.name, path.relative_to(ROOT).as_posix())
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ClassDef) and node.name in names
    ]
    assert sorted(sheets) == [(name, "reports/sheets.py") for name in names], sheets


# Who asks a table of one name: a code's figures, what `doctor` measures, devices added to a run, and their site.
ASKING = {
    "bench/door/code_figures.py",
    "bench/door/examine.py",
    "bench/door/folder.py",
    "bench/show/import_command.py",
    "bench/show/site_command.py",
}


def test_only_listed_files_outside_the_tables_import_a_table():
    """The list may only become shorter."""
    folders = {path.parent.name for path in (BENCH / "tables").glob("*/table.py")}
    others = (path for path in BENCH.rglob("*.py") if BENCH / "tables" not in path.parents)
    asking = {
        path.relative_to(ROOT).as_posix()
        for path in others
        for module in _modules_of_bench(path)
        if module.startswith("bench.tables.") and module.split(".")[2] in folders
    }
    assert asking == ASKING


def _text_of(node: ast.expr, constants: dict[str, ast.expr]) -> object:
    """Return the value of an expression that is a constant, or a name assigned to a constant."""
    node = constants.get(node.id, node) if isinstance(node, ast.Name) else node
    return node.value if isinstance(node, ast.Constant) else None


def _tables_asked(path: Path) -> set[object]:
    """Return the constants with which a file looks up tables, in `tables[...]` and `tables.get(...)`."""
    tree = ast.parse(path.read_text())
    constants = {
        node.targets[0].id: node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
    }
    asked = [(node.value, node.slice) for node in ast.walk(tree) if isinstance(node, ast.Subscript)]
    asked += [
        (node.func.value, node.args[0])
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "get" and node.args
    ]
    return {_text_of(name, constants) for where, name in asked if ast.unparse(where).lower().endswith("tables")}


def test_tables_of_a_run_are_not_looked_up_by_a_literal_name():
    others = (path for path in SOURCES if BENCH / "tables" not in path.parents)
    wrong = [(path.name, name) for path in others for name in _tables_asked(path) if name in TABLES]
    assert not wrong, wrong


def _is_anothers(module: list[str], own: str) -> bool:
    return len(module) > 3 and module[2] != own and module[3] in ("work", "pictures")


def _is_text_of_names(argument: ast.arg) -> bool:
    """Whether an argument holds names as text, of codecs or storages for example."""
    kinds = "codec", "encoding", "storage", "normal_set", "scene", "layout"
    return argument.arg.removesuffix("s") in kinds and "str" in ast.unparse(argument.annotation or ast.Name(""))


def test_text_is_split_into_names_when_a_command_is_parsed():
    """Only options and commands call the splitter. In rooms below the subjects, no argument is text with names."""
    wrong, splitters = [], {("options.words", "names"), ("user_files", "file_names")}
    below = [ROOT / "encodings", ROOT / "gbuffer", BENCH / "shaders"]
    for path in SOURCES:
        tree, place = ast.parse(path.read_text()), path.relative_to(ROOT)
        asked = {
            (node.module.removeprefix("bench.").removeprefix("ground."), alias.name)
            for node in ast.walk(tree)
            if isinstance(node, ast.ImportFrom) and node.module
            for alias in node.names
        }
        is_door = path.is_relative_to(BENCH / "door") or path.name in ("option.py", "user_files.py")
        wrong += [f"{place} splits names" for module, name in asked & splitters if not is_door]
        if not any(path.is_relative_to(room) for room in below):
            continue
        wrong += [f"{place} reads names" for module, _ in asked if module in ("choose", "options.words")]
        functions = (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))
        arguments = (argument for node in functions for argument in (*node.args.args, *node.args.kwonlyargs))
        wrong += [
            f"{place}, line {argument.lineno}: {argument.arg} is a text"
            for argument in arguments
            if _is_text_of_names(argument)
        ]
    assert not wrong, wrong


# Turns that a reader stumbles over, in any text.
BANNED = re.compile(
    r"\bso (?:many|few)\b|\bof which (?:every|some|each|the)\b|^And \w|(?<!--pictures )(?<!`)\bbeside\b(?!:)"
    r"|\b(?:is|are) (?:said|seen)\b(?! by)|\bbears?\b|\bstays? free\b|\bfrom which (?:\w+ ){0,3}on\b"
    r"|\bli(?:e|es|ying) (?:in|on|at|below|above|between|within|near|next|under)\b"
    r"|^No \w+ (?:is|are|has|have|can|may)\b|(?<![Tt]here )\b(?:is|are) none\b"
    r"|(?<![Tt]here )\b(?:is|are) no (?!longer|more|less|better|worse|larger|smaller|faster|slower|wider)\w"
    r"|^What (?!is|are|do|does|did|can|must|would)\w+ [^?:]*$|\bdear(?:er|est)?\b|\bpric(?:e|es|ed)\b"
    r"|\boccup(?:y|ies)\b",
    re.M,
)
# How many of each kind of text still have such a turn. These figures only go down.
MOST_BANNED = {"strings": 0, "pages of the manual": 0, "docstrings": 6, "names of tests": 0, "docstrings of tests": 9}
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def _docstrings(tree: ast.Module) -> list[str]:
    """Return the docstrings of a file with their indentation."""
    documented = (node for node in ast.walk(tree) if isinstance(node, DOCUMENTED))
    return [text for node in documented if (text := ast.get_docstring(node, clean=False))]


def _texts() -> dict[str, list[tuple[str, str]]]:
    """Return each text that people read, with its file, by kind of text."""
    texts = {kind: [] for kind in MOST_BANNED}
    for path in SOURCES:
        tree = ast.parse(path.read_text())
        docstrings = _docstrings(tree)
        constants = (node.value for node in ast.walk(tree) if isinstance(node, ast.Constant))
        strings = [text for text in constants if isinstance(text, str) and " " in text and text not in docstrings]
        texts["strings"] += [(path.name, text) for text in strings]
        texts["docstrings"] += [(path.name, text) for text in docstrings]
    for path in sorted((ROOT / "reports" / "page").rglob("*.js")):
        quoted = re.findall(r"\"([^\"\n]*[a-z] [a-z][^\"\n]*)\"|`([^`\n]*[a-z] [a-z][^`\n]*)`", path.read_text())
        texts["strings"] += [(path.name, re.sub(r"\$\{[^}]*\}", "", "".join(pair))) for pair in quoted]
    for path, page in PAGES.items():
        paragraphs = re.split(r"\n\s*\n", re.sub(r"^```.*?^```|^    .*?$", "", page, flags=re.S | re.M))
        texts["pages of the manual"] += [(path.name, " ".join(paragraph.split())) for paragraph in paragraphs]
    for path in sorted((ROOT / "tests").rglob("*.py")):
        tree = ast.parse(path.read_text())
        names = [node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
        tests = [name.removeprefix("test_").replace("_", " ") for name in names if name.startswith("test_")]
        texts["names of tests"] += [(path.name, name) for name in tests]
        texts["docstrings of tests"] += [(path.name, text) for text in _docstrings(tree)]
    return texts


def test_texts_have_no_more_banned_phrases_than_allowed():
    for kind, texts in _texts().items():
        wrong = sorted(f"{name}: ...{text[max(match.start() - 40, 0) : match.end() + 40]!r}"
                       for name, text in texts if (match := BANNED.search(text)))  # fmt: skip
        assert len(wrong) <= MOST_BANNED[kind], f"{len(wrong)} {kind} of {MOST_BANNED[kind]}: {wrong}"


# Fields and parameters that are still called so; no more are added.
EMPTY_NAMES, MOST_EMPTY = {"one", "found", "made", "said", "at"}, 36


def test_variables_are_named_for_what_they_hold():
    stored = [
        f"{path.relative_to(ROOT)}, line {node.lineno}: {node.id}"
        for path in [*SOURCES, *sorted((ROOT / "tests").rglob("*.py"))]
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and node.id in EMPTY_NAMES
    ]
    assert len(stored) <= MOST_EMPTY, stored


def test_names_that_the_setup_imports_exist():
    """A script that imports a name of an older version would reinstall everything, and report the name as missing."""
    asked = [
        (script.name, module, name)
        for script in sorted((ROOT / ".ci").glob("prepare-*"))
        for module, name in re.findall(r"from (normalbench[\w.]*) import (\w+)", script.read_text())
    ]
    assert asked
    for script, module, name in asked:
        # It imports what is a module of its own.
        assert pkgutil.resolve_name(f"{module}.{name}"), f".ci/{script}: {module} has no {name}"


# Seconds of processor of each tier, as the last nightly took them: a change that goes over takes something out.
BUDGETS = {"quick": 430, "slow": 1480, "nightly": 3600}
# Of a quick file that no nightly has run yet.
UNMEASURED = 5.0


@pytest.mark.parametrize("tier", TIERS)
def test_a_tier_takes_no_more_than_its_budget(tier):
    measured = json.loads((ROOT / "tests" / "seconds.json").read_text())["files"]
    unmeasured = UNMEASURED if tier == TIERS[0] else 0.0
    names = [str(path.relative_to(ROOT)) for path in (ROOT / "tests").rglob("test_*.py") if tier_of(path) == tier]
    seconds = {name: measured[name][0] if name in measured else unmeasured for name in names}
    longest = sorted(seconds.items(), key=lambda file: -file[1])[:10]
    largest = ", ".join(f"{name} {spent:g}" for name, spent in longest)
    new = ", ".join(sorted(set(names) - set(measured))) or "none"
    assert sum(seconds.values()) <= BUDGETS[tier], (
        f"{sum(seconds.values()):.0f} s of {BUDGETS[tier]}; the longest: {largest}; "
        f"not measured yet, {unmeasured:g} s each: {new}"
        "; `pytest FILE --seconds tests/seconds.json` measures one"
    )
