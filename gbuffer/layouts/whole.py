"""Engines' layouts of a whole opaque metallic-roughness material: every field, format and curve, each from its
source.

`other` is a field that an engine keeps and this renderer does not use. `shading_model`, this renderer's Deferred
ID, is placed where the engine has a shading model, flags or opacity. If a target stores emissive light in a way that
this renderer does not support, the field is `other` and emissive light is added to the light buffer here. The words
of an integer target are written as channels of RGBA8 targets, which have the same bits.
"""

from __future__ import annotations

from typing import Any

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.encoding import Encoding
from .layout import Layout, engine_layout

UNREAL_4 = "Unreal Engine 4.27.2, SceneRenderTargets.cpp, DeferredShadingCommon.ush"
UNREAL_5 = "Unreal Engine 5.8, GBufferInfo.cpp, DeferredShadingCommon.ush"
UNITY = "Unity 2022.3 as in Torgo13/CustomRenderPipeline (373861b)"
URP = "srgb8_a8: base_color shading_model; rgba8: reflectivity(metallic) - - ao"
KAJIYA = (
    "rgba8: square_root(base_color) -; rgba8: normal.x:11 normal.y:10 normal.z:11; rg16f: roughness metallic; "
    "rgba8: rgb9e5(emissive); rgb10a2: other other other -; rgba16f: motion.x motion.y other -"
)
# Decals.
BLENDED = "blended into the targets"
BEFORE = "collected in separate buffers and applied when the targets are written"
IN_SHADER = "evaluated in the material's shader"


def _whole(
    engine: str, year: int, name: str, title: str, encoding: Encoding, targets: str, light: str, source: str, **how: Any
) -> Layout:
    return engine_layout(engine, year, name, title, encoding, targets, source, is_whole=True, light=light, **how)


