# One library target per folder of src: dovetail_<name>, alias dovetail::<name>.
include(GNUInstallDirs)

# dovetail_add_module(<name> [LIGHT] [TOGETHER] SOURCES file… [DEPENDS module…] [HEADERS header…])
# Headers live in include/dovetail/<name>; a module sees only those of the modules it depends on. LIGHT: optimised
# lightly, for code that a step never runs. TOGETHER: see dovetail_compile_together. HEADERS: its own to precompile
# beside those that all modules share.
function(dovetail_add_module name)
  cmake_parse_arguments(MODULE "LIGHT;TOGETHER" "" "SOURCES;DEPENDS;HEADERS" ${ARGN})
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
  foreach(dependency ${MODULE_DEPENDS})
    target_link_libraries(${target} PUBLIC dovetail::${dependency})
  endforeach()
  set(light "")
  if(MODULE_LIGHT)
    set(light LIGHT)
  endif()
  set(together "")
  if(MODULE_TOGETHER)
    set(together TOGETHER)
  endif()
  dovetail_set_options(${target} ${light} ${together} HEADERS ${MODULE_HEADERS})
  set_property(GLOBAL APPEND PROPERTY DOVETAIL_MODULES ${name})
  set_property(GLOBAL PROPERTY DOVETAIL_DEPENDS_${name} "${MODULE_DEPENDS}")
endfunction()

# dovetail_add_test(<name> [EIGEN] [TOGETHER] SOURCES file… DEPENDS module…): one GoogleTest program per folder of tests.
# They share a precompiled header, those that use Eigen another, and are optimised lightly, which halves the time to
# build them. TOGETHER: see dovetail_compile_together. ctest runs several of them at once, so each runs on one thread
# where the test does not ask for more.
function(dovetail_add_test name)
  cmake_parse_arguments(TEST "EIGEN;TOGETHER" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(test_${name} ${TEST_SOURCES})
  foreach(dependency ${TEST_DEPENDS})
    target_link_libraries(test_${name} PRIVATE dovetail::${dependency})
  endforeach()
  target_link_libraries(test_${name} PRIVATE GTest::gtest_main)
  target_include_directories(test_${name} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}")
  dovetail_set_flags(test_${name} LIGHT)
  if(TEST_TOGETHER)
    dovetail_compile_together(test_${name})
  endif()
  if(TEST_EIGEN)
    dovetail_reuse_headers(test_${name} dovetail_eigen_test_headers)
    target_link_libraries(test_${name} PRIVATE dovetail_eigen_test_headers Eigen3::Eigen)
  else()
    dovetail_reuse_headers(test_${name} dovetail_test_headers)
  endif()
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                       PROPERTIES ENVIRONMENT "OMP_NUM_THREADS=1")
endfunction()

# dovetail_add_test_on_ranks(<name> RANKS n… …): as dovetail_add_test, with a main() of its own, and once more as a whole
# under mpirun with each number of ranks.
function(dovetail_add_test_on_ranks name)
  cmake_parse_arguments(TEST "" "" "RANKS;SOURCES;DEPENDS" ${ARGN})
  dovetail_add_test(${name} EIGEN SOURCES ${TEST_SOURCES} DEPENDS ${TEST_DEPENDS})
  foreach(ranks ${TEST_RANKS})
    add_test(NAME ${name}.${ranks}
             COMMAND "${MPIEXEC_EXECUTABLE}" --mca plm isolated --oversubscribe --allow-run-as-root ${MPIEXEC_NUMPROC_FLAG} ${ranks}
                     $<TARGET_FILE:test_${name}>)
    set_tests_properties(${name}.${ranks} PROPERTIES ENVIRONMENT "OMP_NUM_THREADS=2" PROCESSORS 2 TIMEOUT 300)
  endforeach()
endfunction()

