# The target headers_alone compiles each header alone. What many of them include themselves is precompiled for
# those, and for those only: it must not help a header that forgot it.

set(dear_includes Eigen/Core Eigen/Eigenvalues)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86|AMD64")
  list(APPEND dear_includes immintrin.h)
endif()

set(all_headers "")
set(all_components "")
foreach(component IN LISTS nysalt_components)
  if(TARGET nysalt::${component})
    get_target_property(paths nysalt_${component} HEADER_SET)
    foreach(path IN LISTS paths)
      cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${PROJECT_SOURCE_DIR}/include OUTPUT_VARIABLE header)
      list(APPEND all_headers ${header})
    endforeach()
    list(APPEND all_components nysalt_${component})
  endif()
endforeach()

# What users compile reads Eigen and the standard library alone: others are the library's own affair.
foreach(component IN ITEMS core nysalt)
  foreach(header IN LISTS headers_of_${component})
    file(STRINGS ${header} theirs REGEX "^#include <(fmt|boost|oneapi|tbb|ceres|glog)/")
    if(theirs)
      message(SEND_ERROR "${header} has '${theirs}', which those who use nysalt need not have: a source may")
    endif()
  endforeach()
endforeach()

# In groups that include the same of what is dear.
add_custom_target(headers_alone)
foreach(header IN LISTS all_headers)
  find_includes(${header} all)
  set(its_dear "")
  foreach(dear IN LISTS dear_includes)
    if(dear IN_LIST all)
      list(APPEND its_dear ${dear})
    endif()
  endforeach()
  if(NOT "${its_dear}" STREQUAL "${dear_includes}")
    list(REMOVE_ITEM its_dear Eigen/Eigenvalues)  # few include it without all others: not worth their groups
  endif()
  string(MAKE_C_IDENTIFIER "headers_${its_dear}" group)
  if(NOT TARGET ${group})
    add_library(${group} OBJECT EXCLUDE_FROM_ALL)
    target_link_libraries(${group} PRIVATE ${all_components} nysalt_warnings)
    target_compile_options(${group} PRIVATE -O0)  # all that counts is whether they compile
    list(TRANSFORM its_dear REPLACE "(.+)" "<\\1>")
    target_precompile_headers(${group} PRIVATE ${its_dear})
    add_dependencies(headers_alone ${group})
  endif()
  set(source ${PROJECT_BINARY_DIR}/headers_alone/${header}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include <${header}>\n")
  target_sources(${group} PRIVATE ${source})
endforeach()

# All together, for clang-tidy.
list(TRANSFORM all_headers REPLACE "(.+)" "#include <\\1>")
list(JOIN all_headers "\n" all)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/every_header.cpp CONTENT "${all}\n")
add_library(every_header OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/every_header.cpp)
target_link_libraries(every_header PRIVATE ${all_components} nysalt_warnings)
