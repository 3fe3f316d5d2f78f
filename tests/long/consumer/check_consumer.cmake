# Uses nysalt as others do: installs below FOLDER what BUILD has built, then configures, builds and runs the projects
# that stand beside this file, rightly and wrongly. MPI says whether there is one, PROCESSOR what its kind is.

cmake_minimum_required(VERSION 3.25)
load_cache(${BUILD} READ_WITH_PREFIX its_
  CMAKE_CXX_COMPILER CMAKE_GENERATOR CMAKE_HOME_DIRECTORY CMAKE_MAKE_PROGRAM CMAKE_PREFIX_PATH NYSALT_NATIVE)
set(nysalt ${its_CMAKE_HOME_DIRECTORY})
cmake_path(CONVERT "${its_CMAKE_PREFIX_PATH};$ENV{CMAKE_PREFIX_PATH}" TO_NATIVE_PATH_LIST prefixes)
set(ENV{CMAKE_PREFIX_PATH} "${prefixes}")
unset(ENV{DESTDIR})
file(REMOVE_RECURSE ${FOLDER})

include(${CMAKE_CURRENT_LIST_DIR}/../run_and_require.cmake)

# A project beside this file, nysalt itself, or the tutorial's, in a folder of its own. A second time there is
# quick, as the compiler is known, but packages are looked for anew.
function(try_to_configure name)
  set(source ${CMAKE_CURRENT_LIST_DIR}/${name})
  if(name STREQUAL "nysalt")
    set(source ${nysalt})
  elseif(name STREQUAL "tutorial")
    set(source ${nysalt}/examples/tutorial)
  endif()
  execute_process(RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output
    COMMAND ${CMAKE_COMMAND} -S ${source} -B ${FOLDER}/${name} -G ${its_CMAKE_GENERATOR}
      -U *_DIR -U CMAKE_DISABLE_* -D CMAKE_MAKE_PROGRAM=${its_CMAKE_MAKE_PROGRAM}
      -D CMAKE_CXX_COMPILER=${its_CMAKE_CXX_COMPILER}
      -D CMAKE_PREFIX_PATH=${FOLDER}/${installed} ${ARGN})
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

# The program has the project's name, and its main.cpp, or that of another project, says what it prints.
function(build_and_run name)
  set(source ${name} ${ARGN})
  list(GET source -1 source)
  run(${CMAKE_COMMAND} --build ${FOLDER}/${name})
  set(output "${output}" PARENT_SCOPE)
  run(${CMAKE_COMMAND} -D PROGRAM=${FOLDER}/${name}/${name}
    -D SOURCE=${CMAKE_CURRENT_LIST_DIR}/${source}/main.cpp -P ${nysalt}/tests/check_example.cmake)
endfunction()

# The libraries that the program loads, straight or through others.
function(inspect name)
  set(program ${FOLDER}/${name}/${name})
  file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${program} RESOLVED_DEPENDENCIES_VAR libraries)
  list(TRANSFORM libraries REPLACE ".*/" "")
  set(libraries "${libraries}" PARENT_SCOPE)
endfunction()

# What is built, as a user installs it.
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${FOLDER}/installed --component nysalt_development)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${FOLDER}/installed --component nysalt_library)
set(installed installed)

