/// Drawing says which picture of the scene comes next and what it is made of, whoever draws it and wherever it is shown: a window
/// (picture_view.h) or a browser (engine/app/serve). It remembers what the last one showed. Frame thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/viewer/shell/controls.h"
#include "engine/app/viewer/shell/pacing.h"
#include "engine/app/viewer/shell/pick.h"
#include "engine/app/viewer/shell/scene_host.h"
#include "render/passes/renderer.h"

namespace catena::app {

inline constexpr double kRestS = 0.25;  ///< without a change for so long: the picture may take its time

class Drawing {
 public:
  Drawing(SceneHost& scene, const Controls& controls, Pacing& pacing) : scene_(scene), controls_(controls), pacing_(pacing) {}

  // which one comes next, in a picture of that many pixels
  NextPicture best() { return pacing_.best(kind_); }
  NextPicture moving() { return pacing_.moving(kind_); }
  std::optional<NextPicture> still() { return pacing_.still(kind_); }
  /// After the hand has moved: as good as the last where rays meet what they met, else as while something moves.
  NextPicture followed(std::uint32_t width, std::uint32_t height);
  /// In time while something moves, better ones when it rests; nothing where the last one stands.
  std::optional<NextPicture> next(bool moved, bool hand_moved, std::uint32_t width, std::uint32_t height);
  /// Since what the picture shows has changed, seconds.
  double rest_s() const;
  /// It has changed now.
  void changed();

  /// Of the scene as it is now, for a picture of that many pixels.
  Result<render::FramePacket> packet(std::uint32_t width, std::uint32_t height) const;
  /// The same for this picture, each way so many pixels less; what followed() has made already is used.
  Result<render::FramePacket> packet(const NextPicture& next, std::uint32_t width, std::uint32_t height);
  /// What followed() has made is not wanted.
  void drop_ahead() { ahead_.reset(); }
  /// Where the error decides on the next picture: it is estimated.
  Outcome estimate_if_wanted(render::Renderer& renderer, const render::FramePacket& packet, const NextPicture& next);
  /// That packet was drawn.
  void drawn(render::FramePacket packet, const render::Renderer& renderer);
  /// What there is to draw in that packet: the next pictures are chosen by it.
  const SceneKind& look_at(const render::FramePacket& packet, const render::Renderer& renderer);
  /// Another scene: nothing of the last picture counts.
  void forget() { shown_.reset(); }

  const std::optional<render::FramePacket>& shown() const { return shown_; }
  /// What the last picture shows beside the hand, in shares of its width and height.
  std::optional<PickedPlace> picked_at(double x, double y) const;
  /// "isosurfaces[0]"; empty: an id of no item.
  std::string item_of(std::uint32_t id) const;

 private:
  std::uint32_t scale_of(const NextPicture& next) const;

  SceneHost& scene_;
  const Controls& controls_;
  Pacing& pacing_;
  std::optional<render::FramePacket> shown_;  ///< the last picture's
  std::optional<render::FramePacket> ahead_;  ///< the next one's, where followed() has made it
  SceneKind kind_;                            ///< the last picture's
  std::int64_t last_change_ns_ = 0;
};

}  // namespace catena::app
