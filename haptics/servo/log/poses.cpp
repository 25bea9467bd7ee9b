// SPDX-License-Identifier: MIT
#include "haptics/servo/log/poses.h"

#include <fmt/format.h>

#include "engine/base/numbers.h"
#include "haptics/servo/log/format.h"

namespace catena::haptics::log {
namespace {

constexpr std::uint32_t kMaxPosesABlock = 100'000;

/// Calls `each` for the numbers of a pose, in the order of the format.
template <class Pose, class F>
void each_tracked_number(Pose& pose, const F& each) {
  for (int a = 0; a < 3; ++a) each(pose.position_m[a]);
  for (auto* v : {&pose.orientation.w, &pose.orientation.x, &pose.orientation.y, &pose.orientation.z}) each(*v);
}

}  // namespace

const char* to_string(TrackedPart part) {
  constexpr const char* words[kTrackedPartCount] = {"head", "left_hand", "right_hand", "gaze"};
  return words[static_cast<std::size_t>(part)];
}

std::string to_bytes(const std::vector<LogPoses>& poses) {
  ByteWriter out;
  out.put(static_cast<std::uint32_t>(poses.size()));
  for (const LogPoses& one : poses) {
    out.put(one.tick);
    out.put(one.predicted_ns);
    std::uint8_t known = 0;
    for (std::size_t i = 0; i < kTrackedPartCount; ++i) known = static_cast<std::uint8_t>(known | (one.parts[i] ? 1u << i : 0u));
    out.put(known);
    for (const auto& pose : one.parts)
      if (pose) each_tracked_number(*pose, [&](double v) { out.put(v); });
  }
  return std::move(out.bytes());
}

std::optional<std::vector<LogPoses>> parse_poses(std::string_view bytes) {
  ByteReader in(bytes);
  const auto count = in.get<std::uint32_t>();
  if (count > kMaxPosesABlock) return std::nullopt;
  std::vector<LogPoses> out;
  bool good = true;
  for (std::uint32_t i = 0; i < count && good && in.is_ok(); ++i) {
    LogPoses one;
    one.tick = in.get<std::uint64_t>();
    one.predicted_ns = in.get<std::int64_t>();
    const auto known = in.get<std::uint8_t>();
    good = known < 1u << kTrackedPartCount;
    for (std::size_t part = 0; part < kTrackedPartCount; ++part) {
      if ((known >> part & 1u) == 0) continue;
      each_tracked_number(one.parts[part].emplace(), [&](double& v) {
        v = in.get<double>();
        good = good && std::isfinite(v);
      });
    }
    out.push_back(one);
  }
  if (!good || !in.at_end()) return std::nullopt;
  return out;
}

std::string poses_csv_header() {
  std::string line = "tick,predicted_ns";
  for (std::size_t i = 0; i < kTrackedPartCount; ++i) {
    const char* part = to_string(static_cast<TrackedPart>(i));
    for (const char* number : {"x", "y", "z", "qw", "qx", "qy", "qz"}) line += fmt::format(",{}_{}", part, number);
  }
  return line + "\n";
}

void append_poses_csv(std::string& line, const LogPoses& poses) {
  line += fmt::format("{},{}", poses.tick, poses.predicted_ns);
  for (const auto& pose : poses.parts) {
    if (!pose) {
      line += ",,,,,,,";
      continue;
    }
    each_tracked_number(*pose, [&](double v) {
      line += ',';
      append_number(line, v);
    });
  }
  line += '\n';
}

}  // namespace catena::haptics::log
