# SPDX-License-Identifier: Apache-2.0
# Installs the codec alone: its headers, one static library and a CMake package. Programs that call
# find_package(vitrine) link the target vitrine::codec.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# The library has all modules of the codec except the interface for the browser.
vitrine_folders(codec folders)
list(REMOVE_ITEM folders codec/wasm)
add_library(vitrine_codec STATIC)
foreach(folder IN LISTS folders)
  vitrine_module_target(${folder} module)
  target_sources(vitrine_codec PRIVATE $<TARGET_OBJECTS:${module}>)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vitrine/codec FILES_MATCHING PATTERN "*.h")
endforeach()
set_target_properties(vitrine_codec PROPERTIES OUTPUT_NAME vitrine EXPORT_NAME codec)
target_include_directories(vitrine_codec INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/vitrine>)
target_compile_features(vitrine_codec INTERFACE cxx_std_20)

vitrine_libraries_of(codec libraries)
set(package_finds)
foreach(library IN LISTS libraries)
  vitrine_find_library(${library} targets)
  target_link_libraries(vitrine_codec INTERFACE ${targets})
  string(APPEND package_finds "vitrine_find_library(${library} targets)\n")
endforeach()

install(FILES codec/vitrine.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vitrine/codec)
install(TARGETS vitrine_codec EXPORT vitrine ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/vitrine)
install(EXPORT vitrine NAMESPACE vitrine:: DESTINATION ${package} FILE vitrine-targets.cmake)
configure_package_config_file(codec/cmake/vitrine-config.cmake.in ${CMAKE_BINARY_DIR}/vitrine-config.cmake
                              INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/vitrine-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/vitrine-config.cmake ${CMAKE_BINARY_DIR}/vitrine-config-version.cmake
              codec/cmake/libraries.cmake DESTINATION ${package})
