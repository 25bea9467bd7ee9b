// SPDX-License-Identifier: MIT
/// Poses of the user in a session with a headset, besides the probe: head, hands and gaze at the time when a frame is displayed, as
/// predicted by the runtime. Optional part of a recording (format.h, POSES); a recording without a headset has none. Meters of the stage
/// space, axes of the runtime; the gaze direction is -z.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/vec.h"

namespace catena::haptics::log {

/// Part of the user that a headset tracks.
enum class TrackedPart : std::size_t { head, left_hand, right_hand, gaze };
inline constexpr std::size_t kTrackedPartCount = 4;  ///< number of tracked parts
/// Returns head, left_hand, right_hand or gaze.
CATENA_EXPORT const char* to_string(TrackedPart part);

/// Pose of a tracked part.
struct TrackedPose {
  Vec3 position_m{0.0};                 ///< position in the stage space, meters
  Quat orientation{kIdentityRotation};  ///< rotation from the axes of the part to the stage space, unit
  bool operator==(const TrackedPose&) const = default;
};

/// Poses of one frame of the headset.
struct LogPoses {
  std::uint64_t tick = 0;         ///< newest tick that had been received when the frame was started
  std::int64_t predicted_ns = 0;  ///< predicted display time to which the poses refer, on the runtime's clock, nanoseconds
  std::array<std::optional<TrackedPose>, kTrackedPartCount> parts{};  ///< pose of each part; none: not tracked
  bool operator==(const LogPoses&) const = default;

  /// Returns the pose of a part.
  std::optional<TrackedPose>& operator[](TrackedPart part) { return parts[static_cast<std::size_t>(part)]; }
};

/// Returns the payload of a poses block.
CATENA_EXPORT std::string to_bytes(const std::vector<LogPoses>& poses);
/// Parses the payload of a poses block; returns nothing if the bytes are invalid or a number is not finite.
CATENA_EXPORT std::optional<std::vector<LogPoses>> parse_poses(std::string_view bytes);

/// Returns the header line of the CSV table: tick, predicted_ns, then head_x,y,z,qw,qx,qy,qz and so on for each part.
CATENA_EXPORT std::string poses_csv_header();
/// Appends one row with its line end; the columns of a part that is not tracked are empty.
CATENA_EXPORT void append_poses_csv(std::string& line, const LogPoses& poses);

}  // namespace catena::haptics::log
