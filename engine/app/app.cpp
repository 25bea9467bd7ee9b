#include "engine/app/app.h"

namespace catena::app {
int run(int, char**) { return 0; }
}  // namespace catena::app
