// SPDX-License-Identifier: MIT
#include "render/xr/xr_loader.h"

#include <dlfcn.h>
#include <openxr/openxr_reflection.h>
#include <stdlib.h>

namespace catena::render::xr {

const char* result_name(XrResult result) {
  switch (result) {
#define CATENA_XR_RESULT_CASE(name, value) \
  case name:                               \
    return #name;
    XR_LIST_ENUM_XrResult(CATENA_XR_RESULT_CASE)
#undef CATENA_XR_RESULT_CASE
        default : return "an unknown XrResult";
  }
}

Error xr_error(XrResult result, const std::string& what) {
  const std::string said = "the headset could not " + what + ": " + result_name(result);
  if (result == XR_ERROR_RUNTIME_UNAVAILABLE) return Error{said + "; expected an OpenXR runtime that is installed and made the active one"};
  if (result == XR_ERROR_FORM_FACTOR_UNAVAILABLE) return Error{said + "; expected a headset that is plugged in and switched on"};
  return Error{said};
}

Outcome DispatchTable::load(XrInstance instance) {
  const auto find = [&](const char* name) {
    PFN_xrVoidFunction found = nullptr;
    return XR_SUCCEEDED(GetInstanceProcAddr(instance, name, &found)) ? found : nullptr;
  };
#define CATENA_XR_OPTIONAL_ONE(name) name = reinterpret_cast<PFN_xr##name>(find("xr" #name));
#define CATENA_XR_NEEDED(name) \
  CATENA_XR_OPTIONAL_ONE(name) \
  if (!name) return Error{"the headset's runtime has no xr" #name};
  CATENA_XR_CORE(CATENA_XR_NEEDED)
  CATENA_XR_VULKAN(CATENA_XR_NEEDED)
  CATENA_XR_OPTIONAL(CATENA_XR_OPTIONAL_ONE)
#undef CATENA_XR_NEEDED
#undef CATENA_XR_OPTIONAL_ONE
  return Done{};
}

void DispatchTable::disable_destruction() {
  DestroyInstance = [](XrInstance) { return XR_SUCCESS; };
  DestroySession = [](XrSession) { return XR_SUCCESS; };
  DestroySpace = [](XrSpace) { return XR_SUCCESS; };
  DestroySwapchain = [](XrSwapchain) { return XR_SUCCESS; };
  DestroyActionSet = [](XrActionSet) { return XR_SUCCESS; };
}

Result<std::unique_ptr<Loader>> Loader::open(const char* library) {
  // the loader's own output is disabled: errors are reported once, by Catena
  ::setenv("XR_LOADER_DEBUG", "none", 0);
  std::unique_ptr<Loader> self(new Loader);
  self->library_ = ::dlopen(library, RTLD_NOW | RTLD_LOCAL);
  if (!self->library_)
    return Error{std::string("no headset: OpenXR's loader ") + library + " cannot be opened, expected the package libopenxr-loader1"};
  DispatchTable& f = self->dispatch_;
  f.GetInstanceProcAddr = reinterpret_cast<PFN_xrGetInstanceProcAddr>(::dlsym(self->library_, "xrGetInstanceProcAddr"));
  if (!f.GetInstanceProcAddr) return Error{std::string("no headset: ") + library + " has no xrGetInstanceProcAddr"};
#define CATENA_XR_FIND(name)                                                                                                   \
  if (XR_FAILED(f.GetInstanceProcAddr(XR_NULL_HANDLE, "xr" #name, reinterpret_cast<PFN_xrVoidFunction*>(&f.name))) || !f.name) \
    return Error{std::string("no headset: ") + library + " has no xr" #name};
  CATENA_XR_GLOBAL(CATENA_XR_FIND)
#undef CATENA_XR_FIND
  return self;
}

Loader::~Loader() {
  if (library_) ::dlclose(library_);
}

}  // namespace catena::render::xr
