# An unknown option is refused: exit code 2, one line, nothing on standard output.
execute_process(COMMAND "${PROGRAM}" --bad RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)
if(NOT code EQUAL 2 OR NOT out STREQUAL "" OR NOT err MATCHES "^[a-z]+: unknown option '--bad'[^\n]*\n$")
  message(FATAL_ERROR "exit code ${code}, output '${out}', error '${err}'")
endif()
