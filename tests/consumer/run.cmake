# Takes the example out of README.md, builds it in a project of its own, runs it, and compares what it
# prints with what README says it prints.

# A fenced block of README that stands behind <!-- NAME -->.
function(read_block name result)
  file(READ ${SOURCE}/README.md text)
  foreach(edge "<!-- ${name} -->\n```" "\n")
    string(FIND "${text}" "${edge}" start)
    if(start EQUAL -1)
      message(FATAL_ERROR "README.md has no fenced block behind <!-- ${name} -->")
    endif()
    string(LENGTH "${edge}" length)
    math(EXPR start "${start} + ${length}")
    string(SUBSTRING "${text}" ${start} -1 text)
  endforeach()
  string(FIND "${text}" "```" end)
  string(SUBSTRING "${text}" 0 ${end} text)
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
read_block(example example)
read_block(output expected)
file(WRITE ${WORK}/example.cpp "${example}")

set(options)
if(KIND STREQUAL installed)
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
  list(APPEND options -D CMAKE_PREFIX_PATH=${WORK}/prefix)
  # A package that names the tree it came from works on this machine and nowhere else.
  file(GLOB_RECURSE package ${WORK}/prefix/*.cmake)
  foreach(file ${package})
    file(READ ${file} text)
    string(FIND "${text}" "${SOURCE}/" place)
    if(NOT place EQUAL -1)
      message(FATAL_ERROR "${file} names the source tree")
    endif()
  endforeach()
else()
  list(APPEND options -D SAMESTEP_SOURCE=${SOURCE})
endif()
if(KIND STREQUAL fixed)
  list(APPEND options -D SAMESTEP_SCALARS=fixed -D BUILD_SHARED_LIBS=ON)
  set(FLAGS_RELEASE "-Ofast")
endif()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/project -B ${WORK}/build -G ${GENERATOR}
  -D CMAKE_BUILD_TYPE=Release -D EXAMPLE=${WORK}/example.cpp
  -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
  -D CMAKE_CXX_FLAGS=${FLAGS} -D CMAKE_CXX_FLAGS_RELEASE=${FLAGS_RELEASE} ${options})
run(${CMAKE_COMMAND} --build ${WORK}/build --target example)
execute_process(COMMAND ${WORK}/build/example OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
if(NOT printed STREQUAL expected)
  message(FATAL_ERROR "README.md says the example prints\n${expected}\nit prints\n${printed}")
endif()
