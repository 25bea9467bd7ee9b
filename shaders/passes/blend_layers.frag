// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// blend.frag with translucent layers. Fewer grids, because a device guarantees 32 push descriptors only.
#include "shaders/shared/frame.h"
#define NO_CUBIC
#define GRID_COUNT MAX_GRIDS_WITH_LAYERS
layout(constant_id = 4) const int LAYER_COUNT = 1;
#include "shaders/lib/layers.glsl"
#define HAS_LAYERS
#include "shaders/lib/blend.glsl"
