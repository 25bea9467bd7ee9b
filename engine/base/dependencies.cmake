# Every third-party library in one place. All are Debian 12 packages; `./run packages` lists them.
find_package(Threads REQUIRED)
find_package(Vulkan REQUIRED)
find_package(PNG REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(glm REQUIRED)
find_package(glfw3 CONFIG REQUIRED)
find_package(PkgConfig REQUIRED)
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)

pkg_check_modules(IMATH REQUIRED IMPORTED_TARGET Imath)
pkg_check_modules(OPENEXR REQUIRED IMPORTED_TARGET OpenEXR)
pkg_check_modules(JSONCPP REQUIRED IMPORTED_TARGET jsoncpp)
pkg_check_modules(LIBUSB REQUIRED IMPORTED_TARGET libusb-1.0)
add_library(JsonCpp::JsonCpp ALIAS PkgConfig::JSONCPP)

if(NOT TARGET CLI11::CLI11)
  find_path(CLI11_INCLUDE_DIR CLI/CLI.hpp REQUIRED)
  add_library(CLI11::CLI11 INTERFACE IMPORTED)
  target_include_directories(CLI11::CLI11 SYSTEM INTERFACE ${CLI11_INCLUDE_DIR})
endif()

# The distribution's FindOpenVDB wants components that Catena does not use; an imported target is enough.
find_library(OPENVDB_LIBRARY openvdb REQUIRED)
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h REQUIRED)
find_path(NANOVDB_INCLUDE_DIR nanovdb/NanoVDB.h REQUIRED)
add_library(catena_openvdb INTERFACE)
target_include_directories(catena_openvdb SYSTEM INTERFACE ${OPENVDB_INCLUDE_DIR} ${NANOVDB_INCLUDE_DIR})
target_link_libraries(catena_openvdb INTERFACE ${OPENVDB_LIBRARY} TBB::tbb PkgConfig::IMATH)

find_path(NIFTI_INCLUDE_DIR nifti1_io.h PATH_SUFFIXES nifti REQUIRED)
find_library(NIFTI_LIBRARY niftiio REQUIRED)
find_library(ZNZ_LIBRARY znz REQUIRED)
add_library(catena_nifti INTERFACE)
target_include_directories(catena_nifti SYSTEM INTERFACE ${NIFTI_INCLUDE_DIR})
target_link_libraries(catena_nifti INTERFACE ${NIFTI_LIBRARY} ${ZNZ_LIBRARY})

# The SpaceMouse's daemon is spoken to through its own library.
find_path(SPNAV_INCLUDE_DIR spnav.h REQUIRED)
find_library(SPNAV_LIBRARY spnav REQUIRED)
add_library(catena_spnav INTERFACE)
target_include_directories(catena_spnav SYSTEM INTERFACE ${SPNAV_INCLUDE_DIR})
target_link_libraries(catena_spnav INTERFACE ${SPNAV_LIBRARY})
