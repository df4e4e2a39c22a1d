# Test programs, one per source named *_test.cpp.
find_package(GTest REQUIRED)
include(GoogleTest)

# samestep_add_tests(FOLDER LIBRARY...): a program for each test source of the folder, linked with the
# libraries. Its tests are those found when ctest runs.
function(samestep_add_tests folder)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*_test.cpp)
  foreach(source ${sources})
    get_filename_component(name ${source} NAME_WE)
    add_executable(${name} ${source})
    target_link_libraries(${name} PRIVATE ${ARGN})
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 120 PROPERTIES TIMEOUT 300)
  endforeach()
endfunction()
