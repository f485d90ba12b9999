# nacre_library(NAME DEPENDS … PRIVATE …): the library nacre::NAME from this folder's sources (sub-folders included).
# The include root is the repository, so that every include names its room: #include "core/math.hpp".
function(nacre_library name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_library(nacre_${name} STATIC ${sources})
  add_library(nacre::${name} ALIAS nacre_${name})
  set_target_properties(nacre_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(nacre_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/nacre>)
  target_link_libraries(nacre_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  nacre_warnings(nacre_${name})
endfunction()

# Warnings are errors, in every target of ours.
function(nacre_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)  # false alarms on std::string concatenation (GCC bug 105651)
  endif()
endfunction()
