# Without a build type Samestep's own sources are compiled as Release and say so, and a project's that takes it
# in are not touched; a build type that was chosen stays.
function(configure source name expected)
  file(REMOVE_RECURSE ${WORK}/${name})
  execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=CMAKE_BUILD_TYPE
      ${CMAKE_COMMAND} -S ${source} -B ${WORK}/${name} -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${COMPILER}
      -D SAMESTEP_SOURCE=${SOURCE} -D SAMESTEP_TESTS=OFF -D SAMESTEP_REPLAY=OFF
      -D CMAKE_EXPORT_COMPILE_COMMANDS=ON ${ARGN}
    OUTPUT_VARIABLE said ERROR_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
  string(FIND "${said}" "no build type was chosen" place)
  if((expected STREQUAL said) AND place EQUAL -1)
    message(FATAL_ERROR "${name}: nothing is said of the build type:\n${said}")
  elseif((expected STREQUAL silent) AND NOT place EQUAL -1)
    message(FATAL_ERROR "${name}: a build type was chosen, and yet:\n${said}")
  endif()
endfunction()

# The command that compiles a source.
function(command_of name source result)
  file(STRINGS ${WORK}/${name}/compile_commands.json lines REGEX "\"command\".*${source}")
  if(NOT lines)
    message(FATAL_ERROR "${name}: ${source} is not compiled")
  endif()
  set(${result} "${lines}" PARENT_SCOPE)
endfunction()

configure(${SOURCE} alone said)
command_of(alone body.cpp command)
if(NOT command MATCHES " -O[23] ")
  message(FATAL_ERROR "alone, the library is not optimised: ${command}")
endif()

configure(${CMAKE_CURRENT_LIST_DIR}/build_type within said)
command_of(within body.cpp command)
if(NOT command MATCHES " -O[23] ")
  message(FATAL_ERROR "within a project, the library is not optimised: ${command}")
endif()
command_of(within client.cpp command)
if(command MATCHES " -O[1-3] ")
  message(FATAL_ERROR "the project's own source is compiled with other flags: ${command}")
endif()

configure(${SOURCE} chosen silent -D CMAKE_BUILD_TYPE=Debug)
command_of(chosen body.cpp command)
if(command MATCHES " -O[1-3] ")
  message(FATAL_ERROR "a Debug build is optimised: ${command}")
endif()
