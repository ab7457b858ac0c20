# Finds PETSc with real numbers, and the MPI and Scotch that it was built with; defines Petsc::Petsc.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(Petsc_PC QUIET PETSc)
endif()
find_path(Petsc_INCLUDE_DIR petscksp.h HINTS ${Petsc_PC_INCLUDE_DIRS} PATHS /usr/lib/petsc/include)
find_library(Petsc_LIBRARY NAMES petsc_real petsc HINTS ${Petsc_PC_LIBRARY_DIRS} PATHS /usr/lib/petsc/lib)
find_path(Scotch_INCLUDE_DIR scotch.h PATH_SUFFIXES scotch)
find_library(Scotch_LIBRARY scotch)
find_package(MPI QUIET COMPONENTS CXX)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Petsc REQUIRED_VARS Petsc_LIBRARY Petsc_INCLUDE_DIR MPI_CXX_FOUND Scotch_LIBRARY Scotch_INCLUDE_DIR
                                  REASON_FAILURE_MESSAGE "on Debian: apt install libpetsc-real-dev libopenmpi-dev libscotch-dev")
if(Petsc_FOUND AND NOT TARGET Petsc::Petsc)
  add_library(Petsc::Petsc UNKNOWN IMPORTED)
  set_target_properties(Petsc::Petsc PROPERTIES
    IMPORTED_LOCATION "${Petsc_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${Petsc_INCLUDE_DIR};${Scotch_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "MPI::MPI_CXX;${Scotch_LIBRARY}")
endif()
mark_as_advanced(Petsc_LIBRARY Petsc_INCLUDE_DIR Scotch_LIBRARY Scotch_INCLUDE_DIR)
