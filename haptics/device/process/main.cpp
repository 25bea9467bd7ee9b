// SPDX-License-Identifier: MIT
// The program `catena-device`: runs a haptic device for catena, which starts it and passes the shared memory page (descriptor 3,
// haptics/device/process/device_page.h), the lifeline (descriptor 4) and the force table to write (descriptor 5). catena-device has its own
// session, blocks all signals that can be blocked, and outlives catena only until the device is released.
#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstring>

#include "haptics/device/emulator/emulated_transport.h"
#include "haptics/device/process/device_host.h"
#include "haptics/device/process/force_table.h"

namespace {

using namespace catena::haptics;

constexpr int kPage = 3, kLifeline = 4, kTable = 5;
constexpr int kPriority = 83;  // above the servo: this process mostly sleeps

int usage() {
  std::fputs("catena-device: runs a haptic device for catena, which starts this program\n", stderr);
  return 2;
}

bool answers(char word) { return ::write(kLifeline, &word, 1) == 1; }

}  // namespace

int main() {
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, nullptr);
  ::setsid();
  struct stat about {};
  if (::fcntl(kLifeline, F_GETFD) < 0 || ::fstat(kPage, &about) != 0 || about.st_size < static_cast<off_t>(sizeof(process::DevicePage)))
    return usage();
  void* const at = ::mmap(nullptr, sizeof(process::DevicePage), PROT_READ | PROT_WRITE, MAP_SHARED, kPage, 0);
  if (at == MAP_FAILED) return usage();
  process::DevicePage& page = *static_cast<process::DevicePage*>(at);
  if (page.magic != process::DevicePage::kMagic || page.version != process::DevicePage::kVersion) return usage();
  sched_param parameter{};
  parameter.sched_priority = kPriority;
  sched_setscheduler(0, SCHED_FIFO, &parameter);  // if permitted

  process::ForceTable table(kTable, page.table_error);
  const std::string name = page.device;
  DeviceSettings settings;
  settings.rate_hz = page.rate_hz;
  settings.force_gain = page.force_gain;
  settings.firmware = page.firmware;
  const std::size_t colon = name.find(':');
  auto device = open_emulated_falcon(colon == std::string::npos ? "" : name.substr(colon + 1), settings,
                                     [&table](const EmulatedFalcon::Exchange& exchange) { table.add(exchange.force_n); });
  if (!device) {
    std::snprintf(page.error_text, sizeof page.error_text, "%s", device.error().message.c_str());
    page.is_machine_error = device.error().system_failure;
    return answers(process::kFailed) ? 1 : 2;
  }
  process::describe_device((*device)->capabilities(), page.description);
  if (!answers(process::kReady)) return 1;
  process::serve_device(page, kLifeline, **device);
  return 0;
}
