# SPDX-License-Identifier: MIT
# The Python module: `import catena` after `cmake --install`, or from build/PRESET/python. Optional: it needs pybind11-dev and python3-dev.
if(NOT DEFINED Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)  # the system's, whose packages the module works with, not another one of PATH
endif()
find_package(Python3 COMPONENTS Interpreter Development.Module)
find_package(pybind11 CONFIG QUIET)
if(NOT Python3_FOUND OR NOT pybind11_FOUND)
  message(STATUS "The Python module will not be built: pybind11-dev or python3-dev is missing")
  return()
endif()
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(default lib/python3/dist-packages)
else()
  set(default lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/dist-packages)
endif()
set(CATENA_PYTHON_FOLDER ${default} CACHE STRING "where the Python package is installed, below the prefix")

file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/engine/python/*.cpp)
python3_add_library(catena_python MODULE WITH_SOABI ${sources})
# its warnings are the house's, what it may see is what is installed; a binding needs no speed of its own
get_target_property(options catena_flags INTERFACE_COMPILE_OPTIONS)
target_compile_options(catena_python PRIVATE ${options})
target_link_libraries(catena_python PRIVATE pybind11::headers catena::haptics catena::render)
file(RELATIVE_PATH to_library /${CATENA_PYTHON_FOLDER}/catena /${CMAKE_INSTALL_LIBDIR})
set_target_properties(catena_python PROPERTIES OUTPUT_NAME _catena CXX_VISIBILITY_PRESET hidden INSTALL_RPATH "$ORIGIN/${to_library}"
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/python/catena)
file(GLOB scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/engine/python/catena/*.py ${PROJECT_SOURCE_DIR}/engine/python/catena/*.pyi
  ${PROJECT_SOURCE_DIR}/engine/python/catena/py.typed)
add_custom_command(TARGET catena_python POST_BUILD
  COMMAND ${CMAKE_COMMAND} -E copy_if_different ${scripts} ${PROJECT_BINARY_DIR}/python/catena)
if(CATENA_INSTALL)
  install(TARGETS catena_python LIBRARY DESTINATION ${CATENA_PYTHON_FOLDER}/catena COMPONENT python)
  install(FILES ${scripts} DESTINATION ${CATENA_PYTHON_FOLDER}/catena COMPONENT python)
endif()
