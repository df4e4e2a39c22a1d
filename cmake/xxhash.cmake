# samestep_xxhash: xxhash.h alone, used header-only (XXH_INLINE_ALL) by sources, never by public headers.
# It is copied beside the build, because the folder it comes from must not come before a cross compiler's own.
find_file(SAMESTEP_XXHASH_HEADER xxhash.h PATHS /usr/include NO_CMAKE_FIND_ROOT_PATH)
mark_as_advanced(SAMESTEP_XXHASH_HEADER)
if(NOT SAMESTEP_XXHASH_HEADER)
  message(FATAL_ERROR "xxhash.h is missing; 'scripts/setup core' installs it")
endif()
configure_file(${SAMESTEP_XXHASH_HEADER} ${PROJECT_BINARY_DIR}/xxhash/xxhash.h COPYONLY)
add_library(samestep_xxhash INTERFACE)
target_include_directories(samestep_xxhash SYSTEM INTERFACE ${PROJECT_BINARY_DIR}/xxhash)
