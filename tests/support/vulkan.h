// SPDX-License-Identifier: MIT
/// Tests draw on lavapipe with the validation layer on: the same pictures on every machine. CATENA_TEST_DEVICE names another device
/// ("gpu", or a part of its name): a few tests compare with pictures or costs that lavapipe alone has, and skip there.
#pragma once
#include <stdlib.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace catena::test {

/// What DeviceOptions::choose is in tests.
inline std::string test_device() {
  const char* asked = std::getenv("CATENA_TEST_DEVICE");
  return asked ? asked : "cpu";
}

/// Whether tests draw on lavapipe.
inline bool uses_lavapipe() { return test_device() == "cpu"; }

/// Points the Vulkan loader at lavapipe, unless the environment already says which driver or which device to take.
inline void use_lavapipe() {
  ::setenv("LP_NUM_THREADS", "2", 0);
  if (std::getenv("CATENA_TEST_DEVICE") || std::getenv("VK_DRIVER_FILES") || std::getenv("VK_ICD_FILENAMES")) return;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/usr/share/vulkan/icd.d", ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("lvp_icd.", 0) != 0) continue;
    ::setenv("VK_DRIVER_FILES", entry.path().c_str(), 1);
    ::setenv("VK_ICD_FILENAMES", entry.path().c_str(), 1);
    return;
  }
}

}  // namespace catena::test
