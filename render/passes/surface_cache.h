/// Isosurfaces that are kept from picture to picture (RenderSettings::keep): while they, the eye and the lights stay as they are, no ray
/// looks for them again, whatever else moves before or behind them. Holds their colours, depths and ids, 20 bytes a pixel, from the first
/// picture that asks for it on. The picture is the same to the bit. Frame thread only.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "render/vk/commands.h"
#include "render/vk/pipeline.h"
#include "shaders/shared/frame.h"

namespace catena::render {

class SurfaceCache {
 public:
  /// What pictures of surfaces follow from: the data of each as its shader gets them, and a count of all else.
  struct Key {
    std::vector<shared::FrameData> surfaces;
    std::uint64_t version = 0;
    bool matches(const Key& other) const;
  };

  /// Room for a picture; an error where there is no memory for it, nothing is kept then.
  Outcome ensure(vk::Device& device, const VkExtent3D& picture);
  /// After fit(), not within a pass. `draw` draws the surfaces into opaque targets that hold nothing else; it is asked only where `look` is
  /// new.
  Outcome update(vk::Commands& commands, Key look, const std::function<Outcome()>& draw);
  /// CellFinder a pass over the picture's opaque targets. `frame`: of the picture.
  Outcome draw(vk::Device& device, vk::Commands& commands, const shared::FrameData& frame);
  /// Whether the last update() had nothing to do.
  bool reused_previous() const { return reused_previous_; }

 private:
  vk::Image color_, depth_, id_, depth_buffer_;
  std::optional<Key> key_;  ///< of what the images hold
  bool reused_previous_ = false;
  vk::Pipeline pipeline_;
  vk::Buffer uniform_;
};

}  // namespace catena::render
