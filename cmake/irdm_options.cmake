# One interface target that every target of the project links: warnings, sanitizers, include root.
add_library(irdm_options INTERFACE)
target_include_directories(irdm_options INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/irdm>)
set(warnings
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align
  -Wunused -Wdouble-promotion -Wformat=2
  $<$<BOOL:${IRDM_WERROR}>:-Werror>)
target_compile_options(irdm_options INTERFACE "$<BUILD_INTERFACE:${warnings}>")
# GCC collects its garbage less often: a tenth less time for up to 1 GB of memory a compiler.
target_compile_options(irdm_options INTERFACE
  "$<BUILD_INTERFACE:$<$<COMPILE_LANG_AND_ID:CXX,GNU>:SHELL:--param ggc-min-heapsize=524288>>")
# Identical inputs give identical bits: no contraction that depends on the optimiser's mood.
target_compile_options(irdm_options INTERFACE -ffp-contract=off)
target_compile_definitions(irdm_options INTERFACE $<BUILD_INTERFACE:IRDM_VERSION="${PROJECT_VERSION}">)
# Eigen's own threads wait in a spin that is a data race, and its sums would depend on their number.
# Large products go to OpenBLAS; our own loops say themselves when they are parallel.
target_compile_definitions(irdm_options INTERFACE EIGEN_DONT_PARALLELIZE)
# One set of flags for all targets, so that they can share precompiled headers.
target_link_libraries(irdm_options INTERFACE OpenMP::OpenMP_CXX Threads::Threads)
# Libraries and a program that embeds them may be built for different processors: their matrices must be laid out alike,
# as where the processor may be any, and freed by each other, so that each block says where it begins
# (common/geometry.hpp checks both).
target_compile_definitions(irdm_options INTERFACE EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MALLOC_ALREADY_ALIGNED=0)

if(IRDM_SANITIZE)
  # Reports name functions. Their lines would take a fifth more time to compile: scripts/build.sh asan
  # -DIRDM_SANITIZE_LINES=ON.
  target_compile_options(irdm_options INTERFACE
    -O1 $<IF:$<BOOL:${IRDM_SANITIZE_LINES}>,-g1,-g0> -fsanitize=${IRDM_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  target_link_options(irdm_options INTERFACE -fsanitize=${IRDM_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_link_options(irdm_options INTERFACE -fuse-ld=lld)
  endif()
  if(IRDM_SANITIZE MATCHES "undefined")
    # These take half of the time to compile, and the address sanitizer finds what matters of them.
    target_compile_options(irdm_options INTERFACE -fno-sanitize=null,object-size,vptr,alignment,pointer-overflow)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
      # A vendor's library is called through declarations of our own: its types are never ours.
      target_compile_options(irdm_options INTERFACE -fno-sanitize=function)
    endif()
  endif()
  target_compile_definitions(irdm_options INTERFACE IRDM_SANITIZED)
  if(IRDM_SANITIZE MATCHES "thread")
    target_compile_definitions(irdm_options INTERFACE IRDM_THREAD_SANITIZED)
  endif()
endif()

# Optimisation levels of the presets. Each target has one, and all targets of a level share its precompiled headers.
#   step   loops of the force step and of the deformation
#   work   finite elements, files, references: seconds to minutes offline
#   shell  configuration, messages, sockets, commands: they wait more than they compute, and compile in half the time
#   test   the tests' own sources
# With a sanitizer all have -O1: without optimising, tests take longer than their compiling saves.
set(irdm_flags_step -O3)
set(irdm_flags_work -O2)
set(irdm_flags_shell -O1)
set(irdm_flags_test -O1)
set(irdm_headers_step <Eigen/Dense>)
set(irdm_headers_work <Eigen/Dense>)
set(irdm_headers_shell <Eigen/Dense> "${PROJECT_SOURCE_DIR}/common/wire/asio.hpp" <spdlog/spdlog.h>)
set(irdm_headers_test "${PROJECT_SOURCE_DIR}/tests/support/catch.hpp" <Eigen/Dense>)
set(irdm_common_headers
  <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional> <span> <sstream> <string>
  <utility> <variant> <vector>)

# irdm_set_level(TARGET LEVEL) compiles a target at a level, with that level's precompiled headers. Not in the preset
# `debug`: there every file has to name the headers that it needs.
function(irdm_set_level name level)
  if(NOT IRDM_SANITIZE)
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:${irdm_flags_${level}}>)
  endif()
  if(IRDM_FUZZ AND NOT level STREQUAL "test")
    target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
  if(NOT level STREQUAL "test")
    # Libraries become part of the Python module and of the C library; none of their functions is replaced from outside.
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_compile_options(${name} PRIVATE -fno-semantic-interposition)
  endif()
  if(level STREQUAL "shell")
    target_link_libraries(${name} PRIVATE spdlog::spdlog)
  endif()
  if(level MATCHES "shell|test")
    # GCC sees less at -O1 and warns where nothing is wrong; the other levels keep this warning.
    target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  endif()
  if(NOT IRDM_PRECOMPILE)
    return()
  endif()
  # Reading the headers again costs more than most sources.
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Werror=invalid-pch>)
  set(headers irdm_headers_of_${level})
  if(NOT TARGET ${headers})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${headers}.cpp CONTENT "")
    add_library(${headers} STATIC ${PROJECT_BINARY_DIR}/${headers}.cpp)
    target_link_libraries(${headers} PRIVATE irdm_options Eigen3::Eigen)
    if(level STREQUAL "shell")
      target_link_libraries(${headers} PRIVATE Boost::headers)
    elseif(level STREQUAL "test")
      target_link_libraries(${headers} PRIVATE Catch2::Catch2)
    endif()
    set(IRDM_PRECOMPILE OFF)
    irdm_set_level(${headers} ${level})
    target_precompile_headers(${headers} PRIVATE ${irdm_common_headers} ${irdm_headers_${level}})
  endif()
  target_precompile_headers(${name} REUSE_FROM ${headers})
endfunction()

# irdm_add_library(NAME LEVEL SOURCES...) makes one static library target for a folder.
function(irdm_add_library name level)
  add_library(${name} STATIC ${ARGN})
  target_link_libraries(${name} PUBLIC irdm_options)
  irdm_set_level(${name} ${level})
endfunction()

# irdm_add_part(LIBRARY LEVEL SOURCES...) adds sources to a library that are compiled at another level than the rest.
# Call it after target_link_libraries(LIBRARY ...).
function(irdm_add_part library level)
  set(name ${library}_${level})
  add_library(${name} OBJECT ${ARGN})
  get_target_property(links ${library} LINK_LIBRARIES)
  target_link_libraries(${name} PRIVATE ${links})
  target_include_directories(${name} SYSTEM PRIVATE $<TARGET_PROPERTY:${library},INCLUDE_DIRECTORIES>)
  target_compile_definitions(${name} PRIVATE $<TARGET_PROPERTY:${library},COMPILE_DEFINITIONS>)
  irdm_set_level(${name} ${level})
  target_sources(${library} PRIVATE $<TARGET_OBJECTS:${name}>)
endfunction()

# irdm_add_program(NAME LIBRARY) makes a program from the folder's main.cpp and its library.
function(irdm_add_program name library)
  add_executable(${name} main.cpp)
  target_link_libraries(${name} PRIVATE ${library})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
endfunction()
