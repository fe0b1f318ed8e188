# SPDX-License-Identifier: Apache-2.0
# One folder is one target, and link edges say who may include whom: the headers of a folder are
# reached only through a symlink that belongs to its target, so an include without a link edge
# does not compile.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

# What is optimised as a whole is in an archive as machine code, too, for tests. Its index must name
# what that defines: with gcc's plugin it names functions that are inlined away there, and a linker that looks
# for one takes the same member twice.
if(VITRINE_TESTS AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(CMAKE_CXX_ARCHIVE_CREATE_IPO "<CMAKE_AR> --plugin=/dev/null cr <TARGET> <LINK_FLAGS> <OBJECTS>")
  set(CMAKE_CXX_ARCHIVE_FINISH_IPO "<CMAKE_RANLIB> --plugin=/dev/null <TARGET>")
endif()

add_library(vitrine_flags INTERFACE)
# -ffp-contract=off: a fused multiply-add would make the decoder differ between machines.
# -fno-tree-slp-vectorize: g++ 12.2 drops the rounding of paired double -> float -> double
# conversions when it vectorises straight-line code.
# -fno-math-errno: a square root is one instruction, without a branch to a call.
target_compile_options(vitrine_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                                               -Wno-sign-conversion -Wno-missing-field-initializers -Werror -ffp-contract=off
                                               -fno-math-errno -fno-tree-slp-vectorize)
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
  target_compile_definitions(vitrine_flags INTERFACE VITRINE_SANITISED)
endif()
target_link_options(vitrine_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Werror=odr>)

# Files of a target are compiled as one where the preset says so.
function(vitrine_unity target)
  if(VITRINE_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
    # The compiler takes files that a file includes for headers, coroutines of theirs, too.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# vitrine_room(codec/core SOURCES a.cpp b.cpp USES codec/other Lib::target)
function(vitrine_room folder)
  cmake_parse_arguments(room "" "" "SOURCES;USES;PRIVATE" ${ARGN})
  vitrine_room_target(${folder} target)
  if(room_SOURCES)
    add_library(${target} STATIC ${room_SOURCES})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE vitrine_flags ${room_PRIVATE})
    vitrine_unity(${target})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  set(door ${CMAKE_BINARY_DIR}/rooms/${target})
  get_filename_component(parent ${folder} DIRECTORY)
  if(room_SOURCES AND folder MATCHES "^codec/" AND CMAKE_BUILD_TYPE STREQUAL "Release")
    # The codec's hot loops cross files: a twentieth of a build's time.
    set_target_properties(${target} PROPERTIES INTERPROCEDURAL_OPTIMIZATION ON)
    if(VITRINE_TESTS)  # whose links would each optimise the codec anew
      target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-ffat-lto-objects>)
    endif()
  endif()
  file(MAKE_DIRECTORY ${door}/${parent})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${door}/${folder} SYMBOLIC)
  target_include_directories(${target} ${scope} ${door})
  foreach(use IN LISTS room_USES)
    if(use MATCHES "^(codec|server|acquisition)/")
      vitrine_room_target(${use} use)
    endif()
    target_link_libraries(${target} ${scope} ${use})
  endforeach()
endfunction()

function(vitrine_room_target folder out)
  string(REPLACE "/" "_" name "vitrine_${folder}")
  set(${out} ${name} PARENT_SCOPE)
endfunction()
