#include "engine/base/start_thread.h"

namespace catena {

Error no_thread(const std::string& what, const std::system_error& error) {
  return {what + ": no other thread can be started (" + error.code().message() +
              "); more processes (ulimit -u) or more memory (ulimit -v) were expected",
          true};
}

}  // namespace catena