# dovetail_set_options(<target> [LIGHT] [TOGETHER] [HEADERS header…]): flags and a precompiled header for libraries and
# programs. It is shared by targets of the same flags, and saves a fifth of their time to build. Sources with flags of
# their own skip it; DOVETAIL_PRECOMPILED_HEADERS=OFF shows which #include a file lacks.
function(dovetail_set_options target)
  cmake_parse_arguments(SET "LIGHT;TOGETHER" "" "HEADERS" ${ARGN})
  set(light "")
  if(SET_LIGHT)
    set(light LIGHT)
  endif()
  dovetail_set_flags(${target} ${light})
  if(SET_TOGETHER)
    dovetail_compile_together(${target})
  endif()
  if(NOT DOVETAIL_PRECOMPILED_HEADERS)
    return()
  endif()
  if(SET_HEADERS)
    target_precompile_headers(${target} PRIVATE ${DOVETAIL_STANDARD_HEADERS} <Eigen/Core> ${SET_HEADERS})
    return()
  endif()
  set(kind program)
  get_target_property(shared ${target} POSITION_INDEPENDENT_CODE)
  if(shared)
    set(kind module)
  endif()
  if(SET_LIGHT)
    string(PREPEND kind light_)
  endif()
  dovetail_reuse_headers(${target} dovetail_${kind}_headers)
endfunction()

set(DOVETAIL_STANDARD_HEADERS <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <random>
    <set> <span> <sstream> <string> <vector>)

# dovetail_reuse_headers(<target> <headers>): compiles with the precompiled header of an object library, which the first
# call makes: the standard library and Eigen, or for tests GoogleTest and the standard library, and Eigen where asked.
function(dovetail_reuse_headers target headers)
  if(NOT TARGET ${headers})
    dovetail_add_headers(${headers})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${headers})
endfunction()

function(dovetail_add_headers headers)
  set(source "${PROJECT_BINARY_DIR}/${headers}.cpp")
  set(light "")
  set(more <Eigen/Core>)
  if(headers MATCHES test|light)
    set(light LIGHT)
  endif()
  if(headers STREQUAL dovetail_eigen_test_headers)
    set(source "${PROJECT_SOURCE_DIR}/tests/dense_algebra.cpp")
    set(more <gtest/gtest.h> "${PROJECT_SOURCE_DIR}/tests/dense_algebra.hpp")
  else()
    file(CONFIGURE OUTPUT "${source}" CONTENT "")
    if(headers MATCHES test)
      set(more <gtest/gtest.h>)
    endif()
  endif()
  add_library(${headers} OBJECT "${source}")
  target_link_libraries(${headers} PRIVATE Eigen3::Eigen)
  if(headers MATCHES test)
    target_link_libraries(${headers} PRIVATE GTest::gtest)
  endif()
  if(headers MATCHES module)
    set_target_properties(${headers} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  dovetail_set_flags(${headers} ${light})
  target_precompile_headers(${headers} PRIVATE ${DOVETAIL_STANDARD_HEADERS} ${more})
endfunction()

# dovetail_set_flags(<target> [LIGHT]): the language, warnings, and with LIGHT -O1 in a release build, where g++ takes
# much for uninitialized that is not.
function(dovetail_set_flags target)
  cmake_parse_arguments(SET "LIGHT" "" "" ${ARGN})
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                         -Wno-psabi $<$<BOOL:${DOVETAIL_WARNINGS_AS_ERRORS}>:-Werror>)
  if(SET_LIGHT)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>
                           $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  endif()
endfunction()

# dovetail_compile_together(<target>): eight files in one go where DOVETAIL_UNITY_BUILD is on. Templates are instantiated
# once for all of them, which takes half the time or less. For targets whose files give no two things one name, and not
# for code that steps run: its speed is that of files by themselves. Names of other files are no reason to warn. New
# files go to the ends of lists, where they meet few others.
function(dovetail_compile_together target)
  if(DOVETAIL_UNITY_BUILD)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    target_compile_options(${target} PRIVATE -Wno-shadow)
  endif()
endfunction()
