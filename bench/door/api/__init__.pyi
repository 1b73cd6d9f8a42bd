"""normalbench in Python: every table as a function, and codecs on arrays. Made by bench/door/python."""

from collections.abc import Mapping, Sequence
from typing import Any

from .bench.door.python.codecs import Codes as Codes
from .bench.door.python.codecs import decode as decode
from .bench.door.python.codecs import encode as encode
from .bench.door.python.codecs import encoding as encoding
from .bench.door.python.layouts import pack as pack
from .bench.door.python.layouts import unpack as unpack
from .bench.door.python.tables import Rows as Rows
from .encodings.codecs.codec import Codec as Codec
from .encodings.codecs.encoding import Encoding as Encoding
from .encodings.storages.storage import Storage as Storage

Named = str | Encoding | Storage
Names = Named | Sequence[Named | float] | Mapping[str, Any]

def pick(
    *,
    storage: Names = ...,
    bytes: Names | None = ...,
    rounding: Names = ...,
    encoding: Names = ...,
    against: Names | None = ...,
    normals: Names | None = ...,
    scene: Names = ...,
    power: Names = ...,
    effects: Names | None = ...,
    family: Names = ...,
    aim: Names = ...,
    readers: int = ...,
    worth: float = ...,
    enough: float = ...,
    accept_holes: bool = ...,
    accept_lengths: bool = ...,
    look_ups: bool = ...,
    most_instructions: int | None = ...,
    domain: Names | None = ...,
    needs: Names | None = ...,
    survey: bool = ...,
    count: int = ...,
    seed: int = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    channels: Names | None = ...,
    unpack: bool | None = ...,
    curve: Names = ...,
    normalise: bool = ...,
    space: Names = ...,
    code_space: Names = ...,
    view_matrix: Names | None = ...,
    mask: Names | None = ...,
    nan_share: float = ...,
    fov: float | None = ...,
    size: Names = ...,
    on: str | None = ...,
) -> Rows:
    """Which code to take for each storage, at what price, and what to take instead.

    Codes that do not meet the constraints are left out, with the reason. Of the others a code may cost twice as much if it is --worth decibels better. The exit status is 1 where no code meets the constraints.

    Args:
        storage: Storages, comma-separated, or all; `normalbench list` shows them. Any bits are one too: unorm:9:7, snorm:12:12, unorm:4:4..16:16.
        bytes: Bytes of a texel, comma-separated: all storages of that size, not --storage.
        rounding: nearest, truncate, truncate_half; comma-separated, or all.
        encoding: Encodings or files of GLSL, HLSL, Slang or WGSL, comma-separated, or all; `normalbench list` shows them.
        against: Encodings or files of GLSL, HLSL or Slang to compare with the answer, comma-separated, or all; `normalbench list` shows them.
        normals: Normal sets or files, comma-separated, or all; `normalbench list` shows them. Default: those of --domain.
        scene: Scenes, mesh files or captured frames (gbuffer.json), comma-separated, or all; `normalbench list` shows them.
        power: Specular powers that the scenes are rendered with, comma-separated.
        effects: Effects in the image, all at once, with settings: gtao:size=half,lpv.
        family: GPU families that issue slots are counted for, comma-separated; the dearest counts.
        aim: What a code must be good at: angle (the mean), worst (the largest angle), image (the lowest dB), or cost (cheap before exact).
        readers: Passes that decode: light, reflections, occlusion, denoiser. Encoding counts once.
        worth: The decibels that a code must gain for twice the price.
        enough: Degrees that a mirror's reflection may move. Default: a texel of a 1k environment map.
        accept_holes: Take codes whose largest angle is over 4 times the least.
        accept_lengths: Take codes whose decodes are not of length 1.
        look_ups: Take codes that read a look-up table, or leave them out.
        most_instructions: The most issue slots that encoding and decoding once may execute.
        domain: What the code must hold and is measured on: sphere, hemisphere (z >= 0), view (facing the viewer). Default: your normals.
        needs: What stored codes must survive: filter, blend, resolve, upsample; comma-separated, or all.
        survey: Measure too what a reader of the page may ask: each use of --needs, and other GPU families.
        count: Normals in a uniform set.
        seed: The random seed of uniform sets, points and scenes.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        channels: Captures: a layer, or the channels of x,y,z by name.
        unpack: Captures: [0,1] stands for [-1,1]. Default: for integers.
        curve: Captures: linear, srgb (to be undone), srgb-removed (to be redone).
        normalise: Captures: accept normals of any length.
        space: Captures: view, view-left-handed, world.
        code_space: Captures: the space that normals are encoded in: view, world.
        view_matrix: World to view space: 9 or 16 numbers by rows, or a file.
        mask: Captures: a file or a channel that is 0 on the background.
        nan_share: Captures: the share of NaN that is masked and counted.
        fov: Captures: vertical degrees, for per-pixel view space.
        size: WIDTHxHEIGHT of the picture of a mesh.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def budget(
    *,
    bytes: Names = ...,
    scene: Names = ...,
    environment: Names | None = ...,
    hold: Names = ...,
    speed: float = ...,
    targets: int = ...,
    formats: Names = ...,
    fields: bool = ...,
    integers: bool = ...,
    limit: Names | None = ...,
    light: Names = ...,
    threshold: float | None = ...,
    blend: Names | None = ...,
    read_alone: Names = ...,
    classes: Names = ...,
    overdraw: float = ...,
    readers: Names = ...,
    family: Names = ...,
    most_instructions: int | None = ...,
    size: Names = ...,
    against: Names | None = ...,
    engines: bool = ...,
    on: str | None = ...,
) -> Rows:
    """How few bytes a pixel does the whole G-buffer need, and which layout does it?

    Each code of each attribute is measured by itself, by what it does to the displayed image of mirrors, glossy and rough surfaces. An integer program then finds the codes and targets whose worst class is best, and the layout is drawn whole.

    Args:
        bytes: Bytes a pixel without native depth, comma-separated.
        scene: Metal/rough scenes that judge: ramps, studio, glTF files, and captured frames (gbuffer.json); comma-separated.
        environment: What they reflect: studio, sky, strips, lamp, or an .hdr or .exr file.
        hold: What is stored: normal, basecolor, roughness, metalness, specular, occlusion, tangent; motion in a target of its own, or motion:packed; id:BITS, flags:BITS, or either as id:stencil; shadow:BITS, custom:BITS, other:BITS; emission, or emission:light where the light buffer has it.
        speed: Pixels a frame at 1920 x 1080 up to which motion must be within 1/16 pixel, 0 to 500.
        targets: The most render targets that there may be.
        formats: Formats that targets may have, comma-separated, or all.
        fields: Allow several numbers to share a channel as bit fields.
        integers: Allow integer targets.
        limit: webgpu: its 32 bytes a sample and its formats; tile:16, tile:32, tile:64: a GPU's bytes a pixel in tiles.
        light: Format of the light buffer, which is drawn with the G-buffer: it counts for --limit.
        threshold: The fewest bytes whose FLIP (99th percentile) is at most this, in place of --bytes.
        blend: What decals blend into, such as basecolor,roughness,normal.
        read_alone: What a pass reads by itself: at most 4 bytes for each, in targets with nothing else of 16 bits; or none.
        classes: Classes of surfaces that judge: mirror, glossy, rough, emissive; or all.
        overdraw: How often a pixel is written.
        readers: The passes that read the G-buffer, comma-separated: a number of passes that read all of it, or all for one of them, and for each other pass its attributes, such as 1,normal+roughness.
        family: GPU families that issue slots are counted for, comma-separated; the dearest counts.
        most_instructions: The most issue slots that packing and unpacking once may execute.
        size: WIDTHxHEIGHT of the image.
        against: Layouts to compare with: presets, or TOML files of yours; comma-separated.
        engines: Whether engines' layouts are measured as well.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def quality(
    *,
    encoding: Names = ...,
    storage: Names = ...,
    rounding: Names = ...,
    arithmetic: Names = ...,
    normals: Names = ...,
    backend: Names = ...,
    count: int = ...,
    seed: int = ...,
    worst_case: bool = ...,
    codes: bool = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    channels: Names | None = ...,
    unpack: bool | None = ...,
    curve: Names = ...,
    normalise: bool = ...,
    space: Names = ...,
    code_space: Names = ...,
    view_matrix: Names | None = ...,
    mask: Names | None = ...,
    nan_share: float = ...,
    fov: float | None = ...,
    size: Names = ...,
    on: str | None = ...,
) -> Rows:
    """What each codec loses of the normals of a set: MSE, PSNR, angles, effective bits.

    A set may be a file: a captured frame (EXR, PNG, TIFF, DDS, HDR, WebP, NPY), a mesh seen by a camera (glTF, GLB, OBJ, PLY, STL, OFF), its vertex normals in object space (mesh.glb#vertices), or a point cloud (PLY).

    Args:
        encoding: Encodings or files of GLSL, HLSL, Slang or WGSL, comma-separated, or all; `normalbench list` shows them.
        storage: Storages, comma-separated, or all; `normalbench list` shows them. Any bits are one too: unorm:9:7, snorm:12:12, unorm:4:4..16:16.
        rounding: nearest, truncate, truncate_half, dithered; comma-separated, or all.
        arithmetic: What codes are computed in: float (32 bits), half (every step rounded to 16 bits), or declared: float, and half as well for a file that declares half, min16float, float16_t or mediump; comma-separated, or all.
        normals: Normal sets or files, comma-separated, or all; `normalbench list` shows them. `domain` is all that a code is made for: sphere and axes, or hemisphere.
        backend: jax, glsl, wgsl; comma-separated, or all.
        count: Normals in a uniform set.
        seed: The random seed of uniform sets, points and scenes.
        worst_case: The true supremum and where it is, in float64; seconds a codec.
        codes: Codes unused, duplicate, unstable, of up to 2^24; seconds a codec.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        channels: Captures: a layer, or the channels of x,y,z by name.
        unpack: Captures: [0,1] stands for [-1,1]. Default: for integers.
        curve: Captures: linear, srgb (to be undone), srgb-removed (to be redone).
        normalise: Captures: accept normals of any length.
        space: Captures: view, view-left-handed, world.
        code_space: Captures: the space that normals are encoded in: view, world.
        view_matrix: World to view space: 9 or 16 numbers by rows, or a file.
        mask: Captures: a file or a channel that is 0 on the background.
        nan_share: Captures: the share of NaN that is masked and counted.
        fov: Captures: vertical degrees, for per-pixel view space.
        size: WIDTHxHEIGHT of the picture of a mesh.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def render(
    *,
    pipeline: Names = ...,
    layout: Names | None = ...,
    encoding: Names | None = ...,
    storage: Names | None = ...,
    rounding: Names | None = ...,
    light_buffer: Names = ...,
    light_targets: Names = ...,
    scene: Names = ...,
    power: Names | None = ...,
    effects: Names | None = ...,
    shadow: Names = ...,
    exposure: Names | None = ...,
    tone_mapping: Names | None = ...,
    environment: Names | None = ...,
    specular_antialiasing: Names = ...,
    least_roughness: float = ...,
    size: Names = ...,
    samples: int = ...,
    scale: float = ...,
    objects: int = ...,
    lights: int = ...,
    frames: int = ...,
    repeats: int = ...,
    seed: int = ...,
    flip: bool = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """What codecs, layouts and light buffers do to the final image, against the same pipeline in fp32.

    Without --layout every encoding lies in rgba8 in an otherwise exact G-buffer. With --layout and none of --encoding, --storage and --rounding the layouts are measured as they are.

    Args:
        pipeline: Pipelines, comma-separated, or all; `normalbench list` shows them.
        layout: Layouts: names or TOML files.
        encoding: Encodings or files to put into each layout, comma-separated, or all.
        storage: Storages of the codes, or all. Default: rgba8.
        rounding: nearest, truncate, truncate_half, dithered; or all. Default: nearest.
        light_buffer: Light buffers or files of yours, comma-separated, or all; `normalbench list` shows them. Any bits are one too: ufloat:6:9, linear/unorm:10:10:10.
        light_targets: 1, 2; comma-separated, or all.
        scene: Scenes, mesh files or captured frames (gbuffer.json), comma-separated, or all; `normalbench list` shows them.
        power: Specular powers of all materials, comma-separated. Default: each material's own.
        effects: Effects in the image, all at once, with settings: gtao:size=half,lpv.
        shadow: on, off; comma-separated, or all.
        exposure: Stops, or auto: clip 1 % at most. Default: the scene's own, and auto for files.
        tone_mapping: none, reinhard or aces. Default: aces for metal/rough scenes.
        environment: What metal/rough scenes reflect: studio, sky, strips, lamp, or an .hdr or .exr file. Default: studio.
        specular_antialiasing: on, off: whether metal/rough surfaces become rougher where a pixel sees many normals.
        least_roughness: The least roughness that lights see; what lies around is mirrored to 0.
        size: WIDTHxHEIGHT of the image.
        samples: Samples per pixel; the device may give more.
        scale: Size of inferred's buffers relative to the image's, up to 1.
        objects: Objects in the scene `objects`.
        lights: Point lights.
        frames: Moments to average over. 0: as the scene has it.
        repeats: Frames that times are taken over; of render, 0 takes none.
        seed: The random seed of uniform sets, points and scenes.
        flip: FLIP as well, a perceptual difference; a second a row.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def mix(
    *,
    encoding: Names = ...,
    storage: Names = ...,
    operation: Names = ...,
    normals: Names = ...,
    angle: Names = ...,
    edge: Names = ...,
    backend: Names = ...,
    samples: int = ...,
    power: float = ...,
    count: int = ...,
    worst_case: bool = ...,
    seed: int = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    channels: Names | None = ...,
    unpack: bool | None = ...,
    curve: Names = ...,
    normalise: bool = ...,
    space: Names = ...,
    code_space: Names = ...,
    view_matrix: Names | None = ...,
    mask: Names | None = ...,
    nan_share: float = ...,
    fov: float | None = ...,
    size: Names = ...,
    on: str | None = ...,
) -> Rows:
    """What happens to a code when texels meet: filtering, mip levels, multisample resolve and blending.

    The verdict of each codec: filterable, blendable, resolvable, or why not. `pick --needs filter,blend,resolve` leaves out codecs that are not.

    Args:
        encoding: Encodings or files of GLSL, HLSL, Slang or WGSL, comma-separated, or all; `normalbench list` shows them.
        storage: Storages, comma-separated, or all; `normalbench list` shows them. Any bits are one too: unorm:9:7, snorm:12:12, unorm:4:4..16:16.
        operation: filter, mip_2x2, mip_4x4, resolve, resolve_decoded, blend, blend_decoded, detail, upsample; comma-separated, or all.
        normals: Normal sets or files, comma-separated, or all; `normalbench list` shows them.
        angle: Degrees between neighbours, comma-separated. Images have their own neighbours.
        edge: Degrees across an edge through a patch, comma-separated, or none. Images have their own edges.
        backend: jax, glsl; comma-separated, or all.
        samples: Samples per pixel that are resolved; the device may give more.
        power: The specular power that Toksvig's formula starts from.
        count: Mixes of each set and angle.
        worst_case: The worst mix of each operation, by search; seconds a codec.
        seed: The random seed of uniform sets, points and scenes.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        channels: Captures: a layer, or the channels of x,y,z by name.
        unpack: Captures: [0,1] stands for [-1,1]. Default: for integers.
        curve: Captures: linear, srgb (to be undone), srgb-removed (to be redone).
        normalise: Captures: accept normals of any length.
        space: Captures: view, view-left-handed, world.
        code_space: Captures: the space that normals are encoded in: view, world.
        view_matrix: World to view space: 9 or 16 numbers by rows, or a file.
        mask: Captures: a file or a channel that is 0 on the background.
        nan_share: Captures: the share of NaN that is masked and counted.
        fov: Captures: vertical degrees, for per-pixel view space.
        size: WIDTHxHEIGHT of the picture of a mesh.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def maps(
    *,
    encoding: Names = ...,
    block: Names = ...,
    swizzle: Names = ...,
    normals: Names = ...,
    decoder: Names = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    channels: Names | None = ...,
    unpack: bool | None = ...,
    curve: Names = ...,
    normalise: bool = ...,
    space: Names = ...,
    code_space: Names = ...,
    view_matrix: Names | None = ...,
    mask: Names | None = ...,
    nan_share: float = ...,
    fov: float | None = ...,
    size: Names = ...,
    on: str | None = ...,
) -> Rows:
    """What block compression loses of a normal map: BC5, BC7, EAC RG11 and ASTC 4x4.

    A normal map is an image file (PNG, EXR, TIFF, DDS, HDR, WebP, NPY). The encoders are packages: pip install normalbench[maps].

    Args:
        encoding: Encodings or files of GLSL, HLSL, Slang or WGSL, comma-separated, or all; `normalbench list` shows them.
        block: none, bc5, bc7, eac_rg11, astc_4x4; comma-separated, or all.
        swizzle: rg, rrrg, dxt5nm, rgb; those with room for the code are used.
        normals: Image files of normals, or bumps (smooth), grain (noise), playground; comma-separated.
        decoder: model, device; comma-separated, or all.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        channels: Captures: a layer, or the channels of x,y,z by name.
        unpack: Captures: [0,1] stands for [-1,1]. Default: for integers.
        curve: Captures: linear, srgb (to be undone), srgb-removed (to be redone).
        normalise: Captures: accept normals of any length.
        space: Captures: view, view-left-handed, world.
        code_space: Captures: the space that normals are encoded in: view, world.
        view_matrix: World to view space: 9 or 16 numbers by rows, or a file.
        mask: Captures: a file or a channel that is 0 on the background.
        nan_share: Captures: the share of NaN that is masked and counted.
        fov: Captures: vertical degrees, for per-pixel view space.
        size: WIDTHxHEIGHT of the picture of a mesh.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def cost(
    *,
    encoding: Names = ...,
    isa: bool = ...,
    time: bool = ...,
    article: bool = ...,
    family: Names = ...,
    stage: Names = ...,
    operation: Names = ...,
    arithmetic: Names = ...,
    storage: Names = ...,
    size: Names | None = ...,
    repeats: int = ...,
    count: int = ...,
    seed: int = ...,
    normals: Names = ...,
    error: Names = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """What encoding and decoding cost: instructions on GPUs of five vendors, and time; all of it by default.

    Counts are by Mesa's compilers, and by NVIDIA's of CUDA, for GPUs that need not be there, less an empty kernel that moves the same numbers.

    Args:
        encoding: Encodings or files of GLSL, HLSL, Slang or WGSL, comma-separated, or all; `normalbench list` shows them.
        isa: Instructions that compilers make of the GLSL; needs no GPU.
        time: Nanoseconds a megapixel on the GL device.
        article: The figures of Pranckevicius' article next to them.
        family: GPUs, comma-separated: polaris10, vega10, navi10, navi21, navi31, or radeon for these; hsw (Haswell), bdw (Broadwell), skl (Skylake), tgl (Tiger Lake), adl (Alder Lake), dg2 (Arc A770), or intel for these; sm_75 (Turing), sm_86 (Ampere), sm_89 (Ada), sm_90 (Hopper), sm_100 (Blackwell B200), sm_120 (Blackwell), or nvidia for these; a630 (Adreno 630), a650 (Adreno 650), a660 (Adreno 660), v3d42 (V3D 4.2, Raspberry Pi 4), or mobile for these, whose drivers you build; all.
        stage: fragment, compute; comma-separated, or all.
        operation: encode, decode; comma-separated, or all.
        arithmetic: What codes are computed in: float (32 bits), half (every step rounded to 16 bits), or declared: float, and half as well for a file that declares half, min16float, float16_t or mediump; comma-separated, or all.
        storage: Storages and packings whose own cost is shown, comma-separated, or all.
        size: WIDTHxHEIGHT of the target that is timed. Default: 64x64 in software, or 1024x1024.
        repeats: Repetitions that medians are taken over.
        count: --plot: normals in uniform sets.
        seed: The random seed of uniform sets, points and scenes.
        normals: --plot: normal sets, comma-separated, or all; `normalbench list` shows them.
        error: --plot: psnr, mean or max, the largest angle.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def roofline(
    *,
    encoding: Names = ...,
    storage: Names = ...,
    gpu: Names = ...,
    size: Names = ...,
    reads: Names = ...,
    overdraw: float = ...,
    cache_share: float = ...,
    shared: bool = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """Bytes saved against instructions spent: which code is faster on which GPU, by a model.

    A code's bytes take memory bandwidth. Its instructions, as `cost --isa` counts them, take arithmetic. The longer of the two is its time. Nothing is timed, and the GPUs need not be there.

    Args:
        encoding: Encodings or files of GLSL, HLSL, Slang or WGSL, comma-separated, or all; `normalbench list` shows them.
        storage: Storages, comma-separated, or all; `normalbench list` shows them. Any bits are one too: unorm:9:7, snorm:12:12, unorm:4:4..16:16.
        gpu: GPUs, comma-separated, or all: rx480 (Radeon RX 480), vega64 (Radeon RX Vega 64), rx5700xt (Radeon RX 5700 XT), rx6800xt (Radeon RX 6800 XT), rx7900xtx (Radeon RX 7900 XTX), series_x (Xbox Series X), steam_deck (Steam Deck), hd530 (HD Graphics 530, two channels of DDR4-2133), iris_xe (Iris Xe of a Core i7-1185G7, LPDDR4x-4266), a770 (Arc A770), rtx2080 (GeForce RTX 2080), rtx3080 (GeForce RTX 3080), rtx4090 (GeForce RTX 4090), rtx5090 (GeForce RTX 5090). NAME:memory=400 changes a rate; known: lanes, clock (GHz), memory (GB/s), cache (MB), cached (GB/s). A family with these is a GPU of that family.
        size: WIDTHxHEIGHT of the G-buffer, comma-separated.
        reads: Passes that read and decode each pixel's normal, comma-separated.
        overdraw: How often each pixel's normal is encoded and written.
        cache_share: The share of the last-level cache that normals may have, 0 to 1.
        shared: Something else uses the rest of each texel: bytes are those of a code's own bits.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def effects(
    *,
    effect: Names = ...,
    pipeline: Names = ...,
    encoding: Names | None = ...,
    storage: Names = ...,
    rounding: Names = ...,
    depth: Names | None = ...,
    layout: Names | None = ...,
    scene: Names | None = ...,
    size: Names = ...,
    objects: int = ...,
    lights: int = ...,
    rays: int = ...,
    repeats: int = ...,
    seed: int = ...,
    flip: bool = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """How much of a code's error arrives in effects that read the G-buffer: ambient occlusion and others.

    Every normal code lies in an otherwise exact layout, and every depth code in one with exact normals. A layout is measured as it is.

    Args:
        effect: Effects to measure, each alone, with settings: gtao:size=half; comma-separated, or all.
        pipeline: Pipelines, comma-separated, or all; `normalbench list` shows them.
        encoding: Encodings or files, each in an exact layout; comma-separated, or all.
        storage: Storages of the codes, comma-separated, or all; `normalbench list` shows them.
        rounding: nearest, truncate, truncate_half, dithered; comma-separated, or all.
        depth: Depth codes as CODE/STORAGE, each in an exact layout, or none. Default: linear/packed16,window/depth24,window/depth32f.
        layout: Layouts: names or TOML files.
        scene: Scenes, mesh or frame files. Default: what shows the effect.
        size: WIDTHxHEIGHT of the image.
        objects: Objects in the scene `objects`.
        lights: Point lights.
        rays: Rays for each of 4096 pixels, for the method's own error; 0 for none.
        repeats: Frames that times are taken over; of render, 0 takes none.
        seed: The random seed of uniform sets, points and scenes.
        flip: FLIP as well, a perceptual difference; a second a row.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def motion(
    *,
    encoding: Names = ...,
    storage: Names = ...,
    rounding: Names = ...,
    space: Names = ...,
    moves: Names = ...,
    axis: Names = ...,
    turn: Names = ...,
    picture_turn: Names | None = ...,
    frames: int = ...,
    count: int = ...,
    size: Names = ...,
    lights: int = ...,
    seed: int = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """How much a code's error changes from frame to frame while the camera or an object turns.

    A code in view space is another one in each frame of a turning camera, so highlights wobble; a code in world space stays. Measured of the normals, of highlights and of the displayed image.

    Args:
        encoding: Encodings or files of GLSL, HLSL, Slang or WGSL, comma-separated, or all; `normalbench list` shows them.
        storage: Storages, comma-separated, or all; `normalbench list` shows them. Any bits are one too: unorm:9:7, snorm:12:12, unorm:4:4..16:16.
        rounding: nearest, truncate, truncate_half; comma-separated, or all.
        space: view, world: the space that normals are encoded in; comma-separated, or all. Of several spaces a code is measured in those that it is made for.
        moves: camera, object: what turns; comma-separated, or all.
        axis: yaw, pitch, roll; comma-separated, or all.
        turn: Degrees a frame, comma-separated.
        picture_turn: Those of --turn that frames are rendered of as well; none: no frames. Default: the one nearest to 0.25.
        frames: Frames of a sequence.
        count: Normals whose codes are followed. Frames take longer; --picture-turn none leaves them out.
        size: WIDTHxHEIGHT of the image.
        lights: Point lights.
        seed: The random seed of uniform sets, points and scenes.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def roughness(
    *,
    encoding: Names = ...,
    storage: Names = ...,
    rounding: Names = ...,
    object: Names = ...,
    environment: Names = ...,
    threshold: Names = ...,
    size: Names = ...,
    dither: Names = ...,
    frames: Names | None = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """From which roughness on a normal code carries reflections: a mirror shows each step of a code, a dull surface none.

    A sphere and two panels of a metal that reflects all light fill the picture one by one, under three environments. A code carries a roughness where FLIP's 99th percentile is at most --threshold there and at every greater roughness, on the worst of objects and environments. 0.1 is what we call acceptable and 0.05 invisible: both are conventions.

    Args:
        encoding: Encodings or files of GLSL, HLSL, Slang or WGSL, comma-separated, or all; `normalbench list` shows them.
        storage: Storages, comma-separated, or all; `normalbench list` shows them. Any bits are one too: unorm:9:7, snorm:12:12, unorm:4:4..16:16.
        rounding: nearest, truncate, truncate_half; comma-separated, or all.
        object: sphere, panel20, panel4; comma-separated, or all.
        environment: studio, strips, lamp, sky, or .hdr and .exr files; comma-separated.
        threshold: FLIP's 99th percentile that a code may have, comma-separated.
        size: WIDTHxHEIGHT of the image.
        dither: Noise before rounding, besides none: still, moving; comma-separated, or all.
        frames: Frames whose mean a picture is, comma-separated. Default: 1; with --dither 1,8.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def lights(
    *,
    experiment: Names = ...,
    light_buffer: Names = ...,
    light_targets: Names = ...,
    sums: Names = ...,
    counts: Names = ...,
    peaks: Names = ...,
    samples: Names = ...,
    pipeline: Names = ...,
    scene: Names = ...,
    power: Names = ...,
    size: Names = ...,
    objects: int = ...,
    lights: int = ...,
    seed: int = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """What light buffers lose: adding lights up, banding, rebuilt colour, antialiasing, and the final image.

    The model, in JAX, stands next to what the GL device does. Without a GL device the model is measured alone.

    Args:
        experiment: equal, random, banding, chromaticity, resolve, image; or all.
        light_buffer: Light buffers or files of yours, comma-separated, or all; `normalbench list` shows them. Any bits are one too: ufloat:6:9, linear/unorm:10:10:10.
        light_targets: 1, 2; comma-separated, or all.
        sums: equal: what the lights sum to; random: the least.
        counts: equal, random: numbers of lights.
        peaks: banding: the light at a lamp's centre.
        samples: resolve: samples per pixel.
        pipeline: Pipelines, comma-separated, or all; `normalbench list` shows them.
        scene: Scenes, mesh files or captured frames (gbuffer.json), comma-separated, or all; `normalbench list` shows them.
        power: image: specular powers.
        size: WIDTHxHEIGHT of the image.
        objects: Objects in the scene `objects`.
        lights: Point lights.
        seed: The random seed of uniform sets, points and scenes.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def depth(
    *,
    depth: Names = ...,
    storage: Names | None = ...,
    rounding: Names = ...,
    rebuild: Names | None = ...,
    near: Names = ...,
    far: Names = ...,
    distance: Names | None = ...,
    fov: float | None = ...,
    depths: Names | None = ...,
    channel: Names | None = ...,
    depths_are: Names = ...,
    depth_unit: float = ...,
    backend: Names = ...,
    count: int = ...,
    seed: int = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """How far off a position is that was rebuilt from a stored depth, at distances and over the whole range.

    Errors are distances in the unit of --near and --far, of points anywhere on the screen; a distance stands for depths up to a sixteenth of it nearer or farther. --depths measures the depths of your own image.

    Args:
        depth: Depth codes or files of yours, comma-separated, or all; `normalbench list` shows them.
        storage: Depth storages, comma-separated, or all; `normalbench list` shows them. Default: each code's usual.
        rounding: nearest, truncate, truncate_half, dithered; comma-separated, or all.
        rebuild: inverse_projection, projection_terms, eye_ray; comma-separated, or all. Default: each code's usual.
        near: Near planes, comma-separated.
        far: Far planes, comma-separated.
        distance: Distances, comma-separated. Default: every power of ten.
        fov: Vertical field of view in degrees. Default: 60, of a 16:9 image; of --depths none, points lie on the view axis.
        depths: Images of depths to measure, in place of made ones: EXR, TIFF, PNG, NPY.
        channel: Depth images: the channel. Default: the one called so, or the only one.
        depths_are: Depth images: view (along the view axis), or the depth code that they are in: window, reversed_window, linear.
        depth_unit: Depth images: what 1 is in the unit of --near; 0.001 for millimetres.
        backend: jax, glsl; comma-separated, or all.
        count: Points at each distance.
        seed: The random seed of uniform sets, points and scenes.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def frames(
    *,
    encoding: Names = ...,
    storage: Names | None = ...,
    rounding: Names = ...,
    frames: Names = ...,
    backend: Names = ...,
    count: int = ...,
    seed: int = ...,
    worst_case: bool = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """What tangent frame codes lose: the angles of normals, of tangents and of the whole rotation, and lost handedness.

    A set may be a mesh (glTF, GLB, OBJ, PLY): the tangent frames of its vertices, authored or along its uv.

    Args:
        encoding: Tangent frame codes or files of yours, comma-separated, or all; `normalbench list` shows them.
        storage: Tangent frame storages, comma-separated, or all; `normalbench list` shows them. Default: each code's usual.
        rounding: nearest, truncate, truncate_half, dithered; comma-separated, or all.
        frames: Tangent frame sets or mesh files, whose vertices are taken, comma-separated, or all; `normalbench list` shows them.
        backend: jax, glsl; comma-separated, or all.
        count: Tangent frames in a uniform set.
        seed: The random seed of uniform sets, points and scenes.
        worst_case: The true largest rotation, by search in float64; seconds a code.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def vectors(
    *,
    encoding: Names = ...,
    storage: Names | None = ...,
    rounding: Names = ...,
    backend: Names = ...,
    speed: Names = ...,
    size: Names = ...,
    range: Names = ...,
    count: int = ...,
    seed: int = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """How exact motion vectors are in compact targets: errors in pixels over the speed, what slow motion is lost, and how far reprojected points drift.

    A motion is in screens a frame. Fixed-point storages keep motions up to the range. `_centred` is UNORM with an exact code for no motion, as engines store it.

    Args:
        encoding: Motion codes or files of yours, comma-separated, or all; `normalbench list` shows them.
        storage: Motion storages, comma-separated, or all; `normalbench list` shows them. Default: each code's usual.
        rounding: nearest, truncate, truncate_half, dithered; comma-separated, or all.
        backend: jax, glsl; comma-separated, or all.
        speed: Speeds in pixels a frame, comma-separated.
        size: WIDTHxHEIGHT of the image.
        range: Largest motions that are kept, in screens a frame, comma-separated.
        count: Points that move, each for 16 frames.
        seed: The random seed of uniform sets, points and scenes.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def curves(
    *,
    encoding: Names = ...,
    storage: Names | None = ...,
    rounding: Names = ...,
    backend: Names = ...,
    range: Names | None = ...,
    count: int = ...,
    seed: int = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """How exact roughness, metalness, occlusion and channels of colours are in few bits: on a curve, over a range, rounded, cut off or dithered.

    A curve lies in the first channel of a storage. `unorm:5` is five bits.

    Args:
        encoding: Curves or files of yours, comma-separated, or all; `normalbench list` shows them.
        storage: Storages, comma-separated, or all; `normalbench list` shows them. Default: each curve's usual.
        rounding: nearest, truncate, truncate_half, dithered; comma-separated, or all.
        backend: jax, glsl; comma-separated, or all.
        range: Largest quantities that are kept, comma-separated. Default: each curve's usual.
        count: Quantities, one at random in each of as many steps to the range.
        seed: The random seed of uniform sets, points and scenes.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def sweep(
    *,
    pipeline: Names = ...,
    objects: Names = ...,
    shadow: Names = ...,
    layout: Names | None = ...,
    light_buffer: Names = ...,
    light_targets: Names = ...,
    size: Names = ...,
    samples: int = ...,
    scale: float = ...,
    lights: int = ...,
    repeats: int = ...,
    seed: int = ...,
    define: Names | None = ...,
    prelude: Names | None = ...,
    include: Names | None = ...,
    language: Names | None = ...,
    all_pairs: bool = ...,
    on: str | None = ...,
) -> Rows:
    """How each pipeline's passes grow with the number of objects: light pre-pass against hybrid and the others.

    Args:
        pipeline: Pipelines, comma-separated, or all; `normalbench list` shows them.
        objects: Numbers of objects, comma-separated.
        shadow: on, off; comma-separated, or all.
        layout: Layouts: names or TOML files.
        light_buffer: Light buffers or files of yours, comma-separated, or all; `normalbench list` shows them. Any bits are one too: ufloat:6:9, linear/unorm:10:10:10.
        light_targets: 1, 2; comma-separated, or all.
        size: WIDTHxHEIGHT of the image; auto: 640x480, or 320x240 on a software rasteriser.
        samples: Samples per pixel; the device may give more.
        scale: Size of inferred's buffers relative to the image's, up to 1.
        lights: Point lights.
        repeats: Frames that times are taken over; of render, 0 takes none.
        seed: The random seed of uniform sets, points and scenes.
        define: Shader files: macros, NAME or NAME=VALUE.
        prelude: Shader files: files that are put in front.
        include: Shader files: where includes lie: FOLDER, or NAME=FOLDER of NAME/file.
        language: Shader files: hlsl, slang, glsl or wgsl. Default: by the ending.
        all_pairs: Shader files: each encoder that its decoder undoes, not one.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def tune(
    *,
    encoding: Names = ...,
    normals: Names = ...,
    storage: Names = ...,
    parameter: Names = ...,
    error: Names = ...,
    count: int = ...,
    seed: int = ...,
    channels: Names | None = ...,
    unpack: bool | None = ...,
    curve: Names = ...,
    normalise: bool = ...,
    space: Names = ...,
    code_space: Names = ...,
    view_matrix: Names | None = ...,
    mask: Names | None = ...,
    nan_share: float = ...,
    fov: float | None = ...,
    size: Names = ...,
    on: str | None = ...,
) -> Rows:
    """Fit an encoding's parameters and its numbers' bits to normals; what that gains on a half that was held out.

    What is found has a name that --encoding and --storage take in every command, such as stereographic:scale=1.31.

    Args:
        encoding: An encoding; `normalbench list encodings` shows them.
        normals: A normal set or a file of one.
        storage: A storage.
        parameter: An encoding's own; bits, table; comma-separated. Default: all there are.
        error: psnr, rms, mean or max, the largest angle.
        count: Normals in a uniform set.
        seed: The random seed of uniform sets, points and scenes.
        channels: Captures: a layer, or the channels of x,y,z by name.
        unpack: Captures: [0,1] stands for [-1,1]. Default: for integers.
        curve: Captures: linear, srgb (to be undone), srgb-removed (to be redone).
        normalise: Captures: accept normals of any length.
        space: Captures: view, view-left-handed, world.
        code_space: Captures: the space that normals are encoded in: view, world.
        view_matrix: World to view space: 9 or 16 numbers by rows, or a file.
        mask: Captures: a file or a channel that is 0 on the background.
        nan_share: Captures: the share of NaN that is masked and counted.
        fov: Captures: vertical degrees, for per-pixel view space.
        size: WIDTHxHEIGHT of the picture of a mesh.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def published(
    *,
    source: Names = ...,
    on: str | None = ...,
) -> Rows:
    """Figures of articles and engines, measured anew: what is printed, what is measured here, and why they differ.

    A figure that is neither reproduced nor explained makes the exit status 1.

    Args:
        source: Words of the sources' names, comma-separated, such as cigolle,2010; or all.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """

def devices(
    *,
    devices: Names = ...,
    facts: bool = ...,
    on: str | None = ...,
) -> Rows:
    """What readers' devices make of each codec: codes that differ from the run's, angles and times. With --facts, how they round, filter, resolve and compute.

    A device file is what the live section of a page saves by "Save this device".

    Args:
        devices: Device files, or folders of them, comma-separated.
        facts: Show how each device rounds, filters, resolves and computes, in place of its codecs.
        on: Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT.
    """
