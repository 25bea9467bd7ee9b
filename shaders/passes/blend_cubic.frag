// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// blend.frag with support for cubic grids.
#include "shaders/shared/frame.h"
#define GRID_COUNT MAX_GRIDS
#include "shaders/lib/blend.glsl"
