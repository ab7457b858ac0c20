# Finds the headers of Spectra (eigenvalues of large operators); sets Spectra_INCLUDE_DIR.
find_path(Spectra_INCLUDE_DIR Spectra/SymGEigsSolver.h)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Spectra REQUIRED_VARS Spectra_INCLUDE_DIR)
mark_as_advanced(Spectra_INCLUDE_DIR)
