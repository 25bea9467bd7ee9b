// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/shader_reload.h"

#include <fmt/format.h>

#include <cstdio>

#include "engine/base/console.h"
#include "render/passes/pass.h"

namespace catena::app {
namespace {

constexpr std::int64_t kLookNs = 250'000'000;

}  // namespace

Result<ShaderReload> ShaderReload::open(const std::string& folder) {
  std::vector<std::string> names;
  for (const render::EmbeddedShader& shader : render::embedded_shaders()) names.emplace_back(shader.name);
  CATENA_TRY(render::ShaderWatcher watch, render::ShaderWatcher::open(folder, std::move(names)));
  return ShaderReload(std::move(watch));
}

bool ShaderReload::poll(render::Renderer& renderer, std::int64_t now_ns) {
  if (last_poll_ns_ && now_ns - *last_poll_ns_ < kLookNs) return false;
  last_poll_ns_ = now_ns;
  render::ShaderChanges changes = watch_.poll();
  for (const std::string& error : changes.errors) print_message(error);
  bool any = false;
  for (render::ChangedShader& shader : changes.changed) {
    const auto replaced = renderer.replace_shader(shader.name, std::move(shader.words));
    if (!replaced) print_message(replaced.error().message);
    if (!replaced || !*replaced) continue;
    fmt::print("{}: reloaded from the file\n", shader.name);
    any = true;
  }
  std::fflush(stdout);
  replaced_ = replaced_ || any;
  return any;
}

bool ShaderReload::fall_back(render::Renderer& renderer, const std::string& reason) {
  if (!replaced_) return false;
  print_message(reason + "; the shaders of the program are used");
  renderer.restore_shaders();
  replaced_ = false;
  return true;
}

}  // namespace catena::app
