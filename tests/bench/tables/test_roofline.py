"""Bytes against instructions: the model by hand, the reads at which an encoding becomes faster, and GPU rates."""

import re
from pathlib import Path

import pytest
from typed import gpus_named

from normalbench.bench.ground.options.gpu_families import FAMILIES
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.isa import spirv
from normalbench.bench.tables.roofline import measure
from normalbench.bench.tables.roofline.answers import answers
from normalbench.bench.tables.roofline.charts import points, ridge_lines
from normalbench.bench.tables.roofline.measure import Frame, Work, from_reads
from normalbench.bench.tables.roofline.rates import GPUS, Rates

FULL_HD = (1920, 1080)


ONE = Rates("of one lane", "navi21", 1, 1.0, 1.0)


DOCS = Path(__file__).parents[3] / "docs" / "roofline.md"


def frame(reads: int, size=FULL_HD, overdraw=1.0, share=0.25) -> Frame:
    return Frame(size, reads, overdraw, share)


def test_times_are_bytes_over_bandwidth_and_instructions_over_the_rate():
    """By hand: 2,073,600 pixels, 1.5 writes and 4 reads of 2 bytes at 512 GB/s; 1.5 x 16 + 4 x 18 instructions on
    4608 lanes at 2.25 GHz."""
    rates = Rates("", "navi21", 4608, 2.25, 512)
    memory, alu = Work(2, 16, 18).times(frame(4, overdraw=1.5), rates)
    assert memory == pytest.approx(2073600 * 2 * 5.5 / 512e9)
    assert alu == pytest.approx(2073600 * 96 / 10.368e12)
    assert rates.ridge(512) == pytest.approx(20.25)


def test_normals_that_fit_in_their_share_of_the_cache_get_its_bandwidth():
    rates, work = Rates("", "navi21", 1, 1.0, 100, 20, 400), Work(2, 0, 0)
    # 4.15 MB of a share of 5 MB, and of 4.
    (cached, _), (not_cached, _) = (work.times(frame(1, share=share), rates) for share in (0.25, 0.2))
    assert (work.is_cached(frame(1, share=0.25), rates), work.is_cached(frame(1, share=0.2), rates)) == (True, False)
    assert not_cached == pytest.approx(4 * cached)
    assert not work.is_cached(frame(1), ONE), "no cache is known"


@pytest.mark.parametrize(
    "one, other, said",
    # Rates of one byte and one instruction at a time. Of `1 + R` bytes and `e + R d` instructions the larger counts.
    [
        (Work(2, 0, 0), Work(6, 0, 0), "always"),
        (Work(6, 0, 0), Work(2, 0, 0), "never"),
        (Work(2, 0, 0), Work(2, 1, 1), "equal"),
        # 20 + R against 4 + 4 R: less from R = 6 on; equal at 16 / 3.
        (Work(1, 20, 1), Work(4, 0, 0), "from 6"),
        # 4 + 4 R against 20 + R.
        (Work(4, 0, 0), Work(1, 20, 1), "up to 5"),
    ],
)
def test_the_number_of_reads_decides_which_encoding_is_faster(one, other, said):
    assert from_reads(one, other, ONE, frame(1)) == said


def test_a_point_is_above_its_line_if_memory_takes_longer():
    """This holds for codes in memory and for codes in the cache."""
    rates = Rates("", "navi21", 1, 1.0, 1, 20, 4)
    rows = []
    for number, work in enumerate((Work(2, 1, 1), Work(2, 20, 20), Work(9, 10, 10), Work(9, 50, 50))):
        about = {"encoding": f"e{number}", "storage": "s", "gpu": "g", "size": "1920x1080", "reads": 1, "overdraw": 1.0}
        rows.append(about | measure._figures(work, frame(1), rates))
    assert [row["in_cache"] for row in rows] == [True, True, False, False]
    plotted = points(rows)
    lines = ridge_lines(plotted, "g")
    for row, point in zip(rows, plotted, strict=True):
        on_line = min(lines[row["in_cache"]], key=lambda place: abs(place[0] - point["x"]))
        slope = on_line[1] / on_line[0]
        assert (point["y"] > slope * point["x"]) == (row["bound"] == "memory"), row


def test_equal_codes_share_a_rank():
    rows = [
        {"gpu": "g", "size": "s", "reads": 1, "frame_us": us, "code": name}
        for name, us in (("slow", 3.0), ("one", 1.0), ("lost", None), ("other", 1.0 + 1e-12))
    ]
    assert [(row["code"], row.get("rank")) for row in measure.ranked(rows)] == [
        *(("one", 1), ("other", 1), ("slow", 3)),
        ("lost", None),
    ]


