# nacre_library(NAME PUBLIC … PRIVATE …): the library nacre::NAME from this folder's sources (sub-folders included).
# The include root is the repository, so that every include names its room: #include "core/math.hpp". Rooms that
# applications may link are installed with their headers; demos is not one of them.
function(nacre_library name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")  # a program beside the library has its own target
  list(FILTER sources EXCLUDE REGEX "_module\\.cpp$")  # and so has what is loaded at run time
  add_library(nacre_${name} STATIC ${sources})
  add_library(nacre::${name} ALIAS nacre_${name})
  set_target_properties(nacre_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(nacre_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/nacre>)
  target_compile_features(nacre_${name} PUBLIC cxx_std_20)
  target_link_libraries(nacre_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  nacre_warnings(nacre_${name})
  if(NOT name STREQUAL "demos")
    install(TARGETS nacre_${name} EXPORT nacreTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/ DESTINATION include/nacre/${name} FILES_MATCHING PATTERN "*.hpp")
  endif()
endfunction()

# Warnings are errors, in every target of ours.
function(nacre_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)  # false alarms on std::string concatenation (GCC bug 105651)
  endif()
endfunction()
