// SPDX-License-Identifier: MIT
// The program `catena-watchdog`: started by the driver of a USB device, which passes the device node (descriptor 3), the shared memory page
// (descriptor 4) and the lifeline (descriptor 5). The program has its own session, blocks all signals that can be blocked, and locks its
// memory.
#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "haptics/watchdog/watch.h"

namespace {

constexpr int kUsb = 3, kPage = 4, kLifeline = 5;
constexpr int kPriority = 85;  // above all of the program's threads, because it rarely runs

int usage() {
  std::fputs("catena-watchdog: stops the force of a USB device for catena, which starts this program\n", stderr);
  return 2;
}

// Raises priority and locks memory, as far as permitted.
void prefer() {
  sched_param parameter{};
  parameter.sched_priority = kPriority;
  if (sched_setscheduler(0, SCHED_FIFO, &parameter) != 0) setpriority(PRIO_PROCESS, 0, -20);
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT);
  const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  [[maybe_unused]] const auto written = write(file, "-1000", 5);
  close(file);
}

}  // namespace

int main() {
  using namespace catena::haptics::watchdog;
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, nullptr);
  struct stat page_file {};
  if (fcntl(kUsb, F_GETFD) < 0 || fcntl(kLifeline, F_GETFD) < 0 || fstat(kPage, &page_file) != 0 ||
      page_file.st_size < static_cast<off_t>(sizeof(SharedPage)))
    return usage();
  void* const at = mmap(nullptr, sizeof(SharedPage), PROT_READ | PROT_WRITE, MAP_SHARED, kPage, 0);
  if (at == MAP_FAILED) return usage();
  SharedPage& page = *static_cast<SharedPage*>(at);
  if (page.magic != SharedPage::kMagic) return usage();
  prefer();
  if (write(kLifeline, &kReady, 1) != 1) return 1;
  return run_watchdog(page, kUsb, kLifeline, STDERR_FILENO) == EndReason::requested ? 0 : 1;
}
