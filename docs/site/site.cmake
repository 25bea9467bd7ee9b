# The target `docs`: the documents and the public headers as a site, build/PRESET/site/index.html. Optional: it needs doxygen.
if(NOT TARGET catena_library)
  return()
endif()
find_program(CATENA_DOXYGEN doxygen)
find_program(CATENA_PERL perl)
if(NOT CATENA_DOXYGEN OR NOT CATENA_PERL)
  add_custom_target(docs COMMAND ${CMAKE_COMMAND} -E echo "The site is not made: doxygen is missing (apt-get install doxygen)"
    COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
  return()
endif()
file(GLOB pages CONFIGURE_DEPENDS README.md SECURITY.md CONTRIBUTING.md engine/app/viewer/README.md docs/*.md docs/*/*.md)
list(TRANSFORM CATENA_PUBLIC_HEADERS PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE headers)
string(REPLACE ";" " " CATENA_SITE_INPUT "${pages};${headers}")
configure_file(docs/site/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
# beside the pages: what they link to that is no page
add_custom_target(docs
  COMMAND ${CATENA_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${PROJECT_SOURCE_DIR}/docs/examples ${PROJECT_BINARY_DIR}/site/examples
  COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_BINARY_DIR}/site
  COMMENT "The documents' site: site/index.html" VERBATIM)