def test_every_gpu_has_a_family_and_is_in_the_manual():
    lines = re.findall(
        r"^\| `(\w+)` \((.+)\) \| `(\w+)` \| (\S+) \| (\S+) \| (\S+) \| (\S*) \| (\S*) \|$", DOCS.read_text(), re.M
    )
    documented = {
        name: Rates(title, family, *(float(figure or 0) for figure in figures))
        for name, title, family, *figures in lines
    }
    assert documented == dict(GPUS) and {gpu.family for gpu in GPUS.values()} <= set(FAMILIES)


def test_users_can_give_their_own_rates():
    gpus = gpus_named("rx6800xt:clock=2, navi31:lanes=100:clock=1:memory=50:cache=8:cached=200")
    (first, other) = gpus.values()
    assert (first.clock, first.memory, first.cache) == (2, 512, 128)
    assert other == Rates("Navi 3x", "navi31", 100, 1, 50, 8, 200)
    assert list(gpus_named("all")) == list(GPUS)


@pytest.mark.parametrize(
    "words, said",
    [
        ("rx9999", "unknown GPU 'rx9999'; known: all, rx480"),
        ("navi21:clock=2", "requires lanes, memory; write for example navi21:clock=2:lanes=2304:memory=448"),
        ("rx480:clock=1:clock=2", "a rate is given twice"),
        ("rx480:speed=3", "unknown setting 'speed=3'; known: lanes, clock, memory"),
        ("rx480:title=mine", "unknown setting"),
        ("rx480:clock", "unknown setting 'clock'"),
        ("rx480:clock=fast", "clock is 'fast'; use 0.01 to 100"),
        ("rx480:clock=nan", "clock is 'nan'"),
        ("rx480:memory=0", "memory is '0'"),
        ("rx480:cache=32", "cache (MB) and cached (GB/s) require each other"),
        (" , ", "no GPU named"),
    ],
)
def test_invalid_gpu_is_refused_with_the_reason(words, said):
    with pytest.raises(UsageError, match=re.escape(said)):
        gpus_named(words)


@pytest.mark.parametrize(
    "words, said",
    [
        (["--overdraw", "0"], "--overdraw 0.0: out of range; use 0.01 to 1000"),
        (["--overdraw", "nan"], "--overdraw nan"),
        (["--cache-share", "2"], "out of range; use 0 to 1"),
        (["--reads", "-1"], "--reads"),
        (["--reads", "two"], "--reads"),
        (["--size", "0x1"], "--size 0x1"),
        (["--plot", "chart.txt"], "chart.txt"),
        (["--encoding", "xyz", "--storage", "rg8"], "3 components, but RG8 has 2 channels"),
    ],
)
def test_options_out_of_range_are_refused(run, words, said):
    status, out, err = run("roofline", *words)
    assert (status, out) == (2, "") and said in err


def test_without_a_compiler_the_command_says_what_to_install(run, monkeypatch):
    monkeypatch.setattr(spirv, "COMPILER", "no-such-compiler")
    status, _, err = run("roofline", "--encoding", "octahedral", "--storage", "rg8", "--gpu", "rx480")
    assert status == 3 and "apt-get install glslang-tools" in err


def ranked_row(gpu: str, code: str, rank: int, reads: int = 1, size: str = "1920x1080") -> dict:
    encoding, storage = code.split()
    return {"gpu": gpu, "size": size, "reads": reads, "encoding": encoding, "storage": storage, "rank": rank}


def test_the_first_sentences_name_the_fastest_encodings_of_each_gpu():
    rows = [ranked_row("a", "spheremap rg8", 1), ranked_row("a", "octahedral rg8", 1), ranked_row("a", "xyz rgba8", 3)]
    assert answers(rows) == ("a: spheremap and octahedral in rg8 are equally fast.",)
    other = [ranked_row("b", "xyz rgba8", 1), ranked_row("b", "xyz rgba8", 2, 4), ranked_row("b", "xy rg8", 1, 4)]
    same = [row | {"gpu": "c"} for row in other]
    assert answers([*rows, *other, *same, ranked_row("a", "spheremap rg8", 1, 4)]) == (
        "The fastest encodings on each GPU:",
        "a: spheremap and octahedral in rg8 are equally fast with 1 read; "
        "spheremap in rg8 is the fastest with 4 reads.",
        "b and c: xyz in rgba8 is the fastest with 1 read; xy in rg8 is the fastest with 4 reads.",
    )
    assert answers([ranked_row("a", "xyz rgba8", 0) | {"rank": None}]) == ()


def test_zero_reads_are_refused(run):
    status, out, err = run("roofline", "--reads", "0")
    assert (status, out) == (2, "") and err.count("\n") == 1 and "--reads 0: expected whole numbers from 1" in err


def test_an_unknown_gpu_gets_a_suggestion(run):
    assert "did you mean rtx3080?" in run("roofline", "--gpu", "rtx3081")[2]
