"""Save the G-buffer of a RenderDoc capture for normalbench: every target and the depth as EXR, matrices as text.

In RenderDoc, open the capture, then Window > Python Shell > Run Scripts. The folder `gbuffer` is created next to the
capture. Or:

    python3 save_gbuffer.py FRAME.rdc [FOLDER] [EVENT]

with RenderDoc's Python module (Debian: apt-get install python3-renderdoc). EVENT is the number of the draw after
which targets are read. By default it is the last draw into the targets that most draws with two or more targets
write.

At the end the script prints the commands that measure the saved files. `gbuffer.json` lists the contents of each
file, for `normalbench budget --scene`. RenderDoc's own EXR files hold half floats; the files saved here hold 32-bit
floats. The script needs RenderDoc 1.18 or newer, Python 3.6, and nothing else.
"""

import json
import math
import re
import struct
import sys
from array import array
from pathlib import Path

DEPTH = "depth.exr"
FARTHEST = 1e9  # in place of a far plane that is infinitely far
# A channel of each file: 1 where the depth is not that of the background.
COVERED = "covered"
# A target holds normals where nine tenths of what is covered have such a length.
LEAST, MOST, SHARE = 0.97, 1.03, 0.9
FLOATS = {2: "e", 4: "f", 8: "d"}
# By names of targets, what they hold where they are called after one quantity: and that of a number or a colour.
NUMBERS = {"roughness": "rough", "smoothness": "smooth|gloss", "metallic": "metal", "ao": "occlusion|\\bao\\b"}
COLOURS = {"base_color": "base_?colou?r|albedo", "emissive": "emissi"}
# What is left for people to say. F0 is what is reflected head on, which targets called specular seldom hold.
QUANTITIES = ("depth", "normal", "base_color", "roughness", "metallic", "f0", "ao", "emissive")
NEEDED = ("fov", "near", "far", "depth", "normal", "base_color", "roughness")
# Unreal's targets, where there are all three; its specular of 1 reflects 0.08.
UNREAL = re.compile(r"gbuffer_?([abc])$", re.I)
# Normals that are looked at for what space they are in, and by how much more of them must face the camera.
LOOKED_AT, MORE = 4096, 0.02


# Numbers of a texture


def shares(data, code, largest):
    """Return integers in `data`, of array type `code`, as a list of floats: fractions of `largest`, not below -1."""
    return [max(value / largest, -1.0) for value in little(code, data)]


def little(code, data):
    """Return the little-endian numbers in `data` as an array of type `code`, such as "H" for 16-bit integers."""
    numbers = array(code)
    numbers.frombytes(bytes(data))
    if sys.byteorder == "big":
        numbers.byteswap()
    return numbers


def small_float(bits, mantissa):
    """Return the float that an integer's bits encode: a 5-bit exponent above `mantissa` bits, without a sign bit."""
    exponent, fraction = bits >> mantissa, bits & ((1 << mantissa) - 1)
    if exponent == 0:
        return fraction * 2.0 ** (-14 - mantissa)
    if exponent == 31:
        return float("nan") if fraction else float("inf")
    return (1 + fraction / (1 << mantissa)) * 2.0 ** (exponent - 15)


def regular(data, kind, width):
    """Return the numbers of all channels, pixel by pixel: floats and integers unchanged, UNorm and SNorm as fractions
    of the largest integer. Each channel has `width` bytes."""
    if kind == "Float":
        return struct.unpack(f"<{len(data) // width}{FLOATS[width]}", data)
    signed = kind in ("SNorm", "SInt", "SScaled")
    code = {1: "b", 2: "h", 4: "i"}[width]
    code = code if signed else code.upper()
    if kind in ("UInt", "SInt", "UScaled", "SScaled"):
        return [float(value) for value in little(code, data)]
    return shares(data, code, 2 ** (8 * width - (1 if signed else 0)) - 1)


