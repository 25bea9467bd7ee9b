// SPDX-License-Identifier: MIT
#include "engine/app/tuning/report/system_info.h"

#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <fstream>
#include <thread>

#include "engine/app/cli/command.h"

namespace catena::app {
namespace {

/// Processor name as reported by the kernel, or "unknown".
std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos) return line.substr(line.find(": ") + 2);
  return "unknown";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02} UTC", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min);
}

#if defined(__OPTIMIZE__)
constexpr const char* kOptimised = "optimised";
#else
constexpr const char* kOptimised = "not optimised";
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr const char* kSanitised = ", with sanitizers";
#else
constexpr const char* kSanitised = "";
#endif

}  // namespace

std::vector<std::pair<std::string, std::string>> system_info() {
  return {{"version", kVersion},
          {"build", fmt::format("GCC {}, {}{}", __VERSION__, kOptimised, kSanitised)},
          {"processor", processor_name()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"date", today()}};
}

}  // namespace catena::app
