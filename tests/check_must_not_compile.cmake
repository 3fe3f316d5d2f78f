# SOURCE must fail to compile, and the compiler must print the sentences in the source's first lines,
#   // expect: a sentence
# With -DNYSALT_CONTROL it must compile, which shows that it fails for the named cause only.

cmake_minimum_required(VERSION 3.25)
file(STRINGS ${SOURCE} sentences REGEX "^// expect: ")
list(TRANSFORM sentences REPLACE "^// expect: *" "")
if(NOT sentences)
  message(FATAL_ERROR "the first line of ${SOURCE} must be '// expect: a sentence'")
endif()

set(compile ${COMPILER} @${FLAGS} -fsyntax-only -include ${PRECOMPILED})
execute_process(COMMAND ${compile} -DNYSALT_CONTROL ${SOURCE} ERROR_VARIABLE errors RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message("${errors}")
  message(FATAL_ERROR "${SOURCE} must compile with NYSALT_CONTROL")
endif()

execute_process(COMMAND ${compile} ${SOURCE} ERROR_VARIABLE errors RESULT_VARIABLE result)
if(result EQUAL 0)
  message(FATAL_ERROR "${SOURCE} compiles, but must not")
endif()
foreach(sentence IN LISTS sentences)
  string(FIND "${errors}" "${sentence}" found)
  if(found EQUAL -1)
    message("${errors}")
    message(FATAL_ERROR "the compiler does not say '${sentence}'")
  endif()
endforeach()
