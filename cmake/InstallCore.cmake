# What `cmake --install` puts down of the library: the rooms base, surface, detection and contact, with AMONTONS_EXCHANGE
# parallel and exchange too, their headers, and the package that find_package(Amontons) reads. Included beside the rooms'
# targets.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Amontons)

# Puts rooms into an export of their own, so that only who asks for exchange needs MPI.
function(amontons_install_rooms export)
  foreach(room ${ARGN})
    set_target_properties(amontons_${room} PROPERTIES EXPORT_NAME ${room})
    install(TARGETS amontons_${room} EXPORT ${export})
    install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/amontons
            FILES_MATCHING PATTERN "*.h")
  endforeach()
  install(EXPORT ${export} NAMESPACE Amontons:: DESTINATION ${package_dir})
endfunction()
amontons_install_rooms(AmontonsTargets base surface detection contact)
if(AMONTONS_EXCHANGE)
  amontons_install_rooms(AmontonsExchangeTargets parallel exchange)
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/AmontonsConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/AmontonsConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/AmontonsConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/AmontonsConfig.cmake ${PROJECT_BINARY_DIR}/AmontonsConfigVersion.cmake
        DESTINATION ${package_dir})
