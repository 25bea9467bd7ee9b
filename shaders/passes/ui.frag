// SPDX-License-Identifier: MIT
#version 460
// Straight alpha, display values; blended over the window.
layout(binding = 1) uniform sampler2D image;
layout(location = 0) in vec2 in_texture;
layout(location = 1) in vec4 in_color;
layout(location = 0) out vec4 out_color;

void main() { out_color = in_color * texture(image, in_texture); }
