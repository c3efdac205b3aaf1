# SPDX-License-Identifier: Apache-2.0
# The room of scenes, with what is made of other files while it is built.
tesserae_room(scenes USES parallel render EXCEPT scenes/program/main.cpp
  PRIVATE_LIBRARIES TBB::tbb PkgConfig::XXHASH Freetype::Freetype $<INSTALL_INTERFACE:hdf5::hdf5>
    Threads::Threads
  BUILD_LIBRARIES CLI11::CLI11 nlohmann_json::nlohmann_json ${HDF5_C_LIBRARIES})
# toml++ is compiled in, its shared library not linked: see scenes/load/toml_declarations.hpp.
target_include_directories(tesserae_scenes SYSTEM PRIVATE ${HDF5_C_INCLUDE_DIRS}
  $<TARGET_PROPERTY:tomlplusplus::tomlplusplus,INTERFACE_INCLUDE_DIRECTORIES>)
# What --version tells, beside the commit.
string(JOIN ", " libraries "oneTBB ${TBB_VERSION}" "Eigen ${Eigen3_VERSION}"
  "Embree ${embree_VERSION}" "OpenEXR ${OpenEXR_VERSION}" "HDF5 ${HDF5_VERSION}"
  "Qhull ${QHULL_VERSION}" "libpng ${PNG_VERSION_STRING}" "zlib ${ZLIB_VERSION_STRING}"
  "FreeType ${FREETYPE_VERSION_STRING}" "xxHash ${XXHASH_VERSION}" "toml++ ${tomlplusplus_VERSION}"
  "CLI11 ${CLI11_VERSION}" "fmt ${fmt_VERSION}" "nlohmann-json ${nlohmann_json_VERSION}")
string(JOIN ", " settings ${CMAKE_BUILD_TYPE} ${TESSERAE_ARCH} ${TESSERAE_SANITIZE})
set_property(SOURCE scenes/process/version.cpp PROPERTY COMPILE_DEFINITIONS
  "TESSERAE_VERSION=\"${PROJECT_VERSION}\"" "TESSERAE_SETTINGS=\"${settings}\""
  "TESSERAE_COMPILER=\"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\""
  "TESSERAE_LIBRARIES=\"${libraries}\"")
# The sources of `tesserae view`'s page go into the program.
set(page ${PROJECT_SOURCE_DIR}/scenes/view/page)
file(GLOB page_sources CONFIGURE_DEPENDS RELATIVE ${page} ${page}/*)
list(TRANSFORM page_sources PREPEND ${page}/ OUTPUT_VARIABLE page_files)
list(JOIN page_sources " " page_names)
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/page_sources.cpp VERBATIM
  COMMAND ${CMAKE_COMMAND} -DFOLDER=${page} -DOUTPUT=${PROJECT_BINARY_DIR}/page_sources.cpp
    "-DSOURCES=${page_names}" -P ${PROJECT_SOURCE_DIR}/scenes/view/embed.cmake
  DEPENDS ${page_files} scenes/view/embed.cmake)
target_sources(tesserae_scenes PRIVATE ${PROJECT_BINARY_DIR}/page_sources.cpp)
# Changes often while the page is worked on, and is quick to compile alone.
set_source_files_properties(${PROJECT_BINARY_DIR}/page_sources.cpp PROPERTIES
  SKIP_UNITY_BUILD_INCLUSION ON)
