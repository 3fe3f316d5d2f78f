# What checks of whole folders do: run a program, and look into what it said and wrote.

# Sets output to what the command prints.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nended with '${code}':\n${output}${errors}")
  endif()
  set(output "${output}" PARENT_SCOPE)
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
