# GLSL kernels -> SPIR-V (glslang), optimised and validated (SPIRV-Tools), embedded as C++ arrays.

# isolux_kernels(TARGET name SOURCES kernel.comp...): a static library with `isolux::kernels::<name>` per kernel.
function(isolux_kernels target)
  cmake_parse_arguments(ARG "" "" "SOURCES" ${ARGN})
  set(out ${CMAKE_CURRENT_BINARY_DIR}/spirv)
  set(embedded)
  set(names)
  foreach(source IN LISTS ARG_SOURCES)
    get_filename_component(name ${source} NAME_WE)
    set(raw ${out}/${name}.raw.spv)
    set(spirv ${out}/${name}.spv)
    add_custom_command(
      OUTPUT ${raw} # the output that the file of dependencies names
      COMMAND ${CMAKE_COMMAND} -E make_directory ${out}
      COMMAND ${GLSLANG_VALIDATOR} --quiet --target-env vulkan1.2 -I${CMAKE_CURRENT_SOURCE_DIR} --depfile ${out}/${name}.d
              -o ${raw} ${source}
      DEPENDS ${source}
      DEPFILE ${out}/${name}.d
      COMMENT "SPIR-V ${name}"
      VERBATIM)
    add_custom_command(
      OUTPUT ${spirv}
      COMMAND ${SPIRV_OPT} -O --target-env=vulkan1.2 ${raw} -o ${spirv}
      COMMAND ${SPIRV_VAL} --target-env vulkan1.2 ${spirv}
      DEPENDS ${raw}
      COMMENT "SPIR-V ${name}, optimised"
      VERBATIM)
    add_custom_command(
      OUTPUT ${out}/${name}.cpp
      COMMAND ${CMAKE_COMMAND} -DNAME=${name} -DSPIRV=${spirv} -DOUTPUT=${out}/${name}.cpp
              -P ${PROJECT_SOURCE_DIR}/tools/cmake/embed_spirv.cmake
      DEPENDS ${spirv} ${PROJECT_SOURCE_DIR}/tools/cmake/embed_spirv.cmake
      VERBATIM)
    list(APPEND embedded ${out}/${name}.cpp)
    list(APPEND names ${name})
  endforeach()

  set(header "// Generated: the SPIR-V of every kernel.\n#pragma once\n#include <cstdint>\n#include <span>\nnamespace isolux::kernels {\n")
  foreach(name IN LISTS names)
    string(APPEND header "extern const std::span<const std::uint32_t> ${name};\n")
  endforeach()
  string(APPEND header "} // namespace isolux::kernels\n")
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/include/kernels/spirv.h CONTENT "${header}" @ONLY)

  add_library(${target} STATIC ${embedded})
  target_include_directories(${target} PUBLIC ${CMAKE_CURRENT_BINARY_DIR}/include)
endfunction()
