# SPDX-License-Identifier: MIT
# What almost every file includes is parsed once: the standard library, GLM's vectors, fmt. GCC takes a precompiled header only for
# the very options that it was made with, so files with options of their own are named in catena_without_precompiled().
add_library(catena_precompiled OBJECT ${PROJECT_SOURCE_DIR}/engine/base/precompiled.cpp)
target_link_libraries(catena_precompiled PUBLIC catena_flags)
set(catena_common_headers
  <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional> <limits> <map> <memory> <mutex>
  <optional> <random> <set> <span> <sstream> <string> <string_view> <thread> <utility> <vector>
  <fmt/format.h> ${PROJECT_SOURCE_DIR}/engine/base/vec.h)
target_precompile_headers(catena_precompiled PRIVATE ${catena_common_headers})

function(catena_precompile TARGET)
  target_precompile_headers(${TARGET} REUSE_FROM catena_precompiled)
endfunction()

# OpenVDB's headers define static members of templates, of which the library and the program must share one: they may not be hidden, and the
# precompiled headers are made for hidden symbols.
function(catena_prepare_openvdb TARGET)
  if(catena_openvdb IN_LIST ARGN)
    set_target_properties(${TARGET} PROPERTIES CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN OFF DISABLE_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

# Sources with compile options of their own.
function(catena_without_precompiled)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
endfunction()
