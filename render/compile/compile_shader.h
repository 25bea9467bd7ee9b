/// GLSL to SPIR-V at run time, by the glslang library, as the build does it (Vulkan 1.3, SPIR-V 1.6). One thread at a time; the first call
/// in a process takes a few hundred milliseconds, the next ones a few.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena::render {

struct CompiledShader {
  std::vector<std::uint32_t> words;
  std::vector<std::string> files;  ///< the shader and all that it includes, from the folder, sorted
};

/// `folder` stands for `shaders/`: "passes/x.frag" is folder/passes/x.frag, and what it includes as "shaders/lib/y.glsl" is
/// folder/lib/y.glsl. The last part of the name says the stage: vert, frag, comp. Errors read "folder/passes/x.frag:12: what".
Result<CompiledShader> compile_shader(const std::string& folder, const std::string& name);

}  // namespace catena::render
