# find_package(nacre) after cmake --install: the targets nacre::core, nacre::factorize, …
include(CMakePackageConfigHelpers)
set(nacre_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/nacre)
install(EXPORT nacreTargets NAMESPACE nacre:: DESTINATION ${nacre_config_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/nacreConfig.cmake.in ${PROJECT_BINARY_DIR}/nacreConfig.cmake
                              INSTALL_DESTINATION ${nacre_config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/nacreConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/nacreConfig.cmake ${PROJECT_BINARY_DIR}/nacreConfigVersion.cmake
        DESTINATION ${nacre_config_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md DESTINATION share/doc/nacre)
