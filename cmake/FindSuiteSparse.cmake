# Finds the factorisations of SuiteSparse; defines SuiteSparse::Cholmod, SuiteSparse::Umfpack and what
# both stand on, SuiteSparse::Config, SuiteSparse::Lapack and SuiteSparse::Blas.
find_path(SuiteSparse_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
find_path(SuiteSparse_Umfpack_INCLUDE_DIR umfpack.h PATH_SUFFIXES suitesparse)
find_library(SuiteSparse_Cholmod_LIBRARY cholmod)
find_library(SuiteSparse_Config_LIBRARY suitesparseconfig)
find_library(SuiteSparse_Umfpack_LIBRARY umfpack)
find_library(SuiteSparse_Lapack_LIBRARY lapack)
find_library(SuiteSparse_Blas_LIBRARY blas)
set(SuiteSparse_parts SuiteSparse_Cholmod_LIBRARY SuiteSparse_Umfpack_LIBRARY SuiteSparse_Config_LIBRARY
                      SuiteSparse_Lapack_LIBRARY SuiteSparse_Blas_LIBRARY SuiteSparse_INCLUDE_DIR
                      SuiteSparse_Umfpack_INCLUDE_DIR)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SuiteSparse REQUIRED_VARS ${SuiteSparse_parts}
                                  REASON_FAILURE_MESSAGE "on Debian: apt install libsuitesparse-dev")
if(SuiteSparse_FOUND AND NOT TARGET SuiteSparse::Cholmod)
  foreach(part Cholmod Umfpack Config Lapack Blas)
    add_library(SuiteSparse::${part} UNKNOWN IMPORTED)
    set_target_properties(SuiteSparse::${part} PROPERTIES
      IMPORTED_LOCATION "${SuiteSparse_${part}_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${SuiteSparse_INCLUDE_DIR};${SuiteSparse_Umfpack_INCLUDE_DIR}")
  endforeach()
endif()
mark_as_advanced(${SuiteSparse_parts})
