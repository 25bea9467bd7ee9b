// SPDX-License-Identifier: MIT
/// Shader reloading, option `--shaders DIR`: changed shaders are used without a restart. If one does not compile, the error is reported in
/// one line and its last working version stays. Frame thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "render/passes/renderer.h"
#include "render/shader_compiler/compile_shader.h"

namespace catena::app {

/// Watches the folder and replaces shaders of the renderer.
class ShaderReload {
 public:
  /// Starts watching. `folder`: the folder `shaders` of the sources, or a copy of it. An Error if files are missing.
  static Result<ShaderReload> open(const std::string& folder);
  /// Checks the files, at most four times per second. Returns true if the next frame uses other shaders.
  bool poll(render::Renderer& renderer, std::int64_t now_ns);
  /// Call when rendering with the replaced shaders fails: restores the embedded ones and prints `reason` to stderr. Returns false if no
  /// shader was replaced.
  bool fall_back(render::Renderer& renderer, const std::string& reason);

 private:
  explicit ShaderReload(render::ShaderWatcher watch) : watch_(std::move(watch)) {}
  render::ShaderWatcher watch_;
  std::optional<std::int64_t> last_poll_ns_;
  bool replaced_ = false;
};

}  // namespace catena::app
