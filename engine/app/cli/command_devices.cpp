// SPDX-License-Identifier: MIT
/// catena devices [--json]: lists the haptic devices.
/// catena devices test NAME [--forces] [--seconds S] [--firmware FILE]: a safe self-test.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/cli/command.h"
#include "engine/app/cli/options.h"
#include "engine/app/haptics/device_check.h"
#include "engine/app/haptics/signal_handlers.h"
#include "engine/base/console.h"
#include "engine/base/json_text.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "haptics/device/registry.h"

namespace catena::app {
namespace {

struct DevicesOptions {
  bool json = false, forces = false;
  std::string name, firmware;
  double seconds = 2;
};

std::string abilities(const haptics::DeviceCapabilities& c) {
  std::string line = c.has_orientation ? "position, orientation" : "position";
  if (c.max_force_n > 0) line += fmt::format(", force up to {} N", to_text(c.max_force_n));
  if (c.max_torque_nm > 0) line += fmt::format(", torque up to {} N m", to_text(c.max_torque_nm));
  if (c.has_vibration) line += ", vibration";
  if (!(c.max_force_n > 0) && !(c.max_torque_nm > 0)) line += ", no force";
  return line;
}

std::string how_to_open(const haptics::DeviceInfo& info) {
  if (info.name == "mouse") return "catena view SCENE";
  if (info.name == "controller") return "catena view SCENE --xr";
  return "--device " + info.name;
}

void list(bool json) {
  const std::vector<haptics::DeviceInfo> found = haptics::list_devices();
  if (json) fmt::print("[");
  for (std::size_t i = 0; i < found.size(); ++i) {
    const haptics::DeviceInfo& info = found[i];
    const haptics::DeviceCapabilities c = haptics::nominal_capabilities(haptics::parse_device_type(info.name));
    if (json) {
      fmt::print(
          "{}\n  {{\"name\": {}, \"present\": {}, \"detail\": {}, \"position\": true, \"orientation\": {}, \"max_force_n\": {}, "
          "\"max_torque_nm\": {}, \"buttons\": {}, \"workspace_m\": {}, \"open\": {}}}",
          i == 0 ? "" : ",", json_string(info.name), info.available, json_string(info.detail), c.has_orientation, to_text(c.max_force_n),
          to_text(c.max_torque_nm), c.button_count, to_text(c.workspace_m), json_string(how_to_open(info)));
    } else {
      fmt::print("{:<22} {:<8} {}\n{:<32}{}; {}\n", sanitize_for_terminal(info.name), info.available ? "present" : "absent",
                 sanitize_for_terminal(info.detail), "", abilities(c), sanitize_for_terminal(how_to_open(info)));
    }
  }
  if (json) fmt::print("\n]\n");
}

void print_check(const haptics::Device& device, const std::string& name, const DeviceCheckResult& check) {
  const haptics::DeviceCapabilities& c = device.capabilities();
  fmt::print("{}: {}\n", sanitize_for_terminal(name), sanitize_for_terminal(c.name));
  fmt::print("  features     {}; {} button{}; workspace {} m\n", abilities(c), c.button_count, c.button_count == 1 ? "" : "s",
             to_text(c.workspace_m));
  if (check.read_count == 0) return;
  fmt::print("  ready after  {:.2f} s\n", check.ready_after_s);
  if (check.seconds > 0)
    fmt::print("  read         {} poses in {:.2f} s, {:.0f} per second\n", check.read_count, check.seconds, check.rate_hz());
  fmt::print("  position     x {:.5f} .. {:.5f}, y {:.5f} .. {:.5f}, z {:.5f} .. {:.5f} m\n", check.min_m.x, check.max_m.x, check.min_m.y,
             check.max_m.y, check.min_m.z, check.max_m.z);
  if (c.has_orientation) fmt::print("  rotation     up to {:.4f} rad\n", check.max_rotation_rad);
  fmt::print("  jitter       {:.3g} um rms\n", 1e6 * check.jitter_m);
  fmt::print("  pose age     {:.3f} ms on average, {:.3f} ms at most\n", 1e3 * check.mean_age_s, 1e3 * check.max_age_s);
  std::string buttons;
  for (int b = 0; b < 32; ++b)
    if ((check.buttons >> b & 1u) != 0) buttons += fmt::format(" {}", b + 1);
  fmt::print("  buttons     {}\n", buttons.empty() ? " none pressed" : buttons);
  for (const PushResult& push : check.pushes)
    fmt::print("  force        {:+.2f} {:+.2f} {:+.2f} N moved the hand {:+.3f} {:+.3f} {:+.3f} mm{}\n", push.requested_n.x,
               push.requested_n.y, push.requested_n.z, 1e3 * push.displacement_m.x, 1e3 * push.displacement_m.y,
               1e3 * push.displacement_m.z, norm(push.displacement_m) < 1e-5 ? " (no motion: check the power supply)" : "");
}

Outcome test(const DevicesOptions& options) {
  if (!haptics::is_device_type(haptics::parse_device_type(options.name)))
    return Error{"there is no device " + in_quotes(options.name) + "; one of " + haptics::device_type_names() + " was expected"};
  if (!(options.seconds > 0 && options.seconds <= 600))
    return Error{"--seconds is " + to_text(options.seconds) + "; a number above 0, up to 600, was expected"};
  haptics::DeviceSettings settings;
  settings.type = haptics::parse_device_type(options.name);
  settings.firmware = options.firmware;
  settings.report_progress = [](const std::string& message) { print_line(message); };
  auto opened = haptics::open_device(options.name, settings);
  if (!opened && !haptics::force_table_path(options.name).empty()) return opened.error();
  if (!opened) throw MachineFailure{options.name + ": " + opened.error().message};
  haptics::Device& device = **opened;
  const InterruptHandler interrupt;
  const CrashGuard crash_guard(device);

  DeviceCheckOptions check_options;
  check_options.seconds = options.seconds;
  check_options.forces = options.forces;
  check_options.stop = &interrupt.flag();
  check_options.prompt = settings.report_progress;
  if (options.forces && device.capabilities().max_force_n > 0)
    print_line(options.name + ": the device will exert forces of up to 1 N; hold the grip, Ctrl-C stops the test");
  const DeviceCheckResult check = check_device(device, check_options, make_realtime_schedule(check_options.rate_hz));
  device.stop();
  CATENA_CHECK(interrupt.outcome());
  CATENA_CHECK(device.check_output_files());
  print_check(device, options.name, check);
  if (!check.failure.empty()) throw MachineFailure{options.name + ": " + check.failure};
  fmt::print("pass{}\n", options.forces ? "" : " (without forces; --forces tests them, too)");
  return Done{};
}

}  // namespace

void add_devices(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<DevicesOptions>();
  CLI::App* devices = program.add_subcommand("devices", "lists the haptic devices, or tests one");
  devices->add_flag("--json", options->json, "prints the list as JSON");
  CLI::App* command = devices->add_subcommand("test", "tests a device: reads poses, and exerts forces only with --forces");
  command->add_option("NAME", options->name, "name of the device, as listed by catena devices")->type_name("DEVICE")->required();
  command->add_flag("--forces", options->forces, "exerts small forces (at most 1 N) along every axis; hold the grip");
  command->add_option("--seconds", options->seconds, "duration of the test of poses")
      ->type_name("S")
      ->check(accepted("> 0, up to 600"))
      ->capture_default_str();
  command->add_option("--firmware", options->firmware, "firmware image of the vendor, for a device without firmware")
      ->type_name("FIRMWARE");
  command->callback([&chosen, options] { chosen = [options] { return test(*options); }; });
  devices->callback([&chosen, options, command] {
    if (command->parsed()) return;
    chosen = [options]() -> Outcome {
      list(options->json);
      return Done{};
    };
  });
}

}  // namespace catena::app
