# The components of nysalt, and what each needs of the others and of other projects. Read by nysalt's own
# CMakeLists.txt and, installed, by find_package(nysalt).

set(nysalt_components core nysalt shared learn report odeint mpi)
set(nysalt_compiled nysalt shared)  # one library, static and shared
set(nysalt_core_needs Eigen3)
set(nysalt_nysalt_needs core fmt TBB Ceres)  # to be linked with: no header of ours includes them
set(nysalt_shared_needs core)
set(nysalt_learn_needs nysalt)
set(nysalt_report_needs nysalt fmt TBB)  # to be linked with, as above
set(nysalt_report_library_needs nlohmann_json mustache)  # to compile it
set(nysalt_odeint_needs core Boost)
set(nysalt_mpi_needs nysalt MPI)
set(nysalt_library_needs core Boost fmt TBB Ceres)  # to compile it

# By its package: the target, the version, and the name for people.
macro(nysalt_describe package target version name)
  set(nysalt_target_of_${package} ${target})
  set(nysalt_version_of_${package} ${version})
  set(nysalt_name_of_${package} "${name}")
endmacro()
nysalt_describe(Eigen3 Eigen3::Eigen 3.4 "Eigen 3.4 (Debian: libeigen3-dev, or set Eigen3_DIR)")
nysalt_describe(Boost Boost::headers 1.74 "Boost 1.74, its headers (Debian: libboost-dev, or set Boost_DIR)")
nysalt_describe(fmt fmt::fmt 9 "fmt 9 (Debian: libfmt-dev, or set fmt_DIR)")
nysalt_describe(TBB TBB::tbb 2021 "oneTBB 2021 (Debian: libtbb-dev, or set TBB_DIR)")
nysalt_describe(Ceres Ceres::ceres 2.1 "Ceres 2.1 (Debian: libceres-dev, or set Ceres_DIR)")
nysalt_describe(nlohmann_json nlohmann_json::nlohmann_json 3.11
  "nlohmann-json 3.11 (Debian: nlohmann-json3-dev, or set nlohmann_json_DIR)")
nysalt_describe(mustache nysalt::mustache 4.1
  "mustache 4.1 of Kevin Wojniak, a header (Debian: libkainjow-mustache-dev, or set NYSALT_MUSTACHE)")
nysalt_describe(MPI MPI::MPI_CXX 3.1 "an MPI 3.1 for C++ (Debian: libopenmpi-dev, or set MPI_HOME)")

# What is linked for a package.
function(nysalt_library_of package result)
  set(${result} ${nysalt_target_of_${package}} PARENT_SCOPE)
  if(package STREQUAL "Ceres")
    set(${result} nysalt::ceres PARENT_SCOPE)
  endif()
endfunction()

# In a function, so that what the packages set does not reach who looks for nysalt.
function(nysalt_look_for package)
  set(options "")
  if(package STREQUAL Eigen3)
    set(options NO_MODULE)
  elseif(package STREQUAL MPI)
    set(options COMPONENTS CXX)
    set(MPI_CXX_SKIP_MPICXX ON)  # its C++ bindings are long gone, and ours is the C interface
  endif()
  if(package STREQUAL mustache)  # which has no package of CMake
    find_path(NYSALT_MUSTACHE kainjow/mustache.hpp)
    if(NYSALT_MUSTACHE)
      add_library(nysalt::mustache INTERFACE IMPORTED)
      set_target_properties(nysalt::mustache PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${NYSALT_MUSTACHE})
    endif()
    return()
  endif()
  set(CMAKE_MESSAGE_LOG_LEVEL WARNING)  # Ceres tells of what it looks for, QUIET or not
  find_package(${package} ${nysalt_version_of_${package}} QUIET ${options})
endfunction()

# nysalt::ceres, the shared library of Ceres where there is one. Debian's package names the static one, which holds
# functions of Eigen that are compiled for 16 bytes of alignment, and ours are for 64: in one program the linker takes
# either for both, and memory would be given back as what it is not. The shared one keeps its own to itself.
function(nysalt_take_shared_ceres)
  if(NOT TARGET Ceres::ceres OR TARGET nysalt::ceres)
    return()
  endif()
  add_library(nysalt::ceres INTERFACE IMPORTED)
  get_target_property(type Ceres::ceres TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    get_target_property(static Ceres::ceres LOCATION)
    cmake_path(REPLACE_EXTENSION static LAST_ONLY ${CMAKE_SHARED_LIBRARY_SUFFIX} OUTPUT_VARIABLE shared)
    if(EXISTS ${shared})
      get_target_property(includes Ceres::ceres INTERFACE_INCLUDE_DIRECTORIES)
      set_target_properties(nysalt::ceres PROPERTIES
        INTERFACE_INCLUDE_DIRECTORIES "${includes}" INTERFACE_LINK_LIBRARIES ${shared})
      return()
    endif()
  endif()
  set_target_properties(nysalt::ceres PROPERTIES INTERFACE_LINK_LIBRARIES Ceres::ceres)
endfunction()

# Looks for all that a component needs, and names what is not there; `missing` is empty if all is. What the
# project around us has found before is taken, unless it is known to be too old.
function(nysalt_look_for_needs_of component missing)
  set(names "")
  foreach(need IN LISTS nysalt_${component}_needs)
    if(need IN_LIST nysalt_components)
      nysalt_look_for_needs_of(${need} further)
      list(APPEND names ${further})
      continue()
    endif()
    if(NOT TARGET ${nysalt_target_of_${need}})
      nysalt_look_for(${need})
      set(${need}_VERSION "")
    endif()
    if(NOT TARGET ${nysalt_target_of_${need}})
      list(APPEND names "${nysalt_name_of_${need}}")
    elseif(NOT "${${need}_VERSION}" STREQUAL "" AND ${need}_VERSION VERSION_LESS ${nysalt_version_of_${need}})
      list(APPEND names "${nysalt_name_of_${need}}, not the ${${need}_VERSION} that was found before")
    endif()
    if(need STREQUAL "Ceres")
      nysalt_take_shared_ceres()
    endif()
  endforeach()
  list(JOIN names " and " names)
  set(${missing} "${names}" PARENT_SCOPE)
endfunction()
