# The compiled library: each source once, as an object that may stand anywhere in memory, and of the objects
# libnysalt.a (nysalt::nysalt) and libnysalt.so (nysalt::shared).

# nysalt_nysalt or nysalt_shared. In the project of others both are made when something asks for them.
function(add_library_of component)
  set(library nysalt_${component})
  set(kind STATIC)
  if(component STREQUAL "shared")
    set(kind SHARED)
  endif()
  set(if_asked_for EXCLUDE_FROM_ALL)
  if(NYSALT_INSTALL)
    set(if_asked_for "")
  endif()
  add_library(${library} ${kind} ${if_asked_for} $<TARGET_OBJECTS:nysalt_objects>)
  set_target_properties(${library} PROPERTIES OUTPUT_NAME nysalt LINKER_LANGUAGE CXX
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
endfunction()

# What the library and those who use it must be compiled with alike.
function(agree_with_users library)
  # Eigen's own vectors round differently from machine to machine, and our hot loops do without them; what
  # Eigen allocates must still be aligned as packs want it, by the library and by those who use it.
  target_compile_definitions(${library} PUBLIC EIGEN_DONT_VECTORIZE EIGEN_MAX_ALIGN_BYTES=64)
  # The number of lanes is part of the interface: detail::library_is_compiled_for says so to the linker.
  foreach(flag IN LISTS nysalt_native_flags)
    target_compile_options(${library} PUBLIC $<$<COMPILE_LANGUAGE:CXX>:${flag}>)
  endforeach()
endfunction()

# A source that holds the files of share/exports, so that programs and modules need no folder of nysalt.
function(embed_templates source)
  file(GLOB templates CONFIGURE_DEPENDS share/exports/*.in)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${templates})
  list(LENGTH templates NYSALT_TEMPLATE_COUNT)
  set(NYSALT_TEMPLATES "")
  foreach(template IN LISTS templates)
    cmake_path(GET template FILENAME name)
    file(READ ${template} text)
    string(APPEND NYSALT_TEMPLATES "    {\"${name}\", R\"template(${text})template\"},\n")
  endforeach()
  configure_file(src/nysalt/exports/bundled_templates.cpp.in ${source} @ONLY)
endfunction()

function(compile_library)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS src/nysalt/*.cpp)
  set(templates ${CMAKE_CURRENT_BINARY_DIR}/exports/bundled_templates.cpp)
  embed_templates(${templates})
  set_source_files_properties(${templates} PROPERTIES INCLUDE_DIRECTORIES ${CMAKE_CURRENT_SOURCE_DIR}/src/nysalt/exports)
  list(APPEND sources ${templates})
  add_library(nysalt_objects OBJECT EXCLUDE_FROM_ALL ${sources})
  # Of the shared library users see names of nysalt, and nothing of what it has of Eigen and others: a list for
  # the linker says so, and not the compiler, as the static library is made of the same objects.
  set_target_properties(nysalt_objects PROPERTIES POSITION_INDEPENDENT_CODE ON
    CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN OFF)
  target_link_libraries(nysalt_objects PRIVATE nysalt_core)
  if(PROJECT_IS_TOP_LEVEL)
    target_link_libraries(nysalt_objects PRIVATE nysalt_warnings)
  endif()
  target_precompile_headers(nysalt_objects PRIVATE cmake/precompiled.hpp)
  # Sources of a folder include the same, and are compiled together, which takes a third of the time. No two of
  # them may give one name to two things. Not those that the systems of users need of the static library: a linker
  # takes whole objects, and would take the learner, and want Ceres, with them. The passes over data are a unit of
  # their own: in a larger one g++ no longer inlines the operators of derivatives there.
  foreach(source IN LISTS sources)
    if(NOT source MATCHES "/losses/passes.cpp$" AND source MATCHES "/(analysis|exports|learning|losses|sampling)/")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${CMAKE_MATCH_1})
    endif()
  endforeach()
  set_target_properties(nysalt_objects PROPERTIES UNITY_BUILD_MODE GROUP)
  if(NOT NYSALT_COMPILE_APART)
    set_target_properties(nysalt_objects PROPERTIES UNITY_BUILD ON)
  endif()
  foreach(need IN LISTS nysalt_library_needs)
    if(need IN_LIST nysalt_components)
      continue()
    endif()
    nysalt_library_of(${need} theirs)
    target_link_libraries(nysalt_objects PRIVATE ${theirs})
    if(need IN_LIST nysalt_nysalt_needs)
      target_link_libraries(nysalt_nysalt PRIVATE ${theirs})
      target_link_libraries(nysalt_shared PRIVATE ${theirs})
    endif()
  endforeach()
  foreach(library IN ITEMS objects nysalt shared)
    agree_with_users(nysalt_${library})
  endforeach()
  if(UNIX AND NOT APPLE)
    set(exported ${PROJECT_SOURCE_DIR}/cmake/exported.map)
    target_link_options(nysalt_shared PRIVATE LINKER:--version-script=${exported})
    set_target_properties(nysalt_shared PROPERTIES LINK_DEPENDS ${exported})
  endif()
endfunction()
