# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where of the libraries: component "development". A project finds them
# with find_package(tesserae COMPONENTS core parallel render scenes).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/tesserae)
set(built ${PROJECT_BINARY_DIR}/library)

# A set of exported targets each, so that a project needs the libraries of what it takes alone.
foreach(component core parallel render scenes)
  if(NOT TARGET tesserae_${component})
    continue()
  endif()
  install(TARGETS tesserae_${component} EXPORT tesserae-${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT tesserae-${component} NAMESPACE tesserae:: DESTINATION ${cmake_folder}
    COMPONENT development)
endforeach()

if(TARGET tesserae_render)
  set(embree_version ${embree_VERSION_MAJOR})
endif()
configure_package_config_file(${PROJECT_SOURCE_DIR}/scenes/library/tesserae-config.cmake.in
  ${built}/tesserae-config.cmake INSTALL_DESTINATION ${cmake_folder}
  NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Until version 1 a minor version may change what is called how.
write_basic_package_version_file(${built}/tesserae-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${built}/tesserae-config.cmake ${built}/tesserae-config-version.cmake
  DESTINATION ${cmake_folder} COMPONENT development)

# The headers are gathered when they are installed: no list of what they include is kept.
install(CODE "
  execute_process(COMMAND \"${CMAKE_COMMAND}\" \"-DSOURCE=${PROJECT_SOURCE_DIR}\"
    \"-DOUTPUT=${built}/include\" \"-DCOMPONENTS=${TESSERAE_COMPONENTS}\"
    -P \"${PROJECT_SOURCE_DIR}/scenes/library/public_closure.cmake\" COMMAND_ERROR_IS_FATAL ANY)"
  COMPONENT development)
install(DIRECTORY ${built}/include/tesserae DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/tesserae-dev COMPONENT development)
