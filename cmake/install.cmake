# The headers of all components, whatever this machine has, and how others find them. Nothing of it has to be
# built, and nothing depends on the machine.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME nysalt_development)

set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/nysalt)
foreach(component IN LISTS nysalt_components)
  install(TARGETS nysalt_${component} EXPORT nysalt_${component} FILE_SET HEADERS)
  install(EXPORT nysalt_${component} NAMESPACE nysalt:: FILE nysalt-${component}.cmake
    DESTINATION ${package_dir})
endforeach()
write_basic_package_version_file(nysaltConfigVersion.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES cmake/nysaltConfig.cmake cmake/nysaltNeeds.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/nysaltConfigVersion.cmake DESTINATION ${package_dir})

# For who builds without CMake. Boost's headers have no file of this kind, and MPI has compilers of its own:
# nysalt.pc is theirs too. The flags are those of the CMake targets, but the version of C++ is left to the
# command line.
set(pkg_config_dir ${CMAKE_INSTALL_DATADIR}/pkgconfig)
if(IS_ABSOLUTE ${CMAKE_INSTALL_DATADIR} OR IS_ABSOLUTE ${CMAKE_INSTALL_INCLUDEDIR})
  set(prefix ${CMAKE_INSTALL_PREFIX})
  set(include_dir ${CMAKE_INSTALL_FULL_INCLUDEDIR})
else()  # from where the file stands, so that the tree can be moved
  file(RELATIVE_PATH up /prefix/${pkg_config_dir} /prefix)
  string(REGEX REPLACE "/$" "" up "${up}")
  set(prefix "\${pcfiledir}/${up}")
  set(include_dir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
endif()
function(add_pkg_config name description requires cflags libs)
  configure_file(cmake/pkg_config.pc.in ${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${pkg_config_dir})
endfunction()
list(JOIN nysalt_flags " " flags)
add_pkg_config(nysalt-core "${PROJECT_DESCRIPTION}: systems, methods and steps" "eigen3 >= 3.4"
  "-I\${includedir} ${flags}" "")
add_pkg_config(nysalt "${PROJECT_DESCRIPTION}"
  "nysalt-core = ${PROJECT_VERSION}, fmt >= 9, tbb >= 2021" "" "")
add_pkg_config(nysalt-learn "${PROJECT_DESCRIPTION}: the learner" "nysalt = ${PROJECT_VERSION}, libglog" ""
  "-lceres")
