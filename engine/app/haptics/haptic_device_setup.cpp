// SPDX-License-Identifier: MIT
#include "engine/app/haptics/haptic_device_setup.h"

#include <fmt/format.h>
#include <algorithm>

#include "engine/base/console.h"
#include "engine/base/output_file.h"
#include "haptics/build/build_program.h"
#include "haptics/device/registry.h"
#include "haptics/servo/device_limits.h"

namespace catena::app {

void fit_workspace(scene::Scene& scene, const Bounds& bounds, double reach_m, const Vec3& centre_m) {
  if (!scene.coupling.ramp_s) scene.coupling.ramp_s = 0.02;
  if (scene.workspace.is_explicit) {
    scene.workspace.origin -= scene.workspace.rotation * centre_m / scene.workspace.meters_per_unit;
    return;
  }
  if (bounds.empty()) return;
  const double edge = bounds.longest_edge();
  if (!(edge > 0)) return;
  scene.workspace.meters_per_unit = reach_m / edge;
  scene.workspace.origin = bounds.center() - scene.workspace.rotation * centre_m * (edge / reach_m);
}

Vec3 initial_probe_position(const scene::Scene& scene, const Bounds& bounds) {
  if (scene.cursor && scene.entities.has<scene::Cursor>(scene.cursor)) {
    const scene::Cursor& cursor = scene.entities.get<scene::Cursor>(scene.cursor);
    if (cursor.visible && is_finite(cursor.probe)) return cursor.probe;
  }
  std::optional<Vec3> seed;
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    if (seed || link.node.find("seed") == nullptr) return;
    if (const auto v = json::require_vec3(link.node, "seed")) seed = *v;
  });
  if (seed) return *seed;
  return bounds.empty() ? Vec3(0.0) : bounds.center();
}

Vec3 device_from_world(const scene::Workspace& workspace, const Vec3& world) {
  return ((world - workspace.origin) * workspace.rotation) * workspace.meters_per_unit;  // v * R = R^T v
}

Result<HapticDeviceSetup> open_haptic_device(const scene::Scene& scene, const std::string& name, std::optional<double> rate_hz,
                                             const std::string& firmware) {
  HapticDeviceSetup hand;
  hand.settings.type = "simulated";
  if (scene.device) {
    CATENA_TRY(hand.settings, haptics::read_device_settings(*scene.device, scene.path));
  }
  const std::string wanted = name.empty() ? hand.settings.type : name, type = haptics::parse_device_type(wanted);
  if (type != hand.settings.type) {
    if (scene.device && haptics::is_device_type(type))
      hand.note = fmt::format("the scene's \"device\" describes a device of type {}; it is not used for {}", hand.settings.type, wanted);
    hand.settings = {};
    hand.settings.type = type;
  }
  if (rate_hz) hand.settings.rate_hz = *rate_hz;
  if (!firmware.empty()) hand.settings.firmware = firmware;
  hand.settings.report_progress = [](const std::string& message) { print_message(message); };
  CATENA_TRY(hand.device, haptics::open_device(wanted, hand.settings));
  hand.limits = haptics::compute_device_limits(hand.device->capabilities(), hand.settings);
  return hand;
}

Result<std::shared_ptr<const haptics::HapticProgram>> make_device_program(scene::Scene& scene, const HapticDeviceSetup& hand,
                                                                          const Bounds& bounds) {
  const haptics::DeviceCapabilities& device = hand.device->capabilities();
  fit_workspace(scene, bounds, device.workspace_m, device.workspace_center_m);
  return haptics::build_program(scene, hand.limits);
}

haptics::RealtimeOptions RealtimeChoice::options() const {
  const bool on = realtime == "on";
  return {.fifo = on, .lock_memory = on, .cpu = cpu};
}

Outcome write_servo_stats(const std::string& path, const haptics::Servo& servo, const haptics::Device& device) {
  if (path.empty()) return Done{};
  CATENA_TRY(OutputFile file, OutputFile::open(path));
  file.write(haptics::servo_json(servo.stats(), device.capabilities().name, servo.state_hash()));
  return file.commit();
}

}  // namespace catena::app
