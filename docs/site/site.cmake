# SPDX-License-Identifier: MIT
# The target `docs`: the documents and the public headers as a site, build/PRESET/site/index.html. Optional: it needs doxygen.
if(NOT TARGET catena_library OR NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
find_program(CATENA_DOXYGEN doxygen)
if(NOT CATENA_DOXYGEN)
  add_custom_target(docs COMMAND ${CMAKE_COMMAND} -E echo "The site is not made: doxygen is missing (apt-get install doxygen)"
    COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
  return()
endif()
file(GLOB_RECURSE pages CONFIGURE_DEPENDS docs/*.md docs/site/*.dox)
list(PREPEND pages ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/SECURITY.md ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md
  ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
list(TRANSFORM CATENA_PUBLIC_HEADERS PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE headers)
string(REPLACE ";" "\" \"" CATENA_SITE_INPUT "\"${pages};${headers}\"")
configure_file(docs/site/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
# beside the pages: what they link to that is no page
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/site.cmake @ONLY CONTENT [[
execute_process(COMMAND "@CATENA_DOXYGEN@" "@PROJECT_BINARY_DIR@/Doxyfile" COMMAND_ERROR_IS_FATAL ANY)
file(COPY "@PROJECT_SOURCE_DIR@/docs/examples" "@PROJECT_SOURCE_DIR@/LICENSE" DESTINATION "@PROJECT_BINARY_DIR@/site")
]])
add_custom_target(docs COMMAND ${CMAKE_COMMAND} -P ${PROJECT_BINARY_DIR}/site.cmake COMMENT "The documents' site: site/index.html" VERBATIM)
