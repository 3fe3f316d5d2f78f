# Each component that can be built here, and how others find it. Of odeint and mpi there are headers alone, which are
# installed whether or not this machine has what their users need.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME nysalt_development)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/nysalt)
foreach(component IN LISTS nysalt_components)
  if(NOT TARGET nysalt_${component})
    continue()
  endif()
  set(headers FILE_SET HEADERS)
  if(component STREQUAL "shared")
    set(headers "")
  endif()
  # The shared library itself is what programs run with; all else is for who compiles.
  install(TARGETS nysalt_${component} EXPORT nysalt_${component} ARCHIVE
    LIBRARY COMPONENT nysalt_library NAMELINK_COMPONENT nysalt_development ${headers})
  install(EXPORT nysalt_${component} NAMESPACE nysalt:: FILE nysalt-${component}.cmake
    DESTINATION ${package_dir})
endforeach()
install(FILES include/nysalt/c_force.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/nysalt)
write_basic_package_version_file(nysaltConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/nysaltConfig.cmake cmake/nysaltNeeds.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/nysaltConfigVersion.cmake DESTINATION ${package_dir})

# For who builds without CMake. Boost's headers have no file of this kind, and MPI has compilers of its own:
# nysalt.pc is theirs too. The flags are those of the CMake targets, but the version of C++ is left to the
# command line. With --static there is what the static library needs, named as it is linked: the shared library
# needs no file of theirs.
set(pkg_config_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
if(IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR} OR IS_ABSOLUTE ${CMAKE_INSTALL_INCLUDEDIR})
  set(prefix ${CMAKE_INSTALL_PREFIX})
  set(include_dir ${CMAKE_INSTALL_FULL_INCLUDEDIR})
  set(lib_dir ${CMAKE_INSTALL_FULL_LIBDIR})
else()  # from where the file stands, so that the tree can be moved
  file(RELATIVE_PATH up /prefix/${pkg_config_dir} /prefix)
  string(REGEX REPLACE "/$" "" up "${up}")
  set(prefix "\${pcfiledir}/${up}")
  set(include_dir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
  set(lib_dir "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
endif()
function(add_pkg_config name description requires cflags libs private_libs)
  configure_file(cmake/pkg_config.pc.in ${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${pkg_config_dir})
endfunction()
list(JOIN nysalt_flags " " flags)
add_pkg_config(nysalt-core "${PROJECT_DESCRIPTION}: systems, methods and steps" "eigen3 >= 3.4"
  "-I\${includedir} ${flags}" "" "")
if(TARGET nysalt::nysalt)
  get_target_property(definitions nysalt_nysalt INTERFACE_COMPILE_DEFINITIONS)
  list(TRANSFORM definitions PREPEND -D)
  list(JOIN definitions " " definitions)
  list(JOIN nysalt_native_flags " " native)
  string(STRIP "${definitions} ${native}" flags)
  add_pkg_config(nysalt "${PROJECT_DESCRIPTION}" "nysalt-core = ${PROJECT_VERSION}" "${flags}"
    "-L\${libdir} -lnysalt" "-lceres -ltbb -lfmt")
  if(TARGET nysalt::report)
    add_pkg_config(nysalt-report "${PROJECT_DESCRIPTION}: comparisons and reports" "nysalt = ${PROJECT_VERSION}" ""
      "-L\${libdir} -lnysalt_report -lnysalt -lfmt -ltbb" "")
  endif()
  add_pkg_config(nysalt-learn "${PROJECT_DESCRIPTION}: the learner" "nysalt = ${PROJECT_VERSION}" "" "" "")
endif()
