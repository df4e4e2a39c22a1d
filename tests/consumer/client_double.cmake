# A game's own double code, compiled for a processor with FMA and the flags of samestep::flags, has no fused
# multiply-add; without them it has some, or this test would show nothing.
execute_process(COMMAND ${OBJDUMP} -d ${PLAIN} OUTPUT_VARIABLE plain COMMAND_ERROR_IS_FATAL ANY)
if(NOT plain MATCHES "vfn?m(add|sub)")
  message(FATAL_ERROR "nothing is fused even without the flags")
endif()
foreach(object ${FLAGGED})
  execute_process(COMMAND ${OBJDUMP} -d ${object} OUTPUT_VARIABLE code COMMAND_ERROR_IS_FATAL ANY)
  if(code MATCHES "vfn?m(add|sub)[^\n]*")
    message(FATAL_ERROR "${object}: ${CMAKE_MATCH_0}")
  endif()
endforeach()
