// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Several volumes and translucent isosurfaces.
#include "shaders/shared/frame.h"
#define NO_CUBIC
#define GRID_COUNT MAX_GRIDS
#include "shaders/lib/blend.glsl"
