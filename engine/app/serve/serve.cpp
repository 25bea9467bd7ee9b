#include "engine/app/serve/serve.h"

#include <unistd.h>

#include <optional>
#include <utility>

#include "engine/app/serve/serve_session.h"
#include "engine/app/viewer/shell/scene_files.h"
#include "engine/base/tell.h"

namespace catena::app {

namespace {

constexpr const char* kServePage =
#include "serve_page.inc"
    ;

/// What hears beyond this machine is said: nothing is encrypted.
void tell_exposure(const web::ServerOptions& server) {
  if (server.address == "127.0.0.1" || server.address == "::1") return;
  tell_from_catena("others can reach " + server.address + ", and what goes there is not encrypted: `ssh -L` is safer (docs/serve.md)");
}

}  // namespace

Outcome serve(ServeOptions options) {
  options.server.page = kServePage;
  CATENA_TRY(scene::Document document, scene::Document::open(options.source, options.overrides, {}, options.grid));
  CATENA_TRY(SceneHost scene, SceneHost::open(std::move(document), options.adjust));
  HandHost hand(options.hand);
  CATENA_CHECK(hand.open_device(scene.scene()));
  CATENA_TRY(const LoadedScene loaded, load_first(scene, hand, options.width, options.height));
  CATENA_TRY(PictureMaker maker, PictureMaker::open(options.gpu_memory));
  CATENA_TRY(const std::unique_ptr<web::Server> server, web::Server::open(options.server));
  const Interrupt interrupt;
  ServeSession session(options, loaded, scene, hand, *server, maker, interrupt);
  CATENA_CHECK(hand.start());
  tell_exposure(options.server);
  print_now(STDOUT_FILENO, server->url() + "\n");
  CATENA_CHECK(session.run());
  hand.stop();
  return interrupt.outcome();
}

}  // namespace catena::app
