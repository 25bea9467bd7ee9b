// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Projection of a paged volume (projection.frag).
#include "shaders/shared/frame.h"
#include "shaders/shared/fast_volume.h"
layout(scalar, binding = 0) uniform Frame { FrameData frame; };
#define BRICK_SIZE 8
#include "shaders/lib/rays.glsl"
#include "shaders/lib/tables.glsl"
const float seen_transmittance = 1.0;
#define HAS_NUMBERS
#include "shaders/lib/paged.glsl"

layout(constant_id = 1) const uint HAS_OPAQUE = 0;
layout(constant_id = 2) const uint PROJECTION_KIND = 1;  // 1 maximum, 2 minimum, 3 average
layout(binding = 2) uniform texture2D opaque_depth;
layout(location = 0) out vec4 out_color;  // premultiplied

#include "shaders/lib/projection_paged.glsl"
float field_value(float code) { return frame.grids[0].value_offset + frame.grids[0].value_scale * code; }
#include "shaders/lib/project.glsl"
