# Runs the example of docs/c.md and compares what it prints with what the page says.
execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
file(READ ${EXPECTED} expected)
if(NOT printed STREQUAL expected)
  message(FATAL_ERROR "docs/c.md says the example prints\n${expected}\nit prints\n${printed}")
endif()
