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
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}")
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

# dovetail_add_test(<name> [EIGEN] SOURCES file… DEPENDS module…): one GoogleTest program per folder of tests. They share
# a precompiled header, those that use Eigen another, and are optimised lightly, which halves the time to build them; the
# libraries are not. ctest runs several of them at once, so each runs on one thread where the test does not ask for more.
function(dovetail_add_test name)
  cmake_parse_arguments(TEST "EIGEN" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(test_${name} ${TEST_SOURCES})
  foreach(dependency ${TEST_DEPENDS})
    target_link_libraries(test_${name} PRIVATE dovetail::${dependency})
  endforeach()
  target_link_libraries(test_${name} PRIVATE GTest::gtest_main)
  target_include_directories(test_${name} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}")
  dovetail_set_test_options(test_${name})
  if(TEST_EIGEN)
    dovetail_reuse_headers(test_${name} dovetail_eigen_test_headers)
    target_link_libraries(test_${name} PRIVATE dovetail_eigen_test_headers Eigen3::Eigen)
  else()
    dovetail_reuse_headers(test_${name} dovetail_test_headers)
  endif()
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                       PROPERTIES ENVIRONMENT "OMP_NUM_THREADS=1")
endfunction()

# dovetail_reuse_headers(<target> <headers>): compiles with the precompiled header of an object library, which the first
# call makes: GoogleTest, the standard library, and for dovetail_eigen_test_headers Eigen.
function(dovetail_reuse_headers target headers)
  if(NOT TARGET ${headers})
    set(source "${PROJECT_BINARY_DIR}/test_headers.cpp")
    set(more "")
    file(CONFIGURE OUTPUT "${source}" CONTENT "")
    if(headers STREQUAL dovetail_eigen_test_headers)
      set(source "${PROJECT_SOURCE_DIR}/tests/dense_algebra.cpp")
      set(more "${PROJECT_SOURCE_DIR}/tests/dense_algebra.hpp")
    endif()
    add_library(${headers} OBJECT "${source}")
    target_link_libraries(${headers} PRIVATE GTest::gtest Eigen3::Eigen)
    dovetail_set_test_options(${headers})
    target_precompile_headers(${headers} PRIVATE
      <gtest/gtest.h> <algorithm> <array> <cmath> <functional> <random> <span> <string> <vector> ${more})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${headers})
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
