"""Instructions from NVIDIA's CUDA compiler: listings, compiled code and missing tools."""

import json
import re
import subprocess

import numpy as np
import pytest
from vendors import INSTRUCTIONS, NVIDIA

from normalbench.bench.ground.options.gpu_families import FAMILIES
from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.keep.machine import require_nvidia
from normalbench.bench.shaders.isa import isa
from normalbench.bench.shaders.isa.nvidia import source, tools
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.vec import Vec2, Vec3
from normalbench.gbuffer.defines import kernels
from normalbench.gbuffer.defines.packings import PACKINGS

# The machine's own C++ in place of CUDA's: what glsl.cuh takes from CUDA, less what is written in machine code.
HOST = """
#include <cmath>
#include <cstring>
#define __forceinline__ inline
#define __constant__ static
static inline float rsqrtf(float x) { return 1.0f / sqrtf(x); }
static inline int __float_as_int(float x) { int y; memcpy(&y, &x, 4); return y; }
static inline unsigned __float_as_uint(float x) { unsigned y; memcpy(&y, &x, 4); return y; }
static inline float __int_as_float(int x) { float y; memcpy(&y, &x, 4); return y; }
static inline float __uint_as_float(unsigned x) { float y; memcpy(&y, &x, 4); return y; }
static inline int min(int a, int b) { return a < b ? a : b; }
static inline int max(int a, int b) { return a > b ? a : b; }
static inline unsigned umin(unsigned a, unsigned b) { return a < b ? a : b; }
static inline unsigned umax(unsigned a, unsigned b) { return a > b ? a : b; }
"""


CALL = """
extern "C" void call_{at}(const float *given, const float *beside, float *made, int count) {{
    for (int i = 0; i < count; ++i) {{
        glsl::vec{given} g;
        glsl::vec{beside} b;
        for (int k = 0; k < {given}; ++k) g[k] = given[i * {given} + k];
        for (int k = 0; k < {beside}; ++k) b[k] = beside[i * {beside} + k];
        auto m = glsl::own_{at}::kernel_operation(g, b);
        for (int k = 0; k < {made}; ++k) made[i * {made} + k] = m[k];
    }}
}}
"""


# Encodings that read no texture, which the machine's C++ has none of.
PLAIN = [encoding for encoding in ENCODINGS.values() if not encoding.tables()]


PACKED = ("rgba8", "12:12", "16:16", "11:10:11", "11:11", "rgba8_snorm")


@pytest.fixture(scope="module")
def called(shared):
    """A function (operation, given, beside) that runs each operation's CUDA, compiled as C++ on this machine."""
    import ctypes

    operations = [kernels.encode(e) for e in PLAIN] + [kernels.decode(e) for e in PLAIN]
    operations += [way for name in PACKED for p in PACKINGS[name] for way in (p.pack(), p.unpack())]
    language = source.LANGUAGE.read_text().replace('asm("abs.f32 %0, %1;" : "=f"(made) : "f"(x));', "made = fabsf(x);")
    text = HOST + re.sub(r"    asm\(.*?\);\n", "", language, flags=re.S)
    for index, operation in enumerate(operations):
        text += f"namespace own_{index} {{\n{source.functions_of(operation)}}}\n"
    text += "}\n"
    sizes = [
        {"at": number, "given": o.given, "beside": o.beside, "made": o.made} for number, o in enumerate(operations)
    ]
    text += "".join(CALL.format(**size) for size in sizes)
    command = ["c++", "-std=c++17", "-O1", "-w", "-ffp-contract=off", "-shared", "-fPIC", "-o", "all.so", "all.cpp"]
    with shared("cuda") as folder:
        if not (folder / "all.so").exists():
            (folder / "all.cpp").write_text(text)
            try:
                done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
            except FileNotFoundError:
                pytest.skip("no C++ compiler: c++ is not on the path")
            assert done.returncode == 0, done.stderr[:2000]
    library = ctypes.CDLL(str(folder / "all.so"))

    def call(at: int, given: np.ndarray, beside: np.ndarray) -> np.ndarray:
        output = np.zeros((len(given), sizes[at]["made"]), np.float32)
        kept = [np.ascontiguousarray(a, np.float32) for a in (given, beside)]
        pointers = [a.ctypes.data_as(ctypes.c_void_p) for a in kept]
        getattr(library, f"call_{at}")(*pointers, output.ctypes.data_as(ctypes.c_void_p), len(given))
        return output

    return call


@pytest.mark.parametrize("name", PACKED)
def test_cuda_code_of_a_packing_round_trips_numbers(called, name):
    """Numbers return to within a step of the smallest channel, 8 bits."""
    first = 2 * len(PLAIN) + 2 * sum(len(PACKINGS[other]) for other in PACKED[: PACKED.index(name)])
    random = np.random.default_rng(7)
    for index, packing in enumerate(PACKINGS[name]):
        size = packing.unpack().made
        given = random.uniform(-1, 1, (500, size)).astype(np.float32)
        texels = called(first + 2 * index, given, np.zeros((500, 3)))
        back = called(first + 2 * index + 1, texels, np.zeros((500, 3)))
        assert np.abs(back - given).max() < 1 / 127, packing.name


# What the figures below hold for.
VERSIONS = "NVRTC 12.9.86 (CUDA's compiler, not the graphics driver's), nvdisasm 13.5.37"


