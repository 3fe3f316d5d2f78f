# Uses nysalt as others do: installs BUILD below FOLDER, then configures, builds and runs the projects that
# stand beside this file, rightly and wrongly.

cmake_minimum_required(VERSION 3.25)
load_cache(${BUILD} READ_WITH_PREFIX its_
  CMAKE_CXX_COMPILER CMAKE_GENERATOR CMAKE_HOME_DIRECTORY CMAKE_MAKE_PROGRAM CMAKE_PREFIX_PATH)
set(nysalt ${its_CMAKE_HOME_DIRECTORY})
cmake_path(CONVERT "${its_CMAKE_PREFIX_PATH};$ENV{CMAKE_PREFIX_PATH}" TO_NATIVE_PATH_LIST prefixes)
set(ENV{CMAKE_PREFIX_PATH} "${prefixes}")
unset(ENV{DESTDIR})
file(REMOVE_RECURSE ${FOLDER})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nended with '${code}':\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# A project beside this file, or nysalt itself, in a folder of its own. A second time there is quick, as the
# compiler is known, but packages are looked for anew.
function(try_to_configure name)
  set(source ${CMAKE_CURRENT_LIST_DIR}/${name})
  if(name STREQUAL "nysalt")
    set(source ${nysalt})
  endif()
  execute_process(RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output
    COMMAND ${CMAKE_COMMAND} -S ${source} -B ${FOLDER}/${name} -G ${its_CMAKE_GENERATOR} -U *_DIR -U CMAKE_DISABLE_*
      -D CMAKE_MAKE_PROGRAM=${its_CMAKE_MAKE_PROGRAM} -D CMAKE_CXX_COMPILER=${its_CMAKE_CXX_COMPILER}
      -D nysalt_ROOT=${FOLDER}/installed ${ARGN})
  string(REGEX REPLACE "[ \n]+" " " sentences "${output}")  # CMake breaks lines
  foreach(result code output sentences)
    set(${result} "${${result}}" PARENT_SCOPE)
  endforeach()
endfunction()

function(configure name)
  try_to_configure(${name} ${ARGN})
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${name} with '${ARGN}' cannot be configured:\n${output}")
  endif()
  set(sentences "${sentences}" PARENT_SCOPE)
endfunction()

function(refuses words name)
  try_to_configure(${name} ${ARGN})
  string(FIND "${sentences}" "${words}" found)
  if(code EQUAL 0 OR found EQUAL -1)
    message(FATAL_ERROR "${name} with '${ARGN}' did not say '${words}', but ended with '${code}':\n${output}")
  endif()
endfunction()

# The program has the project's name, and its main.cpp says what it prints.
function(build_and_run name)
  run(${CMAKE_COMMAND} --build ${FOLDER}/${name})
  run(${CMAKE_COMMAND} -D PROGRAM=${FOLDER}/${name}/${name} -D SOURCE=${CMAKE_CURRENT_LIST_DIR}/${name}/main.cpp
    -P ${nysalt}/tests/check_example.cmake)
endfunction()

# The libraries that the program loads, straight or through others, and where it names Ceres: a static Ceres is
# in no list of libraries.
function(inspect name)
  set(program ${FOLDER}/${name}/${name})
  file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${program} RESOLVED_DEPENDENCIES_VAR libraries)
  list(TRANSFORM libraries REPLACE ".*/" "")
  file(STRINGS ${program} symbols REGEX "N5ceres" LIMIT_COUNT 1)
  set(libraries "${libraries}" PARENT_SCOPE)
  set(symbols "${symbols}" PARENT_SCOPE)
endfunction()

function(require_match text pattern)
  if(NOT "${text}" MATCHES "${pattern}")
    message(FATAL_ERROR "'${pattern}' is not in:\n${text}")
  endif()
endfunction()

function(require_no_match text pattern)
  if("${text}" MATCHES "${pattern}")
    message(FATAL_ERROR "'${pattern}' should not be in:\n${text}")
  endif()
endfunction()