# nysalt itself, configured where there is Eigen alone, or without its library: what is installed then is the same
# as far as it goes, and has nothing compiled. That no file knows where it was made package/ shows.
set(eigen_alone "")
foreach(package IN ITEMS Boost fmt TBB Ceres MPI)
  list(APPEND eigen_alone -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
set(no_ceres -D CMAKE_DISABLE_FIND_PACKAGE_Ceres=ON)
refuses("benchmarks need Ceres 2.1 (Debian: libceres-dev, or set Ceres_DIR)" nysalt ${no_ceres})
refuses("benchmarks need the library: NYSALT_BUILD_LIBRARY" nysalt -D NYSALT_BUILD_LIBRARY=OFF)
refuses("nysalt needs Eigen 3.4 (Debian: libeigen3-dev, or set Eigen3_DIR)" nysalt
  -D NYSALT_BUILD_LIBRARY=ON -D CMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON)
set(headers_alone -D NYSALT_BUILD_TESTS=OFF -D NYSALT_BUILD_EXAMPLES=OFF -D NYSALT_BUILD_PROGRAMS=OFF)
configure(nysalt ${eigen_alone} ${headers_alone})
require_match("${sentences}" "component nysalt needs Boost 1.74, [^)]*\\) and fmt 9 [^)]*\\) and oneTBB .*is left out")
run(${CMAKE_COMMAND} --install ${FOLDER}/nysalt --prefix ${FOLDER}/of_eigen)
configure(nysalt ${headers_alone} -D NYSALT_BUILD_LIBRARY=OFF)
run(${CMAKE_COMMAND} --install ${FOLDER}/nysalt --prefix ${FOLDER}/of_headers)
file(GLOB_RECURSE files RELATIVE ${FOLDER}/of_eigen ${FOLDER}/of_eigen/*)
file(GLOB_RECURSE others RELATIVE ${FOLDER}/of_headers ${FOLDER}/of_headers/*)
if(NOT files STREQUAL others)
  message(FATAL_ERROR "without a library, what is installed depends on what is found:\n${files}\n${others}")
endif()
require_match("${files}" "/nysalt/core\\.hpp;.*/nysalt-core\\.cmake;.*/nysalt-odeint\\.cmake;.*/nysalt-core\\.pc")
require_no_match("${files}" "libnysalt|nysalt-(nysalt|shared|learn|report|mpi)|/nysalt/(nysalt|learn|compare)\\.hpp")
foreach(file IN LISTS files)
  file(READ ${FOLDER}/of_eigen/${file} text)
  file(READ ${FOLDER}/installed/${file} other)
  if(NOT text STREQUAL other)
    message(FATAL_ERROR "${file} depends on what is found")
  endif()
endforeach()

# With Eigen alone there is core, and its headers read nothing else.
set(theirs "/include/(fmt|boost|oneapi|tbb|ceres|glog)/|/mpi\\.h")
set(installed of_eigen)
configure(core ${eigen_alone})
build_and_run(core)
require_match("${output}" "/nysalt/core\\.hpp.*/Eigen/Core")
require_no_match("${output}" "${theirs}")
refuses("nysalt's component nysalt is not installed" integrate -D COMPONENTS=nysalt)
set(installed installed)

# No header of nysalt reads others. Who links the shared library needs Eigen alone; what it shows of itself are names
# of nysalt.
configure(shared ${eigen_alone})
build_and_run(shared)
require_match("${output}" "/nysalt/learn\\.hpp.*/nysalt/nysalt\\.hpp")
require_no_match("${output}" "${theirs}")
inspect(shared)
require_match("${libraries}" "libceres.*;libnysalt\\.so\\.0\\.[0-9]+;")
find_program(nm nm)
if(nm)
  file(GLOB_RECURSE library ${FOLDER}/installed/libnysalt.so)
  run(${nm} -DC --defined-only ${library})
  require_match("${output}" " void nysalt::detail::library_is_compiled_for<[0-9]+>\\(\\)\n")
  string(REGEX REPLACE "[^\n]* _ZN(K|)6nysalt[^\n]*\n" "" output "${output}")  # which nm cannot read
  string(REGEX REPLACE "[^\n]* (typeinfo[a-z ]*|vtable|VTT|guard variable) for nysalt::[^\n]*\n" "" output "${output}")
  string(REGEX REPLACE "[^\n]*nysalt::[^\n]*\n" "" output "${output}")
  if(NOT output STREQUAL "")
    message(FATAL_ERROR "libnysalt.so exports what is not of nysalt:\n${output}")
  endif()
endif()

# The static one needs what it is made with, to link.
refuses("nysalt's component nysalt needs Ceres 2.1" integrate ${no_ceres} -D COMPONENTS=nysalt)
configure(integrate -D COMPONENTS=nysalt)
build_and_run(integrate)
require_no_match("${output}" "${theirs}")
inspect(integrate)
require_match("${libraries}" "libtbb")
require_no_match("${libraries}" "libnysalt")
configure(learn)
build_and_run(learn)
inspect(learn)
require_match("${libraries}" "libceres")
configure(report)
build_and_run(report)

# A program for another processor, with other lanes, does not link, and the linker says why.
if(PROCESSOR MATCHES "x86_64|AMD64")
  set(other haswell)
  if(its_NYSALT_NATIVE)
    set(other x86-64)
  endif()
  configure(other_lanes -D PROCESSOR=${other})
  foreach(library IN ITEMS nysalt shared)
    execute_process(COMMAND ${CMAKE_COMMAND} --build ${FOLDER}/other_lanes --target with_${library}
      RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(code EQUAL 0)
      message(FATAL_ERROR "a program for ${other} links to the ${library} library")
    endif()
    require_match("${output}" "undefined [^\n]*nysalt::detail::library_is_compiled_for<[0-9]+>\\(\\)")
  endforeach()
endif()

# Boost's headers are enough for odeint, beside ours.
set(installed of_headers)
configure(odeint -D CMAKE_DISABLE_FIND_PACKAGE_fmt=ON -D CMAKE_DISABLE_FIND_PACKAGE_TBB=ON ${no_ceres}
  -D CMAKE_DISABLE_FIND_PACKAGE_MPI=ON)
build_and_run(odeint)
set(installed installed)

# Without a wish there is what can be found, and the rest is told of.
configure(link_interface)
string(REPLACE "${FOLDER}" "" sentences "${sentences}")
require_match("${sentences}" "nysalt::core includes [^/;]*/installed/include>?;")
require_match("${sentences}" "nysalt::core compiles with [^ ]*:-ffp-contract=off>;[^ ]*:-fno-tree-slp-vectorize>;")
require_no_match("${sentences}" "nysalt::core compiles with [^ ]*;-")  # to what language it may be
require_match("${sentences}" "nysalt::core brings nysalt::core;Eigen3::Eigen;")
require_match("${sentences}" "nysalt::nysalt brings [^ ]*;TBB::tbb;")
require_match("${sentences}" "nysalt::shared brings nysalt::shared;nysalt::core;Eigen3::Eigen;")
require_no_match("${sentences}" "libceres\\.a")
require_match("${sentences}" "nysalt::learn brings nysalt::learn;nysalt::nysalt;[^ ]*;nysalt::ceres;[^ ]*/libceres\\.so;")
configure(link_interface -D CMAKE_DISABLE_FIND_PACKAGE_fmt=ON -D CMAKE_DISABLE_FIND_PACKAGE_MPI=ON)
require_match("${sentences}"
  "component nysalt needs fmt 9 \\(Debian: libfmt-dev, or set fmt_DIR\\), and is left out")
require_match("${sentences}" "component mpi needs fmt 9 [^)]*\\) and an MPI 3.1 [^)]*\\), and is left out")
require_match("${sentences}" "nysalt::shared brings")
require_match("${sentences}" "nysalt::odeint brings nysalt::odeint;nysalt::core;Boost::headers;")
require_no_match("${sentences}" "nysalt::(nysalt|learn|mpi) brings")

# With one there is that, and what it stands on.
configure(link_interface -D COMPONENTS=core)
require_no_match("${sentences}" "nysalt::(nysalt|shared|learn|odeint|mpi) brings")
configure(link_interface -D COMPONENTS=learn)
require_match("${sentences}" "nysalt::nysalt brings")
require_no_match("${sentences}" "nysalt::(shared|odeint|mpi) brings")
refuses("nysalt has no component 'lern': there are core, nysalt, shared, learn, report, odeint, mpi" link_interface
  -D COMPONENTS=lern)
refuses("component learner is now called learn, and its target nysalt::learn" link_interface
  -D COMPONENTS=learner)
refuses("nysalt's component learn needs Ceres 2.1 (Debian: libceres-dev" learn ${no_ceres})
refuses("nysalt's component core needs Eigen 3.4 (Debian: libeigen3-dev" link_interface
  -D COMPONENTS= -D CMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON)
refuses("nysalt's component mpi needs an MPI 3.1" link_interface
  -D COMPONENTS=mpi -D CMAKE_DISABLE_FIND_PACKAGE_MPI=ON)
if(MPI)
  configure(mpi)
  build_and_run(mpi)
endif()
configure(tutorial)

# Whatever policies there are, nothing is said that is not to be and nothing left but what find_package promises.
# What is there already is taken, if it is not known to be too old.
if(CMAKE_VERSION VERSION_LESS 4)  # which knows policies so old no more
  set(promised "nysalt_(CONFIG|CONSIDERED_[A-Z]+|DIR|FOUND|NOT_FOUND_MESSAGE|VERSION[A-Z_]*)")
  configure(old)
  require_match("${sentences}" "looks for nysalt -- found: 1 ;")
  set(components "nysalt_(core|nysalt|shared|learn|report|odeint|mpi)_FOUND")
  require_match("${sentences}" "left behind: ((${promised}|${components});)+ ")
  require_match("${sentences}" "nysalt_learn_FOUND;")
  configure(old -D COMPONENTS=learn -D CERES=2.1)
  require_match("${sentences}" "looks for nysalt -- found: 1 ;")
  configure(old -D COMPONENTS=learn -D CERES=2.0.9)
  require_match("${sentences}"
    "found: 0 nysalt's component learn needs Ceres 2.1 \\([^)]*\\), not the 2.0.9 that was found before;")
  require_match("${sentences}" "left behind: ((${promised}|nysalt_learn_FOUND);)+ ")
endif()

# Without CMake: the same flags, from wherever the tree stands, and either library.
find_program(pkg_config pkg-config)
if(pkg_config)
  file(RENAME ${FOLDER}/installed ${FOLDER}/moved)
  file(GLOB_RECURSE folder ${FOLDER}/moved/nysalt.pc)
  cmake_path(GET folder PARENT_PATH folder)
  set(ENV{PKG_CONFIG_PATH} ${folder}:$ENV{PKG_CONFIG_PATH})
  cmake_path(GET folder PARENT_PATH folder)
  set(main ${CMAKE_CURRENT_LIST_DIR}/integrate/main.cpp)
  run(${pkg_config} --cflags --libs nysalt-learn)
  require_match("${output}"
    "-DEIGEN_DONT_VECTORIZE -DEIGEN_MAX_ALIGN_BYTES=64 .*-ffp-contract=off -fno-tree-slp-vectorize.* -lnysalt")
  require_no_match("${output}" "-l(ceres|tbb|fmt)")
  run(${pkg_config} --cflags --libs nysalt-core)
  require_no_match("${output}" "-lnysalt")
  set(ENV{LD_LIBRARY_PATH} ${folder}:$ENV{LD_LIBRARY_PATH})
  foreach(linked IN ITEMS "--libs nysalt" "--static --libs nysalt | sed s/-lnysalt/-l:libnysalt.a/")
    run(sh -c "\"$0\" -std=c++20 \"$1\" -o \"$2\" $(\"$3\" --cflags nysalt) $(\"$3\" ${linked})"
      ${its_CMAKE_CXX_COMPILER} ${main} ${FOLDER}/by_pkg_config ${pkg_config})
    run(${CMAKE_COMMAND} -D PROGRAM=${FOLDER}/by_pkg_config -D SOURCE=${main}
      -P ${nysalt}/tests/check_example.cmake)
  endforeach()
  file(RENAME ${FOLDER}/moved ${FOLDER}/installed)
endif()
# Folders that are not below the prefix are named as they are.
function(require_include_dir folder option)
  configure(nysalt ${headers_alone} -U CMAKE_INSTALL_*DIR -D CMAKE_INSTALL_PREFIX=/there -D ${option})
  file(READ ${FOLDER}/nysalt/nysalt-core.pc text)
  require_match("${text}" "\nincludedir=${folder}\n")
endfunction()
require_include_dir(/elsewhere CMAKE_INSTALL_INCLUDEDIR=/elsewhere)
require_include_dir(/there/include CMAKE_INSTALL_LIBDIR=/elsewhere)

# nysalt as a subdirectory builds nothing that is not asked for, changes nothing around it and is not installed
# with it, but if asked.
configure(subdirectory -D NYSALT=${nysalt})
build_and_run(subdirectory core)
run(${CMAKE_COMMAND} --install ${FOLDER}/subdirectory --prefix ${FOLDER}/of_others)
file(GLOB files RELATIVE ${FOLDER} ${FOLDER}/of_others/*)
require_no_match("${files}" "of_others")
configure(subdirectory -D NYSALT=${nysalt} -D NYSALT_INSTALL=ON -D NYSALT_BUILD_LIBRARY=OFF)
run(${CMAKE_COMMAND} --install ${FOLDER}/subdirectory --prefix ${FOLDER}/of_others)
file(GLOB files RELATIVE ${FOLDER} ${FOLDER}/of_others/*)
require_match("${files}" "of_others/include;of_others/lib")
refuses("nysalt builds more than is asked for: ${nysalt}/src" subdirectory
  -D NYSALT=${nysalt} -D NYSALT_BUILD_LIBRARY=ON -D NYSALT_BUILD_EXAMPLES=ON)

# So it does from an archive, which needs no more than this.
run(${CMAKE_COMMAND} -E chdir ${nysalt}
  ${CMAKE_COMMAND} -E tar czf ${FOLDER}/nysalt.tar.gz CMakeLists.txt cmake include src/nysalt)
configure(fetch -D NYSALT=${FOLDER}/nysalt.tar.gz)

foreach(change
    "set(CMAKE_CXX_STANDARD 20 PARENT_SCOPE)"
    "set(CMAKE_POSITION_INDEPENDENT_CODE ON PARENT_SCOPE)"
    "set(CMAKE_BUILD_TYPE Release CACHE STRING \"\" FORCE)"
    "set_property(DIRECTORY \${CMAKE_SOURCE_DIR} APPEND PROPERTY COMPILE_OPTIONS -Wall)")
  file(WRITE ${FOLDER}/changes/CMakeLists.txt "${change}\n")
  refuses("nysalt makes it" subdirectory -D NYSALT=${FOLDER}/changes)
endforeach()
