// A triangle of a reader's model, in the world's axes.
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
uniform mat3 to_view;
uniform vec3 eye;
uniform vec2 slope;
uniform vec2 depths;  // of the nearest and of the farthest surface that is drawn

out vec3 n;
out vec3 view;

void main() {
    n = to_view * normal;
    view = to_view * (place - eye);
    float near = depths.x, far = depths.y, z = -view.z;
    gl_Position = vec4(view.xy / slope, (z * (far + near) - 2.0 * far * near) / (far - near), z);
}
