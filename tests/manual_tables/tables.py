"""The measured tables of the manual as values: each table's measurement and columns, and how close a figure must be
when it is measured again. Imports nothing heavy."""

from collections.abc import Mapping

import pytest

from . import measuring, writing
from .cost_tables import COST_TABLES, counted
from .table import Column, Line, Table, key

END = "\n<!-- end -->\n"
RG8 = "optimised_rings,octahedral_precise,octahedral,latitude_longitude,spherical,spheremap"
RGB10A2 = "warped_cube,cube,xyz_largest,xyz_renormalised,xyz,signed_octahedral,octahedral_precise,octahedral"
ARTICLES = "xyz,xy,spherical,spheremap,stereographic,per_pixel_view,octahedral"
RENDERED = "best_fit,xyz_renormalised,per_pixel_view,xy,octahedral,spheremap,stereographic,spherical"
LIGHT_BUFFERS = "rgba16f,r11g11b10f,linear,srgb,log,rgbm,rgb9e5"
LIT = "linear,srgb,linear:8,srgb:8,log,rgbm"
EFFECTS = "ssao,hbao,sao,gtao,lpv,subsurface,water"
MIXED = (
    "xyz,xyz_renormalised,hemi_octahedral,signed_octahedral,stereographic,xy,xy_sign,spheremap,spherical,"
    "latitude_longitude,octahedral,spherical_fibonacci"
)
HALVES = {
    "rg8": "octahedral,latitude_longitude,spherical,spheremap_classic,spheremap,equal_area_octahedral",
    "rgb10a2": "warped_cube,cube,xyz_renormalised,signed_octahedral,octahedral",
}
ON_SPHERE, AT_A_QUARTER = {"normals": "sphere"}, {"turn_deg": 0.25}
BY_JAX = {**ON_SPHERE, "backend": "jax"}
TWO, THREE, FOUR = "{:.2f}".format, "{:.3f}".format, "{:.4f}".format
FOUR_THAT_COUNT = "{:#.4g}".format


def of_storages(names: Mapping[str, str]) -> str:
    """Return lines that begin with a storage and an encoding."""
    return ",".join(f"{storage} {name}" for storage, encodings in names.items() for name in encodings.split(","))


def best_first(lines: list[Line]) -> None:
    """Check that lines are in the order of the mean error as shown, those of rg8 first."""
    shown = [(storage != "rg8", round(mean, 3)) for storage, _, _, mean, *_ in lines]
    assert shown == sorted(shown)


def glsl_agrees(lines: list[Line]) -> None:
    """Check that GLSL gives the same figures to an eighth, because its division may differ."""
    for line in lines:
        shown = [float(writing.two_digits(figure)) for figure in line[3:7]]
        assert shown == [pytest.approx(figure, rel=0.125) for figure in line[7:]], line


def fifteen_times(lines: list[Line]) -> None:
    """Check that the error of octahedral 8:8 is less than a fifteenth of the method's own."""
    assert all(line[5] is None or line[5] > 15 * line[1] for line in lines)


def noise_helps(lines: list[Line]) -> None:
    """Check that noise lowers the error by at least a quarter, and by nearly two bits if frames are averaged; without
    noise, more frames change nothing."""
    eight, ten = lines[3], lines[4]
    assert (eight[:3], ten[:3]) == (["rg8", "moving", 8], ["rgb10a2", "none", 1])
    assert eight[3:] == pytest.approx(ten[3:], abs=0.04)
    for storage in ("rg8", "rgb10a2"):
        errors = {(dither, frames): figures for name, dither, frames, *figures in lines if name == storage}
        assert errors["none", 8] == pytest.approx(errors["none", 1], abs=0.011)
        for none, single, mean in zip(errors["none", 1], errors["moving", 1], errors["moving", 8], strict=True):
            assert mean <= single <= 0.75 * none


