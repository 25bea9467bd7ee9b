/// The shaders of the program by name, "compose.frag": what a viewer needs in order to put others in their place. Any thread.
#pragma once
#include <span>
#include <string_view>

#include "render/vk/pipeline.h"

namespace catena::render {

struct EmbeddedShader {
  std::string_view name;
  vk::Spirv words;
};

/// One for every file of shaders/passes, in the order of their names.
std::span<const EmbeddedShader> embedded_shaders();

}  // namespace catena::render
