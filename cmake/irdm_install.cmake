# What is installed, in two components: `runtime` (programs, page, configurations, documents) and `development`
# (libraries and headers for programs that embed the renderer; docs/embedding.md).
include(CMakePackageConfigHelpers)

set(data ${CMAKE_INSTALL_DATADIR}/irdm)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/irdm)

install(DIRECTORY configs/ DESTINATION ${data}/configs COMPONENT runtime)
install(PROGRAMS scripts/plot_comparison.py scripts/plot_force.py DESTINATION ${data}/scripts COMPONENT runtime)
install(DIRECTORY examples/tutorial DESTINATION ${data}/examples COMPONENT runtime)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT runtime)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)

# irdm::common, irdm::simulation, irdm::scene and irdm::trace.
set(embedded common simulation scene trace)
foreach(folder ${embedded})
  set_target_properties(irdm_${folder} PROPERTIES EXPORT_NAME ${folder})
  install(TARGETS irdm_${folder} EXPORT irdm_targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/irdm
    COMPONENT development FILES_MATCHING PATTERN "*.hpp")
endforeach()
set_target_properties(irdm_options PROPERTIES EXPORT_NAME options)
install(TARGETS irdm_options EXPORT irdm_targets COMPONENT development)
install(EXPORT irdm_targets NAMESPACE irdm:: FILE irdm-targets.cmake
  DESTINATION ${package} COMPONENT development)

configure_package_config_file(cmake/irdm-config.cmake.in ${PROJECT_BINARY_DIR}/irdm-config.cmake
  INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/irdm-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/irdm-config.cmake ${PROJECT_BINARY_DIR}/irdm-config-version.cmake
  DESTINATION ${package} COMPONENT development)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/irdm-dev RENAME copyright COMPONENT development)
install(DIRECTORY examples/python DESTINATION ${data}/examples COMPONENT python)
install(DIRECTORY examples/embed examples/c examples/csharp examples/engines DESTINATION ${data}/examples COMPONENT development)
