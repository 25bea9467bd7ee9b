// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Fast raycast of several channels of a paged volume.
#define HAS_CHANNELS
#include "shaders/lib/ray_grid.glsl"
