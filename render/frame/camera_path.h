/// A camera that moves through key frames, read from CSV: t, position p, target t, and optionally up u and the vertical field of view.
///   t,px,py,pz,tx,ty,tz[,ux,uy,uz][,fovy]
/// Seconds (strictly rising), world units, degrees. Between keys: cubic Hermite curves through every key with the tangents of
/// Catmull-Rom for uneven times, m_i = (p_(i+1) - p_(i-1)) / (t_s_(i+1) - t_s_(i-1)), one-sided at both ends; up and fovy are linear.
/// Before the first and after the last key the camera rests. Pure functions, any thread.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

struct CameraKey {
  double t_s = 0;
  Vec3 position{0.0}, target{0.0};
  std::optional<Vec3> up;          ///< in all keys or in none
  std::optional<double> fovy_deg;  ///< the same
};

class CameraPath {
 public:
  /// At least one key, t rising strictly.
  explicit CameraPath(std::vector<CameraKey> keys);
  /// `base` with the path's place, and its up and angle if the path has them.
  View at(const View& base, double t_s) const;
  double start_s() const { return keys_.front().t_s; }
  double duration_s() const { return keys_.back().t_s - keys_.front().t_s; }

 private:
  std::vector<CameraKey> keys_;
};

/// Errors: "FILE:LINE: what; what was expected".
Result<CameraPath> read_camera_path(const std::string& path);
Result<CameraPath> parse_camera_path(std::string_view text, const std::string& file);

}  // namespace catena::render
