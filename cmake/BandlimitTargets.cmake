# What every target of the project shares, and how a component is made of rooms.

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

# Warnings, sanitizers and floating point as we want them, for our own code only.
function(bandlimit_options target)
    target_compile_options(${target} PRIVATE
        -Wall -Wextra -Wpedantic -Wconversion
        # Clang counts sign conversions among -Wconversion, GCC does not.
        $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>
        $<$<BOOL:${BANDLIMIT_WERROR}>:-Werror>
        # The definition of every float filter is one rounding per tap: the compiler must fuse nothing by itself.
        -ffp-contract=off)
    if(BANDLIMIT_SANITIZE)
        target_compile_options(${target} PUBLIC -fsanitize=${BANDLIMIT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
        target_link_options(${target} PUBLIC -fsanitize=${BANDLIMIT_SANITIZE})
    endif()
endfunction()

# bandlimit_component(NAME ROOMS room...): the library bandlimit::NAME of everything in these rooms but tests and benchmarks.
function(bandlimit_component name)
    cmake_parse_arguments(ARG "" "" "ROOMS" ${ARGN})
    set(target bandlimit_${name})
    add_library(${target})
    add_library(bandlimit::${name} ALIAS ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    foreach(room IN LISTS ARG_ROOMS)
        file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bandlimit/${room}/*.cpp)
        list(FILTER sources EXCLUDE REGEX "_(test|bench)\\.cpp$")
        target_sources(${target} PRIVATE ${sources})
    endforeach()
    target_include_directories(${target} PUBLIC
        $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_compile_features(${target} PUBLIC cxx_std_20)
    bandlimit_options(${target})
    set_property(GLOBAL APPEND PROPERTY BANDLIMIT_COMPONENTS ${name})
    set_property(GLOBAL APPEND PROPERTY BANDLIMIT_ROOMS ${ARG_ROOMS})
endfunction()

# The tests of a room, from its *_test.cpp files; one program each, so that rooms build and run side by side.
function(bandlimit_room_tests room)
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bandlimit/${room}/*_test.cpp)
    if(NOT sources)
        return()
    endif()
    set(target test_${room})
    add_executable(${target} ${sources})
    target_link_libraries(${target} PRIVATE ${ARGN} GTest::gtest_main)
    bandlimit_options(${target})
    gtest_discover_tests(${target} TEST_PREFIX "${room}: " DISCOVERY_TIMEOUT 60)
endfunction()
