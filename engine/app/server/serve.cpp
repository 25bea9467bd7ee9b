// SPDX-License-Identifier: MIT
#include "engine/app/server/serve.h"

#include <unistd.h>

#include <optional>
#include <utility>

#include "engine/app/server/serve_session.h"
#include "engine/app/viewer/scene/scene_files.h"
#include "engine/base/console.h"

namespace catena::app {

namespace {

constexpr const char* kServePage =
#include "serve_page.inc"
    ;

/// Prints a warning if the server is reachable from other machines: nothing is encrypted.
void tell_exposure(const http::ServerOptions& server) {
  if (server.address == "127.0.0.1" || server.address == "::1") return;
  print_message("other machines can connect to " + server.address + " without encryption: `ssh -L` is safer (docs/user/browser.md)");
}

}  // namespace

Outcome serve(ServeOptions options) {
  options.server.page = kServePage;
  CATENA_TRY(scene::Document document, scene::Document::open(options.source, options.overrides, {}, options.grid));
  CATENA_TRY(SceneModel scene, SceneModel::open(std::move(document), options.adjust_scene));
  HapticSession hand(options.haptic_options);
  CATENA_CHECK(hand.open_device(scene.scene()));
  CATENA_TRY(const LoadedScene loaded, load_initial_scene(scene, hand, options.width, options.height));
  CATENA_TRY(FrameEncoder maker, FrameEncoder::open(options.gpu_memory));
  CATENA_TRY(const std::unique_ptr<http::Server> server, http::Server::open(options.server));
  const InterruptHandler interrupt;
  ServeSession session(options, loaded, scene, hand, *server, maker, interrupt);
  CATENA_CHECK(hand.start());
  tell_exposure(options.server);
  print_nonblocking(STDOUT_FILENO, server->url() + "\n");
  CATENA_CHECK(session.run());
  hand.stop();
  return interrupt.outcome();
}

}  // namespace catena::app
