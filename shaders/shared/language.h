// SPDX-License-Identifier: MIT
// Shared structs: the headers of this folder are compiled as C++ (GLM types) and as GLSL with scalar block layout, which place members at
// the same offsets. No booleans, no arrays of unknown length, only 32-bit scalars, vectors and matrices.
#ifndef CATENA_SHARED_LANGUAGE_H
#define CATENA_SHARED_LANGUAGE_H
#ifdef __cplusplus

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#define CATENA_SHARED_BEGIN          \
  namespace catena::render::shared { \
  using glm::mat3;                   \
  using glm::vec2;                   \
  using glm::vec3;                   \
  using glm::vec4;                   \
  using uint = std::uint32_t;
#define CATENA_SHARED_END }

#else
#define CATENA_SHARED_BEGIN
#define CATENA_SHARED_END
#endif
#endif
