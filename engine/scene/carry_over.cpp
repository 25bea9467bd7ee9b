#include "engine/scene/document.h"

namespace catena::scene {
// carried: see below
void carry_over(Scene&, Scene&) {}
}  // namespace catena::scene
