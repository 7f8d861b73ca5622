# What every folder shares: the language, the warnings, the libraries, the tests.
include(CTest)
include(GNUInstallDirs)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON) # the libraries end up in ParaView's plug-in
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

find_program(PALPATE_CCACHE ccache)
if(PALPATE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${PALPATE_CCACHE})
endif()

option(PALPATE_TOGETHER "Compile the files of a folder together: half the time from nothing, more after a change" ON)

# An include is the path in the tree: the root is the one include folder.
# Designated initializers name what they set and leave the rest at its default: no reason for a warning.
# -ffp-contract=off: a session is replayed bit for bit, so no compiler may fuse what the source keeps apart.
add_library(palpate_compile_options INTERFACE)
target_include_directories(palpate_compile_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(palpate_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -Wno-missing-field-initializers -ffp-contract=off)
if(NOT PALPATE_TOGETHER) # else a name of one file hides one of another; clang-tidy reads each file by itself
  target_compile_options(palpate_compile_options INTERFACE -Wshadow)
endif()
if(PALPATE_WERROR)
  target_compile_options(palpate_compile_options INTERFACE -Werror)
endif()
if(PALPATE_WERROR AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
  # What these say changes with what the compiler inlines: told, but no errors.
  target_compile_options(palpate_compile_options INTERFACE -Wno-error=array-bounds -Wno-error=dangling-reference -Wno-error=free-nonheap-object
    -Wno-error=maybe-uninitialized -Wno-error=restrict -Wno-error=stringop-overflow -Wno-error=stringop-overread)
endif()
if(PALPATE_SANITIZE)
  target_compile_options(palpate_compile_options INTERFACE
    -fsanitize=${PALPATE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(PALPATE_SANITIZE MATCHES undefined)
    target_compile_options(palpate_compile_options INTERFACE -fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/.ci/unchecked)
  endif()
  target_link_options(palpate_compile_options INTERFACE -fsanitize=${PALPATE_SANITIZE})
endif()

# Under clang's address sanitizer, the fuzzers. What they read counts its edges: .ci/fuzzed names it.
set(palpate_fuzzes OFF)
if(PALPATE_TESTS AND CMAKE_CXX_COMPILER_ID STREQUAL Clang AND PALPATE_SANITIZE MATCHES address)
  set(palpate_fuzzes ON)
  target_compile_options(palpate_compile_options INTERFACE
    -fsanitize=fuzzer-no-link -fsanitize-coverage-allowlist=${PROJECT_SOURCE_DIR}/.ci/fuzzed)
endif()

# palpate_fuzzer(<name> SOURCES <file>... LINK <library>...): the program fuzz_<name>, which plugin/testing/fuzz runs.
function(palpate_fuzzer name)
  if(NOT palpate_fuzzes)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(fuzz_${name} ${ARG_SOURCES})
  target_link_libraries(fuzz_${name} PRIVATE palpate_compile_options ${ARG_LINK})
  target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
endfunction()

# palpate_together(<target> [<file>...]): the files of each folder are compiled together, which halves the time of a cold build: most of
# a file's time is what it includes. So names in unnamed namespaces are unique within a folder. Where a target has a part of the
# files alone, they are grouped as among all of them, so that no two meet there that do not meet in the whole.
function(palpate_together target)
  if(NOT PALPATE_TOGETHER)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set(sources ${ARGN})
  if(NOT sources)
    get_target_property(sources ${target} SOURCES)
  endif()
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source NORMALIZE)
    cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE name)
    cmake_path(GET name PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    # Not more than this at once: two cores are to share the work, and a compiler its memory (1 GiB). Thirty instead of twelve
    # take an eighth less time.
    math(EXPR count "0${count_${folder}} + 1")
    set(count_${folder} ${count})
    math(EXPR part "${count} / 30")
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${folder}_${part})
  endforeach()
endfunction()

# The arrows: what a folder may depend on; all know solver/text. palpate_module() refuses any other, and the test `arrows` reads
# the includes of every file, at any depth.
set(PALPATE_ARROWS_solver "")
set(PALPATE_ARROWS_io "")
set(PALPATE_ARROWS_device "")
set(PALPATE_ARROWS_modes io solver)
set(PALPATE_ARROWS_testdata io)
set(PALPATE_ARROWS_plugin solver io device modes)

# palpate_module(<name> SOURCES <file>... [HEADERS <file>...] [DEPENDS <folder>...] [PUBLIC <library>...]
#                [PRIVATE <library>...])
#
# The library palpate::<name> of the folder this is called in. HEADERS are its public ones: they are installed under
# include/palpate/<name>, and nothing else is. A module without HEADERS is not installed.
function(palpate_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;DEPENDS;PUBLIC;PRIVATE" ${ARGN})
  foreach(dependency IN LISTS ARG_DEPENDS)
    if(NOT dependency IN_LIST PALPATE_ARROWS_${name})
      message(FATAL_ERROR "${name} may not depend on ${dependency}: see the arrows in .cmake/PalpateModule.cmake")
    endif()
    list(APPEND ARG_PUBLIC palpate::${dependency})
  endforeach()

  add_library(palpate_${name} STATIC ${ARG_SOURCES})
  add_library(palpate::${name} ALIAS palpate_${name})
  set_target_properties(palpate_${name} PROPERTIES EXPORT_NAME ${name} VERIFY_INTERFACE_HEADER_SETS ON)
  target_include_directories(palpate_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_compile_features(palpate_${name} PUBLIC cxx_std_20)
  target_link_libraries(palpate_${name} PUBLIC palpate::text ${ARG_PUBLIC}
    PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:palpate_compile_options>)
  palpate_together(palpate_${name})
  if(NOT ARG_HEADERS)
    return()
  endif()

  list(TRANSFORM ARG_HEADERS PREPEND ${name}/ OUTPUT_VARIABLE headers)
  set_property(GLOBAL APPEND PROPERTY PALPATE_PUBLIC_HEADERS ${headers})
  target_sources(palpate_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARG_HEADERS})
  install(TARGETS palpate_${name} EXPORT palpate_${name}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate)
  install(EXPORT palpate_${name} NAMESPACE palpate:: FILE palpate-${name}.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
endfunction()

# palpate_test_code(<target>): how tests are compiled. What nearly every test includes is parsed once for all of them, and their own
# code is hardly optimized: most of a build's time is theirs. What they test is optimized as ever.
function(palpate_test_code target)
  set(gnu $<CXX_COMPILER_ID:GNU>)
  set(options -O0 "$<${gnu}:-Wno-restrict;-Wno-maybe-uninitialized>" # false of code that is not optimized: GCC's bug 105651
    "$<$<NOT:${gnu}>:SHELL:-Xclang -fno-pch-timestamp>") # for ccache
  if(NOT TARGET palpate_test_headers)
    # A program, because a library's code is another (position-independent in another way).
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/test_headers.cpp CONTENT "int main() {}\n")
    add_executable(palpate_test_headers EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/test_headers.cpp)
    target_compile_options(palpate_test_headers PRIVATE ${options})
    target_link_libraries(palpate_test_headers PRIVATE palpate_compile_options palpate_text glm::glm GTest::gmock)
    target_precompile_headers(palpate_test_headers PRIVATE
      <algorithm> <chrono> <filesystem> <fstream> <functional> <map> <memory> <optional> <random> <span> <sstream> <string>
      <thread> <vector> <gmock/gmock.h> <glm/glm.hpp> <gtest/gtest.h>)
  endif()
  target_compile_options(${target} PRIVATE ${options})
  target_precompile_headers(${target} REUSE_FROM palpate_test_headers)
endfunction()

set(PALPATE_TEST_FILES "" CACHE STRING "Regular expression: of the files of tests only those that match are compiled, as paths in the tree")

# palpate_tests(<name> SOURCES <file>... [LINK <library>...] [SECONDS <limit>]): GoogleTest cases of a folder, one CTest
# entry for each suite; no program if PALPATE_TEST_FILES leaves no test. A test that hangs is ended after SECONDS (20), six times as many under a sanitizer. Suites named Shared*
# need the real series in PALPATE_SHARED_DATA: their entries begin with `shared.`, and `plugin/run check shared` runs them.
function(palpate_tests name)
  if(NOT PALPATE_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "SECONDS" "SOURCES;LINK" ${ARGN})
  find_package(GTest REQUIRED)
  set(all ${ARG_SOURCES})
  if(PALPATE_TEST_FILES)
    set(tests 0)
    foreach(source IN LISTS ARG_SOURCES)
      cmake_path(ABSOLUTE_PATH source NORMALIZE OUTPUT_VARIABLE path)
      cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
      if(path MATCHES "${PALPATE_TEST_FILES}")
        math(EXPR tests "${tests} + 1")
      elseif(path MATCHES "_test\\.cpp$")
        list(REMOVE_ITEM ARG_SOURCES ${source})
      endif()
    endforeach()
    if(tests EQUAL 0)
      return()
    endif()
  endif()
  if(NOT TARGET palpate_test_limit)
    add_library(palpate_test_limit OBJECT EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/solver/text/testing/test_limit.cpp)
    target_link_libraries(palpate_test_limit PRIVATE palpate_compile_options GTest::gtest)
  endif()
  add_executable(${name}_tests ${ARG_SOURCES})
  target_link_libraries(${name}_tests PRIVATE palpate_compile_options palpate_test_limit ${ARG_LINK} GTest::gmock GTest::gtest_main)
  palpate_together(${name}_tests ${all})
  palpate_test_code(${name}_tests)
  # Real series are never copied into the project.
  target_compile_definitions(${name}_tests PRIVATE PALPATE_SHARED_DATA="${PALPATE_SHARED_DATA}")
  set(seconds 60)
  if(ARG_SECONDS)
    set(seconds ${ARG_SECONDS})
  endif()
  if(PALPATE_SANITIZE)
    math(EXPR seconds "6 * ${seconds}")
  endif()
  # Which suites there are is asked when ctest begins: the program is not built yet.
  file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake CONTENT
"set(program $<TARGET_FILE:${name}_tests>)\nset(prefix ${name}.)\nset(seconds ${seconds})\ninclude(${PROJECT_SOURCE_DIR}/.cmake/TestSuites.cmake)\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
endfunction()

# palpate_benchmarks(<name> SOURCES <file>... [LINK <library>...]): Google Benchmark cases, built but never timed by tests.
function(palpate_benchmarks name)
  if(NOT PALPATE_TESTS OR PALPATE_SANITIZE)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  find_package(benchmark REQUIRED)
  add_executable(${name}_benchmarks ${ARG_SOURCES})
  target_link_libraries(${name}_benchmarks PRIVATE palpate_compile_options ${ARG_LINK} benchmark::benchmark_main)
endfunction()
