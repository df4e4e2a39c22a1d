# Test programs: one for a folder of tests, named after it.
find_package(GTest REQUIRED)
include(GoogleTest)

# What only tests cost: their own code is compiled as it stands, which takes a third of the time; the library they
# test keeps the flags it ships with.
option(SAMESTEP_OPTIMISE_TESTS "Optimise the tests' own code like the library" OFF)
add_library(samestep_test_flags INTERFACE)
if(NOT SAMESTEP_OPTIMISE_TESTS)
  target_compile_options(samestep_test_flags INTERFACE -O0)
endif()

# samestep_add_test_program(NAME LIBRARY... SOURCES FILE...): a program of these sources; its tests are those
# found when ctest runs.
function(samestep_add_test_program name)
  cmake_parse_arguments(PARSE_ARGV 1 argument "" "" SOURCES)
  add_executable(${name} ${argument_SOURCES})
  target_link_libraries(${name} PRIVATE ${argument_UNPARSED_ARGUMENTS} GTest::gtest_main)
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 120 PROPERTIES TIMEOUT 300)
endfunction()

# samestep_add_tests(NAME FOLDER LIBRARY... [WITHOUT TEST...] [ALONE TEST...]): the program NAME of the folder's
# *_test.cpp but those named by WITHOUT, and a program for each of those named by ALONE.
function(samestep_add_tests name folder)
  cmake_parse_arguments(PARSE_ARGV 2 argument "" "" "WITHOUT;ALONE")
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*_test.cpp)
  set(together "")
  foreach(source ${sources})
    get_filename_component(test ${source} NAME_WE)
    if(test IN_LIST argument_WITHOUT)
      continue()
    elseif(test IN_LIST argument_ALONE)
      samestep_add_test_program(${test} ${argument_UNPARSED_ARGUMENTS} SOURCES ${source})
    else()
      list(APPEND together ${source})
    endif()
  endforeach()
  if(together)
    samestep_add_test_program(${name} ${argument_UNPARSED_ARGUMENTS} SOURCES ${together})
  endif()
endfunction()
