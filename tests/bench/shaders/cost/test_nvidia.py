"""Instructions from NVIDIA's CUDA compiler: listings, compiled code and missing tools."""

import re
from pathlib import Path

import pytest
from typed import chosen_families

from normalbench.bench.ground.options.gpu_families import CHOICES, FAMILIES
from normalbench.bench.shaders.isa import isa
from normalbench.bench.shaders.isa.compiler import DriverError
from normalbench.bench.shaders.isa.nvidia import cubin, listing, sass, source, tools
from normalbench.bench.shaders.isa.nvidia.child import statistics
from normalbench.bench.shaders.isa.nvidia.cubin import Kernel
from normalbench.bench.tables.cost import extras
from normalbench.gbuffer.defines import kernels
from normalbench.gbuffer.gl.shader import ShaderError

LISTINGS = Path(__file__).with_name("nvidia_listings")


# By hand, line by line, of listings that NVRTC 12.9.86 and nvdisasm 13.5.37 wrote.
COUNTED = {
    "sm_75-spheremap-encode": {"other_alu": 15, "transcendental": 2, "memory": 14, "control_flow": 3},
    "sm_86-xy-decode": {"other_alu": 11, "transcendental": 1, "memory": 14, "control_flow": 3},
    "sm_90-rgba8-depth-8-8-pack": {"other_alu": 13, "conversion": 3, "memory": 15, "control_flow": 3},
    "sm_120-spherical_lut-decode": {"other_alu": 12, "conversion": 2, "scalar": 1, "memory": 18, "control_flow": 3},
}


def line(code: str, place: int = 0, control: int = 0x000FE40000000F00) -> str:
    """Return an instruction as nvdisasm prints it."""
    return f"        /*{place:04x}*/   {code} ;   /* 0x0000000000000000 */\n    /* {control:#018x} */\n"


@pytest.mark.parametrize("name", COUNTED)
def test_kinds_in_a_recorded_listing_match_the_count_by_hand(name):
    counts = dict.fromkeys(sass.KINDS, 0) | COUNTED[name]
    assembly = (LISTINGS / f"{name}.asm").read_text()
    assert sass.kinds(assembly, sum(counts.values())) == counts


def test_every_recorded_listing_is_counted():
    assert {path.stem for path in LISTINGS.iterdir()} == set(COUNTED)


@pytest.mark.parametrize(
    "code, kind",
    [
        ("@!P0 FADD.FTZ R17, -R17, -RZ", "other_alu"),
        ("HFMA2 R13, -RZ, RZ, 1.75, 0", "other_alu"),
        ("S2R R2, SR_TID.X", "other_alu"),
        ("FRND.FTZ.FLOOR R4, R4", "conversion"),
        ("I2FP.F32.S32 R4, R5", "conversion"),
        ("MUFU.RSQ R4, R4", "transcendental"),
        ("R2UR UR4, R2", "scalar"),
        ("@UP0 UMOV UR5, URZ", "scalar"),
        ("LDCU.64 UR6, c[0x0][0x358]", "memory"),
        ("TLD.LZ RZ, R12, R12, UR4, 2D, 0x3", "memory"),
        ("BSSY.RECONVERGENT B0, 0x210", "control_flow"),
        ("BAR.SYNC.DEFER_BLOCKING 0x0", "waiting"),
    ],
)
def test_an_instruction_has_the_expected_kind(code, kind):
    assert sass.kinds(line(code), 1) == dict.fromkeys(sass.KINDS, 0) | {kind: 1}


def test_a_listing_that_is_not_understood_has_no_kinds():
    """Examples are an unknown instruction, doubles and a wrong number of instructions."""
    text = line("FADD R1, R2, R3")
    assert sass.kinds(text, 1) and not sass.kinds(text, 2)
    assert sass.kinds(text + line("FROB R1, R2"), 2) is None and sass.kinds(line("DADD R2, R2, R4"), 1) is None


def test_padding_after_the_end_is_not_an_instruction():
    text = line("NOP") + line("EXIT", 16) + line("BRA 0x20", 32) + line("NOP", 48) + line("NOP", 64)
    assert sass.names(text) == ["NOP", "EXIT", "BRA"]


def test_loops_and_branches_are_counted():
    """The jumps are conditional and unconditional, forward and backward, and the last jumps to itself."""
    code = ["@P0 BRA 0x20", "BRA 0x30", "@!P1 BRA 0x10", "BRA P2, 0x40", "BRA 0x40"]
    assert sass.jumps("".join(line(text, 16 * index) for index, text in enumerate(code))) == (2, 1)


def test_stalls_are_read_from_the_second_word():
    """The stall is 4 bits, from bit 105 of the 128 bits of an instruction: 2, 13 and 4 cycles for the words
    0x000fe4..., 0x010fda... and 0x004fc8..., whose upper halves shifted by 9 are 0x7f2, 0x87ed and 0x27e4."""
    words = (0x000FE400078E00FF, 0x010FDA0003F05270, 0x004FC800078E9607)
    assert [sass.stall_cycles(line("MOV R1, R2", 0, word)) for word in words] == [2, 13, 4]
    assert sass.stall_cycles(line("MOV R1, R2", 0, 0)) is None


def test_a_sum_waits_for_the_product_it_needs():
    """In the recorded decoder for sm_86, the stalls from FMUL R4 to FFMA, which reads R4, are 4 cycles: the latency
    that microbenchmarks find on Volta and later (Jia et al., 2018). A compare stalls 13 cycles before the jump under
    its predicate."""
    instructions = sass.instructions((LISTINGS / "sm_86-xy-decode.asm").read_text())
    names = [instruction.name for instruction in instructions]
    stalls = [instruction.control >> 41 & 15 for instruction in instructions]
    first, second = names.index("FMUL"), names.index("FFMA")
    assert sum(stalls[first:second]) == 4 and stalls[names.index("ISETP")] == 13
    assert sum(stalls) == sass.stall_cycles((LISTINGS / "sm_86-xy-decode.asm").read_text()) == 92


