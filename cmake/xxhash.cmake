# samestep_xxhash: xxhash.h alone, used header-only (XXH_INLINE_ALL) by sources, never by public headers.
# It is copied beside the build, because the folder it comes from must not come before a cross compiler's own.
# SAMESTEP_XXHASH_HEADER names the file; else it is that of the package of CMake or pkg-config, or of the system.
if(NOT SAMESTEP_XXHASH_HEADER)
  find_package(xxHash CONFIG QUIET)
  if(TARGET xxHash::xxhash)
    get_target_property(xxhash_folders xxHash::xxhash INTERFACE_INCLUDE_DIRECTORIES)
  endif()
  find_package(PkgConfig QUIET)
  if(PKG_CONFIG_FOUND)
    pkg_check_modules(xxhash QUIET libxxhash)
  endif()
  find_file(SAMESTEP_XXHASH_HEADER xxhash.h HINTS ${xxhash_folders} ${xxhash_INCLUDEDIR}
    PATHS /usr/include /usr/local/include /opt/homebrew/include NO_CMAKE_FIND_ROOT_PATH)
  mark_as_advanced(SAMESTEP_XXHASH_HEADER)
endif()
if(NOT EXISTS "${SAMESTEP_XXHASH_HEADER}")
  message(FATAL_ERROR "xxhash.h (xxHash 0.8 or newer) is missing. It is in libxxhash-dev of Debian and Ubuntu "
    "('scripts/setup core' installs it), xxhash-devel of Fedora, xxhash of Arch, Homebrew, Alpine (xxhash-dev), "
    "MSYS2, vcpkg and Conan; or name the file: -D SAMESTEP_XXHASH_HEADER=/path/to/xxhash.h")
endif()
configure_file(${SAMESTEP_XXHASH_HEADER} ${PROJECT_BINARY_DIR}/xxhash/xxhash.h COPYONLY)
add_library(samestep_xxhash INTERFACE)
target_include_directories(samestep_xxhash SYSTEM INTERFACE ${PROJECT_BINARY_DIR}/xxhash)
