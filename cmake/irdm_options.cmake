# One interface target that every target of the project links: warnings, sanitizers, include root.
add_library(irdm_options INTERFACE)
target_include_directories(irdm_options INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/irdm>)
set(warnings
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align
  -Wunused -Wdouble-promotion -Wformat=2
  $<$<BOOL:${IRDM_WERROR}>:-Werror>)
target_compile_options(irdm_options INTERFACE "$<BUILD_INTERFACE:${warnings}>")
# Identical inputs give identical bits: no contraction that depends on the optimiser's mood.
target_compile_options(irdm_options INTERFACE -ffp-contract=off)
target_compile_definitions(irdm_options INTERFACE $<BUILD_INTERFACE:IRDM_VERSION="${PROJECT_VERSION}">)
# Eigen's own threads wait in a spin that is a data race, and its sums would depend on their number.
# Large products go to OpenBLAS; our own loops say themselves when they are parallel.
target_compile_definitions(irdm_options INTERFACE EIGEN_DONT_PARALLELIZE)
# An embedding program may be built for a newer processor: its matrices must be laid out as those of the libraries.
target_compile_definitions(irdm_options INTERFACE $<INSTALL_INTERFACE:EIGEN_MAX_ALIGN_BYTES=16>)

if(IRDM_SANITIZE)
  # Half the time to compile of -O2 -g, and reports still name functions and lines.
  target_compile_options(irdm_options INTERFACE
    -O1 -g1 -fsanitize=${IRDM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  # Sources of tests, most of what is compiled, and of servers of sockets in half the time; what computes is optimised.
  # Not with the thread sanitizer, which is slower.
  if(IRDM_SANITIZE MATCHES "address")
    target_compile_options(irdm_options INTERFACE $<$<BOOL:$<TARGET_PROPERTY:IRDM_UNOPTIMISED>>:-O0>)
  endif()
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

# Headers that most files of a target need, read once: saves half of the time to compile where there are several unity
# batches. Not in the preset `debug`: there every file has to name what it needs.
function(irdm_precompile name)
  get_target_property(sources ${name} SOURCES)
  list(LENGTH sources count)
  if(IRDM_PRECOMPILE AND count GREATER 24)
    target_precompile_headers(${name} PRIVATE ${ARGN})
  endif()
endfunction()

# irdm_optimise_more(SOURCES...) compiles these with -O3, each by itself; the presets build all else with -O2. Without the
# precompiled header: with it GCC compiles as the header was, with -O2.
function(irdm_optimise_more)
  if(NOT IRDM_SANITIZE)
    set_source_files_properties(${ARGN} PROPERTIES
      COMPILE_OPTIONS $<$<CONFIG:Release>:-O3> SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()

# irdm_add_library(NAME SOURCES... ) makes one static library target for a folder. The Python module and the C library
# are made of them; none of their functions is replaced from outside.
function(irdm_add_library name)
  add_library(${name} STATIC ${ARGN})
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${name} PRIVATE -fno-semantic-interposition)
  target_link_libraries(${name} PUBLIC irdm_options)
  irdm_precompile(${name} <Eigen/Dense> <algorithm> <functional> <memory> <string> <vector>)
endfunction()

# irdm_add_program(NAME LIBRARY) makes a program from the folder's main.cpp and its library.
function(irdm_add_program name library)
  add_executable(${name} main.cpp)
  target_link_libraries(${name} PRIVATE ${library})
  # It reads the command line and calls the library.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
endfunction()
