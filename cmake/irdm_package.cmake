# What a package has beside programs and libraries: man pages, completion, systemd units; and the Debian packages
# themselves, `cpack -G DEB` in the build folder: irdm; for programs that embed it, irdm-dev; and python3-irdm.
set(files ${PROJECT_SOURCE_DIR}/cmake/package)

install(PROGRAMS scripts/irdm-play DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
install(FILES ${files}/irdm-server.service ${files}/irdm-bridge.service
  DESTINATION lib/systemd/system COMPONENT runtime)
set(programs irdm-bridge irdm-play irdm-precompute irdm-replay irdm-server)
if(TARGET irdm-ros-bridge)
  list(APPEND programs irdm-ros-bridge)
endif()
foreach(program ${programs})  # bash looks for a file of the program's name
  install(FILES ${files}/irdm.bash-completion DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    RENAME ${program} COMPONENT runtime)
endforeach()

# All that is packaged, without tests and benchmarks.
add_custom_target(irdm_packaged DEPENDS irdm-bridge irdm-precompute irdm-replay irdm-server irdm_c irdm_scene irdm_trace)
foreach(optional irdm_python irdm-ros-bridge)
  if(TARGET ${optional})
    add_dependencies(irdm_packaged ${optional})
  endif()
endforeach()

find_program(IRDM_HELP2MAN help2man)
if(IRDM_HELP2MAN AND NOT IRDM_SANITIZE)
  set(man ${PROJECT_BINARY_DIR}/man)
  set(built ${programs})
  list(REMOVE_ITEM built irdm-play)
  set(commands ${PROJECT_SOURCE_DIR}/scripts/irdm-play)
  foreach(program ${built})
    list(APPEND commands $<TARGET_FILE:${program}>)
  endforeach()
  add_custom_command(
    OUTPUT ${man}/irdm-server.1.gz
    COMMAND ${CMAKE_COMMAND} -E env IRDM_DATA=${PROJECT_SOURCE_DIR}
      ${files}/man_pages.sh ${man} ${PROJECT_VERSION} ${commands}
    DEPENDS ${built} ${files}/man_pages.sh ${files}/man_sections.h2m scripts/irdm-play
    COMMENT "Making the man pages"
    VERBATIM)
  add_custom_target(irdm_man ALL DEPENDS ${man}/irdm-server.1.gz)
  add_dependencies(irdm_packaged irdm_man)
  install(DIRECTORY ${man}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
elseif(NOT IRDM_SANITIZE)
  message(STATUS "help2man not found: no man pages")
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME irdm)
set(IRDM_PACKAGE_CONTACT "The authors of irdm <irdm@localhost>" CACHE STRING "Maintainer of the Debian packages")
set(CPACK_PACKAGE_CONTACT ${IRDM_PACKAGE_CONTACT})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "haptic rendering of soft, free-floating objects")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development)
if(TARGET irdm_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
"Precomputes the impulse responses of a soft object and renders its forces
to force-feedback styluses and its shape to browsers, in real time.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME irdm)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS tetgen)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "gmsh, python3-h5py, python3-matplotlib")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "bash-completion, chromium, ffmpeg")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${files}/postinst ${files}/prerm ${files}/postrm ${files}/triggers)

set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"Static libraries and headers of irdm's force step, scenes and traces, for
programs that embed them by find_package(irdm), and the C interface.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME irdm-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "irdm (= ${PROJECT_VERSION}), libboost-dev, libeigen3-dev, libhdf5-dev, libspdlog-dev, libssl-dev, libtomlplusplus-dev")

set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"Simulations, models, recordings and contact forces of irdm as numpy arrays.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-irdm)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "irdm (= ${PROJECT_VERSION}), python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-h5py)
include(CPack)
