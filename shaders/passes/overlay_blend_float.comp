// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
layout(binding = 1, rgba32f) uniform image2D image;
#include "shaders/lib/overlay_blend.glsl"
