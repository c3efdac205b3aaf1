# What `cmake --install` puts where, and what `cpack` packs: the program, its page for man, and its
# completions. Components are packages of their own; so far there is one, "program".
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
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME tesserae)
set(CPACK_PACKAGE_CONTACT "The maintainers of tesserae")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "rigid bodies in four dimensions, simulated and filmed")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "A scene file goes in; a trajectory, EXR frames and an MP4 come out.
The same scene gives the same bytes with any number of threads.")
if(TESSERAE_ARCH)
  string(APPEND CPACK_COMPONENT_PROGRAM_DESCRIPTION "
It needs a CPU of level ${TESSERAE_ARCH}.")
endif()
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# Libraries as dpkg-shlibdeps finds them; beside them what the program calls where it is there.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "ffmpeg, fonts-dejavu-core, gnuplot-nox | gnuplot")
# A package is of one system, whose libraries it needs: its version tells which.
cmake_host_system_information(RESULT system QUERY DISTRIB_INFO)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1~${system_ID}${system_VERSION_ID})
set(CPACK_STRIP_FILES ON)
include(CPack)
