# Use ccache where it is installed, unless the caller chose a launcher.
if(NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(SAMESTEP_CCACHE ccache)
  mark_as_advanced(SAMESTEP_CCACHE)
  if(SAMESTEP_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${SAMESTEP_CCACHE})
  endif()
endif()
