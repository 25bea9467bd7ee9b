// SPDX-License-Identifier: MIT
#include "render/raycast/render_settings.h"

namespace catena::render {

RenderSettings draft_settings() {
  RenderSettings s;
  s.step_voxels = 2;
  s.jitter = true;
  s.fast = FastSettings{2, 4, -1, -1};
  s.fast->smooth_gradients = true;
  s.fast->termination = 1.0 / 64;
  return s;
}

RenderSettings balanced_settings() {
  RenderSettings s;
  s.fast = FastSettings{1, 2, 0, 6};
  s.fast->smooth_gradients = true;
  return s;
}

RenderSettings reference_settings() {
  RenderSettings s;
  s.step_voxels = 0.1;
  s.termination = 1e-4;
  s.texel_format = TexelFormat::r32f;
  return s;
}

}  // namespace catena::render