def test_listings_of_several_kernels_are_split_and_begin_at_0():
    """A jump refers to an address in its own kernel."""
    lines = "".join(
        line(code, 16 * index) for index, code in enumerate(["MOV R1, R2", "BRA 0x10", "@P0 BRA 0x40", "NOP", "EXIT"])
    )
    first, second = listing._parted(["\t.headerflags", *lines.splitlines()], [32, 48])
    assert sass.names(first) == ["MOV", "BRA"] and sass.jumps(first) == (0, 0)
    assert sass.names(second) == ["BRA", "NOP", "EXIT"] and sass.jumps(second) == (1, 0)
    assert sass.every(second)[0].operands == "0x20"
    with pytest.raises(DriverError, match="did not list all instructions"):
        listing._parted(lines.splitlines(), [32, 64])


@pytest.mark.parametrize(
    "data", [b"", b"\x7fELF\x01" + bytes(100), b"\x7fELF\x02" + bytes(10), b"\x7fELF\x02" + b"\xff" * 100]
)
def test_invalid_elf_file_is_an_error(data):
    with pytest.raises(DriverError, match=r"not a known ELF file|has 0 functions"):
        cubin.kernel_of(data)


def test_figures_do_not_include_padding():
    text = line("MOV R1, R2") + line("EXIT", 16) + line("NOP", 32)
    figures = statistics(Kernel(bytes(48), 16, 0), text)
    assert figures == {
        "Instructions": 2,
        "Registers": 16,
        "Code size": 32,
        "Stall cycles": 4,
        "Spill Count": 0,
        "Fill Count": 0,
    }
    assert "Spill Count" not in statistics(Kernel(bytes(48), None, 8), text)


def test_vendor_names_select_their_families():
    assert chosen_families("nvidia") == ["sm_75", "sm_86", "sm_89", "sm_90", "sm_100", "sm_120"]
    assert chosen_families("Turing,SM 86,Blackwell") == ["sm_75", "sm_86", "sm_120"]
    assert CHOICES["nvidia"] == tuple(name for name in FAMILIES if name.startswith("sm_"))


def test_all_selects_only_families_with_an_installed_compiler(monkeypatch):
    """Families named explicitly are selected in any case."""
    monkeypatch.setattr(tools, "missing", lambda: "nothing is installed")
    assert not set(chosen_families("all")) & set(CHOICES["nvidia"])
    assert set(chosen_families("all,sm_86")) >= {"navi31", "sm_86"}
    monkeypatch.setattr(tools, "missing", lambda: "")
    assert {*CHOICES["radeon"], *CHOICES["nvidia"]} <= set(chosen_families("all"))
    monkeypatch.setattr(isa, "missing", lambda _: "")
    assert chosen_families("all") == list(FAMILIES)


def test_page_uses_the_family_with_fragment_shaders():
    """Both families are drawn."""
    stages = {"sm_120": "compute", "navi31": "fragment"}
    rows = [{"family": name, "stage": stage, "instructions": 3} for name, stage in stages.items()]
    assert extras.usual_family({"cost": rows}) == "navi31"
    assert [row["family"] for row in extras._counted({"cost": rows})] == [*stages]


def taken(folder: Path) -> list[str]:
    """Return the tools that are found in a CUDA folder."""
    return [path.relative_to(folder).as_posix() for path in (tools.library(), tools.disassembler()) if path]


def test_an_installed_cuda_is_found_through_its_environment_variable(monkeypatch, tmp_path):
    monkeypatch.setattr(tools, "find_spec", lambda _: None)
    monkeypatch.setenv("CUDA_HOME", str(tmp_path))
    monkeypatch.setenv("PATH", "")
    assert taken(tmp_path) == [] and tools.missing() == tools.NO_COMPILER
    (tmp_path / "lib64").mkdir()
    for name in ("libnvrtc-builtins.so.12.9", "libnvrtc.alt.so.12", "libnvrtc.so.12.9.86", "libnvrtc.so.12"):
        (tmp_path / "lib64" / name).write_text("")
    assert taken(tmp_path) == ["lib64/libnvrtc.so.12"] and tools.missing() == tools.NO_DISASSEMBLER
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "nvdisasm").write_text("")
    (tmp_path / "bin" / "nvdisasm").chmod(0o755)
    assert taken(tmp_path) == ["lib64/libnvrtc.so.12", "bin/nvdisasm"] and not tools.missing()


def test_glsl_that_cannot_be_translated_is_reported_with_file_and_line(tmp_path):
    file = tmp_path / "mine.glsl"
    file.write_text(
        "// Mine.\nMADE kernel_operation(GIVEN given, BESIDE beside) {\n    return given.yx * frob(beside);\n}\n"
    )
    operation = kernels.Operation("kernel_empty.glsl", 2, 3, 2, own_names={})
    with pytest.raises(ShaderError, match=rf"{re.escape(str(file))}:3: unknown function frob.*CUDA"):
        source.functions_of(_Operation(operation, file))


class _Operation:
    """An operation from a file outside the program."""

    def __init__(self, operation, file):
        self.defines, self._file, self._operation = operation.defines, file, operation

    def source(self, shader):
        from normalbench.gbuffer.gl.shader import Source

        return Source(shader, self.defines, {"OPERATION": self._file})
