# SPDX-License-Identifier: MIT
# Debian packages: cmake --preset package && cmake --build --preset package && cpack --config build/package/CPackConfig.cmake
#   catena          the program, the helpers that it and the library start, manual pages, completion, scenes, the rules for devices
#   libcatena0.3    the shared library
#   libcatena-dev   headers, `find_package(catena)`, examples
#   python3-catena  the Python module
# What they depend on is found by dpkg-shlibdeps. Nothing but the program's package asks anything of the machine: it makes the group
# catena, whose members may use the Falcon and the haptic thread's priority without being root.

# ---- what the program says of itself ----
set(manual ${PROJECT_BINARY_DIR}/manual)
add_custom_command(OUTPUT ${manual}/catena.1 ${manual}/catena.bash
  COMMAND ${CMAKE_COMMAND} -E make_directory ${manual}
  COMMAND catena documents man ${manual}
  COMMAND catena documents completion ${manual}/catena.bash
  DEPENDS catena COMMENT "Manual pages and completion")
add_custom_target(catena_manual ALL DEPENDS ${manual}/catena.1)
set(pages ${manual}/)
find_program(CATENA_GZIP gzip)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND CATENA_GZIP)  # as packages have them
  set(pages ${PROJECT_BINARY_DIR}/manual-packed/)
  add_custom_command(OUTPUT ${pages}catena.1.gz
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${pages} COMMAND ${CMAKE_COMMAND} -E make_directory ${pages}
    COMMAND cp ${manual}/*.1 ${pages} COMMAND ${CATENA_GZIP} -9n ${pages}*.1
    DEPENDS ${manual}/catena.1 COMMENT "Manual pages, packed")
  add_custom_target(catena_manual_packed ALL DEPENDS ${pages}catena.1.gz)
endif()
install(DIRECTORY ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT catena FILES_MATCHING PATTERN *.1 PATTERN *.1.gz)
install(FILES ${manual}/catena.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME catena COMPONENT catena)

# ---- rules of the machine, and each package's licence: only where packages go ----
set(abi ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(so libcatena${abi})
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  foreach(pair catena:catena library:${so} development:libcatena-dev python:python3-catena)
    string(REGEX MATCH "(.*):(.*)" pair ${pair})
    install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CMAKE_MATCH_2} RENAME copyright COMPONENT ${CMAKE_MATCH_1})
  endforeach()
  install(FILES assets/system/60-catena.rules DESTINATION lib/udev/rules.d COMPONENT catena)
  install(FILES assets/system/catena.conf DESTINATION /etc/security/limits.d COMPONENT catena)
endif()
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/deb/postinst CONTENT "#!/bin/sh\nset -e\n\
if [ \"$1\" = configure ]; then\n  getent group catena >/dev/null || groupadd --system catena\n\
  if command -v udevadm >/dev/null; then udevadm control --reload 2>/dev/null || true; fi\nfi\n"
  FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/deb/conffiles CONTENT "/etc/security/limits.d/catena.conf\n")
# what a package depends on that is linked to the library (the module for Python has no SONAME: CPack would warn of it)
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/deb/shlibs CONTENT "libcatena ${abi} ${so} (>= ${PROJECT_VERSION})\n")

# ---- the packages ----
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL catena)
if(TARGET catena_library)
  list(APPEND CPACK_COMPONENTS_ALL library development)
endif()
if(TARGET catena_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_PACKAGE_NAME catena)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
# Debian asks for an address of who answers for a package: that is whoever builds it, and says so as Debian's own tools are told
set(contact "The Catena authors")
if(DEFINED ENV{DEBEMAIL} AND "$ENV{DEBEMAIL}" MATCHES "<.+@.+>")
  set(contact "$ENV{DEBEMAIL}")
elseif(DEFINED ENV{DEBEMAIL} AND DEFINED ENV{DEBFULLNAME})
  set(contact "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(CATENA_CONTACT "${contact}" CACHE STRING "who answers for the packages: NAME <ADDRESS>")
set(CPACK_PACKAGE_CONTACT "${CATENA_CONTACT}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(same "(= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_CATENA_DESCRIPTION "See a scientific field and feel it with a hand
Vulkan draws volumes, surfaces and streamlines; a chain of proxies gives, a thousand times a second, the force with which a hand follows
them.")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "See and feel scientific fields: the shared library")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "See and feel scientific fields: headers, CMake package, examples")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "See and feel scientific fields: the Python module")
set(CPACK_DEBIAN_CATENA_PACKAGE_NAME catena)
set(CPACK_DEBIAN_CATENA_PACKAGE_SECTION science)
set(CPACK_DEBIAN_CATENA_PACKAGE_DEPENDS "mesa-vulkan-drivers | vulkan-icd, fonts-dejavu-core, passwd")
set(CPACK_DEBIAN_CATENA_PACKAGE_RECOMMENDS "gnuplot-nox, ffmpeg, mricron-data")
set(CPACK_DEBIAN_CATENA_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/deb/postinst;${PROJECT_BINARY_DIR}/deb/conffiles")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${so})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/deb/shlibs")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "catena ${same}")  # the helpers
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libcatena-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${so} ${same}, libglm-dev, libvulkan-dev")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-catena)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${so} ${same}, python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
include(CPack)
