// SPDX-License-Identifier: MIT
/// Driver failures for vk::DeviceOptions::inject_failure.
#pragma once
#include <memory>

#include "render/vk/device.h"
#include "tests/support/vulkan.h"

namespace catena::test {

/// Fails the `at`-th following call of one kind (1: the next; 0: none). Counts all calls of that kind.
struct FailureInjector {
  render::vk::DriverCall call = render::vk::DriverCall::allocate;
  VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
  int at = 0, calls = 0;

  void arm(render::vk::DriverCall kind, VkResult what, int which) {
    call = kind;
    result = what;
    at = which;
    calls = 0;
  }
};

inline render::vk::DeviceOptions failing_options(const std::shared_ptr<FailureInjector>& failing) {
  render::vk::DeviceOptions options;
  options.validation = true;
  options.device_filter = test_device();
  options.inject_failure = [failing](render::vk::DriverCall call) {
    return call == failing->call && ++failing->calls == failing->at ? failing->result : VK_SUCCESS;
  };
  return options;
}

}  // namespace catena::test
