// SPDX-License-Identifier: MIT
/// Tests draw on lavapipe with the validation layer, so that images are equal on every machine. CATENA_TEST_DEVICE names another device
/// ("gpu", or a part of its name); tests of images or costs that are specific to lavapipe are skipped there.
#pragma once
#include <stdlib.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace catena::test {

/// Value of DeviceOptions::device_filter in tests.
inline std::string test_device() {
  const char* asked = std::getenv("CATENA_TEST_DEVICE");
  return asked ? asked : "cpu";
}

/// True if tests draw on lavapipe.
inline bool uses_lavapipe() { return test_device() == "cpu"; }

/// Makes the Vulkan loader use lavapipe, unless the environment selects a driver or a device.
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
