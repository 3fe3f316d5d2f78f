# find_python(result module): a python3 that can import the module, Debian's rather than another; in the cache.

function(nysalt_imports_module its program)  # the `module` of find_python
  execute_process(COMMAND ${program} -c "import ${module}" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
  if(failed)
    set(${its} FALSE PARENT_SCOPE)
  endif()
endfunction()

function(find_python result module)
  find_program(${result} python3 HINTS /usr/bin VALIDATOR nysalt_imports_module)
endfunction()