def a_sixth_moves(lines: list[Line]) -> None:
    """Check that a sixth of the hits move with octahedral 8:8, a fiftieth with 10:10, and few with 16-bit depth."""
    moved = {(normals, depths): share for normals, depths, share, *_ in lines}
    assert 14 < moved["rg8", "exact"] < 20 and 1.5 < moved["rgb10a2", "exact"] < 2.5
    assert moved["exact", "linear/packed16"] < 0.2


def cones_need_more_bits(lines: list[Line]) -> None:
    """Check that SVGF's image is that of exact normals (54 dB) from 10:10 bits on, and NRD's from 12:12 on."""
    images = {(encoding, storage): (svgf, nrd) for encoding, storage, _, svgf, _, nrd in lines}
    (power_8, cone_8), (power_10, cone_10) = images["octahedral", "rg8"], images["octahedral", "rgb10a2"]
    _, cone_12 = images["octahedral", "rgba8 12:12"]
    assert power_8 < 54 <= power_10 and cone_8 < 54 <= cone_12 and cone_8 + 8 < cone_10 < cone_12 - 5


def tangent_space_means(lines: list[Line]) -> None:
    """Check the means on bumps in BC5 that docs/maps.md gives."""
    (line,) = [line for line in lines if line[0] == "bc5"]
    assert [line[2], *line[-2:]] == pytest.approx([0.463, 0.504, 0.574], abs=6e-4)


class Texels(Column):
    """A column of differing texels. Ties depend slightly on the device and the processor, and not all languages are
    run again."""

    def is_near(self, shown: float, measured: float) -> bool:
        return measured <= 2 + 1.2 * shown


