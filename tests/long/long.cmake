# Tests of tier 2 that are no program of ours: each is labelled long. Included by tests/CMakeLists.txt.
set(folder ${CMAKE_CURRENT_SOURCE_DIR}/long)
function(add_long_test name)
  add_test(NAME ${name} COMMAND ${ARGN})
  set_tests_properties(${name} PROPERTIES LABELS long)
endfunction()

# Reports, rendered in Chromium: ./dev pictures.
option(NYSALT_TEST_PICTURES "Render reports in Chromium" OFF)
if(NYSALT_TEST_PICTURES)
  add_subdirectory(long/pictures)
endif()

# The sentences of the other compiler.
find_program(NYSALT_OTHER_COMPILER clang++)
if(NYSALT_OTHER_COMPILER AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_long_test(long_must_not_compile_clang ${must_not_compile} ${NYSALT_OTHER_COMPILER} ${flags_of_must_not_compile})
endif()

# Every input that is large, deep, endless or strange; a program that breaks the four promises must be found.
if(NYSALT_BUILD_PROGRAMS AND UNIX AND NOT APPLE)
  add_long_test(long_inputs_worst ${inputs} $<TARGET_FILE:nysalt_program> ${CMAKE_CURRENT_BINARY_DIR}/inputs_all ${how})
  add_long_test(long_inputs_unbounded_is_found
    ${inputs} ${CMAKE_CURRENT_SOURCE_DIR}/inputs/unbounded.py ${CMAKE_CURRENT_BINARY_DIR}/inputs_unbounded --some)
  set_tests_properties(long_inputs_unbounded_is_found PROPERTIES PASS_REGULAR_EXPRESSION "12 inputs tried, 6 wrong")
endif()

# Long commands that are killed at random moments; a program that does not go on must be found.
if(NYSALT_BUILD_PROGRAMS AND UNIX AND NOT APPLE)
  set(kills Python3::Interpreter -B ${CMAKE_CURRENT_SOURCE_DIR}/faults/kills.py)
  set(launched 1)
  if(TARGET nysalt::mpi)
    set(launched 1,2)
  endif()
  add_long_test(long_kills
    ${kills} $<TARGET_FILE:nysalt_program> ${CMAKE_CURRENT_BINARY_DIR}/kills --kills=3 --ranks=${launched})
  add_long_test(long_kills_without_resume_is_found ${kills} ${CMAKE_CURRENT_SOURCE_DIR}/faults/without_resume.sh
    ${CMAKE_CURRENT_BINARY_DIR}/kills_found --kills=10 --ranks=1 --works=sample)
  set_tests_properties(long_kills PROPERTIES ENVIRONMENT "${of_mpirun}")
  set_tests_properties(long_kills_without_resume_is_found PROPERTIES
    ENVIRONMENT "NYSALT=$<TARGET_FILE:nysalt_program>" PASS_REGULAR_EXPRESSION "exit code 2.*resume it, or remove the file")
endif()

# Every output where the file system has no locks, and where a lock is held.
if(TARGET nysalt_faults)
  add_long_test(long_locks Python3::Interpreter -B ${folder}/locks/locks.py $<TARGET_FILE:nysalt_program>
    ${CMAKE_CXX_COMPILER} $<TARGET_FILE:nysalt_faults> ${CMAKE_CURRENT_BINARY_DIR}/locks)
endif()

# A new formula by many processes at once, of which a program that refuses all but one must be found.
if(NYSALT_BUILD_PROGRAMS AND UNIX AND NOT APPLE)
  set(new_formula Python3::Interpreter -B ${folder}/plugins/new_formula.py)
  set(launcher "")
  if(TARGET nysalt::mpi)
    set(launcher ${MPIEXEC_EXECUTABLE})
  endif()
  add_long_test(long_plugins_new_formula
    ${new_formula} $<TARGET_FILE:nysalt_program> "${launcher}" ${CMAKE_CURRENT_BINARY_DIR}/new_formula)
  add_long_test(long_plugins_refusing_is_found
    ${new_formula} ${folder}/plugins/refusing.py "${launcher}" ${CMAKE_CURRENT_BINARY_DIR}/refusing --repetitions 1)
  set_tests_properties(long_plugins_new_formula long_plugins_refusing_is_found PROPERTIES ENVIRONMENT "${of_mpirun}")
  set_tests_properties(long_plugins_refusing_is_found PROPERTIES PASS_REGULAR_EXPRESSION "repetition 1: 1 of 8 processes")
endif()

# A letter, a host of exports, a loss and an option, each added by a small patch to a copy of the sources; a program without them must be
# found. A copy of instrumented sources would not be instrumented.
find_package(Git QUIET)
if(NYSALT_BUILD_PROGRAMS AND GIT_FOUND AND EXISTS ${PROJECT_SOURCE_DIR}/.git AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
  set(patches Python3::Interpreter -B ${folder}/patches/patches.py)
  add_long_test(long_patches ${patches} ${CMAKE_CURRENT_BINARY_DIR}/patches ${PROJECT_SOURCE_DIR} -G ${CMAKE_GENERATOR}
    -D CMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -D CMAKE_BUILD_TYPE=Release -D NYSALT_NATIVE=${NYSALT_NATIVE})
  add_long_test(long_patches_without_is_found
    ${patches} ${CMAKE_CURRENT_BINARY_DIR}/patches_without --program $<TARGET_FILE:nysalt_program>)
  set_tests_properties(long_patches long_patches_without_is_found PROPERTIES ENVIRONMENT "${of_mpirun}")
  set_tests_properties(long_patches PROPERTIES COST 200 TIMEOUT 7200)  # it builds the library and the program
  set_tests_properties(long_patches_without_is_found PROPERTIES PASS_REGULAR_EXPRESSION
    "letter: exit code 2: [^\n]*the letter T(.|\n)*host: exit code 2: [^\n]*'awk'(.|\n)*loss: exit code 2: [^\n]*'energies'(.|\n)*option: exit code 2: [^\n]*--echoes(.|\n)*4 patches tried, 4 do not work")
endif()

# Exported methods in other programs, where these are installed (./dev hosts).
if(TARGET nysalt_python)
  foreach(host IN ITEMS ase lammps openmm)
    add_long_test(hosts_${host} ${NYSALT_MODULE_PYTHON} -B ${folder}/hosts/${host}_test.py $<TARGET_FILE:nysalt_program>)
    set_tests_properties(hosts_${host} PROPERTIES LABELS "long;hosts" SKIP_RETURN_CODE 77
      ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python")
  endforeach()
endif()

# The documents: what a tool for documents says of them, and the whole site where the tools are.
file(GLOB sources RELATIVE ${folder} CONFIGURE_DEPENDS ${folder}/docs/*_test.py)
foreach(source IN LISTS sources)
  string(REGEX REPLACE "docs/(.*)_test\\.py$" "long_docs_\\1" name ${source})
  add_long_test(${name} Python3::Interpreter -B ${folder}/${source})
  set_tests_properties(${name} PROPERTIES LABELS "long;docs")
endforeach()
find_program(NYSALT_DOXYGEN doxygen)
find_program(NYSALT_SPHINX sphinx-build)
set(tools /usr/lib/python3/dist-packages)
if(NYSALT_DOXYGEN AND NYSALT_SPHINX AND EXISTS ${tools}/furo AND EXISTS ${tools}/breathe AND EXISTS ${tools}/myst_parser)
  add_long_test(long_docs_whole_site ${PROJECT_SOURCE_DIR}/docs/site/build.sh ${CMAKE_CURRENT_BINARY_DIR}/docs_site)
  set_tests_properties(long_docs_whole_site PROPERTIES LABELS "long;docs" COST 100)
endif()

# Projects that use nysalt from outside, and Debian packages of what is built here, where there are Debian's tools.
if(NYSALT_INSTALL)
  add_long_test(consumer ${CMAKE_COMMAND} -D BUILD=${PROJECT_BINARY_DIR} -D FOLDER=${CMAKE_CURRENT_BINARY_DIR}/consumer
    -D MPI=$<TARGET_EXISTS:nysalt::mpi> -D PROCESSOR=${CMAKE_SYSTEM_PROCESSOR} -P ${folder}/consumer/check_consumer.cmake)
  set_tests_properties(consumer PROPERTIES COST 40)
endif()
if(NYSALT_INSTALL AND NYSALT_BUILD_PROGRAMS)
  include(GNUInstallDirs)
  add_long_test(package ${CMAKE_COMMAND} -D BUILD=${PROJECT_BINARY_DIR} -D FOLDER=${CMAKE_CURRENT_BINARY_DIR}/package
    -D VERSION=${PROJECT_VERSION} -D PYTHON=$<TARGET_EXISTS:nysalt_python> -D LIB=${CMAKE_INSTALL_LIBDIR}
    -D CMAKE_CPACK_COMMAND=${CMAKE_CPACK_COMMAND} -P ${folder}/package/check_package.cmake)
  set_tests_properties(package PROPERTIES SKIP_REGULAR_EXPRESSION "skipped: there is no")
endif()
