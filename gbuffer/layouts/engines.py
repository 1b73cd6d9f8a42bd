"""The normals of engines and SDKs, each from its own source, with the other attributes of this renderer.

`shading_model`, this renderer's Deferred ID, is placed where the engine has a material ID or nothing. `whole.py` has
the engines whose whole material is known.
"""

from __future__ import annotations

from typing import Any

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.encoding import Encoding
from ...encodings.codecs.variants import variant
from .layout import Layout, engine_layout

ALBEDO = "rgba8: diffuse_color shading_model"
SPECULAR = "rgba8: f0.rgb -"
MATERIAL = f"{ALBEDO}; rgba8: f0.rgb power"
# What a normal that stands with its roughness is measured beside.
COLOURS = f"{ALBEDO}; {SPECULAR}"
NRD = "NVIDIA-RTX/NRD, Shaders/NRD.hlsli (a822d87)"


def _layout(
    engine: str, year: int, name: str, title: str, encoding: Encoding, targets: str, source: str, **how: Any
) -> Layout:
    return engine_layout(engine, year, name, f"the normal of {engine}: {title}", encoding, targets, source, **how)


def _about_y(name: str) -> Encoding:
    """Return the named encoding of the catalogue, with its pole at +y."""
    return variant(ENCODINGS[name], {"axis": "y"})