ALL = (
    Table(
        marker="headline",
        rows=(
            *(
                f"quality --encoding {names} --storage {storage} --normals sphere --backend jax --count 1048576 "
                "--worst-case"
                for names, storage in ((RG8, "rg8"), (RGB10A2, "rgb10a2"))
            ),
            f"cost --isa --family navi21 --stage fragment --encoding {RG8},{RGB10A2}",
            *(
                f"pick --encoding {names} --against {names} --storage {storage} --scene studio"
                for names, storage in ((RG8, "rg8"), (RGB10A2, "rgb10a2"))
            ),
        ),
        columns=(
            key("storage", "storage"),
            key("encoding", "encoding"),
            Column("bits", "bits", BY_JAX),
            Column("mean error", "angle_mean_deg", BY_JAX, "{:.3f}°".format, abs=6e-4),
            Column("worst error", "angle_sup_deg", BY_JAX, "{:.2f}°".format, abs=6e-3),
            counted("encode", "encode", "navi21", "executed_slots"),
            counted("decode", "decode", "navi21", "executed_slots"),
            Column("image", "image_db_studio", form="{:.1f} dB".format, abs=0.1),
        ),
        needs=("gl", "radv"),
        gather=measuring.for_every_storage,
        lines=of_storages({"rg8": RG8, "rgb10a2": RGB10A2}),
        holds=best_first,
    ),
    Table(
        marker="answer: normalbench pick",
        rows=measuring.answers,
        columns=(key("", "storage"), key("", "said")),
        needs=("gl", "radv"),
        text=writing.answer,
        end=END,
    ),
    Table(
        marker="normalbench run",
        rows=(f"quality --encoding {ARTICLES} --storage rgba8 --normals playground --backend jax,glsl",),
        columns=(
            key("encoding", "encoding"),
            Column("bits", "bits"),
            Column("the article", "article_db", form=TWO, abs=0.0051),
            Column("JAX", "psnr_article_db", {"backend": "jax"}, TWO, abs=0.02),
            Column("GLSL", "psnr_article_db", {"backend": "glsl"}, TWO, abs=0.02),
        ),
        needs=("gl",),
        gather=measuring.of_the_article,
        lines=ARTICLES,
    ),
    Table(
        marker="normalbench quality",
        rows=tuple(
            f"quality --encoding {names} --storage rg8 --normals {domain} --backend jax --worst-case --codes"
            for names, domain in (
                ("octahedral,spherical,spheremap_classic", "sphere"),
                ("spheremap,stereographic,xy", "hemisphere"),
            )
        ),
        columns=(
            key("encoding", "encoding", lambda name: name if name == "limit" else f"`{name}`"),
            key("domain", "domain", str),
            Column("mean", "angle_mean_deg", form=FOUR_THAT_COUNT, rel=5e-4),
            Column("RMS", "angle_rms_deg", form=FOUR_THAT_COUNT, rel=5e-4),
            Column("supremum", "angle_sup_deg", form=FOUR_THAT_COUNT, rel=5e-4),
            Column("effective bits", "effective_bits", form=TWO, rel=5e-4),
            Column("RMS to limit", "reached_rms_percent", form="{:.1f} %".format, abs=0.06),
            Column("codes unused", "codes_unused"),
        ),
        gather=measuring.with_limits,
        lines="octahedral sphere,spherical sphere,spheremap_classic sphere,limit sphere,"
        "spheremap hemisphere,stereographic hemisphere,xy hemisphere,limit hemisphere",
    ),
    Table(
        marker="published figures",
        rows=measuring.published,
        columns=(
            key("source", "source"),
            key("figure", "figure"),
            Column("published", "published"),
            Column("ours", "ours", rel=2e-3),
            *(Column(name, name) for name in ("unit", "verdict", "why", "command")),
        ),
        needs=("gl", "radv"),
        text=writing.published,
        end=END,
    ),
    Table(
        marker="workers simulated",
        rows=measuring.simulated,
        columns=(
            key("work", "work"),
            key("workers", "workers"),
            *(
                Column(name, name)
                for name in ("minutes", "times faster", "workers busy %", "command busy %", "exponent")
            ),
        ),
        text=writing.simulation,
        end=END,
    ),
    Table(
        marker="normalbench tune",
        rows=(
            "tune stereographic --storage rg8 --normals playground",
            "tune stereographic --storage rg8 --normals hemisphere",
            "tune spherical --storage rg8 --normals playground",
            "tune best_fit --storage rgba8 --normals playground",
            "tune best_fit --storage rgba8_snorm --normals playground",
        ),
        columns=(
            key("encoding", "encoding"),
            key("storage", "storage"),
            key("normals", "normals"),
            # Where tuning ends differs between machines by more than what it gains.
            Column("tuned", "parameters", is_compared=False),
            Column("published", "published", form=TWO, abs=0.02),
            Column("dB", "tuned", form=TWO, abs=0.02),
            Column("gain", "gain", form=TWO, abs=0.02),
        ),
        takes=lambda row: row["quantity"] == "psnr_db",
        gather=measuring.parameters_named,
    ),
    Table(
        marker="normalbench render",
        rows=(f"render --encoding {RENDERED} --repeats 0",),
        columns=(
            key("encoding in RGBA8", "encoding"),
            Column("image", "psnr_db", form=TWO, abs=0.1),
            Column("rank", "rank"),
            Column("normals", "normal_psnr_db", form=TWO, abs=0.1),
            Column("rank", "normal_rank"),
        ),
        needs=("gl",),
        lines=RENDERED,
    ),
    Table(
        marker="normalbench lights",
        rows=(f"lights --experiment equal --sum 1 --counts 8,64,256 --light-buffer {LIGHT_BUFFERS}",),
        columns=(
            key("lights that sum to 1", "light_buffer", lambda name: f"`{name}`" + " (blue)" * (name == "r11g11b10f")),
            *(Column(str(count), "model", {"lights": count}, THREE, abs=5e-4) for count in (8, 64, 256)),
        ),
        needs=("gl",),
        # Of channels that differ the table shows colours that lose most: not sRGB's alpha.
        takes=lambda row: row["channel"] != "a",
        lines=LIGHT_BUFFERS,
    ),
    Table(
        marker="normalbench render lights",
        rows=(
            "render --layout fp32 --pipeline prepass --scene gloss --power 47 --lights 6 --size 320x240 --repeats 0"
            f" --light-targets 1,2 --light-buffer {LIT}",
        ),
        columns=(
            key("six lamps, power 47", "light_buffer"),
            Column("two targets", "psnr_db", {"light_targets": 2}, "{:.1f}".format, abs=0.1),
            Column("one target", "psnr_db", {"light_targets": 1}, "{:.1f}".format, abs=0.1),
        ),
        needs=("gl",),
        lines=LIT,
    ),
    Table(
        marker="normalbench depth",
        rows=("depth --near 0.1 --far 1000 --distance 1,10,100,1000 --rebuild all",),
        columns=(
            key("code", "depth"),
            key("storage", "storage"),
            key("rebuilt", "rebuilt"),
            *(
                Column(
                    f"at {distance}" if backend == "jax" else "",
                    "error_max",
                    {"distance": distance, "backend": backend},
                    writing.two_digits,
                    rel=rel,
                )
                for backend, rel in (("jax", 0.06), ("glsl", 0.125))
                for distance in (1, 10, 100, 1000)
            ),
        ),
        needs=("gl",),
        takes=lambda row: row["distance"],
        lines="linear packed16 eye_ray,linear packed24 eye_ray,linear r16f eye_ray,linear_sign packed16 eye_ray,"
        "logarithmic packed16 eye_ray,window depth16 inverse_projection,window depth16 projection_terms,"
        "window depth24 inverse_projection,window depth24 projection_terms,window depth24 eye_ray,"
        "window depth32f inverse_projection,window depth32f projection_terms,"
        "reversed_window depth24 inverse_projection,reversed_window depth24 projection_terms,"
        "reversed_window depth32f inverse_projection,reversed_window depth32f projection_terms",
        holds=glsl_agrees,
    ),
    Table(
        marker="normalbench frames",
        rows=("frames --backend jax",),
        columns=(
            key("code", "encoding"),
            key("storage", "storage"),
            *(
                Column(title, name, form=form, rel=2e-3, abs=6e-5)
                for title, name, form in (
                    ("normal max", "normal_max_deg", FOUR),
                    ("tangent max", "tangent_max_deg", FOUR),
                    ("mean", "rotation_mean_deg", FOUR),
                    ("RMS", "rotation_rms_deg", FOUR),
                    ("max", "rotation_max_deg", FOUR),
                    ("effective bits", "effective_bits", TWO),
                    ("RMS to limit", "reached_rms_percent", "{:.1f} %".format),
                )
            ),
        ),
        takes=lambda row: row["bits"] == 32,
    ),
    Table(
        marker="normalbench vectors",
        rows=("vectors --backend jax --speed 0.05,1,64",),
        columns=(
            key("code", "encoding"),
            key("storage", "storage"),
            Column("still", "still_px", {"speed": 0.05}, writing.two_digits, rel=0.06),
            Column("least", "least_px", {"speed": 0.05}, writing.two_digits, rel=0.06),
            Column("error at 0.05", "error_mean_px", {"speed": 0.05}, writing.two_digits, rel=0.06),
            Column("at 1", "error_mean_px", {"speed": 1}, writing.two_digits, rel=0.06),
            Column("at 64", "error_mean_px", {"speed": 64}, writing.two_digits, rel=0.06),
            Column("lost at 0.05", "lost_percent", {"speed": 0.05}, "{:.0f} %".format, abs=0.6),
            Column("drift at 1", "drift_px", {"speed": 1}, writing.two_digits, rel=0.06),
        ),
        lines="linear rg8,linear rg8_centred,sqrt rg8_centred,log rg8_centred,linear rgb10a2,linear rgb10a2_centred,"
        "sqrt rgb10a2_centred,log rgb10a2_centred,linear rg16,linear rg16_centred,sqrt rg16_centred,log rg16_centred,"
        "linear rg16f",
    ),
    Table(
        marker="normalbench roughness",
        rows=("roughness",),
        columns=(
            key("storage", "storage"),
            Column("bits", "bits"),
            Column("acceptable from", "roughness", {"threshold": 0.1, "decides": True}, "{:.2f}".format, abs=0.011),
            Column("invisible from", "roughness", {"threshold": 0.05, "decides": True}, "{:.2f}".format, abs=0.011),
            Column("worst object", "object", {"threshold": 0.1, "decides": True}, "`{}`".format),
            Column("worst environment", "environment", {"threshold": 0.1, "decides": True}, "`{}`".format),
        ),
        needs=("gl",),
        takes=lambda row: row["threshold"] is not None,
        lines="rg8,rgb10a2,rgb8_12_12,rg16",
    ),
    Table(
        marker="normalbench roughness dither",
        rows=("roughness --storage rg8,rgb10a2 --object panel20,panel4 --environment lamp --dither moving",),
        columns=(
            key("storage", "storage"),
            key("noise", "dither", str),
            key("frames", "frames", str),
            Column("acceptable from", "roughness", {"threshold": 0.1, "decides": True}, "{:.2f}".format, abs=0.011),
            Column("invisible from", "roughness", {"threshold": 0.05, "decides": True}, "{:.2f}".format, abs=0.011),
        ),
        needs=("gl",),
        takes=lambda row: row["threshold"] is not None,
        lines="rg8 none 1,rg8 none 8,rg8 moving 1,rg8 moving 8,"
        "rgb10a2 none 1,rgb10a2 none 8,rgb10a2 moving 1,rgb10a2 moving 8",
        holds=noise_helps,
    ),
    Table(
        marker="normalbench effects",
        rows=(
            f"effects --effect {EFFECTS} --encoding octahedral,spheremap --storage rg8,rgb10a2 --depth linear/packed16",
        ),
        columns=(
            key("effect", "effect"),
            *(
                Column(title, "effect_rms", {"encoding": encoding, "storage": storage}, TWO, rel=0.02, abs=0.01)
                for title, encoding, storage in (
                    ("octahedral 8:8", "octahedral", "rg8"),
                    ("octahedral 10:10", "octahedral", "rgb10a2"),
                    ("spheremap 8:8", "spheremap", "rg8"),
                    ("linear depth, 16 bits", None, None),
                )
            ),
            Column(
                "the method itself",
                "method_rms",
                {"encoding": "octahedral", "storage": "rg8"},
                writing.two_digits,
                rel=0.05,
            ),
        ),
        needs=("gl",),
        gather=measuring.in_thousandths,
        lines=EFFECTS,
        holds=fifteen_times,
    ),
    Table(
        marker="normalbench effects ssr",
        rows=(
            "effects --effect ssr --encoding octahedral --storage rg8,rgb10a2,rg16 "
            "--depth linear/packed16,window/depth24",
        ),
        columns=(
            key("normals", "storage"),
            key("depths", "depth"),
            Column("hits that moved", "moved_percent", form="{:.1f} %".format, rel=0.05, abs=0.1),
            Column("RMS of the light", "effect_rms", form=writing.two_digits, rel=0.1, abs=0.01),
        ),
        needs=("gl",),
        gather=measuring.exact_named,
        holds=a_sixth_moves,
    ),
    Table(
        marker="normalbench effects denoise",
        rows=tuple(
            f"effects --effect denoise,denoise:weights=cone --encoding {encoding} --storage {storage} --depth none "
            "--rays 0 --size 160x120"
            for encoding, storage in (
                ("octahedral", "rg8,rgb10a2,rgb8_12_12,rg16"),
                ("xyz,xyz_renormalised", "rgb10a2"),
            )
        ),
        columns=(
            key("encoding", "encoding"),
            key("storage", "storage"),
            *(
                Column(f"{whose}: {title}", name, {"effect": effect}, form, rel=0.1, abs=least)
                for whose, effect in (("SVGF", "denoise"), ("NRD", "denoise:weights=cone"))
                for title, name, form, least in (
                    ("neighbours lost", "lost_neighbours_percent", "{:.2g} %".format, 0.01),
                    ("image", "psnr_db", "{:.0f} dB".format, 1.0),
                )
            ),
        ),
        needs=("gl",),
        holds=cones_need_more_bits,
    ),
    Table(
        marker="normalbench half",
        rows=tuple(
            f"quality --encoding {names} --storage {storage} --normals sphere --arithmetic float,half --backend jax "
            "--count 1048576"
            for storage, names in HALVES.items()
        ),
        columns=(
            key("storage", "storage"),
            key("encoding", "encoding"),
            *(
                Column(f"{what}, {arithmetic}", f"angle_{what}_deg", {"arithmetic": arithmetic}, form, **near)
                # A driver's roots decide the largest angle.
                for what, form, near in (("mean", FOUR, {"abs": 6e-5}), ("max", THREE, {"rel": 0.03}))
                for arithmetic in ("float", "half")
            ),
            Column("RMS grows by", "half_loss_percent", {"arithmetic": "half"}, "{:.1f} %".format, abs=0.06, rel=0.02),
        ),
        gather=measuring.arithmetic_apart,
        lines=of_storages(HALVES),
    ),
    Table(
        marker="normalbench mix",
        rows=(f"mix --backend jax --encoding {MIXED}",),
        columns=(
            key("code", "encoding"),
            *(
                column
                for use, verdict in (("filter", "filterable"), ("blend", "blendable"), ("resolve", "resolvable"))
                for column in (
                    Column(verdict, verdict),
                    Column("garbage", f"{use}_garbage_percent", form="{:.1f}".format, abs=0.1),
                )
            ),
        ),
        gather=measuring.verdicts_of_mixes,
        lines=MIXED,
    ),
    Table(
        marker="normalbench motion",
        rows=("motion --encoding octahedral,spheremap,per_pixel_view --axis yaw,pitch,roll",),
        columns=(
            key("code", "encoding"),
            key("space", "space", str),
            key("axis", "axis", str),
            Column("static RMS", "static_rms_deg", AT_A_QUARTER, THREE, rel=0.005),
            *(
                Column(f"{turn:g}", "wobble_deg", {"turn_deg": turn}, writing.or_zero, abs=2e-3, rel=0.01)
                for turn in (0.01, 0.05, 0.25, 0.5, 1.0)
            ),
            Column("highlight", "highlight_px", AT_A_QUARTER, writing.or_zero, abs=6e-4, rel=0.05),
            Column("peak", "peak_percent", AT_A_QUARTER, writing.percent, abs=6e-3, rel=0.05),
            # JSON has no infinity. Above 100 dB it is rounding of float32, which processors do otherwise.
            Column("reprojected", "reprojected_psnr_db", AT_A_QUARTER, "{:.1f}".format, "infinite", rel=0.05),
        ),
        needs=("gl",),
        lines="octahedral view yaw,octahedral view roll,spheremap view yaw,spheremap view roll,per_pixel_view view yaw,"
        "per_pixel_view view pitch,per_pixel_view view roll,octahedral world yaw,spheremap world yaw",
    ),
    Table(
        marker="normalbench maps",
        rows=(
            "maps --encoding xy,hemi_octahedral,octahedral --normals bumps,grain",
            "maps --encoding octahedral --normals playground",
        ),
        columns=(
            key("format", "block"),
            key("swizzle", "swizzle"),
            *(
                Column(title, name, {"encoding": encoding, "normals": normals}, FOUR_THAT_COUNT, rel=2e-3)
                for encoding, normals in (("xy", "bumps"), ("xy", "grain"), ("octahedral", "playground"))
                for title, name in ((f"`{encoding}` on {normals}: mean", "angle_mean_deg"), ("max", "angle_max_deg"))
            ),
            *(
                Column("", "angle_mean_deg", {"encoding": encoding, "normals": "bumps"}, FOUR_THAT_COUNT, rel=2e-3)
                for encoding in ("hemi_octahedral", "octahedral")
            ),
        ),
        holds=tangent_space_means,
    ),
    Table(
        marker="normalbench code",
        rows=("code --check all --to all",),
        columns=(
            key("encoding", "encoding"),
            *(
                Texels(f"`{storage}`", storage)
                for storage in ("rg8", "rgba8", "rgb10a2", "rgb8_12_12", "rg16", "rg16f")
            ),
        ),
        needs=("gl",),
        gather=measuring.most_differing,
        again=("code --check all --to c,hlsl",),
    ),
)
TABLES = {table.marker: table for table in (*ALL, *COST_TABLES)}
