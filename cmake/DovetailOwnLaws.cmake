# dovetail_add_laws(<name> <source>…): <name>.so, a library of contact laws that Python loads by dv.load_laws. It links
# nothing: the module that loads it has all it needs. The flags let the loops over contacts vectorise.
include(CheckCXXCompilerFlag)
function(dovetail_add_laws name)
  check_cxx_compiler_flag(-mprefer-vector-width=512 DOVETAIL_PREFERS_WIDE_VECTORS)
  add_library(${name} MODULE ${ARGN})
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden)
  target_compile_features(${name} PRIVATE cxx_std_20)
  foreach(module dem geometry core)
    target_include_directories(${name} PRIVATE $<TARGET_PROPERTY:dovetail::${module},INTERFACE_INCLUDE_DIRECTORIES>)
  endforeach()
  target_compile_options(${name} PRIVATE -O3 -fno-math-errno -fno-trapping-math -ffp-contract=off
                         $<$<BOOL:${DOVETAIL_PREFERS_WIDE_VECTORS}>:-mprefer-vector-width=512>)
endfunction()
