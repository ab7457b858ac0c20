# One library target per folder of src: dovetail_<name>, alias dovetail::<name>.
include(GNUInstallDirs)

# dovetail_add_module(<name> SOURCES file… [DEPENDS module…])
# Headers live in include/dovetail/<name>; a module sees only those of the modules it depends on.
function(dovetail_add_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;DEPENDS" ${ARGN})
  set(target dovetail_${name})
  add_library(${target} ${MODULE_SOURCES})
  add_library(dovetail::${name} ALIAS ${target})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    INSTALL_RPATH "\$ORIGIN")
  dovetail_set_warnings(${target})
  foreach(dependency ${MODULE_DEPENDS})
    target_link_libraries(${target} PUBLIC dovetail::${dependency})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY DOVETAIL_MODULES ${name})
  set_property(GLOBAL PROPERTY DOVETAIL_DEPENDS_${name} "${MODULE_DEPENDS}")
endfunction()

# dovetail_add_test(<name> SOURCES file… DEPENDS module…): one GoogleTest program per folder of tests. They share one
# precompiled header and are optimised lightly, which halves the time to build them; the libraries are not.
function(dovetail_add_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;DEPENDS" ${ARGN})
  if(NOT TARGET dovetail_test_headers)
    file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/test_headers.cpp" CONTENT "")
    add_library(dovetail_test_headers OBJECT "${PROJECT_BINARY_DIR}/test_headers.cpp")
    target_link_libraries(dovetail_test_headers PRIVATE GTest::gtest)
    dovetail_set_test_options(dovetail_test_headers)
    target_precompile_headers(dovetail_test_headers PRIVATE
      <gtest/gtest.h> <algorithm> <array> <cmath> <functional> <random> <span> <string> <vector>)
  endif()
  add_executable(test_${name} ${TEST_SOURCES})
  foreach(dependency ${TEST_DEPENDS})
    target_link_libraries(test_${name} PRIVATE dovetail::${dependency})
  endforeach()
  target_link_libraries(test_${name} PRIVATE GTest::gtest_main)
  dovetail_set_test_options(test_${name})
  target_precompile_headers(test_${name} REUSE_FROM dovetail_test_headers)
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60)
endfunction()

function(dovetail_set_test_options target)
  target_compile_features(${target} PRIVATE cxx_std_20)
  dovetail_set_warnings(${target})
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

function(dovetail_set_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                         -Wno-psabi $<$<BOOL:${DOVETAIL_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()
