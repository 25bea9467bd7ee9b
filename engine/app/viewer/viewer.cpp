#include "engine/app/viewer/viewer.h"

#include <fmt/format.h>

#include "engine/app/viewer/session.h"
#include "engine/base/text.h"

namespace catena::app {

int view(ViewOptions options) {
  Session session(std::move(options));
  auto failure = session.open();
  if (!failure) failure = session.run();
  if (failure) fmt::print(stderr, "catena: {}\n", printable(failure->message));
  return failure ? failure->exit_code : 0;
}

}  // namespace catena::app
