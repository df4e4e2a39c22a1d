# Flags that the results depend on, carried by every target that links the library.
add_library(samestep_flags INTERFACE)
add_library(samestep::flags ALIAS samestep_flags)
set_target_properties(samestep_flags PROPERTIES EXPORT_NAME flags)
target_compile_features(samestep_flags INTERFACE cxx_std_20)
# A fused multiply-add rounds once where the source says twice. gcc's vectoriser fuses a*c - b*d, a*d + b*c
# where the target has FMA even with contraction off, in a game's own code as in the engine's.
target_compile_options(samestep_flags INTERFACE -ffp-contract=off
  $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-tree-vectorize>)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^i[3-6]86$" AND SAMESTEP_SCALARS STREQUAL all)
  # x87 keeps 80 bits between operations.
  target_compile_options(samestep_flags INTERFACE -msse2 -mfpmath=sse)
endif()

# For the project's own targets only: warnings. SAMESTEP_WERROR makes them errors.
add_library(samestep_own_flags INTERFACE)
target_link_libraries(samestep_own_flags INTERFACE samestep_flags)
target_compile_options(samestep_own_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # Instantiations stand in a header (each_scalar.h); gcc takes what a source keeps to itself and they use for
  # something that the header shows.
  target_compile_options(samestep_own_flags INTERFACE -Wno-subobject-linkage)
endif()
option(SAMESTEP_WERROR "Treat warnings of the project's own sources as errors" OFF)
if(SAMESTEP_WERROR)
  target_compile_options(samestep_own_flags INTERFACE -Werror)
endif()
