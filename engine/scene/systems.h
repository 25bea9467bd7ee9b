/// Systems: free functions over the world, run by the frame between the tick's news and the picture. Frame thread only.
#pragma once
#include "engine/exchange/haptic_state.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// The cursor follows the newest haptic state: probe, proxies, which of them hold, force (world axes, N). A state whose probe
/// is not finite leaves the cursor where it was.
void update_cursor(Scene& scene, const exchange::HapticState& state);

}  // namespace catena::scene
