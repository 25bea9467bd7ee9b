#include "render/passes/mirrors.h"

#include "engine/base/clock.h"

namespace catena::render {

Result<std::shared_ptr<const GridMirror>> Mirrors::get(const field::ScalarGrid& grid, const MirrorOptions& options) {
  Entry& entry = entries_[Key{grid.version(), options.float32, options.layout}];
  entry.used = frame_;
  if (!entry.mirror) {
    const std::int64_t start = now_ns();
    auto built = make_grid_mirror(device_, grid, options);
    if (!built) {
      entries_.erase(Key{grid.version(), options.float32, options.layout});
      return built.error();
    }
    entry.mirror = std::make_shared<const GridMirror>(std::move(*built));
    build_ms_ += ms_since(start);
  }
  return entry.mirror;
}

void Mirrors::drop_unused() {
  std::erase_if(entries_, [this](const auto& item) { return item.second.used != frame_; });
}

}  // namespace catena::render
