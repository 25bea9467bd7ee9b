// Sanitizer builds only: the Vulkan loader unloads its driver and layers, and the leak checker then takes what their globals
// held for lost. Here libraries stay loaded to the end.
#ifdef __SANITIZE_ADDRESS__
extern "C" __attribute__((visibility("default"), used)) int dlclose(void*) { return 0; }
#endif
