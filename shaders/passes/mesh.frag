#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/frame.h"

layout(scalar, binding = 0) uniform Frame { MeshFrameData frame; };
#include "shaders/lib/lighting.glsl"
layout(location = 0) in vec3 in_normal;
layout(location = 1) in vec3 in_color;
layout(location = 2) in vec3 in_view;
layout(location = 3) in float in_depth;
layout(location = 4) flat in uint in_id;
layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_id;

void main() {
  const vec3 towards_eye = frame.orthographic != 0u ? vec3(0.0, 0.0, -1.0) : -normalize(in_view);
  out_color = vec4(fogged(lit(in_color, in_normal, towards_eye), in_depth), 1.0);
  out_depth = in_depth;
  out_id = in_id;
}