# Installed, the package must know nothing of where it was made.
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${FOLDER}/installed --component nysalt_development)
file(GLOB_RECURSE package ${FOLDER}/installed/*.cmake)
foreach(file IN LISTS package)
  file(READ ${file} text)
  string(FIND "${text}" "${nysalt}/" found)
  if(NOT found EQUAL -1)
    message(FATAL_ERROR "${file} names a path below ${nysalt}")
  endif()
endforeach()

# Who integrates has nothing of Ceres; who learns does, which shows that it would be seen.
configure(integrate)
build_and_run(integrate)
inspect(integrate)
require_match("${libraries}" "libtbb")
require_no_match("${libraries};${symbols}" "ceres|glog")
configure(learn)
build_and_run(learn)
inspect(learn)
require_match("${libraries}" "libceres|libglog")
require_match("${symbols}" "ceres")

# The same before linking: a linker may leave out what is linked and not used.
configure(link_interface)
string(REPLACE "${FOLDER}" "" sentences "${sentences}")
require_match("${sentences}" "nysalt::nysalt includes [^/;]*/installed/include>?;")
require_match("${sentences}" "nysalt::nysalt brings [^ ]*;TBB::tbb;")
require_no_match("${sentences}" "nysalt::nysalt brings [^ ]*([Cc]eres|glog)")
require_match("${sentences}" "nysalt::learner brings [^ ]*;Ceres::ceres;[^ ]*glog")

# Components, with Ceres and without.
set(no_ceres -D CMAKE_DISABLE_FIND_PACKAGE_Ceres=ON)
configure(link_interface -D COMPONENTS=learner)
require_no_match("${sentences}" "nysalt::mpi")
if(EXISTS ${FOLDER}/installed/include/nysalt/communicators/mpi.hpp)
  configure(link_interface -D COMPONENTS=mpi)
  require_match("${sentences}" "nysalt::mpi brings [^ ]*;MPI::MPI_CXX")
  refuses("nysalt's component mpi needs an MPI 3.1" link_interface
    -D COMPONENTS=mpi -D CMAKE_DISABLE_FIND_PACKAGE_MPI=ON)
endif()
refuses("nysalt has no component 'lerner': there are learner and mpi" link_interface -D COMPONENTS=lerner)
refuses("nysalt's component learner needs Ceres 2.1 (Debian: libceres-dev)" learn ${no_ceres})
configure(integrate ${no_ceres})  # also shows that nothing is found only because Ceres looks for it too
build_and_run(integrate)

# nysalt itself, configured and installed without Ceres: then there is no learner, wherever Ceres comes from later.
refuses("that needs Ceres (Debian: libceres-dev)" nysalt ${no_ceres})
configure(nysalt ${no_ceres}
  -D NYSALT_BUILD_TESTS=OFF -D NYSALT_BUILD_EXAMPLES=OFF -D NYSALT_BUILD_PROGRAMS=OFF)
run(${CMAKE_COMMAND} --install ${FOLDER}/nysalt --prefix ${FOLDER}/installed_without_ceres)
refuses("installed without its component learner" learn -D nysalt_ROOT=${FOLDER}/installed_without_ceres)

# nysalt as a subdirectory builds nothing and changes nothing around it.
configure(subdirectory -D NYSALT=${nysalt})
build_and_run(subdirectory)
refuses("nysalt has more than headers here: ${nysalt}/examples" subdirectory
  -D NYSALT=${nysalt} -D NYSALT_BUILD_EXAMPLES=ON)
foreach(change
    "set(CMAKE_CXX_STANDARD 20 PARENT_SCOPE)"
    "set(CMAKE_POSITION_INDEPENDENT_CODE ON PARENT_SCOPE)"
    "set(CMAKE_BUILD_TYPE Release CACHE STRING \"\" FORCE)"
    "set_property(DIRECTORY \${CMAKE_SOURCE_DIR} APPEND PROPERTY COMPILE_OPTIONS -Wall)")
  file(WRITE ${FOLDER}/changes/CMakeLists.txt "${change}\n")
  refuses("nysalt makes it" subdirectory -D NYSALT=${FOLDER}/changes)
endforeach()
