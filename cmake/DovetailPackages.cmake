# Debian packages by `cpack -G DEB`: `dovetail` with the program, scenes and documents, `libdovetail-dev` with headers,
# static libraries and the files for find_package, and with DOVETAIL_PYTHON `python3-dovetail` with the Python module.
# scripts/package makes them. A build with shared libraries makes none.
if(BUILD_SHARED_LIBS)
  return()
endif()
set(CPACK_PACKAGE_VENDOR "Dovetail authors")
set(CPACK_PACKAGE_CONTACT "Dovetail authors <maintainers@dovetail.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL runtime development)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME dovetail)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS libopenblas0-serial)  # the BLAS that the tests run with
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "The program dovetail runs scenes of particles (discrete element method)
and solids (finite elements at finite strain), joined at surfaces or in
overlaps. Scenes to start from and the documents come with it.")

# A program that asks for the component dem needs Eigen alone; who asks for fem, VTU files or scenes needs these as well.
set(wanted "")
foreach(feature suitesparse=libsuitesparse-dev vtk=libvtk9-dev hdf5=libhdf5-dev fcl=libfcl-dev cgal=libcgal-dev
                muparser=libmuparser-dev ceres=libceres-dev zlib=zlib1g-dev json=nlohmann-json3-dev)
  string(REPLACE "=" ";" pair ${feature})
  list(GET pair 0 name)
  list(GET pair 1 package)
  string(TOUPPER ${name} name)
  if(DOVETAIL_${name}_FOUND)
    list(APPEND wanted ${package})
  endif()
endforeach()
list(JOIN wanted ", " wanted)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libdovetail-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "g++, cmake, ${wanted}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS dovetail)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers, libraries and the files by which find_package(dovetail) finds
them. Recommended packages are needed by single components alone.")

if(DOVETAIL_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-dovetail)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS  # the module is made for one minor version
      "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "libopenblas0-serial, python3-matplotlib")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS dovetail)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python module dovetail runs scenes of particles and solids: states as
numpy arrays, forces of one's own as functions.")
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/doc/python3-dovetail"
          RENAME copyright COMPONENT python)
endif()

# Debian wants the licence under this name in every package.
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/doc/dovetail"
        RENAME copyright COMPONENT runtime)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/doc/libdovetail-dev"
        RENAME copyright COMPONENT development)
include(CPack)
