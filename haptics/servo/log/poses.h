/// What a headset knows of its person beside the probe: where head, hands and gaze are when a picture is shown, as its runtime predicted
/// them. An optional part of a recording (format.h, POSES): a recording without a headset has none, and is as it was before there were any.
/// Metres of room, a tracker's axes; the gaze looks along its -z.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/vec.h"

namespace catena::haptics::log {

/// What a headset tracks.
enum class TrackedPart : std::size_t { head, left_hand, right_hand, gaze };
inline constexpr std::size_t kTrackedPartCount = 4;  ///< How many they are.
const char* to_string(TrackedPart part);             ///< head, left_hand, right_hand, gaze

/// One pose.
struct TrackedPose {
  Vec3 position_m{0.0};                 ///< metres of the room
  Quat orientation{kIdentityRotation};  ///< room from part, unit
  bool operator==(const TrackedPose&) const = default;
};

/// Of one picture.
struct LogPoses {
  std::uint64_t tick = 0;         ///< the newest tick that was known when the picture was begun
  std::int64_t predicted_ns = 0;  ///< when it was to be shown, on the runtime's clock: what the poses are of
  std::array<std::optional<TrackedPose>, kTrackedPartCount> parts{};  ///< none: not tracked
  bool operator==(const LogPoses&) const = default;

  /// The pose of a part.
  std::optional<TrackedPose>& operator[](TrackedPart part) { return parts[static_cast<std::size_t>(part)]; }
};

/// The payload of the block.
std::string to_bytes(const std::vector<LogPoses>& poses);
/// Nothing where the bytes are none, or a number is not finite.
std::optional<std::vector<LogPoses>> parse_poses(std::string_view bytes);

/// As a table: tick, predicted_ns, then head_x,y,z,qw,qx,qy,qz and so on for each part; empty where a part was not tracked.
std::string poses_csv_header();
/// One row, without a line end.
void append_poses_csv(std::string& line, const LogPoses& poses);

}  // namespace catena::haptics::log
