#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// for RenderSettings::float_picture
#define PICTURE_FORMAT rgba32f
#include "shaders/lib/overlay_blend.glsl"
