# Headers, libraries, pkg-config file, CMake package, man pages and completion.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/gonio)
install(DIRECTORY include/gonio DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(TARGETS gonio-shared gonio-static EXPORT gonioTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT gonioTargets NAMESPACE gonio:: DESTINATION ${package_dir})
configure_package_config_file(cmake/gonioConfig.cmake.in gonioConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(gonioConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/gonioConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/gonioConfigVersion.cmake
        DESTINATION ${package_dir})
if(GONIO_HDF5)
  set(gonio_hdf5_requires " hdf5")
endif()
if(GONIO_RENDER)
  set(gonio_render_requires " libpng cairo")
  # OpenEXR's own file asks for its C++ libraries too; Embree has none.
  set(gonio_render_libraries " -lembree3 -lOpenEXRCore")
endif()
configure_file(cmake/gonio.pc.in gonio.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/gonio.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(DIRECTORY data/ DESTINATION ${CMAKE_INSTALL_DATADIR}/gonio FILES_MATCHING PATTERN "*.json")
install(DIRECTORY docs/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 FILES_MATCHING PATTERN "*.1")
install(FILES completions/gonio.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME gonio)
