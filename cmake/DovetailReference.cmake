# The target `reference`, pages on all public headers, if Doxygen is found; its warnings are errors.
find_program(DOVETAIL_DOXYGEN doxygen)
mark_as_advanced(DOVETAIL_DOXYGEN)
if(NOT DOVETAIL_DOXYGEN)
  return()
endif()
set(REFERENCE_FOLDER "${PROJECT_BINARY_DIR}/reference")
file(GLOB_RECURSE public_headers "${PROJECT_SOURCE_DIR}/src/*.hpp")
list(FILTER public_headers INCLUDE REGEX "/include/dovetail/")
set(header_folders ${public_headers})
list(TRANSFORM header_folders REPLACE "/include/dovetail/.*" "/include")
list(REMOVE_DUPLICATES header_folders)
file(GLOB_RECURSE readmes "${PROJECT_SOURCE_DIR}/benchmarks/*.md" "${PROJECT_SOURCE_DIR}/examples/*.md"
     "${PROJECT_SOURCE_DIR}/scenes/*.md")
file(GLOB documents "${PROJECT_SOURCE_DIR}/docs/*.md" "${PROJECT_SOURCE_DIR}/docs/recipes/*.md")
set(inputs "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/CONTRIBUTING.md"
    "${PROJECT_SOURCE_DIR}/RELEASING.md" "${PROJECT_SOURCE_DIR}/CHANGELOG.md" ${documents} ${readmes})
list(JOIN header_folders "\" \"" REFERENCE_HEADERS)
list(JOIN inputs "\" \"" REFERENCE_INPUT)
set(REFERENCE_HEADERS "\"${REFERENCE_HEADERS}\"")
set(REFERENCE_INPUT "\"${REFERENCE_INPUT}\" ${REFERENCE_HEADERS}")
configure_file("${PROJECT_SOURCE_DIR}/docs/Doxyfile.in" "${PROJECT_BINARY_DIR}/Doxyfile" @ONLY)
add_custom_target(reference
  COMMAND ${CMAKE_COMMAND} -E make_directory "${REFERENCE_FOLDER}"
  COMMAND "${DOVETAIL_DOXYGEN}" "${PROJECT_BINARY_DIR}/Doxyfile"
  COMMENT "Writing ${REFERENCE_FOLDER}/html/index.html" VERBATIM)
