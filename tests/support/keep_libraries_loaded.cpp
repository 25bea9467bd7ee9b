// SPDX-License-Identifier: MIT
// Sanitizer builds only. The Vulkan loader unloads its driver and layers, and the leak checker then reports memory of their globals:
// here libraries stay loaded to the end. Suppressed leaks: small blocks of the validation layer, one shader of every pipeline with
// discard of lavapipe 22.3, and data of every instance of OpenXR's loader 1.0.20. Undestroyed objects of Catena are found by the
// validation layers.
#ifdef __SANITIZE_ADDRESS__
extern "C" {
__attribute__((visibility("default"), used)) int dlclose(void*) { return 0; }
__attribute__((visibility("default"), used)) const char* __lsan_default_suppressions() {
  return "leak:libVkLayer_khronos_validation\nleak:libvulkan_lvp\nleak:libopenxr_loader\nleak:libXrApiLayer_core_validation\n";
}
__attribute__((visibility("default"), used)) const char* __lsan_default_options() { return "print_suppressions=0"; }
}
#endif
