# SOURCE must fail to compile, and the compiler must print the sentences in the source's first lines,
#   // expect: a sentence, which may
#   //   go on in further lines
# With "expect GNU:" or "expect Clang:" it is that compiler's alone. docs/messages.md shows them, which
# tests/docs/messages_test.py looks after.
# With -DNYSALT_CONTROL it must compile, which shows that it fails for the named cause only.

cmake_minimum_required(VERSION 3.25)
file(READ ${SOURCE} head)
string(REGEX REPLACE "// SPDX.*" "" head "${head}")
string(REGEX REPLACE "\n//   +" " " head "${head}")
string(REPLACE ";" "\\;" head "${head}")
string(REPLACE "\n" ";" head "${head}")
set(sentences "")
foreach(line IN LISTS head)
  if(NOT line MATCHES "^// expect( [A-Za-z]+)?: (.+)$")
    continue()
  endif()
  set(whose "${CMAKE_MATCH_1}")
  if(whose STREQUAL "" OR whose STREQUAL " ${COMPILER_ID}")
    string(REPLACE ";" "\\;" sentence "${CMAKE_MATCH_2}")
    list(APPEND sentences "${sentence}")
  endif()
endforeach()
if(NOT sentences)
  message(FATAL_ERROR "the first line of ${SOURCE} must be '// expect: a sentence'")
endif()

set(ENV{LC_ALL} C)  # quotation marks are ' in it
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
