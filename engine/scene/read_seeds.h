/// "seeds" of streamlines; read_seeds itself is in lines.h, as `trace` reads the same. Inside this room only.
#pragma once
#include "engine/scene/scene_keys.h"

namespace catena::scene {

Key seeds_key();
std::string write_seeds(const Scene& scene, const Seeds& seeds);

}  // namespace catena::scene