ENGINES = (
    _layout(
        "Killzone 2",
        2007,
        "killzone2",
        "view-space xy in two half floats, in the game packed into RGBA8: same bits, different blending and clears",
        ENCODINGS["xy"],
        f"rg16f: normal.x normal.y; {MATERIAL}",
        "Valient, Deferred Rendering in Killzone 2, 2007",
        space="view",
    ),
    _layout(
        "CryENGINE 3",
        2010,
        "cryengine3",
        "world-space best-fit normal in RGB8, specular power in A",
        ENCODINGS["best_fit"],
        f"rgba8: normal.x normal.y normal.z power; {COLOURS}",
        "Kaplanyan, CryENGINE 3: Reaching the Speed of Light, 2010 (Crysis 2)",
    ),
    _layout(
        "Godot",
        2023,
        "godot4",
        "view-space best-fit normal in RGB8, roughness in A: the Forward+ prepass, not a deferred G-buffer",
        ENCODINGS["best_fit"],
        f"rgba8: normal.x normal.y normal.z power; {COLOURS}",
        "Godot 4",
        space="view",
    ),
    _layout(
        "Unreal Engine",
        2022,
        "unreal5_substrate_22",
        "world-space octahedral, 11:11 bits",
        ENCODINGS["octahedral"],
        f"rgba8: normal.x:11 normal.y:11 power:10; {COLOURS}",
        "Unreal Engine 5, Substrate",
    ),
    _layout(
        "Unreal Engine",
        2022,
        "unreal5_substrate_32",
        "world-space octahedral, 16:16 bits",
        ENCODINGS["octahedral"],
        f"rgba8: normal.x:16 normal.y:16; {MATERIAL}",
        "Unreal Engine 5, Substrate",
    ),
    _layout(
        "Unity",
        2015,
        "unity_builtin",
        "world-space xyz in RGB10A2",
        ENCODINGS["xyz_renormalised"],
        f"{MATERIAL}; rgb10a2: normal.x normal.y normal.z -",
        "Unity, built-in deferred path",
    ),
    _layout(
        "Bevy",
        2023,
        "bevy_truncated",
        "world-space octahedral, 12:12, truncated",
        ENCODINGS["octahedral"],
        f"rgba8: normal.x:12 normal.y:12 -:8; {MATERIAL}",
        "Bevy, deferred path, older releases",
        packing="truncate",
    ),
    _layout(
        "Bevy",
        2023,
        "bevy_prepass",
        "world-space xyz in RGB10A2, the normal prepass",
        ENCODINGS["xyz_renormalised"],
        f"rgb10a2: normal.x normal.y normal.z -; {MATERIAL}",
        "bevyengine/bevy, issues 9264 and 22843",
    ),
    _layout(
        "Bevy",
        2026,
        "bevy_prepass_octahedral",
        "world-space octahedral in RG16 signed, proposed for the normal prepass",
        ENCODINGS["octahedral"],
        f"rg16_snorm: normal.x normal.y; {MATERIAL}",
        "bevyengine/bevy, issue 22843",
    ),
    _layout(
        "NRD",
        2026,
        "nrd",
        "signed octahedron 10:10, its sign on the roughness; material ID; RGB10A2, NRD_NORMAL_ENCODING 2, the default",
        ENCODINGS["signed_octahedral"],
        f"rgb10a2: normal.x normal.y roughness*normal.z shading_model; rgba8: diffuse_color -; {SPECULAR}",
        NRD,
    ),
    _layout(
        "NRD",
        2026,
        "nrd_rgba8",
        "xyz over the largest and roughness in RGBA8, NRD_NORMAL_ENCODING 0",
        ENCODINGS["xyz_largest"],
        f"rgba8: normal.x normal.y normal.z roughness; {COLOURS}",
        NRD,
    ),
    _layout(
        "NRD",
        2026,
        "nrd_rgba8_snorm",
        "xyz over the largest and roughness in RGBA8 signed, NRD_NORMAL_ENCODING 1",
        ENCODINGS["xyz_largest"],
        f"rgba8_snorm: normal.x normal.y normal.z roughness; {COLOURS}",
        NRD,
    ),
    _layout(
        "NRD",
        2026,
        "nrd_rgba16",
        "xyz over the largest and roughness in RGBA16, NRD_NORMAL_ENCODING 3",
        ENCODINGS["xyz_largest"],
        f"rgba16: normal.x normal.y normal.z roughness; {COLOURS}",
        NRD,
    ),
    _layout(
        "NRD",
        2026,
        "nrd_rgba16_snorm",
        "xyz over the largest and roughness in RGBA16 signed, NRD_NORMAL_ENCODING 4",
        ENCODINGS["xyz_largest"],
        f"rgba16_snorm: normal.x normal.y normal.z roughness; {COLOURS}",
        NRD,
    ),
    _layout(
        "Wicked Engine",
        2026,
        "wicked",
        "octahedral and roughness in R11G11B10F, rounded to nearest; Wicked computes them in halves",
        ENCODINGS["octahedral"],
        f"r11g11b10f: normal.x normal.y roughness; {COLOURS}",
        "turanszkij/WickedEngine, shaders/visibility_surfaceCS.hlsl:72, wiRenderer.cpp:11849 (bc3ef16)",
    ),
    _layout(
        "Wicked Engine",
        2026,
        "wicked_truncated",
        "octahedral and roughness in R11G11B10F, on a device that truncates",
        ENCODINGS["octahedral"],
        f"r11g11b10f: normal.x normal.y roughness; {COLOURS}",
        "turanszkij/WickedEngine, shaders/visibility_surfaceCS.hlsl:72, wiRenderer.cpp:11849 (bc3ef16)",
        rounding="truncate",
    ),
    _layout(
        "Wicked Engine",
        2026,
        "wicked_particles",
        "xyz 8:8:8, truncated: pack_unitvector, for particles and primitives",
        ENCODINGS["xyz_renormalised"],
        f"rgba8: normal.x:8 normal.y:8 normal.z:8 -:8; {MATERIAL}",
        "turanszkij/WickedEngine, shaders/globals.hlsli (bc3ef16)",
        packing="truncate",
    ),
    _layout(
        "Skyrim Community Shaders",
        2026,
        "skyrim_community",
        "octahedral of -n (z into the screen), so visible normals are central; in half floats, with 1 - roughness",
        ENCODINGS["octahedral"],
        f"rgb10a2: normal.x normal.y roughness shading_model; rgba8: diffuse_color -; {SPECULAR}",
        "community-shaders/skyrim-community-shaders, package/Shaders/Common/GBuffer.hlsli (fd20066)",
        space="view",
    ),
    _layout(
        "Skyrim",
        2026,
        "skyrim_vanilla",
        "the game's own spheremap (EncodeNormalVanilla); z points into the screen and the pole away from it, as here",
        ENCODINGS["spheremap"],
        f"rgba8: normal.x normal.y - roughness; {COLOURS}",
        "community-shaders/skyrim-community-shaders, package/Shaders/Common/GBuffer.hlsli (fd20066)",
        space="view",
    ),
    _layout(
        "RTX Remix",
        2026,
        "remix_ray_reconstruction",
        "xyz and roughness in RGBA16F: the input of DLSS Ray Reconstruction",
        ENCODINGS["xyz_renormalised"],
        f"rgba16f: normal.x normal.y normal.z roughness; {COLOURS}",
        "NVIDIAGameWorks/dxvk-remix, rtx_render/rtx_resources.cpp:1043 (574be6b)",
    ),
    _layout(
        "Capsaicin",
        2026,
        "capsaicin",
        "three normals as xyz in RGBA8: geometry, shading and vertex; roughness R16F, motion RG16F, visibility",
        ENCODINGS["xyz_renormalised"],
        "rgba8: normal.x normal.y normal.z shading_model; rgba8: diffuse_color other; "
        f"{SPECULAR}; r16f: roughness; rg16f: motion.x motion.y; rgba8: other:24 other:8; "
        "rgba32f: other other other other",
        "GPUOpen-LibrariesAndSDKs/Capsaicin, visibility_buffer.cpp:80-105 (5a3bf2a); albedo replaces a normal here",
    ),
    _layout(
        "Capsaicin",
        2026,
        "capsaicin_rays",
        "xyz 10:10:10, signed: packNormal, for rays",
        ENCODINGS["xyz_renormalised"],
        f"rgba8: normal.x:10 normal.y:10 normal.z:10 -:2; {MATERIAL}",
        "GPUOpen-LibrariesAndSDKs/Capsaicin, packNormal (5a3bf2a)",
        packing="signed",
    ),
    _layout(
        "Blender",
        2024,
        "eevee_next",
        "octahedral in RG16, one layer per closure; only one layer is shown",
        ENCODINGS["octahedral"],
        f"rg16: normal.x normal.y; {MATERIAL}",
        "Blender 4.2, EEVEE Next, eevee_gbuffer_lib",
    ),
    _layout(
        "XeGTAO",
        2021,
        "xegtao",
        "view-space xyz, 11:11:10 in R32_UINT",
        ENCODINGS["xyz_renormalised"],
        f"rgba8: normal.x:11 normal.y:11 normal.z:10; {MATERIAL}",
        "GameTechDev/XeGTAO",
        space="view",
    ),
    _layout(
        "Bevy",
        2025,
        "bevy_solari",
        "world-space xyz and roughness in RGBA16F, motion RG16F: the input of DLSS Ray Reconstruction",
        ENCODINGS["xyz_renormalised"],
        f"rgba16f: normal.x normal.y normal.z roughness; {COLOURS}; rg16f: motion.x motion.y",
        "bevyengine/bevy 0.17, bevy_solari, resolve_dlss_rr_textures.wgsl; decoded from octahedral 12:12 there",
    ),
    _layout(
        "webgpu-samples",
        0,
        "webgpu_samples",
        "world-space xyz in RGBA16F",
        ENCODINGS["xyz_renormalised"],
        f"rgba16f: normal.x normal.y normal.z -; {MATERIAL}",
        "webgpu/webgpu-samples, deferredRendering (pull request 238)",
    ),
    _layout(
        "Diligent Engine",
        0,
        "diligent_fx",
        "world-space xyz in RGBA16F",
        ENCODINGS["xyz_renormalised"],
        f"rgba16f: normal.x normal.y normal.z -; {MATERIAL}",
        "DiligentGraphics/DiligentFX, issue 49",
    ),
    _layout(
        "three.js",
        0,
        "three_directions",
        "view-space xyz in RGBA8, as directionToColor writes them",
        ENCODINGS["xyz_renormalised"],
        f"rgba8: normal.x normal.y normal.z -; {MATERIAL}",
        "mrdoob/three.js, TSL, directionToColor (issue 32136)",
        space="view",
    ),
    _layout(
        "Timberdoodle",
        2026,
        "timberdoodle",
        "octahedral 12:12 and 8-bit roughness in one word",
        ENCODINGS["octahedral"],
        f"rgba8: normal.x:12 normal.y:12 roughness:8; {COLOURS}",
        "Sunset-Flock/Timberdoodle",
    ),
    _layout(
        "Timberdoodle",
        2026,
        "timberdoodle_geometric",
        "octahedral 16:16: the normal of the triangle",
        ENCODINGS["octahedral"],
        f"rgba8: normal.x:16 normal.y:16; {MATERIAL}",
        "Sunset-Flock/Timberdoodle",
    ),
    _layout(
        "Intel deferred samples",
        2010,
        "intel_deferred",
        "view-space spheremap, specular amount and power in RGBA16F",
        ENCODINGS["spheremap_classic"],
        "rgba16f: normal.x normal.y other power; rgba8: diffuse_color shading_model; rgba8: f0.rgb -",
        "A. Lauritzen, Deferred Rendering for Current and Future Rendering Pipelines, 2010",
        space="view",
    ),
    _layout(
        "Torque3D",
        2012,
        "torque3d",
        "Lambert azimuthal about y, 8:8, and 16-bit depth",
        _about_y("spheremap"),
        f"rgba8: normal.x normal.y depth:16; {MATERIAL}",
        "GarageGames/Torque3D, GBuffer conditioner",
        space="view",
    ),
    _layout(
        "volo",
        2023,
        "volo",
        "world-space octahedral about y in RG8, because decals on floors crossed the fold",
        _about_y("octahedral"),
        "srgb8_a8: diffuse_color shading_model; rg8: normal.x normal.y; rg8: roughness other; "
        "r11g11b10f: emissive; rgba8: f0.rgb -",
        "BastianBlokland/volo, assets/shaders/include/geometry.glsl, pull request 513; specular is this renderer's",
    ),
)