def planes(data, layout, kind, width, count, bgra=False):
    """Return a list of numbers for each channel, in the order R, G, B, A. Raises ValueError for other layouts.

    Args:
        layout: Regular, R10G10B10A2 or R11G11B10, as RenderDoc names it.
        kind: the component type, such as UNorm or Float.
        width: the number of bytes per channel.
        count: the number of channels.
    """
    if layout == "R10G10B10A2":
        words = little("I", data)
        scale = 1.0 if kind == "UInt" else 1 / 1023.0
        channels = [[(word >> shift & 1023) * scale for word in words] for shift in (0, 10, 20)]
        channels.append([(word >> 30) * (1.0 if kind == "UInt" else 1 / 3.0) for word in words])
    elif layout == "R11G11B10":
        words = little("I", data)
        eleven = [small_float(bits, 6) for bits in range(2048)]
        ten = [small_float(bits, 5) for bits in range(1024)]
        channels = [[eleven[word >> shift & 2047] for word in words] for shift in (0, 11)]
        channels.append([ten[word >> 22] for word in words])
    elif layout == "Regular":
        numbers = regular(data, kind, width)
        channels = [list(numbers[channel::count]) for channel in range(count)]
    else:
        raise ValueError(f"formats like {layout} are not supported")
    return [channels[2], channels[1], channels[0], *channels[3:]] if bgra else channels


def depths(data, pixels, kind, is_opengl):
    """Return the depths of a buffer of `pixels` pixels as a list of floats in [0, 1], without the stencil."""
    width = len(data) // pixels
    if width == 2:
        return shares(data, "H", 65535)
    if width == 8:
        return list(struct.unpack(f"<{2 * pixels}f", data)[::2])
    if kind == "D32":
        return list(struct.unpack(f"<{pixels}f", data))
    # 24 bits. OpenGL has them above the stencil, the others below.
    return [(word >> 8 if is_opengl else word & 0xFFFFFF) / 16777215.0 for word in little("I", data)]


def from_above(plane, width):
    """Return the numbers of a plane with its rows in reverse order, because OpenGL's first row is the bottom row."""
    rows = [plane[start : start + width] for start in range(0, len(plane), width)]
    return [value for row in reversed(rows) for value in row]


# Files


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def write_exr(path, width, height, channels):
    """Write an uncompressed EXR file of 32-bit floats; `channels` has lists of numbers by name, the top row first."""
    names = sorted(channels)
    described = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in names) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = b"\x76\x2f\x31\x01\x02\0\0\0" + b"".join(
        (
            attribute("channels", "chlist", described),
            attribute("compression", "compression", b"\0"),
            attribute("dataWindow", "box2i", box),
            attribute("displayWindow", "box2i", box),
            attribute("lineOrder", "lineOrder", b"\0"),
            attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
            attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0)),
            attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)),
            b"\0",
        )
    )
    size = 4 * width * len(names)
    first = len(header) + 8 * height
    with path.open("wb") as file:
        file.write(header)
        file.write(struct.pack(f"<{height}Q", *[first + row * (size + 8) for row in range(height)]))
        for row in range(height):
            file.write(struct.pack("<ii", row, size))
            for name in names:
                file.write(struct.pack(f"<{width}f", *channels[name][row * width : (row + 1) * width]))


def write_text(path, text):
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write(text + "\n")


def file_name(name, index, taken):
    """Return a file name for a texture, with the index in front if another target or the depth already has the
    name."""
    plain = f"{re.sub(r'[^A-Za-z0-9]+', '_', name).strip('_').lower() or 'target'}.exr"
    is_free = plain != DEPTH and plain not in [target["file"] for target in taken.values()]
    return plain if is_free else f"{index}_{plain}"


# What the numbers are


def covered(plane):
    """Return a mask of a depth plane: 0.0 at the background depth, 0 or 1, whichever is more common; else 1.0."""
    background = 1.0 if plane.count(1.0) >= plane.count(0.0) else 0.0
    return [0.0 if value == background else 1.0 for value in plane]


def normals_in(channels, mask):
    """Return "--no-unpack" for unit normals, "--unpack" for unit normals stored in [0, 1], and "" for anything else."""
    x, y, z = channels[:3]
    inside = [i for i, is_covered in enumerate(mask) if is_covered]
    for option, scale, bias in (("--no-unpack", 1, 0), ("--unpack", 2, -1)):
        lengths = [sum((plane[pixel] * scale + bias) ** 2 for plane in (x, y, z)) ** 0.5 for pixel in inside]
        good = sum(LEAST < length < MOST for length in lengths)
        if lengths and good >= SHARE * len(lengths):
            return option
    return ""


