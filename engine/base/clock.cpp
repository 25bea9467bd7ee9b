// SPDX-License-Identifier: MIT
#include "engine/base/clock.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace catena {

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::int64_t process_cpu_ns() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return std::int64_t{1'000'000'000} * t.tv_sec + t.tv_nsec;
}

double ms_since(std::int64_t start_ns) { return static_cast<double>(now_ns() - start_ns) * 1e-6; }

namespace {
// Field 22 of /proc/self/stat is the start time in clock ticks since boot.
double process_age_ms() {
  std::FILE* file = std::fopen("/proc/self/stat", "r");
  if (file == nullptr) return 0;
  char text[1024];
  const std::size_t size = std::fread(text, 1, sizeof text - 1, file);
  std::fclose(file);
  text[size] = 0;
  const char* p = std::strrchr(text, ')');
  for (int field = 2; p != nullptr && field < 22; ++field) p = std::strchr(p + 1, ' ');
  unsigned long long ticks = 0;
  if (p == nullptr || std::sscanf(p, "%llu", &ticks) != 1) return 0;
  timespec boot{};
  clock_gettime(CLOCK_BOOTTIME, &boot);
  const double now = 1e3 * static_cast<double>(boot.tv_sec) + 1e-6 * static_cast<double>(boot.tv_nsec);
  const double age = now - 1e3 * static_cast<double>(ticks) / static_cast<double>(sysconf(_SC_CLK_TCK));
  return age > 0 ? age : 0;
}
}  // namespace

double ms_since_process_start() {
  static const double age = process_age_ms();
  static const std::int64_t start = now_ns();
  return age + ms_since(start);
}

}  // namespace catena
