/// ShaderReload is `--shaders DIR`: what changes there is drawn with, without starting anew. What does not compile is said in one line, and
/// the last shader that did stays. Frame thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "render/passes/renderer.h"
#include "render/shader_compiler/compile_shader.h"

namespace catena::app {

class ShaderReload {
 public:
  /// DIR: the folder `shaders` of the sources, or a copy of it.
  static Result<ShaderReload> open(const std::string& folder);
  /// Looks at the files at most four times a second. True: the next picture differs.
  bool poll(render::Renderer& renderer, std::int64_t now_ns);
  /// The newest shaders cannot be drawn with: the embedded ones again, and `why` on stderr. False: nothing was replaced.
  bool fall_back(render::Renderer& renderer, const std::string& why);

 private:
  explicit ShaderReload(render::ShaderWatcher watch) : watch_(std::move(watch)) {}
  render::ShaderWatcher watch_;
  std::optional<std::int64_t> last_poll_ns_;
  bool replaced_ = false;
};

}  // namespace catena::app
