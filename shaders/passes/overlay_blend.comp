#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define PICTURE_FORMAT rgba8
#include "shaders/lib/overlay_blend.glsl"
