# Finds the Flexible Collision Library with what it stands on; defines Fcl::Fcl.
find_path(Fcl_INCLUDE_DIR fcl/fcl.h)
find_library(Fcl_LIBRARY fcl)
find_path(Fcl_ccd_INCLUDE_DIR ccd/ccd.h)
find_library(Fcl_ccd_LIBRARY ccd)
find_path(Fcl_octomap_INCLUDE_DIR octomap/octomap.h)
find_library(Fcl_octomap_LIBRARY octomap)
find_library(Fcl_octomath_LIBRARY octomath)
set(Fcl_parts Fcl_LIBRARY Fcl_INCLUDE_DIR Fcl_ccd_LIBRARY Fcl_ccd_INCLUDE_DIR Fcl_octomap_LIBRARY
              Fcl_octomap_INCLUDE_DIR Fcl_octomath_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Fcl REQUIRED_VARS ${Fcl_parts}
                                  REASON_FAILURE_MESSAGE "on Debian: apt install libfcl-dev")
if(Fcl_FOUND AND NOT TARGET Fcl::Fcl)
  find_package(Eigen3 REQUIRED NO_MODULE)
  add_library(Fcl::Fcl UNKNOWN IMPORTED)
  set_target_properties(Fcl::Fcl PROPERTIES
    IMPORTED_LOCATION "${Fcl_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${Fcl_INCLUDE_DIR};${Fcl_ccd_INCLUDE_DIR};${Fcl_octomap_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${Fcl_ccd_LIBRARY};${Fcl_octomap_LIBRARY};${Fcl_octomath_LIBRARY};Eigen3::Eigen")
endif()
mark_as_advanced(${Fcl_parts})
