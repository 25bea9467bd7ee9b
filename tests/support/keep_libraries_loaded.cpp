// SPDX-License-Identifier: MIT
// Sanitizer builds only. The Vulkan loader unloads its driver and layers, and the leak checker then takes what their globals
// held for lost: here libraries stay loaded to the end. The validation layer also loses some small blocks of its own, lavapipe
// 22.3 one shader of every pipeline that uses discard, and OpenXR's loader 1.0.20 what it keeps of every instance; undestroyed
// objects of ours are what the validation layers find.
#ifdef __SANITIZE_ADDRESS__
extern "C" {
__attribute__((visibility("default"), used)) int dlclose(void*) { return 0; }
__attribute__((visibility("default"), used)) const char* __lsan_default_suppressions() {
  return "leak:libVkLayer_khronos_validation\nleak:libvulkan_lvp\nleak:libopenxr_loader\nleak:libXrApiLayer_core_validation\n";
}
__attribute__((visibility("default"), used)) const char* __lsan_default_options() { return "print_suppressions=0"; }
}
#endif
