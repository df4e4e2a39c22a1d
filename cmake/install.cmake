# find_package(samestep) for other projects. samestep_own_flags (warnings) stays here.
include(CMakePackageConfigHelpers)

set(libraries samestep samestep_fixed samestep_flags)
foreach(optional samestep_recording samestep_replay samestep_lockstep samestep_transport samestep_c samestep_c_shared
    samestep_cli samestep_study samestep_netsim samestep_arena samestep_loopback)
  if(TARGET ${optional})
    list(APPEND libraries ${optional})
  endif()
endforeach()
install(TARGETS ${libraries} EXPORT samestepTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(folder include fixed/include replay/include lockstep/include)
  if(IS_DIRECTORY ${PROJECT_SOURCE_DIR}/${folder})
    install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
  endif()
endforeach()
if(TARGET samestep_c)
  install(DIRECTORY capi/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
  install(FILES capi/samestep.json DESTINATION ${CMAKE_INSTALL_DATADIR}/samestep)
endif()
if(TARGET samestep_program)
  install(TARGETS samestep_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/samestep)
install(EXPORT samestepTargets NAMESPACE samestep:: DESTINATION ${package_folder})
configure_package_config_file(cmake/samestepConfig.cmake.in
  ${PROJECT_BINARY_DIR}/samestepConfig.cmake INSTALL_DESTINATION ${package_folder})
# Before 1.0 a minor version may change the API.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/samestepConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/samestepConfig.cmake ${PROJECT_BINARY_DIR}/samestepConfigVersion.cmake
  DESTINATION ${package_folder})
