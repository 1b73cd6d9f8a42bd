#version 430
// A VPL's intensity, flux / pi x cosine lobe, added to its cell; for each channel of light.

flat in vec3 flux;
flat in vec4 lobe;
layout(location = 0) out vec4 red;
layout(location = 1) out vec4 green;
layout(location = 2) out vec4 blue;

void main() {
    red = flux.r * PER_FLUX * lobe;
    green = flux.g * PER_FLUX * lobe;
    blue = flux.b * PER_FLUX * lobe;
}
