# After `cmake --install`, find_package(lendulet) gives the target lendulet::lendulet.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lendulet)

# The C interface brings the built-in scenes along.
set(installed lendulet)
if(TARGET lendulet_c)
    list(APPEND installed lendulet_c lendulet_scenes lendulet_flags)
endif()
install(TARGETS ${installed} EXPORT lendulet-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lendulet DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT lendulet-targets NAMESPACE lendulet:: DESTINATION ${package_folder})

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/lendulet-config.cmake.in
    ${PROJECT_BINARY_DIR}/lendulet-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lendulet-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lendulet-config.cmake ${PROJECT_BINARY_DIR}/lendulet-config-version.cmake
    DESTINATION ${package_folder})
