# samestep_add_game_double(NAME FLAGS): a game's own double code, under flags of its own and then those that
# linking samestep::flags gives it, which must make its results the same everywhere.
function(samestep_add_game_double name flags)
  add_library(${name} STATIC ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../consumer/client_double.cpp)
  separate_arguments(flags NATIVE_COMMAND "${flags}")
  target_compile_options(${name} PRIVATE ${flags})
  target_link_libraries(${name} PRIVATE samestep::flags)
endfunction()

# samestep_add_hostile_client(NAME FLAGS): the runner as a client that takes none of the library's flags. Its
# objects stand first in the link, so that whatever they define takes the place of the library's own.
function(samestep_add_hostile_client name flags)
  set(folder ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
  add_library(${name}_objects OBJECT ${folder}/hostile.cpp ${folder}/runner.cpp)
  set(flags_given "${flags}")
  separate_arguments(flags NATIVE_COMMAND "-std=c++20 ${flags}")
  target_compile_options(${name}_objects PRIVATE ${flags})
  foreach(library samestep_recording samestep samestep_fixed)
    target_include_directories(${name}_objects PRIVATE $<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>)
    target_compile_definitions(${name}_objects PRIVATE $<TARGET_PROPERTY:${library},INTERFACE_COMPILE_DEFINITIONS>)
  endforeach()
  add_executable(${name} $<TARGET_OBJECTS:${name}_objects>)
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  samestep_add_game_double(${name}_game "${flags_given}")
  target_link_libraries(${name} PRIVATE samestep_recording ${name}_game)
endfunction()
