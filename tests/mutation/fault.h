// SPDX-License-Identifier: MIT
/// Switch of planted faults (plant.py). CATENA_FAULT holds the number of the active fault. CATENA_FAULT_REACH names a file of
/// kReachBytes bytes, in which a byte is set for each test case and fault that it reached; the file is mapped before main, so that confined
/// processes report as well. A child process takes the number of its test case from CATENA_FAULT_CASE.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <type_traits>

namespace catena::mutation {

constexpr std::size_t kMaxFaults = 128, kMaxCases = 1 << 14, kNameBytes = 128;
/// A counter of cases, their names, and a row of faults a case.
constexpr std::size_t kReachBytes = 64 + kMaxCases * (kNameBytes + kMaxFaults);

struct Switch {
  int active = -1;
  int test_case = 0;
  unsigned char* reach = nullptr;

  Switch() {
    if (const char* fault = std::getenv("CATENA_FAULT")) active = std::atoi(fault);
    if (const char* number = std::getenv("CATENA_FAULT_CASE")) test_case = std::atoi(number);
    if (const char* file = std::getenv("CATENA_FAULT_REACH")) {
      const int fd = open(file, O_RDWR | O_CLOEXEC);
      void* map = fd < 0 ? MAP_FAILED : mmap(nullptr, kReachBytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
      if (fd >= 0) close(fd);
      if (map != MAP_FAILED) reach = static_cast<unsigned char*>(map);
    }
  }
  unsigned char* name(int number) const { return reach + 64 + static_cast<std::size_t>(number) * kNameBytes; }
  bool is_active(int fault) const {
    if (reach != nullptr) {
      unsigned char* rows = reach + 64 + kMaxCases * kNameBytes;
      rows[static_cast<std::size_t>(test_case) * kMaxFaults + static_cast<std::size_t>(fault)] = 1;
    }
    return fault == active;
  }
};

__attribute__((visibility("default"))) inline Switch the_switch;

}  // namespace catena::mutation

constexpr bool catena_fault(int fault) { return !std::is_constant_evaluated() && catena::mutation::the_switch.is_active(fault); }
