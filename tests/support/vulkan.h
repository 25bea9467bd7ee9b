/// Tests draw on lavapipe with the validation layer on: the same pictures on every machine.
#pragma once
#include <stdlib.h>

#include <filesystem>
#include <string>

namespace catena::test {

/// Points the Vulkan loader at lavapipe, unless the environment already says which driver to take.
inline void use_lavapipe() {
  ::setenv("LP_NUM_THREADS", "2", 0);
  if (std::getenv("VK_DRIVER_FILES") || std::getenv("VK_ICD_FILENAMES")) return;
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
