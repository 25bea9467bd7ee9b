# SPDX-License-Identifier: MIT
# Tests of the emulated Falcon, and of the unmodified libusb on it: through umockdev (label usb), and within one process.
catena_tests(haptics/device/emulator MODULES haptics/device)

pkg_check_modules(UMOCKDEV REQUIRED IMPORTED_TARGET umockdev-1.0)
add_library(catena_test_usbfs OBJECT haptics/device/usbfs/emulated_usbfs.cpp)
add_library(catena_test_umockdev OBJECT haptics/device/usbfs/umockdev_bus.cpp)
add_library(catena_test_in_process OBJECT haptics/device/usbfs/in_process_bus.cpp)
target_link_libraries(catena_test_usbfs PUBLIC catena_haptics_device)
target_link_libraries(catena_test_umockdev PUBLIC catena_test_usbfs PkgConfig::UMOCKDEV)
target_link_libraries(catena_test_in_process PUBLIC catena_test_usbfs)

# In one process: microseconds per round trip. The soak test has no scene, so that it is small enough for the thread sanitizer.
catena_tests(haptics/device/usb_soak MODULES haptics/servo THIRD_PARTY catena_test_in_process catena_test_usbfs PkgConfig::LIBUSB ${CMAKE_DL_LIBS}
  LABELS usb threads)
catena_tests(haptics/device/usb_fast MODULES haptics/servo haptics/build THIRD_PARTY catena_test_in_process catena_test_usbfs PkgConfig::LIBUSB
  ${CMAKE_DL_LIBS} LABELS usb)

# Through umockdev, whose preload library interposes the C library and is incompatible with the thread sanitizer.
if(NOT CATENA_SANITIZE MATCHES "thread")
  if(CATENA_SANITIZE MATCHES "address")
    # the sanitizer's library must be the first one; leaks of libusb and glib are not checked
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=libasan.so OUTPUT_VARIABLE asan_library OUTPUT_STRIP_TRAILING_WHITESPACE)
    set(CMAKE_CROSSCOMPILING_EMULATOR env LD_PRELOAD=${asan_library}:libumockdev-preload.so.0 ASAN_OPTIONS=detect_leaks=0)
  else()
    find_program(UMOCKDEV_WRAPPER umockdev-wrapper REQUIRED)
    set(CMAKE_CROSSCOMPILING_EMULATOR ${UMOCKDEV_WRAPPER})
  endif()
  # every case runs through the wrapper, by this target property that gtest_discover_tests reads
  catena_tests(haptics/device/usb MODULES haptics/servo THIRD_PARTY catena_test_umockdev catena_test_usbfs PkgConfig::LIBUSB
    PROGRAM LABELS usb)
  # library preloaded into the programs that these tests start
  add_library(catena_inherited_node MODULE haptics/device/usbfs/inherited_node.cpp)
  set_target_properties(catena_inherited_node PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  target_link_libraries(catena_inherited_node PRIVATE ${CMAKE_DL_LIBS})
  add_dependencies(test_haptics_device_usb catena_inherited_node)
  unset(CMAKE_CROSSCOMPILING_EMULATOR)
endif()
