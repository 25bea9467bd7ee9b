// Sanitizer builds only. The Vulkan loader unloads its driver and layers, and the leak checker then takes what their globals
// held for lost: here libraries stay loaded to the end. The validation layer also loses some small blocks of its own, and
// lavapipe 22.3 one shader of every pipeline that uses discard; undestroyed objects of ours are what the validation layer finds.
#ifdef __SANITIZE_ADDRESS__
extern "C" {
__attribute__((visibility("default"), used)) int dlclose(void*) { return 0; }
__attribute__((visibility("default"), used)) const char* __lsan_default_suppressions() {
  return "leak:libVkLayer_khronos_validation\nleak:libvulkan_lvp\n";
}
__attribute__((visibility("default"), used)) const char* __lsan_default_options() { return "print_suppressions=0"; }
}
#endif
