# The version stands in CMakeLists.txt; what CMake does not write must follow: CITATION.cff, and PROGRAM if it is given.

cmake_minimum_required(VERSION 3.25)
file(STRINGS ${SOURCE}/CITATION.cff cited REGEX "^version: ")
if(NOT cited STREQUAL "version: ${VERSION}")
  message(FATAL_ERROR "CITATION.cff has '${cited}', and CMakeLists.txt the version ${VERSION}")
endif()
if(PROGRAM)
  execute_process(COMMAND ${PROGRAM} --version OUTPUT_VARIABLE told COMMAND_ERROR_IS_FATAL ANY)
  if(NOT told STREQUAL "nysalt ${VERSION}\n")
    message(FATAL_ERROR "the program says '${told}', and CMakeLists.txt the version ${VERSION}")
  endif()
endif()
