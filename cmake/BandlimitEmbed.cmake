# bandlimit_embed_photographs(TARGET file...): compiles the bytes of files into TARGET, as embedded_photographs() of
# apps/tour/embedded.h, so that the program needs no file beside it.
function(bandlimit_embed_photographs target)
    set(source ${PROJECT_BINARY_DIR}/embedded_photographs.cpp)
    set(arrays)
    set(entries)
    set(index 0)
    foreach(file IN LISTS ARGN)
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
        file(READ ${file} hex HEX)
        string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
        cmake_path(GET file FILENAME name)
        string(APPEND arrays "const unsigned char file_${index}[] = {${bytes}};\n")
        string(APPEND entries "        {\"${name}\", file_${index}, sizeof file_${index}},\n")
        math(EXPR index "${index} + 1")
    endforeach()
    file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
// Made by cmake/BandlimitEmbed.cmake.
#include "apps/tour/embedded.h"

namespace bandlimit::app {
namespace {
@arrays@}  // namespace

std::vector<EmbeddedFile> embedded_photographs() {
    return {
@entries@    };
}

}  // namespace bandlimit::app
]])
    target_sources(${target} PRIVATE ${source})
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
endfunction()
