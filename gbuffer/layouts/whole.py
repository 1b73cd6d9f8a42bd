"""What engines keep of an opaque metal/rough material, whole: every field, format and curve, from each one's source.

`other` is what an engine keeps and this renderer does not use. `kind`, this renderer's Deferred ID, lies where the
engine has a shading model, flags or opacity. Emission that a target holds otherwise than this renderer can is `other`,
and is added to the light buffer here. Words of one integer target are written as the channels of RGBA8 targets, which
are the same bits.
"""

from __future__ import annotations

from typing import Any

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.encoding import Encoding
from .layout import Layout, engine_layout

UNREAL_4 = "Unreal Engine 4.27.2, SceneRenderTargets.cpp, DeferredShadingCommon.ush"
UNREAL_5 = "Unreal Engine 5.8, GBufferInfo.cpp, DeferredShadingCommon.ush"
UNITY = "Unity 2022.3 as in Torgo13/CustomRenderPipeline (373861b)"
URP = "srgb8_a8: albedo kind; rgba8: reflectivity(metalness) - - occlusion"
KAJIYA = (
    "rgba8: square_root(albedo) -; rgba8: normal.x:11 normal.y:10 normal.z:11; rg16f: roughness metalness; "
    "rgba8: rgb9e5(emission); rgb10a2: other other other -; rgba16f: motion.x motion.y other -"
)
# Decals.
BLENDED = "blended into the targets"
BEFORE = "gathered in buffers of their own and applied when the targets are written"
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
        "rgba8: metalness linear:0.08(reflectance) roughness other:4 kind:4; srgb8_a8: albedo occlusion; "
        "rgba8: other other other other",
        "rgba16f",
        UNREAL_4 + "; with static light AO is its irradiance, and motion has a target of its own",
        decals=BEFORE + ", or " + BLENDED,
    ),
    _whole(
        "Unreal Engine",
        2026,
        "unreal5_mobile",
        "octahedral 10:10, model; metallic, specular, roughness, custom; base colour in sRGB, AO",
        ENCODINGS["octahedral"],
        "rgb10a2: normal.x normal.y kind other; rgba8: metalness linear:0.08(reflectance) roughness other; "
        "srgb8_a8: albedo occlusion",
        "r11g11b10f",
        UNREAL_5 + ", the mobile path; roughness is at least 1/64, the model has 4 bits",
        decals=BEFORE,
    ),
    _whole(
        "Unreal Engine",
        2026,
        "unreal5_substrate",
        "Substrate's simple slab: octahedral 11:11, roughness 10; diffuse and F0 in 7:7:6 bits on the root, a header",
        ENCODINGS["octahedral"],
        "rgba8: normal.x:11 normal.y:11 roughness:10; "
        "rgba8: kind:4 other:12 square_root(albedo.r):7 square_root(albedo.g):7 other:2; "
        "rgba8: square_root(albedo.b):6 square_root(specular.r):7 square_root(specular.g):7 square_root(specular.b):6 "
        "other:6",
        "rgba16f",
        "Unreal Engine 5.8, SubstrateExport.ush; colours have noise there; the order of bits is inferred",
        decals=BEFORE,
    ),
    _whole(
        "Unity",
        2022,
        "unity_hdrp",
        "diffuse in sRGB, specular occlusion; octahedral by floor(x 4095.5), roughness; F0 by a fast sRGB curve, class",
        ENCODINGS["octahedral"],
        "srgb8_a8: albedo occlusion; rgba8: normal.x:12 normal.y:12 roughness; "
        "rgba8: fast_srgb(specular) kind:3 other:5",
        "r11g11b10f",
        f"Unity HDRP 14, Lit.hlsl, NormalBuffer.hlsl, less the step that keeps z off 0; {UNITY}",
        packing="truncate_half",
        decals=BEFORE,
    ),
    _whole(
        "Unity",
        2022,
        "unity_urp",
        "base colour in sRGB, flags; reflectivity for metalness, occlusion; xyz and smoothness in SNORM8",
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
        "four words: base colour by 2.2, roughness; emission RGB9E5; reflectance, metallic, occlusion, coat; "
        "octahedral 12:12, flags; the lighting pass",
        ENCODINGS["octahedral"],
        "rgba8: gamma_2_2(albedo) roughness; rgba8: rgb9e5(emission); "
        "rgba8: square_root:0.16(reflectance) metalness occlusion other; "
        "rgba8: normal.x:12 normal.y:12 other; r8: kind",
        "",
        "bevyengine/bevy 0.20-dev (4805ca79), deferred/functions.wesl, deferred/types.wesl",
        decals=IN_SHADER,
    ),
    _whole(
        "Flax",
        2026,
        "flax",
        "base colour linear in 8 bits, AO; xyz in RGB10A2, model; roughness, metalness, specular",
        ENCODINGS["xyz_renormalised"],
        "rgba8: albedo occlusion; rgb10a2: normal.x normal.y normal.z kind; "
        "rgba8: roughness metalness square_root:0.16(reflectance) -",
        "r11g11b10f",
        "FlaxEngine (1146620), GBuffer.hlsl, RenderBuffers.h; light may be RGBA16F as well",
        decals=BLENDED + ", normals as colours; the alpha that is AO is masked",
    ),
    _whole(
        "Donut",
        2026,
        "donut",
        "diffuse in sRGB, opacity; F0 in sRGB, occlusion; xyz and roughness in RGBA16 signed; emission, motion",
        ENCODINGS["xyz_renormalised"],
        "srgb8_a8: albedo kind; srgb8_a8: specular occlusion; rgba16_snorm: normal.x normal.y normal.z roughness; "
        "rgba16f: emission other; rg16f: motion.x motion.y",
        "",
        "NVIDIA-RTX/Donut, src/render/GBuffer.cpp:40, include/donut/shaders/gbuffer.hlsli (bfdebdd); opacity is `kind`",
    ),
    _whole(
        "Granite",
        2026,
        "granite",
        "base colour in sRGB, ambient; xyz in RGB10A2; metallic, roughness; read in tile memory",
        ENCODINGS["xyz_renormalised"],
        "srgb8_a8: albedo occlusion; rgb10a2: normal.x normal.y normal.z -; rg8: metalness roughness",
        "r11g11b10f",
        "Themaister/Granite (7c59ad8), scene_viewer_application.cpp, inc/render_target.h",
        decals=IN_SHADER,
    ),
    _whole(
        "kajiya",
        2025,
        "kajiya",
        "four words: root of colours 8:8:8; xyz 11:10:11; roughness, metalness in halves; emission RGB9E5; "
        "geometric normal; motion in view space",
        ENCODINGS["xyz_renormalised"],
        KAJIYA,
        "",
        "EmbarkStudios/kajiya (9fdec0f), gbuffer.hlsl, pack_unpack.hlsl; to nearest since 2022-10 (591d966)",
    ),
    _whole(
        "kajiya",
        2021,
        "kajiya_truncated",
        "as kajiya before 2022-10: normals cut off, as colours were, which are rounded here",
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
        "albedo in sRGB, AO; octahedral 10:10, there in halves, class; smoothness, reflectance, metal; motion",
        ENCODINGS["octahedral"],
        "srgb8_a8: albedo occlusion; rgb10a2: normal.x normal.y other kind; "
        "rgba8: inverted(roughness) square_root:0.16(reflectance) metalness other; "
        "rgba16f: motion.x motion.y other other",
        "",
        "GaijinEntertainment/DagorEngine (7572366), gbuffer_pack_unpack_DNG.hlsl; its light buffer was not read",
        decals=BLENDED,
    ),
    _whole(
        "Spartan Engine",
        2026,
        "spartan",
        "base colour linear in 8 bits; xyz in halves, material; roughness, metalness, emission, occlusion; motion",
        ENCODINGS["xyz_renormalised"],
        "rgba8: albedo other; rgba16f: normal.x normal.y normal.z kind; rgba8: roughness metalness other occlusion; "
        "rgba16f: motion.x motion.y other -",
        "",
        "PanosK92/SpartanEngine (9d843cd), Renderer_Resources.cpp, g_buffer.hlsl; emission is a share of the colour",
    ),
    _whole(
        "Second Life",
        2025,
        "second_life",
        "base colour linear in 8 bits; occlusion, roughness, metal; spheremap 16:16 in view space, class",
        ENCODINGS["spheremap"],
        "rgba8: albedo -; rgba8: occlusion roughness metalness -; rgba16: normal.x normal.y other kind",
        "",
        "secondlife/viewer (d6d453b), pipeline.cpp, pbropaqueF.glsl; emission's own target is optional there",
        space="view",
    ),
    _whole(
        "r3d",
        2026,
        "r3d",
        "base colour linear in RGB8; octahedral 16:16 twice; occlusion, roughness, metal, specular; depth; emission",
        ENCODINGS["octahedral"],
        "rgba8: albedo -; rg16: normal.x normal.y; rg16: other other; "
        "rgba8: occlusion roughness metalness square_root:0.16(reflectance); r16f: depth; rgba16f: emission -",
        "",
        "Bigfoot71/r3d (af17457), r3d_target.c, geometry.frag; three numbers take four channels, as GPUs pad them",
        decals=BLENDED + "; octahedral normals are replaced",
    ),
    _whole(
        "O3DE",
        2026,
        "o3de",
        "a prototype, not the main pipeline: base colour, roughness, metalness in halves; signed octahedron 10:10",
        ENCODINGS["signed_octahedral"],
        "rgba16f: albedo -; rgba16f: roughness metalness - -; rgb10a2: normal.x normal.y normal.z -",
        "",
        "o3de/o3de-atom-sampleviewer, Materials/Pipelines/PrototypeDeferredPipeline/DeferredMaterialPass.azsli:79",
    ),
    _whole(
        "FidelityFX",
        2025,
        "fidelityfx",
        "base colour, alpha; xyz in halves, signed here; AO, square of the roughness, metallic; motion",
        ENCODINGS["xyz_renormalised"],
        "rgba8: albedo other; rgba16f: normal.x normal.y normal.z -; rgba8: occlusion squared(roughness) metalness -; "
        "rg16f: motion.x motion.y",
        "",
        "FidelityFX SDK, Cauldron 2 (f4c1da8), gbufferps.hlsl: normals as x/2 + 1/2, coarser than here",
    ),
    _whole(
        "Cocos",
        2024,
        "cocos",
        "three targets in halves: albedo; emission, occlusion; octahedral, roughness, metallic",
        ENCODINGS["octahedral"],
        "rgba16f: albedo other; rgba16f: emission occlusion; rgba16f: normal.x normal.y roughness metalness",
        "",
        "cocos-engine 3.8 (4a7c879), deferred-pipeline.ts, standard-surface-entry.chunk",
    ),
    _whole(
        "hybrid-rendering",
        2026,
        "hybrid_rendering",
        "albedo, metal; octahedral and motion in halves; roughness, curvature, mesh and depth in halves",
        ENCODINGS["octahedral"],
        "rgba8: albedo metalness; rgba16f: normal.x normal.y motion.x motion.y; rgba16f: roughness other kind depth",
        "",
        "diharaw/hybrid-rendering (090360e), G-buffer",
    ),
    _whole(
        "RTX Remix",
        2026,
        "remix",
        "octahedral in two SNORM16; roughness; albedo and F0 linear in RGB10; anisotropy, opacity, flags and emission",
        ENCODINGS["octahedral"],
        "rg16_snorm: normal.x normal.y; r8: roughness; rgb10a2: albedo -; rgb10a2: specular -; "
        "rgba8: other other other:6 kind:2 other; rgba8: other other other other",
        "",
        "NVIDIAGameWorks/dxvk-remix (574be6b), rtx_resources.cpp:1043; emission as a colour and a half is `other` here",
    ),
)
