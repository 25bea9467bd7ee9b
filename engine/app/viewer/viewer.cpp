#include "engine/app/viewer/viewer.h"

#include "engine/app/viewer/shell/session.h"
#include "engine/base/tell.h"

namespace catena::app {

int view(ViewOptions options) {
  Session session(std::move(options));
  auto failure = session.open();
  if (!failure) failure = session.run();
  if (failure) tell_from_catena(failure->message);
  return failure ? failure->exit_code : 0;
}

}  // namespace catena::app
