# The headers of all components, whatever this machine has, and how others find them. Nothing of it has to be built,
# and nothing depends on the machine.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME nysalt_development)

set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/nysalt)
foreach(component IN LISTS nysalt_components)
  install(TARGETS nysalt_${component} EXPORT nysalt_${component} FILE_SET HEADERS)
  install(EXPORT nysalt_${component} NAMESPACE nysalt:: FILE nysalt-${component}.cmake DESTINATION ${package_dir})
endforeach()
configure_package_config_file(cmake/nysaltConfig.cmake.in nysaltConfig.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(nysaltConfigVersion.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES cmake/nysaltNeeds.cmake ${CMAKE_CURRENT_BINARY_DIR}/nysaltConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/nysaltConfigVersion.cmake DESTINATION ${package_dir})
