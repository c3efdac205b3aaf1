# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where of the program: itself, its page for man and its completions, the
# component "program". What `cpack` packs: components are packages of their own.
include(GNUInstallDirs)
install(TARGETS tesserae RUNTIME COMPONENT program)

# The program prints them, when it is installed: they are what this program understands.
# printed(FOLDER NAME TOPIC...): what `tesserae reference TOPIC...` prints, as FOLDER/NAME.
function(printed folder name)
  set(file ${CMAKE_BINARY_DIR}/printed/${folder}/${name})
  list(JOIN ARGN " " topic)
  install(CODE "
    file(MAKE_DIRECTORY \"${CMAKE_BINARY_DIR}/printed/${folder}\")
    execute_process(COMMAND \"$<TARGET_FILE:tesserae>\" reference ${topic}
      OUTPUT_FILE \"${file}\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
  install(FILES ${file} DESTINATION ${CMAKE_INSTALL_DATADIR}/${folder} COMPONENT program)
endfunction()
printed(man/man1 tesserae.1 man)
printed(bash-completion/completions tesserae completion bash)
printed(fish/vendor_completions.d tesserae.fish completion fish)
# Debian's zsh looks for what packages bring in a folder of its own.
install(CODE "
  set(zsh_folder site-functions)
  if(EXISTS /etc/debian_version AND CMAKE_INSTALL_PREFIX MATCHES \"/usr$\")
    set(zsh_folder vendor-completions)
  endif()" COMPONENT program)
printed(zsh/\${zsh_folder} _tesserae completion zsh)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DOCDIR}
  COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR}
  COMPONENT program)

# ---- packages of Debian ----------------------------------------------------------------------
# Without dpkg-shlibdeps, which Debian's dpkg-dev has, nothing would say which libraries a package
# needs: it is an archive then.
find_program(DPKG_SHLIBDEPS dpkg-shlibdeps)
set(CPACK_GENERATOR TXZ)
if(DPKG_SHLIBDEPS)
  set(CPACK_GENERATOR DEB)
endif()
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME tesserae)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME tesserae-dev)
set(CPACK_PACKAGE_CONTACT "The maintainers of tesserae")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "rigid bodies in four dimensions, simulated and filmed")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "A scene file goes in; a trajectory, EXR frames and an MP4 come out.
The same scene gives the same bytes with any number of threads.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "C++ headers and static libraries, for
find_package(tesserae COMPONENTS core parallel render scenes).")
if(TESSERAE_ARCH)
  foreach(package PROGRAM DEVELOPMENT)
    string(APPEND CPACK_COMPONENT_${package}_DESCRIPTION "
It needs a CPU of level ${TESSERAE_ARCH}.")
  endforeach()
endif()
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# Libraries as dpkg-shlibdeps finds them; beside them what the program calls where it is there.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "ffmpeg, fonts-dejavu-core, gnuplot-nox | gnuplot")
# What component core needs; and what the others do.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libfmt-dev, libqhull-dev, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "libtbb-dev, libembree-dev, libopenexr-dev, \
libpng-dev, zlib1g-dev, libxxhash-dev, libfreetype-dev, libhdf5-dev, cmake, g++ | clang")
if(TARGET tesserae_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-tesserae)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python module tesserae: worlds with numpy's views,
scenes, trajectories and pictures as arrays.")
  if(TESSERAE_ARCH)
    string(APPEND CPACK_COMPONENT_PYTHON_DESCRIPTION "
It needs a CPU of level ${TESSERAE_ARCH}.")
  endif()
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  # The module is of one version of Python, that of the system.
  string(REGEX MATCH "^3\\.([0-9]+)" python3 ${TESSERAE_PYTHON_VERSION})
  math(EXPR next_minor "${CMAKE_MATCH_1} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= ${python3}), python3 (<< 3.${next_minor}), python3-numpy")
endif()
# A package is of one system, whose libraries it needs: its version tells which.
cmake_host_system_information(RESULT system QUERY DISTRIB_INFO)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1~${system_ID}${system_VERSION_ID})
set(CPACK_STRIP_FILES ON)
include(CPack)
