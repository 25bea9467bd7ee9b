// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// One value per ray: the exact maximum or minimum along it, or the mean of the values at the middles of its segments.
#include "shaders/shared/frame.h"
#define GRID_COUNT 1
#include "shaders/lib/grids.glsl"
#include "shaders/lib/rays.glsl"
#include "shaders/lib/tables.glsl"

layout(constant_id = 1) const uint HAS_OPAQUE = 0;
layout(constant_id = 2) const uint PROJECTION_KIND = 1;  // 1 maximum, 2 minimum, 3 average
layout(binding = 2) uniform texture2D opaque_depth;
layout(location = 0) out vec4 out_color;  // premultiplied

#include "shaders/lib/projection.glsl"
float field_value(float v) { return v; }
#include "shaders/lib/project.glsl"
