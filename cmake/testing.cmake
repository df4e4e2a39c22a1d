# Test programs, one per source named *_test.cpp.
find_package(GTest REQUIRED)
include(GoogleTest)

# samestep_add_tests(FOLDER LIBRARY... [WITHOUT NAME...]): a program for each test source of the folder but
# those named, linked with the libraries. Its tests are those found when ctest runs.
function(samestep_add_tests folder)
  cmake_parse_arguments(PARSE_ARGV 1 argument "" "" WITHOUT)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*_test.cpp)
  foreach(source ${sources})
    get_filename_component(name ${source} NAME_WE)
    if(name IN_LIST argument_WITHOUT)
      continue()
    endif()
    add_executable(${name} ${source})
    target_link_libraries(${name} PRIVATE ${argument_UNPARSED_ARGUMENTS})
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 120 PROPERTIES TIMEOUT 300)
  endforeach()
endfunction()
