#include "engine/app/info_log.h"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <cmath>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "haptics/servo/log/reader.h"

namespace catena::app {

namespace log = haptics::log;

Outcome describe_log(const std::string& path) {
  CATENA_TRY(log::LogReader reader, log::LogReader::open(path));
  const log::LogHeader& header = reader.header();
  const auto seconds = static_cast<std::time_t>(header.started_unix_ns / 1'000'000'000);
  fmt::print("{}: recording of {}\n", printable(path), header.scene_path.empty() ? "a scene without a name" : printable(header.scene_path));
  for (const std::string& field : header.fields) fmt::print("  field        {}\n", printable(field));
  fmt::print("  recorded     {:%Y-%m-%d %H:%M:%S} UTC by catena {}\n", fmt::gmtime(seconds), printable(header.catena_version));
  fmt::print("  device       {} at {} Hz\n", printable(header.device), to_text(header.rate_hz));
  std::uint64_t ticks = 0;
  double first_s = 0, last_s = 0;
  for (log::LogEvent event = reader.next(); event != log::LogEvent::done; event = reader.next()) {
    if (event == log::LogEvent::gap) fmt::print("  gap          {}\n", printable(reader.gap().text()));
    if (event == log::LogEvent::state) fmt::print("  begins       after tick {}, with the state of that moment\n", reader.state().tick);
    if (event == log::LogEvent::program) {
      std::string names;
      for (const std::string& name : reader.program().link_names()) names += (names.empty() ? "" : ", ") + name;
      fmt::print("  program      from tick {}: {}{}\n", reader.program().first_tick, names.empty() ? "no links" : printable(names),
                 reader.program().known ? "" : " (the recording does not say what they are)");
    }
    if (event != log::LogEvent::tick) continue;
    // a device that is not there has no time of its own
    const double t_s = reader.tick().input.t_s;
    if (ticks++ == 0) first_s = t_s;
    if (std::isfinite(t_s)) last_s = t_s;
  }
  fmt::print("  ticks        {} in {} s\n", ticks, to_text(last_s - first_s));
  fmt::print("  end          {}\n", printable(reader.ending()));
  return Done{};
}

}  // namespace catena::app