@pytest.mark.usefixtures("radv", "own_cache")
def test_a_machine_without_the_compiler_loses_only_nvidias_rows(run, monkeypatch):
    monkeypatch.setattr(tools, "library", lambda: None)
    status, out, err = run(*INSTRUCTIONS, "--family", "navi21,sm_86")
    (lost,) = [row for row in json.loads(out) if row["skipped"]]
    assert status == 3 and err.count("\n") == 1 and "pip install 'normalbench[nvidia]'" in err
    assert lost["family"] == "sm_86" and "normalbench[nvidia]" in lost["skipped"]
    assert sum(row["family"] == "navi21" for row in json.loads(out)) == 12
    with pytest.raises(MissingError, match=r"normalbench\[nvidia\]"):
        require_nvidia()


@pytest.mark.usefixtures("radv", "own_cache")
def test_a_fragment_shader_is_refused_with_a_reason(run, monkeypatch):
    """CUDA has no fragment shaders; rows of other vendors are still measured."""
    monkeypatch.setattr(tools, "missing", lambda: "")
    status, out, _ = run(*INSTRUCTIONS, "--family", "navi21,sm_86", "--stage", "fragment")
    (lost,) = [row for row in json.loads(out) if row["skipped"]]
    assert status == 0 and lost["family"] == "sm_86" and "use --stage compute" in lost["skipped"]
    assert sum(row["family"] == "navi21" for row in json.loads(out)) == 6


def normals(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return unit normals with z >= 0, among them the axes, and points in front of the camera."""
    random = np.random.default_rng(7)
    n = random.normal(size=(count, 3))
    n[:5] = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0]]
    n[:, 2] = np.abs(n[:, 2])
    view = random.uniform((-1, -1, -4), (1, 1, -2), (count, 3))
    return (n / np.linalg.norm(n, axis=1, keepdims=True)).astype(np.float32), view.astype(np.float32)


@pytest.mark.parametrize("at", range(len(PLAIN)), ids=[encoding.name for encoding in PLAIN])
def test_cuda_code_of_an_encoding_computes_its_formula(called, at):
    """Codes agree with the Python version to 2^-19 except on seams, and decoded normals to 2^-18."""
    encoding, (n, view) = PLAIN[at], normals(2000)
    codes = called(at, n, view)
    decoded = called(len(PLAIN) + at, codes, view)
    expected = np.stack(encoding.encode(Vec3(*n.T), Vec3(*view.T)), axis=-1)
    code = (Vec2 if codes.shape[1] == 2 else Vec3)(*codes.T)
    back = np.stack(encoding.decode(code, Vec3(*view.T)), axis=-1)
    if not encoding.is_precise:
        apart = np.abs(codes - expected).max(axis=1)
        # A code on a seam may be either of two.
        assert np.mean(apart > 2.0**-19) < 0.005, f"{apart.max()} of {n[apart.argmax()]}"
    apart = np.abs(decoded - back).max(axis=1)
    assert apart.max() < 2.0**-18, f"{apart.max()} of {codes[apart.argmax()]}"


@pytest.mark.usefixtures("nvidia", "own_cache")
def test_unknown_nvrtc_architecture_is_skipped_with_a_reason(run, monkeypatch):
    monkeypatch.setattr(isa, "FAMILIES", FAMILIES | {"sm_120": FAMILIES["sm_90"]})
    monkeypatch.setattr(isa, "_variables", lambda *_: {isa.ARCHITECTURE: "sm_999"})
    status, out, _ = run(*INSTRUCTIONS, "--family", "sm_120")
    row = json.loads(out)[0]
    assert status == 0 and row["family"] == "sm_120"
    assert re.match(r"NVRTC [\d.]+ does not compile for sm_999; known: sm_", row["skipped"])


# To encode octahedral: one fewer on Blackwell than before, as on a Radeon.
OCTAHEDRAL = {"sm_75": 15, "sm_86": 15, "sm_89": 15, "sm_90": 15, "sm_100": 14, "sm_120": 14}


def test_nvidias_compiler_gives_the_known_counts(vendor_rows, is_every=False):
    """Cheap encodings have the same order as on a Radeon."""
    rows = vendor_rows(NVIDIA, is_every)
    if {row["driver"] for row in rows} != {VERSIONS}:
        pytest.skip("counts hold for one version")
    counts = {(row["encoding"], row["operation"], row["family"]): row["instructions"] for row in rows}
    for name in NVIDIA.families(is_every):
        assert (counts["octahedral", "encode", name], counts["octahedral", "decode", name]) == (OCTAHEDRAL[name], 17), (
            name
        )
        order = [counts[encoding, "encode", name] for encoding in ("xy", "stereographic", "spheremap")]
        assert order == [0, 8, 10], name


def test_nvidia_instructions_are_16_bytes_and_no_kernel_spills(vendor_rows, is_every=False):
    for row in vendor_rows(NVIDIA, is_every):
        assert (row["code_bytes"], row["spills"]) == (16 * row["instructions"], 0), row
        if row["encoding"] == "octahedral":
            assert (row["transcendental"], row["branches"], row["memory"]) == (1, 0, 0), row


def test_the_compiler_is_distinguished_from_the_graphics_driver(nvidia, monkeypatch):  # noqa: ARG001 (asks for the compiler)
    """Rows and `doctor` give the compiler's name and version; a library not installed by pip reports its own."""
    assert re.match(
        r"NVRTC [\d.]+ \(CUDA's compiler, not the graphics driver's\), nvdisasm [\d.]+$", tools.title("1.2")
    )
    monkeypatch.setattr(tools, "_package_version", lambda _: "")
    assert tools.title("1.2").startswith("NVRTC 1.2 (CUDA's")
    assert isa.driver_versions()["NVIDIA NVRTC"].startswith("NVRTC ")