WHOLE_ENGINES = (
    _whole(
        "Unreal Engine",
        2021,
        "unreal4",
        "xyz in RGB10A2; metallic, specular, roughness, model; base colour in sRGB, AO; custom data",
        ENCODINGS["xyz_renormalised"],
        "rgb10a2: normal.x normal.y normal.z other; "
        "rgba8: metallic linear:0.08(f0) roughness other:4 shading_model:4; srgb8_a8: base_color ao; "
        "rgba8: other other other other",
        "rgba16f",
        UNREAL_4 + "; with static light AO holds its irradiance, and motion has a separate target",
        decals=BEFORE + ", or " + BLENDED,
    ),
    _whole(
        "Unreal Engine",
        2026,
        "unreal5_mobile",
        "octahedral 10:10, model; metallic, specular, roughness, custom; base colour in sRGB, AO",
        ENCODINGS["octahedral"],
        "rgb10a2: normal.x normal.y shading_model other; rgba8: metallic linear:0.08(f0) roughness other; "
        "srgb8_a8: base_color ao",
        "r11g11b10f",
        UNREAL_5 + ", the mobile path; roughness is at least 1/64, the model has 4 bits",
        decals=BEFORE,
    ),
    _whole(
        "Unreal Engine",
        2026,
        "unreal5_substrate",
        "Substrate's simple slab: octahedral 11:11, roughness 10; diffuse and F0 as square roots 7:7:6, a header",
        ENCODINGS["octahedral"],
        "rgba8: normal.x:11 normal.y:11 roughness:10; "
        "rgba8: shading_model:4 other:12 square_root(diffuse_color.r):7 square_root(diffuse_color.g):7 other:2; "
        "rgba8: square_root(diffuse_color.b):6 square_root(f0.r):7 square_root(f0.g):7 square_root(f0.b):6 "
        "other:6",
        "rgba16f",
        "Unreal Engine 5.8, SubstrateExport.ush; Unreal adds noise to colours; the bit order is inferred",
        decals=BEFORE,
    ),
    _whole(
        "Unity",
        2022,
        "unity_hdrp",
        "diffuse in sRGB, specular AO; octahedral by floor(x 4095.5), roughness; F0 by a fast sRGB curve, class",
        ENCODINGS["octahedral"],
        "srgb8_a8: diffuse_color ao; rgba8: normal.x:12 normal.y:12 roughness; "
        "rgba8: fast_srgb(f0.rgb) shading_model:3 other:5",
        "r11g11b10f",
        f"Unity HDRP 14, Lit.hlsl, NormalBuffer.hlsl, without the step that keeps z from 0; {UNITY}",
        packing="truncate_half",
        decals=BEFORE,
    ),
    _whole(
        "Unity",
        2022,
        "unity_urp",
        "base colour in sRGB, flags; reflectivity instead of metallic, AO; xyz and smoothness in SNORM8",
        ENCODINGS["xyz_renormalised"],
        f"{URP}; rgba8_snorm: normal.x normal.y normal.z inverted(roughness)",
        "r11g11b10f",
        f"Unity URP 14, UnityGBuffer.hlsl; {UNITY}",
        decals=BEFORE + ", or " + BLENDED,
    ),
    _whole(
        "Unity",
        2022,
        "unity_urp_accurate",
        "as unity_urp, with octahedral 12:12 by floor(x 4095.5) and smoothness in RGBA8",
        ENCODINGS["octahedral"],
        f"{URP}; rgba8: normal.x:12 normal.y:12 inverted(roughness)",
        "r11g11b10f",
        f"Unity URP 14, UnityGBuffer.hlsl, accurate G-buffer normals; {UNITY}",
        packing="truncate_half",
        decals=BEFORE,
    ),
    _whole(
        "Bevy",
        2026,
        "bevy",
        "four words: base colour with gamma 2.2, roughness; emissive RGB9E5; reflectance, metallic, AO, coat; "
        "octahedral 12:12, flags; the lighting pass",
        ENCODINGS["octahedral"],
        "rgba8: gamma_2_2(base_color) roughness; rgba8: rgb9e5(emissive); "
        "rgba8: square_root:0.16(f0) metallic ao other; "
        "rgba8: normal.x:12 normal.y:12 other; r8: shading_model",
        "",
        "bevyengine/bevy 0.20-dev (4805ca79), deferred/functions.wesl, deferred/types.wesl",
        decals=IN_SHADER,
    ),
    _whole(
        "Flax",
        2026,
        "flax",
        "base colour linear in 8 bits, AO; xyz in RGB10A2, model; roughness, metallic, specular",
        ENCODINGS["xyz_renormalised"],
        "rgba8: base_color ao; rgb10a2: normal.x normal.y normal.z shading_model; "
        "rgba8: roughness metallic square_root:0.16(f0) -",
        "r11g11b10f",
        "FlaxEngine (1146620), GBuffer.hlsl, RenderBuffers.h; light can also be RGBA16F",
        decals=BLENDED + ", normals like colours; the alpha channel, which holds AO, is masked",
    ),
    _whole(
        "Donut",
        2026,
        "donut",
        "diffuse in sRGB, opacity; F0 in sRGB, AO; xyz and roughness in RGBA16 signed; emissive, motion",
        ENCODINGS["xyz_renormalised"],
        "srgb8_a8: diffuse_color shading_model; srgb8_a8: f0.rgb ao; "
        "rgba16_snorm: normal.x normal.y normal.z roughness; rgba16f: emissive other; rg16f: motion.x motion.y",
        "",
        "NVIDIA-RTX/Donut, src/render/GBuffer.cpp:40, include/donut/shaders/gbuffer.hlsli (bfdebdd); model: opacity",
    ),
    _whole(
        "Granite",
        2026,
        "granite",
        "base colour in sRGB, ambient; xyz in RGB10A2; metallic, roughness; read in tile memory",
        ENCODINGS["xyz_renormalised"],
        "srgb8_a8: base_color ao; rgb10a2: normal.x normal.y normal.z -; rg8: metallic roughness",
        "r11g11b10f",
        "Themaister/Granite (7c59ad8), scene_viewer_application.cpp, inc/render_target.h",
        decals=IN_SHADER,
    ),
    _whole(
        "kajiya",
        2025,
        "kajiya",
        "four words: square roots of colours 8:8:8; xyz 11:10:11; roughness, metallic in halves; emissive RGB9E5; "
        "geometric normal; motion in view space",
        ENCODINGS["xyz_renormalised"],
        KAJIYA,
        "",
        "EmbarkStudios/kajiya (9fdec0f), gbuffer.hlsl, pack_unpack.hlsl; rounds to nearest since 2022-10 (591d966)",
    ),
    _whole(
        "kajiya",
        2021,
        "kajiya_truncated",
        "kajiya before 2022-10: normals truncated; colours too, but here they are rounded",
        ENCODINGS["xyz_renormalised"],
        KAJIYA,
        "",
        "EmbarkStudios/kajiya before 591d966 (2022-10), pack_unpack.hlsl",
        packing="truncate",
    ),
    _whole(
        "Dagor",
        2026,
        "dagor",
        "albedo in sRGB, AO; octahedral 10:10 (in Dagor halves), class; smoothness, reflectance, metallic; motion",
        ENCODINGS["octahedral"],
        "srgb8_a8: base_color ao; rgb10a2: normal.x normal.y other shading_model; "
        "rgba8: inverted(roughness) square_root:0.16(f0) metallic other; "
        "rgba16f: motion.x motion.y other other",
        "",
        "GaijinEntertainment/DagorEngine (7572366), gbuffer_pack_unpack_DNG.hlsl; its light buffer was not examined",
        decals=BLENDED,
    ),
    _whole(
        "Spartan Engine",
        2026,
        "spartan",
        "base colour linear in 8 bits; xyz in halves, material; roughness, metallic, emissive, AO; motion",
        ENCODINGS["xyz_renormalised"],
        "rgba8: base_color other; rgba16f: normal.x normal.y normal.z shading_model; "
        "rgba8: roughness metallic other ao; rgba16f: motion.x motion.y other -",
        "",
        "PanosK92/SpartanEngine (9d843cd), Renderer_Resources.cpp, g_buffer.hlsl; emissive is a fraction of the colour",
    ),
    _whole(
        "Second Life",
        2025,
        "second_life",
        "base colour linear in 8 bits; AO, roughness, metallic; spheremap 16:16 in view space, class",
        ENCODINGS["spheremap"],
        "rgba8: base_color -; rgba8: ao roughness metallic -; rgba16: normal.x normal.y other shading_model",
        "",
        "secondlife/viewer (d6d453b), pipeline.cpp, pbropaqueF.glsl; the emissive target is optional there",
        space="view",
    ),
    _whole(
        "r3d",
        2026,
        "r3d",
        "base colour linear in RGB8; octahedral 16:16 twice; AO, roughness, metallic, specular; depth; emissive",
        ENCODINGS["octahedral"],
        "rgba8: base_color -; rg16: normal.x normal.y; rg16: other other; "
        "rgba8: ao roughness metallic square_root:0.16(f0); r16f: depth; rgba16f: emissive -",
        "",
        "Bigfoot71/r3d (af17457), r3d_target.c, geometry.frag; three numbers take four channels, because GPUs pad them",
        decals=BLENDED + "; octahedral normals are replaced",
    ),
    _whole(
        "O3DE",
        2026,
        "o3de",
        "a prototype, not the main pipeline: base colour, roughness, metallic in halves; signed octahedron 10:10",
        ENCODINGS["signed_octahedral"],
        "rgba16f: base_color -; rgba16f: roughness metallic - -; rgb10a2: normal.x normal.y normal.z -",
        "",
        "o3de/o3de-atom-sampleviewer, Materials/Pipelines/PrototypeDeferredPipeline/DeferredMaterialPass.azsli:79",
    ),
    _whole(
        "FidelityFX",
        2025,
        "fidelityfx",
        "base colour, alpha; xyz in halves, here signed; AO, squared roughness, metallic; motion",
        ENCODINGS["xyz_renormalised"],
        "rgba8: base_color other; rgba16f: normal.x normal.y normal.z -; rgba8: ao squared(roughness) metallic -; "
        "rg16f: motion.x motion.y",
        "",
        "FidelityFX SDK, Cauldron 2 (f4c1da8), gbufferps.hlsl: normals there are x/2 + 1/2, less precise than here",
    ),
    _whole(
        "Cocos",
        2024,
        "cocos",
        "three targets in halves: albedo; emissive, AO; octahedral, roughness, metallic",
        ENCODINGS["octahedral"],
        "rgba16f: base_color other; rgba16f: emissive ao; rgba16f: normal.x normal.y roughness metallic",
        "",
        "cocos-engine 3.8 (4a7c879), deferred-pipeline.ts, standard-surface-entry.chunk",
    ),
    _whole(
        "hybrid-rendering",
        2026,
        "hybrid_rendering",
        "base colour, metallic; octahedral and motion in halves; roughness, curvature, mesh and depth in halves",
        ENCODINGS["octahedral"],
        "rgba8: base_color metallic; rgba16f: normal.x normal.y motion.x motion.y; "
        "rgba16f: roughness other shading_model depth",
        "",
        "diharaw/hybrid-rendering (090360e), G-buffer",
    ),
    _whole(
        "RTX Remix",
        2026,
        "remix",
        "octahedral in two SNORM16; roughness; albedo and F0 linear in RGB10; anisotropy, opacity, flags and emissive",
        ENCODINGS["octahedral"],
        "rg16_snorm: normal.x normal.y; r8: roughness; rgb10a2: diffuse_color -; rgb10a2: f0.rgb -; "
        "rgba8: other other other:6 shading_model:2 other; rgba8: other other other other",
        "",
        "NVIDIAGameWorks/dxvk-remix (574be6b), rtx_resources.cpp:1043; emissive, a colour and a half float, is `other`",
    ),
)
