"""A small OpenGL program that RenderDoc captures: a sphere in a G-buffer of three targets and a depth buffer.

Run it with RenderDoc's library loaded: `python captured_program.py PATH`. The capture's name begins with PATH.
"""

import ctypes
import sys

import moderngl
import numpy as np

SIZE = (160, 90)
NEAR, FAR, FOV = 0.1, 100.0, 60.0
DISTANCE = 3.0
VERTEX = """#version 430
in vec3 position;
uniform mat4 view_matrix, projection;
out vec3 normal;
void main() {
    normal = position;
    gl_Position = projection * view_matrix * vec4(position, 1.0);
}
"""
FRAGMENT = """#version 430
in vec3 normal;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 packed_normal;
layout(location = 2) out vec4 roughness;
void main() {
    albedo = vec4(1.0, 0.5, 0.25, 1.0);
    packed_normal = vec4(normalize(normal) * 0.5 + 0.5, 1.0);
    roughness = vec4(0.375);
}
"""
# Of the table of RenderDoc's functions, by their places in renderdoc_app.h.
SET_PATH, BEGIN, END = 11, 19, 21
VERSION = 10400


def functions():
    """Return RenderDoc's functions in this program."""
    table = ctypes.c_void_p()
    library = ctypes.CDLL("librenderdoc.so")
    assert library.RENDERDOC_GetAPI(VERSION, ctypes.byref(table)) == 1
    entries = ctypes.cast(table, ctypes.POINTER(ctypes.c_void_p))
    set_path = ctypes.CFUNCTYPE(None, ctypes.c_char_p)(entries[SET_PATH])
    begin = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(entries[BEGIN])
    end = ctypes.CFUNCTYPE(ctypes.c_uint32, ctypes.c_void_p, ctypes.c_void_p)(entries[END])
    return set_path, begin, end


def projection():
    """Return OpenGL's projection matrix, for column vectors."""
    focal = 1 / np.tan(np.radians(FOV) / 2)
    matrix = np.zeros((4, 4), np.float32)
    matrix[0, 0], matrix[1, 1] = focal * SIZE[1] / SIZE[0], focal
    matrix[2, 2], matrix[2, 3] = (FAR + NEAR) / (NEAR - FAR), 2 * FAR * NEAR / (NEAR - FAR)
    matrix[3, 2] = -1
    return matrix


def view():
    """Return the view matrix of a camera in front of the sphere, looking at it."""
    matrix = np.eye(4, dtype=np.float32)
    matrix[2, 3] = -DISTANCE
    return matrix


def sphere():
    """Return the sphere's triangles, with 64 steps around and 32 from pole to pole."""
    around, down = np.meshgrid(np.linspace(0, 2 * np.pi, 65), np.linspace(0, np.pi, 33))
    points = np.stack([np.sin(down) * np.cos(around), np.cos(down), np.sin(down) * np.sin(around)], -1)
    corners = [points[i : i + 32, j : j + 64] for i, j in ((0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1))]
    return np.stack(corners, 2).astype(np.float32)


def main(path):
    set_path, begin, end = functions()
    set_path(path.encode())
    context = moderngl.create_standalone_context(require=430, backend="egl")
    program = context.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
    program["projection"].write(projection().T.tobytes())
    program["view_matrix"].write(view().T.tobytes())
    targets = [
        context.texture(SIZE, 4),
        context.texture(SIZE, 4, internal_format=0x8059),  # GL_RGB10_A2
        context.texture(SIZE, 1, dtype="f2"),
    ]
    for target, name in zip(targets, ("albedo", "normal", "roughness"), strict=True):
        target.label = f"GBuffer {name}"
    frame = context.framebuffer(targets, context.depth_texture(SIZE))
    mesh = context.vertex_array(program, context.buffer(sphere().tobytes()), "position")
    begin(None, None)
    frame.use()
    frame.clear()
    context.enable(moderngl.DEPTH_TEST)
    mesh.render()
    context.finish()
    assert end(None, None) == 1


if __name__ == "__main__":
    main(sys.argv[1])
