/// The mirrors that frames use, keyed by (grid version, texel format, layout), dropped when a frame no longer names them.
#pragma once
#include <map>
#include <memory>
#include <tuple>

#include "render/mirror/grid_mirror.h"

namespace catena::render {

class Mirrors {
 public:
  explicit Mirrors(vk::Device& device) : device_(device) {}
  /// Builds it at the first call.
  Result<std::shared_ptr<const GridMirror>> get(const field::ScalarGrid& grid, const MirrorOptions& options);
  void begin_frame() { ++frame_; }
  void drop_unused();
  std::size_t count() const { return entries_.size(); }
  double build_ms() const { return build_ms_; }

 private:
  using Key = std::tuple<std::uint64_t, bool, MirrorLayout>;
  struct Entry {
    std::shared_ptr<const GridMirror> mirror;
    std::uint64_t used = 0;
  };
  vk::Device& device_;
  std::map<Key, Entry> entries_;
  std::uint64_t frame_ = 0;
  double build_ms_ = 0;
};

}  // namespace catena::render
