// SPDX-License-Identifier: MIT
// A picture of a scene, or of a bare data file: picture SCENE.json|DATA OUT.png
#include <cstdio>
#include <string>

#include "engine/scene/scene.h"
#include "render/extract/extract.h"
#include "render/passes/renderer.h"

using namespace catena;

Outcome draw(const std::string& path, const std::string& out) {
  CATENA_TRY(scene::Scene scene, path.ends_with(".json") ? scene::read_scene(path) : scene::scene_for_file(path));
  CATENA_TRY(const render::FramePacket packet, render::make_frame(scene, 320, 240));
  CATENA_TRY(const auto renderer, render::Renderer::create({}));
  CATENA_CHECK(renderer->draw(packet));
  CATENA_TRY(const render::Image8 picture, renderer->read_back());
  return render::write_png(out, picture, false);
}

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("picture SCENE.json|DATA OUT.png was expected\n", stderr), 2;
  if (const Outcome done = draw(argv[1], argv[2]); !done) return std::fprintf(stderr, "%s\n", done.error().message.c_str()), 2;
  return 0;
}
