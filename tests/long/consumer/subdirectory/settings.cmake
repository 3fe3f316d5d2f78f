# What add_subdirectory could do to the project around it, and must not.

set(watched_properties COMPILE_DEFINITIONS COMPILE_OPTIONS INCLUDE_DIRECTORIES LINK_DIRECTORIES LINK_LIBRARIES
  LINK_OPTIONS TESTS)

macro(list_settings)
  get_cmake_property(variables VARIABLES)
  list(FILTER variables INCLUDE REGEX "^(CMAKE|BUILD)_")
  list(FILTER variables EXCLUDE REGEX "^CMAKE_(MATCH|CURRENT_FUNCTION)")  # CMake's own
  foreach(property IN LISTS watched_properties)
    get_directory_property(${property} ${property})
  endforeach()
endmacro()

macro(remember_settings)
  list_settings()
  foreach(name IN LISTS variables watched_properties)
    set(earlier_${name} "${${name}}")
  endforeach()
endmacro()

# What find_package adds to the cache is new, and no change.
function(compare_settings)
  list_settings()
  foreach(name IN LISTS variables watched_properties)
    if(NOT DEFINED earlier_${name} AND DEFINED CACHE{${name}})
      continue()
    endif()
    if(NOT "${${name}}" STREQUAL "${earlier_${name}}")
      message(FATAL_ERROR "${name} was '${earlier_${name}}', nysalt makes it '${${name}}'")
    endif()
  endforeach()
endfunction()

function(require_nothing_to_build folder)
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(tests DIRECTORY ${folder} PROPERTY TESTS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    get_target_property(waits ${target} EXCLUDE_FROM_ALL)
    if(type STREQUAL "INTERFACE_LIBRARY" OR waits)
      list(REMOVE_ITEM targets ${target})
    endif()
  endforeach()
  if(folders OR targets OR tests)
    message(FATAL_ERROR "nysalt builds more than is asked for: ${folders} ${targets} ${tests}")
  endif()
endfunction()
