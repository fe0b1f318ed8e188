# SPDX-License-Identifier: Apache-2.0
# Tests that CMake refuses Assimp 5.4: looks for it with a package of that version in FOLDER.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/../../../codec/cmake/libraries.cmake)
include(CMakePackageConfigHelpers)
write_basic_package_version_file(${FOLDER}/assimp-config-version.cmake VERSION 5.4 COMPATIBILITY SameMajorVersion
                                 ARCH_INDEPENDENT)
file(WRITE ${FOLDER}/assimp-config.cmake "")
set(assimp_DIR ${FOLDER})
vitrine_find_library(assimp targets)