def facing(channels, option, mask, width, fov, turn):
    """Return the fraction, 0 to 1, of a sample of the covered normals that faces the camera after `turn`, the rows of
    a rotation to view space: x right, y up, z towards the viewer."""
    height, up = len(mask) // width, math.tan(math.radians(fov) / 2)
    scale, bias = (2, -1) if option == "--unpack" else (1, 0)
    inside = [i for i, is_covered in enumerate(mask) if is_covered]
    inside = inside[:: max(1, len(inside) // LOOKED_AT)]
    front = 0
    for pixel in inside:
        n = [plane[pixel] * scale + bias for plane in channels[:3]]
        x, y, z = (sum(a * b for a, b in zip(row, n)) for row in turn)
        right = (2 * (pixel % width + 0.5) / width - 1) * up * width / height
        front += x * right + y * (1 - 2 * (pixel // width + 0.5) / height) * up < z
    return front / max(len(inside), 1)


def space_of(channels, option, mask, width, fov, matrices):
    """Return {"space": ..., "view_matrix": ...} for the first space in which about as many normals face the camera as
    in the best space; without a matrix if the space has none."""
    same, into = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[1, 0, 0], [0, 1, 0], [0, 0, -1]]
    known = [({"space": "view"}, same), ({"space": "view-left-handed"}, into)]
    for name in views(matrices)[:1]:
        turn = [row[:3] for row in matrices[name][:3]]
        # Where view space has z into the screen.
        mirrored = [turn[0], turn[1], [-value for value in turn[2]]]
        matrix = {"view_matrix": file_of_matrix(name)}
        known = [
            (dict(space, **other), axes) for (space, axes), other in zip(known, (matrix, {"view_matrix": mirrored}))
        ]
        known += [(dict(space="world", **matrix), turn), ({"space": "world", "view_matrix": mirrored}, mirrored)]
    shares = [facing(channels, option, mask, width, fov, turn) for _, turn in known]
    return next(space for (space, _), share in zip(known, shares) if share >= max(shares) - MORE)


def views(matrices):
    """Return the names of the rotations that turn world space into view space, judging by the names."""
    return [
        name
        for name, rows in matrices.items()
        if re.search("view", name, re.I) and not re.search("inv|prev", name, re.I) and is_rotation(rows)
    ]


def camera_of(matrices, is_opengl):
    """Return the vertical field of view in degrees and the near and far planes of the first perspective projection;
    None if no matrix is a perspective projection."""
    for rows in matrices.values():
        ends = planes_of_projection(rows, -1.0 if is_opengl else 0.0)
        if ends:
            return math.degrees(2 * math.atan(1 / abs(rows[1][1]))), ends[0], ends[1]
    return None


def guessed(targets):
    """Return the quantities that the targets' names reveal, each with its file and channels as in a description;
    an empty dict if the names reveal none."""
    letters = {
        match.group(1).lower(): buffer for name, buffer in targets.items() for match in [UNREAL.search(name)] if match
    }
    if set("abc") <= set(letters):
        b, c = letters["b"]["file"], letters["c"]["file"]
        return {
            "metallic": {"file": b, "channel": "R"},
            "f0": {"file": b, "channel": "G", "scale": 0.08},
            "roughness": {"file": b, "channel": "B"},
            "base_color": {"file": c, "channels": "R,G,B", "curve": "srgb"},
        }
    kept = {}
    for name, target in targets.items():
        words = {**NUMBERS, **COLOURS}
        called = [quantity for quantity, word in words.items() if re.search(word, name, re.I)]
        if called and called[0] in NUMBERS and len(called) == 1 == len(target["channels"]):
            kept.setdefault(called[0], {"file": target["file"], "channel": "R"})
        elif called and called[0] in COLOURS and len(called) == 1 and len(target["channels"]) >= 3:
            curve = "srgb" if "SRGB" in target["format"].upper() else "linear"
            kept.setdefault(called[0], {"file": target["file"], "channels": "R,G,B", "curve": curve})
    return kept


def description(targets, camera, has_depth):
    """Return the description for `normalbench budget --scene`: the known facts about the frame, and null for the
    rest."""
    scene: dict = {"fov": None, "near": None, "far": None, "view_matrix": None}
    scene.update((name, None) for name in QUANTITIES)
    if camera:
        fov, near, far = camera
        planes = {"fov": fov, "near": min(near, far), "far": min(max(near, far), FARTHEST)}
        # The digits that a matrix of float32 has.
        scene.update((name, float(f"{value:.6g}")) for name, value in planes.items())
    if camera and has_depth:
        code = "window" if camera[1] < camera[2] else "reversed_window"
        scene["depth"] = {"file": DEPTH, "channel": "Z", "depths_are": code}
    for target in targets.values():
        if target["normals"] and not scene["normal"]:
            scene["view_matrix"] = target["space"].get("view_matrix")
            scene["normal"] = {"file": target["file"], "channels": "R,G,B", "unpack": target["normals"] == "--unpack"}
            scene["normal"].update({"space": target["space"]["space"], "mask": COVERED})
    scene.update(guessed(targets))
    if "smoothness" in scene:
        del scene["roughness"]
    return scene


def say(text):
    """Print text to standard output; control characters in a capture's names are shown as escape sequences."""
    print("".join(letter if letter.isprintable() or letter == "\n" else repr(letter)[1:-1] for letter in text))


def say_description(folder, scene, targets):
    """Print the quantities that were guessed and those that the user has to fill in. Return the `normalbench budget`
    command as text, commented out if the command needs one of the missing quantities."""
    where = folder / "gbuffer.json"
    held = [
        f"{name} ({source['file']} {source.get('channel') or source['channels']})"
        for name, source in guessed(targets).items()
    ]
    if held:
        say(f"{where}: guessed from the targets' names: {', '.join(held)}")
    lacks = [name for name in scene if scene[name] is None and name != "view_matrix"]
    if lacks:
        say(
            f"{where}: null marks unknown values: {', '.join(lacks)}. "
            'Write {"file": "FILE.exr", "channel": "R"}, or "channels": "R,G,B" for a colour'
        )
    needed = [name for name in NEEDED if name in lacks]
    command = f"normalbench budget --bytes 12,16 --scene {where}"
    return f"# once you have filled in {', '.join(needed)}: {command}" if needed else command


def planes_of_projection(rows, lowest):
    """Return the distances of the near and far planes of a projection matrix, given by rows; None if the matrix is
    not a perspective projection. With reversed depth, the first distance is the larger.

    Args:
        lowest: the depth of the near plane after the perspective division: -1 in OpenGL, else 0.
    """
    towards = rows[3][2]
    if abs(abs(towards) - 1) > 1e-5 or rows[3][3] or not rows[2][3] or not rows[1][1]:
        return None
    slope = rows[2][2] / towards
    near, far = (rows[2][3] / (end - slope) if abs(end - slope) > 1e-9 else math.inf for end in (lowest, 1.0))
    return (near, far) if near > 0 and far > 0 else None


def is_rotation(rows):
    """Whether a matrix, given by rows, has an orthonormal upper left 3 x 3 block and the last row 0, 0, 0, 1."""
    turn = [row[:3] for row in rows[:3]]
    products = [sum(a * b for a, b in zip(row, other)) for row in turn for other in turn]
    return rows[3] == [0.0, 0.0, 0.0, 1.0] and all(abs(p - (i % 4 == 0)) < 1e-3 for i, p in enumerate(products))


def measuring(folder, targets, matrices, has_depth, is_opengl):
    """Return lines of commands and comments that measure the saved normals and depth; empty if neither is known."""
    camera = camera_of(matrices, is_opengl)
    fov = f" --fov {camera[0]:.6g}" if camera else ""
    lines = []
    for target in targets.values():
        if target["normals"]:
            lines += of_normals(folder, target, matrices, (f" --mask {COVERED}" if has_depth else "") + fov)
    return lines + ([of_depth(folder, camera[1], camera[2], fov)] if has_depth and camera else [])


def of_normals(folder, target, matrices, options):
    """Return lines for a target with normals: the command, and a comment for each view matrix with the options to add
    if the normals are in world space."""
    read = f"--normals {folder / target['file']} {target['normals']}{options}"
    lines = [f"normalbench quality {read} --storage rg8,rgb10a2 --encoding octahedral"]
    for name in views(matrices):
        world = f"--space world --view-matrix {folder / file_of_matrix(name)}"
        lines.append(f"# if the normals are in world space, add: {world}")
    return lines


def of_depth(folder, near, far, fov):
    """Return the command for the depth buffer. A far plane nearer than the near plane means reversed depth."""
    code = "window" if near < far else "reversed_window"
    ends = f"--near {min(near, far):.6g} --far {min(max(near, far), FARTHEST):.6g}"
    read = f"--depths {folder / DEPTH} --depths-are {code} {ends}{fov}"
    return f"normalbench depth {read} --depth window,reversed_window,linear"


def file_of_matrix(name):
    return re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_") + ".txt"


# What RenderDoc knows


def all_actions(actions):
    for action in actions:
        yield action
        yield from all_actions(action.children)


def targets_of(action, rd):
    return tuple(int(output) for output in action.outputs if output != rd.ResourceId.Null())


def chosen(controller, rd, event):
    """Return the draw after which targets are read: the draw with event number `event` or, for None, the last draw
    into the set of targets that most draws write. Exit with a message if no draw qualifies."""
    draws = [action for action in all_actions(controller.GetRootActions()) if action.flags & rd.ActionFlags.Drawcall]
    if event is not None:
        draws = [draw for draw in draws if draw.eventId == event]
        return draws[0] if draws else sys.exit(f"no draw has event number {event}")
    several = [draw for draw in draws if len(targets_of(draw, rd)) > 1] or [
        draw for draw in draws if targets_of(draw, rd)
    ]
    if not several:
        sys.exit("no draw in the capture writes to a render target")
    sets = [targets_of(draw, rd) for draw in several]
    most = max(sets, key=sets.count)
    return [draw for draw in several if targets_of(draw, rd) == most][-1]


def constants(controller, rd):
    """Return all 4 x 4 float matrices in the constant buffers of the draw's vertex and pixel shaders, as rows, by
    name."""
    state, matrices = controller.GetPipelineState(), {}
    for stage in (rd.ShaderStage.Vertex, rd.ShaderStage.Pixel):
        reflection = state.GetShaderReflection(stage)
        for index, _ in enumerate(reflection.constantBlocks if reflection else ()):
            for variable in block(controller, state, stage, index):
                add_matrices(matrices, variable, rd)
    return matrices


def block(controller, state, stage, index):
    """Return RenderDoc's variables for a shader stage's constant buffer, given the buffer's index."""
    if hasattr(state, "GetConstantBlock"):  # RenderDoc 1.32 and newer
        used = state.GetConstantBlock(stage, index, 0).descriptor
        place = (used.resource, used.byteOffset, used.byteSize)
    else:
        used = state.GetConstantBuffer(stage, index, 0)
        place = (used.resourceId, used.byteOffset, used.byteSize)
    pipeline = state.GetGraphicsPipelineObject()
    shader = (state.GetShader(stage), stage, state.GetShaderEntryPoint(stage))
    return controller.GetCBufferVariableContents(pipeline, shader[0], shader[1], shader[2], index, *place)


def add_matrices(matrices, variable, rd):
    if variable.rows == 4 and variable.columns == 4 and variable.type == rd.VarType.Float:
        numbers = list(variable.value.f32v[:16])
        matrices.setdefault(variable.name, [numbers[start : start + 4] for start in (0, 4, 8, 12)])
    for member in variable.members:
        add_matrices(matrices, member, rd)


def name_of(kind, value):
    """Return RenderDoc's name for a value of the enumeration class `kind`."""
    return next(name for name in dir(kind) if name[:1].isupper() and getattr(kind, name) == value)


class Saving:
    """The outputs of one draw of a capture, saved to a folder."""

    def __init__(self, controller, rd, folder, event):
        self.controller, self.rd, self.folder = controller, rd, folder
        self.action = chosen(controller, rd, event)
        controller.SetFrameEvent(self.action.eventId, True)
        self.is_opengl = controller.GetAPIProperties().pipelineType == rd.GraphicsAPI.OpenGL
        self.textures = {int(texture.resourceId): texture for texture in controller.GetTextures()}
        self.names = {int(resource.resourceId): resource.name for resource in controller.GetResources()}
        self.found = constants(controller, rd)
        self.camera = camera_of(self.found, self.is_opengl)
        folder.mkdir(parents=True, exist_ok=True)

    def data_of(self, texture):
        """Return the bytes of a texture's first mip level, slice and sample."""
        return bytes(self.controller.GetTextureData(texture.resourceId, self.rd.Subresource(0, 0, 0)))

    def upright(self, plane, texture):
        return from_above(plane, texture.width) if self.is_opengl else plane

    def write(self, name, texture, channels, says=""):
        write_exr(self.folder / name, texture.width, texture.height, channels)
        say(f"{name}: {self.names[int(texture.resourceId)]}, {texture.format.Name()}{says}")

    def depth(self):
        """Write the depth and a mask of the covered pixels to a file. Return the mask; None without a depth
        buffer."""
        texture = self.textures.get(int(self.action.depthOut))
        if texture is None:
            return None
        form = texture.format.Name()[:3]
        plane = depths(self.data_of(texture), texture.width * texture.height, form, self.is_opengl)
        plane = self.upright(plane, texture)
        mask = covered(plane)
        self.write(DEPTH, texture, {"Z": plane, COVERED: mask})
        return mask

    def planes(self, texture):
        """Return a list of numbers for each channel of a target. Raises ValueError for unsupported formats."""
        form = texture.format
        layout, kind = name_of(self.rd.ResourceFormatType, form.type), name_of(self.rd.CompType, form.compType)
        channels = planes(self.data_of(texture), layout, kind, form.compByteWidth, form.compCount, form.BGRAOrder())
        return [self.upright(plane, texture) for plane in channels]

    def target(self, texture, name, mask):
        """Write a target to the file `name`. Return the known facts about the target: file, format, normals, channels
        and, for unit normals, space."""
        channel_planes = self.planes(texture)
        pixels = len(channel_planes[0])
        own = mask if mask and len(mask) == pixels else [1.0] * pixels
        normals = normals_in(channel_planes, own) if len(channel_planes) >= 3 else ""
        channels = dict(zip("RGBA", channel_planes))
        channels[COVERED] = own
        self.write(name, texture, channels, ", unit normals" if normals else "")
        kept = {
            "file": name,
            "format": texture.format.Name(),
            "normals": normals,
            "channels": "RGBA"[: len(channel_planes)],
        }
        if normals:
            fov = self.camera[0] if self.camera else 60.0
            kept["space"] = space_of(channel_planes, normals, own, texture.width, fov, self.found)
        return kept

    def targets(self, mask):
        """Write all targets, and return the facts about each target, by its name in the capture. Skip targets in
        unsupported formats with a message."""
        kept = {}
        for index, number in enumerate(targets_of(self.action, self.rd)):
            name = self.names[number]
            try:
                kept[name] = self.target(self.textures[number], file_name(name, index, kept), mask)
            except ValueError as why:
                say(f"skipped {name}: {why}")
        return kept

    def matrices(self):
        """Write each matrix of the draw's shaders to a text file, by rows. Return all matrices, by name."""
        for name, rows in self.found.items():
            lines = [" ".join(f"{value:.9g}" for value in row) for row in rows]
            write_text(self.folder / file_of_matrix(name), "\n".join(lines))
            say(f"{file_of_matrix(name)}: {name}, row by row")
        return self.found


def save(controller, rd, folder, event=None):
    """Save a draw's depth, targets and matrices, and a description of them, to a folder. Print the commands that
    measure the saved files. If `event` is None, choose the draw by its targets."""
    saving = Saving(controller, rd, folder, event)
    mask = saving.depth()
    targets = saving.targets(mask)
    matrices = saving.matrices()
    lines = measuring(folder, targets, matrices, mask is not None, saving.is_opengl)
    scene = description(targets, saving.camera, mask is not None)
    kept = {"event": saving.action.eventId, "targets": targets, "matrices": matrices, "commands": lines}
    write_text(folder / "gbuffer.json", json.dumps({**scene, "capture": kept}, indent=1))
    if not any(target["normals"] for target in targets.values()):
        say(
            "No target holds unit normals. If a target holds encoded normals, have your shader write the decoded "
            "normals to a float target."
        )
    say("\n".join([*lines, say_description(folder, scene, targets)]))


def opened(rd, path):
    """Return an opened capture file and its replay controller. Exit with a message if it cannot be replayed."""
    rd.InitialiseReplay(rd.GlobalEnvironment(), [])
    capture = rd.OpenCaptureFile()
    capture.OpenFile(path, "", None)
    status, controller = capture.OpenCapture(rd.ReplayOptions(), None)
    if controller is None:
        sys.exit(f"{path} cannot be replayed: {status}")
    return capture, controller


def main(words):
    import renderdoc as rd  # pyright: ignore[reportMissingImports] # RenderDoc's own Python has it

    shell = globals().get("pyrenderdoc")
    if shell is not None:
        folder = Path(shell.GetCaptureFilename()).with_name("gbuffer")
        shell.Replay().BlockInvoke(lambda controller: save(controller, rd, folder))
        return
    if not words:
        sys.exit(__doc__)
    capture, controller = opened(rd, words[0])
    folder = Path(words[1] if len(words) > 1 else "gbuffer")
    save(controller, rd, folder, int(words[2]) if len(words) > 2 else None)
    controller.Shutdown()
    capture.Shutdown()
    rd.ShutdownReplay()


if __name__ == "__main__" or "pyrenderdoc" in globals():
    main(sys.argv[1:])
