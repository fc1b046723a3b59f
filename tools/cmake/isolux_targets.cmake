# How every library and program of the project is compiled.

add_library(isolux_options INTERFACE)
target_compile_options(isolux_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
  # Both renderers define results to the last bit of each operation; the compiler must not fuse them.
  -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 warns of overlapping copies inside std::string's operator+ where there are none (GCC bug 105651).
  target_compile_options(isolux_options INTERFACE -Wno-restrict)
endif()
if(ISOLUX_WARNINGS_AS_ERRORS)
  target_compile_options(isolux_options INTERFACE -Werror)
endif()
if(ISOLUX_SANITIZE)
  target_compile_options(isolux_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(isolux_options INTERFACE -fsanitize=address,undefined)
endif()

# isolux_library(NAME [DEPENDS library...]): the sources of the current folder's sub-folder NAME as one static library.
# DEPENDS are the only folders it may include from; tests/unit/include_directions checks it in the sources too.
function(isolux_library name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;SYSTEM" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.h)
  add_library(isolux_${name} STATIC ${sources})
  set_target_properties(isolux_${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_include_directories(isolux_${name} PUBLIC ${PROJECT_SOURCE_DIR}/host)
  target_link_libraries(isolux_${name} PRIVATE isolux_options)
  list(TRANSFORM ARG_DEPENDS PREPEND isolux_)
  target_link_libraries(isolux_${name} PUBLIC ${ARG_DEPENDS} ${ARG_SYSTEM})
endfunction()
