# find_package(palpate COMPONENTS ...) for programs outside this tree, and the test that proves it.
include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/palpateConfig.cmake.in
  ${PROJECT_BINARY_DIR}/palpateConfig.cmake INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/palpateConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/palpateConfig.cmake ${PROJECT_BINARY_DIR}/palpateConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/FindOpenCVParts.cmake
  DESTINATION ${config_dir})

# What the API pages are made of (`plugin/run docs`).
get_property(headers GLOBAL PROPERTY PALPATE_PUBLIC_HEADERS)
list(JOIN headers "\n" headers)
file(WRITE ${PROJECT_BINARY_DIR}/public_headers.txt "${headers}\nsolver/text/message.h\n")

if(PALPATE_TESTS)
  add_test(NAME arrows COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -P ${CMAKE_CURRENT_LIST_DIR}/TestArrows.cmake)
  if("modes" IN_LIST PALPATE_MODULES AND NOT PALPATE_SANITIZE)
    add_test(NAME install_tree COMMAND ${CMAKE_COMMAND} -DBINARY_DIR=${PROJECT_BINARY_DIR}
      -DOUTSIDE=${CMAKE_CURRENT_LIST_DIR}/outside -DGENERATOR=${CMAKE_GENERATOR} -DCXX=${CMAKE_CXX_COMPILER}
      -P ${CMAKE_CURRENT_LIST_DIR}/TestInstall.cmake)
  endif()
endif()
