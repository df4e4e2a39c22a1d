# Without a build type the compiler does not optimise, and a step takes 23 times as long. Where nobody chose
# one, the project builds as Release: for everything when it is the whole build, and in this folder alone when
# it is part of another, whose own targets stay as they are.
get_property(multi_config GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
if(NOT multi_config AND NOT CMAKE_BUILD_TYPE)
  if(PROJECT_IS_TOP_LEVEL)
    message(STATUS "Samestep: no build type was chosen; building Release (-D CMAKE_BUILD_TYPE=Debug for another)")
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo or MinSizeRel" FORCE)
  else()
    message(STATUS "Samestep: no build type was chosen; its own targets are built as Release")
    # A variable of this folder and those below it; the cache and the parent keep theirs.
    set(CMAKE_BUILD_TYPE Release)
  endif()
endif()
