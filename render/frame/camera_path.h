// SPDX-License-Identifier: MIT
/// Camera animation through key frames, read from CSV: time t, position p, target t, and optionally up u and the vertical field of view.
///   t,px,py,pz,tx,ty,tz[,ux,uy,uz][,fovy]
/// Seconds (strictly rising), world units, degrees. Between keys: cubic Hermite curves through every key with Catmull-Rom tangents for
/// non-uniform times, m_i = (p_(i+1) - p_(i-1)) / (t_s_(i+1) - t_s_(i-1)), one-sided at both ends; up and fovy are linear. Before the first
/// key and after the last one the camera rests. Pure functions, any thread.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Key frame of a camera path: time, position and target (world units).
struct CameraKey {
  double t_s = 0;
  Vec3 position{0.0}, target{0.0};
  std::optional<Vec3> up;          ///< up vector; set in all keys or in none
  std::optional<double> fovy_deg;  ///< vertical field of view, degrees; set in all keys or in none
};

/// Interpolated camera path through at least one key. Immutable.
class CameraPath {
 public:
  /// Takes at least one key, with strictly rising times.
  explicit CameraPath(std::vector<CameraKey> keys);
  /// Returns `base` with position and target of the path at time `t_s`, and with up and field of view if the path has them.
  View at(const View& base, double t_s) const;
  /// Returns the time of the first key, seconds.
  double start_s() const { return keys_.front().t_s; }
  /// Returns the time between first and last key, seconds.
  double duration_s() const { return keys_.back().t_s - keys_.front().t_s; }

 private:
  std::vector<CameraKey> keys_;
};

/// Reads a camera path from a CSV file. An Error has the form "FILE:LINE: what; what was expected".
Result<CameraPath> read_camera_path(const std::string& path);
/// Parses CSV text; `file` is the name in error messages.
Result<CameraPath> parse_camera_path(std::string_view text, const std::string& file);

}  // namespace catena::render
