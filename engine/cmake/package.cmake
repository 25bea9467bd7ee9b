# SPDX-License-Identifier: MIT
# Catena as a part of other programs: libcatena.so of the modules' own objects (nothing is compiled twice), the targets catena::field,
# catena::flow, catena::haptics and catena::render, what is installed, and what `find_package(catena)` reads. The program itself holds the
# modules; it does not use the library. The readers' programs stay apart, so that OpenVDB and VTK are in neither.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
option(CATENA_LIBRARY "build libcatena.so, which is installed with its headers" ON)
set(CATENA_HELPERS_FOLDER ${CMAKE_INSTALL_LIBEXECDIR}/catena)  # engine/base/helper_process.cpp looks there

# ---- programs, scenes, documents ----
get_property(helpers GLOBAL PROPERTY CATENA_HELPERS)
if(CATENA_INSTALL)
  install(TARGETS catena RUNTIME COMPONENT catena)
  install(TARGETS ${helpers} RUNTIME DESTINATION ${CATENA_HELPERS_FOLDER} COMPONENT catena)
  # scenes/data names files beside this tree, which nobody has where Catena is installed
  install(DIRECTORY assets/ DESTINATION ${CMAKE_INSTALL_DATADIR}/catena COMPONENT catena
    REGEX "/assets/(pictures|system|scenes/data)$" EXCLUDE)
  # documents lie as in this tree, so that their links hold
  install(FILES README.md CHANGELOG.md LICENSE SECURITY.md CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT catena)
  install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT catena REGEX "/docs/(examples|site)$" EXCLUDE)
  install(DIRECTORY assets/pictures DESTINATION ${CMAKE_INSTALL_DOCDIR}/assets COMPONENT catena)
endif()

# ---- the public headers, whose declarations with CATENA_EXPORT can be seen of library and program ----
set(list engine/cmake/public_headers.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${list})
file(STRINGS ${list} CATENA_PUBLIC_HEADERS REGEX "^[^#]")
set(interface "")
foreach(header ${CATENA_PUBLIC_HEADERS})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
  file(READ ${header} text)
  string(REGEX REPLACE "//[^\n]*" "" text "${text}")
  string(APPEND interface "${text}")
endforeach()

# ---- plug-ins: the program has what they call (haptics/plugin/plugin.h), all that is in the modules of the constraints ----
string(SHA256 interface "${interface}")
string(SUBSTRING ${interface} 0 16 interface)
set(interface "CATENA_PLUGIN_INTERFACE=\"${PROJECT_VERSION} ${interface}\"")
set_source_files_properties(haptics/plugin/load.cpp PROPERTIES COMPILE_DEFINITIONS "${interface}")
add_library(catena_part_plugin INTERFACE)
add_library(catena::plugin ALIAS catena_part_plugin)
set_target_properties(catena_part_plugin PROPERTIES EXPORT_NAME plugin)
set(generated ${PROJECT_BINARY_DIR}/generated)
target_include_directories(catena_part_plugin INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${generated}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/catena>)
target_link_libraries(catena_part_plugin INTERFACE glm::glm)
target_compile_features(catena_part_plugin INTERFACE cxx_std_20)
target_compile_definitions(catena_part_plugin INTERFACE ${interface})
target_compile_options(catena_part_plugin INTERFACE -ffp-contract=off)  # a tick repeats to the bit
set(whole WHOLE_ARCHIVE)
foreach(module base schema field geometry_mesh geometry_curves geometry_flow widget)
  string(APPEND whole ",catena_engine_${module}")
endforeach()
set_target_properties(catena PROPERTIES ENABLE_EXPORTS ON LINK_LIBRARY_OVERRIDE "${whole},catena_haptics_chain,catena_haptics_constraints")

if(NOT CATENA_LIBRARY OR CATENA_SANITIZE)
  return()
endif()

# ---- the library ----
set(node CATENA_${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/exports.map
  CONTENT "${node} {\n  global:\n    _ZN6catena*;\n    _ZNK6catena*;\n    _ZT[VIST]N6catena*;\n    _ZTh*_N*6catena*;\n  local: *;\n};\n")
set(objects "")
set(third_party "")
get_property(modules GLOBAL PROPERTY CATENA_MODULES)
foreach(module ${modules})
  if(NOT module MATCHES "^catena_(engine_(io_vdb|io_vtk|io_chunks|io_sandbox|app_server_http)|haptics_plugin|render_(shader_compiler|xr))$")
    get_target_property(libraries ${module} CATENA_THIRD_PARTY)
    list(APPEND objects $<TARGET_OBJECTS:${module}>)
    list(APPEND third_party ${libraries})
  endif()
endforeach()
list(REMOVE_DUPLICATES third_party)
add_library(catena_library SHARED ${objects})
target_link_libraries(catena_library PRIVATE ${third_party} fmt::fmt Threads::Threads ${CMAKE_DL_LIBS} INTERFACE glm::glm)
set_target_properties(catena_library PROPERTIES OUTPUT_NAME catena EXPORT_NAME library LINKER_LANGUAGE CXX LINK_DEPENDS ${PROJECT_BINARY_DIR}/exports.map
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
target_link_options(catena_library PRIVATE -Wl,--version-script=${PROJECT_BINARY_DIR}/exports.map -Wl,--no-undefined -Wl,--as-needed
  -Wl,-z,relro,-z,now,-z,noexecstack)
target_include_directories(catena_library INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${generated}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/catena>)
target_compile_features(catena_library INTERFACE cxx_std_20)
add_dependencies(catena_library ${helpers})

# Parts of it by what they are for: one library is behind all of them.
function(catena_part NAME)
  add_library(catena_part_${NAME} INTERFACE)
  add_library(catena::${NAME} ALIAS catena_part_${NAME})
  set_target_properties(catena_part_${NAME} PROPERTIES EXPORT_NAME ${NAME})
  target_link_libraries(catena_part_${NAME} INTERFACE ${ARGN})
endfunction()
add_library(catena::library ALIAS catena_library)
catena_part(field catena_library)
catena_part(flow catena_part_field)
catena_part(haptics catena_part_flow)
target_compile_options(catena_part_haptics INTERFACE -ffp-contract=off)  # a tick repeats to the bit
catena_part(render catena_part_field Vulkan::Vulkan)

if(CATENA_PYTHON)
  include(engine/python/python.cmake)
endif()
if(NOT CATENA_INSTALL)
  return()
endif()

# ---- what is installed of it ----
install(TARGETS catena_library catena_part_plugin catena_part_field catena_part_flow catena_part_haptics catena_part_render EXPORT catena
  LIBRARY COMPONENT library NAMELINK_COMPONENT development)
install(FILES ${generated}/engine/base/export.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/catena/engine/base COMPONENT development)
foreach(header ${CATENA_PUBLIC_HEADERS})
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/catena/${folder} COMPONENT development)
endforeach()
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/catena)
install(EXPORT catena NAMESPACE catena:: DESTINATION ${package} COMPONENT development)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/catena-config-version.cmake COMPATIBILITY SameMinorVersion)
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/catena-config.cmake CONTENT
  "include(CMakeFindDependencyMacro)\nfind_dependency(glm)\nfind_dependency(Vulkan)\ninclude(\${CMAKE_CURRENT_LIST_DIR}/catena.cmake)\n")
install(FILES ${PROJECT_BINARY_DIR}/catena-config.cmake ${PROJECT_BINARY_DIR}/catena-config-version.cmake DESTINATION ${package}
  COMPONENT development)
install(DIRECTORY docs/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT development)

include(engine/cmake/deb.cmake)
