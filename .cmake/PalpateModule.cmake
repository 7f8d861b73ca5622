# What every folder shares: the language, the warnings, and the arrows between the folders.
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

# Designated initialisers name what they set and leave the rest at its default: no reason for a warning.
# -ffp-contract=off: a session is replayed bit for bit, so no compiler may fuse what the source keeps apart.
add_library(palpate_compile_options INTERFACE)
target_compile_options(palpate_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -Wno-missing-field-initializers -Werror -ffp-contract=off)
if(PALPATE_SANITIZE)
  target_compile_options(palpate_compile_options INTERFACE
    -fsanitize=${PALPATE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(palpate_compile_options INTERFACE -fsanitize=${PALPATE_SANITIZE})
endif()

# The arrows: what a folder may include. Enforced three times: palpate_module() refuses any other dependency; a
# folder's headers can be reached only through the include directory of a target that is linked; and the test
# `arrows` fails on a relative include that would go round both.
set(PALPATE_ARROWS_solver "")
set(PALPATE_ARROWS_io "")
set(PALPATE_ARROWS_device "")
set(PALPATE_ARROWS_modes io solver)
set(PALPATE_ARROWS_testdata io)
set(PALPATE_ARROWS_plugin solver io device modes testdata)

# palpate_module(<name> SOURCES <file>... [DEPENDS <folder>...] [PUBLIC <library>...] [PRIVATE <library>...])
#
# The library palpate::<name> of the folder this is called in. Its headers are included as "palpate/<name>/<file>.h".
function(palpate_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PUBLIC;PRIVATE" ${ARGN})
  foreach(dependency IN LISTS ARG_DEPENDS)
    if(NOT dependency IN_LIST PALPATE_ARROWS_${name})
      message(FATAL_ERROR "${name} may not depend on ${dependency}: see the arrows in .cmake/PalpateModule.cmake")
    endif()
    list(APPEND ARG_PUBLIC palpate::${dependency})
  endforeach()

  set(include_dir ${PROJECT_BINARY_DIR}/include/${name})
  file(MAKE_DIRECTORY ${include_dir}/palpate)
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${include_dir}/palpate/${name} SYMBOLIC)

  add_library(palpate_${name} STATIC ${ARG_SOURCES})
  add_library(palpate::${name} ALIAS palpate_${name})
  set_target_properties(palpate_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(palpate_${name} PUBLIC
    $<BUILD_INTERFACE:${include_dir}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(palpate_${name} PUBLIC cxx_std_20)
  target_link_libraries(palpate_${name} PUBLIC ${ARG_PUBLIC}
    PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:palpate_compile_options>)

  install(TARGETS palpate_${name} EXPORT palpate_${name})
  install(EXPORT palpate_${name} NAMESPACE palpate:: FILE palpate-${name}.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
  install(DIRECTORY ./ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate/${name}
    FILES_MATCHING PATTERN "*.h" PATTERN "internal" EXCLUDE)
endfunction()

# palpate_tests(<name> SOURCES <file>... [LINK <library>...]): GoogleTest cases of a folder, one CTest entry each.
function(palpate_tests name)
  if(NOT PALPATE_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  find_package(GTest REQUIRED)
  include(GoogleTest)
  add_executable(${name}_tests ${ARG_SOURCES})
  target_link_libraries(${name}_tests PRIVATE palpate_compile_options ${ARG_LINK} GTest::gmock GTest::gtest_main)
  # Real series are never copied into the project: tests that use them skip, saying so, where the folder is absent.
  target_compile_definitions(${name}_tests PRIVATE
    PALPATE_SHARED_DATA="${PROJECT_SOURCE_DIR}/../shared/data" PALPATE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(${name}_tests TEST_PREFIX ${name}. DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 600)
endfunction()

# palpate_benchmarks(<name> SOURCES <file>... [LINK <library>...]): Google Benchmark cases, built but never timed by tests.
function(palpate_benchmarks name)
  if(NOT PALPATE_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  find_package(benchmark REQUIRED)
  add_executable(${name}_benchmarks ${ARG_SOURCES})
  target_link_libraries(${name}_benchmarks PRIVATE palpate_compile_options ${ARG_LINK} benchmark::benchmark_main)
endfunction()
