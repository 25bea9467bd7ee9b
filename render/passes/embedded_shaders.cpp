#include "render/passes/embedded_shaders.h"

namespace catena::render {
namespace {

#include "spirv/table.inc"

}  // namespace

std::span<const EmbeddedShader> embedded_shaders() { return kEmbedded; }

}  // namespace catena::render
