# Installation: one export file per module, so that find_package(dovetail COMPONENTS dem) loads dem and what it stands
# on, and looks for no package that only other modules need.
include(CMakePackageConfigHelpers)

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/dovetail")
get_property(modules GLOBAL PROPERTY DOVETAIL_MODULES)

# Packages a consumer of the module must find: those behind the <package>::… targets that the module links.
function(dovetail_packages_of module result)
  get_target_property(links dovetail_${module} INTERFACE_LINK_LIBRARIES)  # static: includes $<LINK_ONLY:private ones>
  set(packages "")
  foreach(link ${links})
    if(link MATCHES "([A-Za-z0-9_]+)::" AND NOT CMAKE_MATCH_1 STREQUAL "dovetail")
      string(TOUPPER ${CMAKE_MATCH_1} upper)
      get_property(arguments GLOBAL PROPERTY DOVETAIL_PACKAGE_${upper})
      if(NOT arguments)
        message(FATAL_ERROR "Module ${module} links ${link}, but no package is recorded for it. "
                            "Find it with dovetail_optional, or call dovetail_record_package.")
      endif()
      list(APPEND packages ${upper})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES packages)
  set(${result} ${packages} PARENT_SCOPE)
endfunction()

set(DOVETAIL_TABLES "set(_dovetail_modules ${modules})\n")
set(all_packages "")
foreach(module ${modules})
  get_property(depends GLOBAL PROPERTY DOVETAIL_DEPENDS_${module})
  dovetail_packages_of(${module} packages)
  list(APPEND all_packages ${packages})
  string(APPEND DOVETAIL_TABLES "set(_dovetail_${module}_depends ${depends})\n"
                                "set(_dovetail_${module}_packages ${packages})\n")

  get_target_property(folder dovetail_${module} SOURCE_DIR)
  install(DIRECTORY "${folder}/include/" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development
          FILES_MATCHING PATTERN "*.hpp")
  install(TARGETS dovetail_${module} EXPORT dovetail-${module}
          ARCHIVE COMPONENT development LIBRARY COMPONENT runtime NAMELINK_COMPONENT development)
  install(EXPORT dovetail-${module} NAMESPACE dovetail:: DESTINATION "${package_folder}" COMPONENT development)
endforeach()
list(REMOVE_DUPLICATES all_packages)
foreach(package ${all_packages})
  get_property(arguments GLOBAL PROPERTY DOVETAIL_PACKAGE_${package})
  list(JOIN arguments " " arguments)
  string(APPEND DOVETAIL_TABLES "set(_dovetail_find_${package} ${arguments})\n")
endforeach()

configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/dovetailConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/dovetailConfig.cmake" INSTALL_DESTINATION "${package_folder}"
  NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/dovetailConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/dovetailConfig.cmake" "${PROJECT_BINARY_DIR}/dovetailConfigVersion.cmake"
              "${CMAKE_CURRENT_LIST_DIR}/FindSuiteSparse.cmake" "${CMAKE_CURRENT_LIST_DIR}/FindFcl.cmake"
              "${CMAKE_CURRENT_LIST_DIR}/FindPetsc.cmake"
              "${CMAKE_CURRENT_LIST_DIR}/DovetailOwnLaws.cmake"
        DESTINATION "${package_folder}" COMPONENT development)

# The documents lie as in the source tree, so that their links hold.
foreach(file README.md CONTRIBUTING.md RELEASING.md CHANGELOG.md CITATION.cff LICENSE)
  install(FILES "${PROJECT_SOURCE_DIR}/${file}" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT runtime)
endforeach()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" "${PROJECT_SOURCE_DIR}/examples" "${PROJECT_SOURCE_DIR}/scenes"
        DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT runtime PATTERN Doxyfile.in EXCLUDE)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/benchmarks" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT runtime
        FILES_MATCHING PATTERN "*.md" PATTERN "*.json")
