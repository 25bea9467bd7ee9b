// SPDX-License-Identifier: MIT
// Time until an image of a store shows its bricks, first and after jumps of the camera: page_jump SCENE STORE MEMORY_MB. The store's files
// are dropped from the page cache before each jump. Frames are drawn one after the other, as in the window, and wait for no brick.
#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/base/clock.h"
#include "engine/base/memory_limit.h"
#include "render/extract/extract.h"
#include "render/passes/renderer.h"

namespace {

using namespace catena;

template <class T>
T get(Result<T> result) {
  if (result) return std::move(*result);
  fmt::print(stderr, "{}\n", result.error().message);
  std::exit(1);
}

void drop_from_page_cache(const std::string& folder) {
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder)) {
    if (!file.is_regular_file()) continue;
    const int opened = open(file.path().c_str(), O_RDONLY | O_CLOEXEC);
    if (opened < 0) continue;
    posix_fadvise(opened, 0, 0, POSIX_FADV_DONTNEED);
    close(opened);
  }
}

/// Returns the median time of frames from positions that differ little, ms.
double resident_frame(render::Renderer& renderer, render::FramePacket packet, const render::RenderSettings& settings) {
  constexpr int kFrames = 9;
  constexpr double kStep = 1e-4;  // of the distance
  std::vector<double> frames;
  for (int k = 0; k < kFrames; ++k) {
    packet.view.position += kStep * (packet.view.position - packet.view.target);
    const std::int64_t frame = now_ns();
    if (const Outcome drawn = renderer.draw(packet, settings); !drawn) get(Result<int>(drawn.error()));
    frames.push_back(ms_since(frame));
  }
  std::ranges::sort(frames);
  return frames[kFrames / 2];
}

/// Draws frames until all bricks are shown, and some after that; prints a row.
void refine(render::Renderer& renderer, const render::FramePacket& packet, const char* name) {
  constexpr double kShare = 0.95, kMaxS = 120;
  render::RenderSettings settings;
  settings.fast = render::FastSettings{2, 4, 8, 8};
  std::vector<double> frames;
  double at_share = -1;
  std::uint64_t visible = 0;
  int level = 0;
  const std::int64_t start = now_ns();
  for (bool done = false; !done && 1e-3 * ms_since(start) < kMaxS;) {
    const std::int64_t frame = now_ns();
    if (const Outcome drawn = renderer.draw(packet, settings); !drawn) get(Result<int>(drawn.error()));
    frames.push_back(ms_since(frame));
    const render::PagingStats pages = renderer.paging();
    visible = pages.visible;
    level = pages.finest_level;
    // the first image has no visits yet
    if (frames.size() > 2 && at_share < 0 && double(pages.resident) >= kShare * double(visible)) at_share = 1e-3 * ms_since(start);
    done = frames.size() > 2 && pages.resident == visible && !pages.is_loading && !pages.has_arrived;
  }
  const double total = 1e-3 * ms_since(start);
  std::ranges::sort(frames);
  fmt::print("{},{},{},{:.2f},{:.2f},{},{:.0f},{:.0f},{:.0f}\n", name, visible, level, at_share, total, frames.size(),
             frames[frames.size() / 2], frames.back(), resident_frame(renderer, packet, settings));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) {
    fmt::print(stderr, "usage: page_jump SCENE STORE MEMORY_MB\n");
    return 2;
  }
  set_memory_limit(std::uint64_t(std::atof(arguments[3]) * 1e6));
  scene::Scene scene = get(scene::read_scene(arguments[1]));
  render::FramePacket packet = get(render::make_frame(scene, 960, 740));
  const auto renderer = get(render::Renderer::create({}));
  fmt::print("view,bricks,coarsest level for lack of memory,95 % s,all s,frames,median frame ms,longest frame ms,frame once resident ms\n");
  drop_from_page_cache(arguments[2]);
  refine(*renderer, packet, "first");
  render::View view = packet.view;
  const Vec3 from = view.position - view.target;
  for (const auto& [name, scale] : {std::pair{"opposite", -1.0}, {"near", 0.45}, {"near and opposite", -0.45}}) {
    view.position = view.target + scale * from;
    render::set_view(scene, view, packet);
    drop_from_page_cache(arguments[2]);
    refine(*renderer, packet, name);
  }
  return 0;
}
