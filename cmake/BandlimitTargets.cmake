# What every target of the project shares, and how rooms become components, tests, benchmarks, fuzzers and a package.
# Every list of files is globbed with CONFIGURE_DEPENDS, so a new file needs no entry anywhere.

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    # The sloppiness that ccache's manual asks for with precompiled headers; paths below the project relative, and no
    # working directory in the key, so that a clone in another folder finds what this one compiled.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros
        CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE_PROGRAM})
endif()
if(PROJECT_IS_TOP_LEVEL)
    set_property(GLOBAL PROPERTY RULE_LAUNCH_COMPILE "${PROJECT_SOURCE_DIR}/cmake/compile.sh <OBJECT>")
endif()

# bandlimit_options(TARGET): warnings, sanitizers and floating point as we want them, for our own code only.
function(bandlimit_options target)
    target_compile_options(${target} PRIVATE
        -Wall -Wextra -Wpedantic -Wconversion
        # Clang counts sign conversions among -Wconversion, GCC does not.
        $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>
        # The definition of every float filter is one rounding per tap: the compiler must fuse nothing by itself.
        -ffp-contract=off)
    if(BANDLIMIT_SANITIZE)
        set(sanitize -fsanitize=${BANDLIMIT_SANITIZE} -fno-sanitize-recover=all)
        # Public: whoever links an instrumented library, a consumer of the package too, needs the same run-time.
        target_compile_options(${target} PUBLIC ${sanitize} -fno-omit-frame-pointer
            # GCC's documentation: with sanitizers this warning has false positives.
            $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
        target_link_options(${target} PUBLIC ${sanitize})
    endif()
endfunction()

# bandlimit_fuzzed(TARGET): a library that fuzzers explore: what its code runs through guides them.
function(bandlimit_fuzzed target)
    if(BANDLIMIT_FUZZ)
        target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
    endif()
endfunction()

# What most files include, compiled once for all libraries.
set(BANDLIMIT_STANDARD_HEADERS <algorithm> <array> <cmath> <cstdint> <functional> <limits> <memory> <numeric> <optional>
    <span> <stdexcept> <string> <utility> <variant> <vector>)

# bandlimit_precompile(TARGET [header...]): the standard headers compiled once for all libraries, or with other headers
# for one. Not with sanitizers, so that ./check all finds a file that includes too little.
function(bandlimit_precompile target)
    if(BANDLIMIT_SANITIZE)
        return()
    endif()
    if(ARGN)
        target_precompile_headers(${target} PRIVATE ${BANDLIMIT_STANDARD_HEADERS} ${ARGN})
        return()
    endif()
    if(NOT TARGET standard_headers)
        set(source ${PROJECT_BINARY_DIR}/standard_headers.cpp)
        file(CONFIGURE OUTPUT ${source} CONTENT "")
        add_library(standard_headers OBJECT ${source})
        target_compile_features(standard_headers PRIVATE cxx_std_20)
        target_precompile_headers(standard_headers PRIVATE ${BANDLIMIT_STANDARD_HEADERS})
        bandlimit_options(standard_headers)
    endif()
    target_precompile_headers(${target} REUSE_FROM standard_headers)
endfunction()

# bandlimit_vector_sources(RESULT source...): those that know Highway's targets; most are compiled once for each.
function(bandlimit_vector_sources result)
    set(found)
    foreach(source IN LISTS ARGN)
        file(STRINGS ${source} vectors REGEX "<hwy/(foreach_target|targets)\\.h>" LIMIT_COUNT 1)
        if(vectors)
            list(APPEND found ${source})
        endif()
    endforeach()
    set(${result} ${found} PARENT_SCOPE)
endfunction()

# bandlimit_public_headers(RESULT room): the headers of a room that are for users, by their path from the root: all but
# those that say "Stability: inner".
function(bandlimit_public_headers result room)
    file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/bandlimit/${room}/*.h)
    list(FILTER headers EXCLUDE REGEX "_test\\.h$")
    set(public)
    foreach(header IN LISTS headers)
        file(STRINGS ${PROJECT_SOURCE_DIR}/${header} mark REGEX "^// Stability: inner\\." LIMIT_COUNT 1)
        if(NOT mark)
            list(APPEND public ${header})
        endif()
    endforeach()
    set(${result} ${public} PARENT_SCOPE)
endfunction()

# bandlimit_component(NAME ROOMS room... [OPTIONS option...] [PRECOMPILE header...]): the library bandlimit::NAME of
# everything in these rooms but tests and benchmarks, with its headers in the package. A room without files yet is an
# empty room. Options of its own go with precompiled headers of its own.
function(bandlimit_component name)
    cmake_parse_arguments(ARG "" "" "ROOMS;OPTIONS;PRECOMPILE" ${ARGN})
    set(target bandlimit_${name})
    add_library(${target})
    add_library(bandlimit::${name} ALIAS ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    foreach(room IN LISTS ARG_ROOMS)
        file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bandlimit/${room}/*.cpp)
        list(FILTER sources EXCLUDE REGEX "_(test|bench)\\.cpp$")
        target_sources(${target} PRIVATE ${sources})
        bandlimit_vector_sources(vectors ${sources})
        set_property(SOURCE ${vectors} APPEND PROPERTY COMPILE_DEFINITIONS ${BANDLIMIT_VECTOR_DEFINITIONS})
        if(vectors AND BANDLIMIT_SANITIZE MATCHES "address")
            # Vectors are values, nothing points at them: it takes half the time to compile without the search for
            # pointers into scopes that have ended.
            set_source_files_properties(${vectors} PROPERTIES COMPILE_OPTIONS -fno-sanitize-address-use-after-scope)
        endif()
        bandlimit_public_headers(headers ${room})
        list(TRANSFORM headers PREPEND ${PROJECT_SOURCE_DIR}/)
        install(FILES ${headers}
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/bandlimit/${room} COMPONENT ${name})
        set_property(GLOBAL PROPERTY BANDLIMIT_COMPONENT_OF_${room} ${name})
    endforeach()
    set_property(GLOBAL APPEND PROPERTY BANDLIMIT_ROOMS ${ARG_ROOMS})
    target_include_directories(${target} PUBLIC
        $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_compile_features(${target} PUBLIC cxx_std_20)
    bandlimit_options(${target})
    target_compile_options(${target} PRIVATE ${ARG_OPTIONS})
    bandlimit_precompile(${target} ${ARG_PRECOMPILE})
    install(TARGETS ${target} EXPORT bandlimit_${name}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name})
    install(EXPORT bandlimit_${name} FILE bandlimit_${name}.cmake NAMESPACE bandlimit::
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/bandlimit COMPONENT ${name})
endfunction()

# The program: the file `bandlimit` at the root of the build directory. All of it but main() is the library
# bandlimit_app, so that the tests run verbs in their own process.
function(bandlimit_program)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/apps/*.cpp)
    list(FILTER sources EXCLUDE REGEX "_test\\.cpp$|/main\\.cpp$")
    find_package(CLI11 REQUIRED)
    add_library(bandlimit_app STATIC ${sources})
    target_link_libraries(bandlimit_app
        PUBLIC bandlimit::core
        PRIVATE bandlimit::job CLI11::CLI11 nlohmann_json::nlohmann_json fmt::fmt ${XXHASH_LIBRARY})
    target_include_directories(bandlimit_app SYSTEM PRIVATE ${XXHASH_INCLUDE_DIR})
    target_compile_definitions(bandlimit_app PRIVATE BANDLIMIT_VERSION="${PROJECT_VERSION}")
    include(BandlimitEmbed)
    file(GLOB photographs CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/*.png)
    bandlimit_embed_photographs(bandlimit_app ${photographs})
    add_executable(bandlimit ${PROJECT_SOURCE_DIR}/apps/main.cpp)
    target_link_libraries(bandlimit PRIVATE bandlimit_app)
    foreach(target IN ITEMS bandlimit_app bandlimit)
        bandlimit_options(${target})
        target_compile_options(${target} PRIVATE ${BANDLIMIT_PROGRAM_OPTIONS})
    endforeach()
    bandlimit_precompile(bandlimit_app <chrono> <filesystem> <map> <fmt/core.h> <nlohmann/json.hpp>)
    install(TARGETS bandlimit RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endfunction()

# What every test includes, compiled once: reading GoogleTest takes longer than compiling most tests.
function(bandlimit_precompiled_test_headers)
    set(source ${PROJECT_BINARY_DIR}/test_headers.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "int main() {}\n")
    add_executable(test_headers ${source})  # compiled as the tests are, unlike a library
    target_link_libraries(test_headers PRIVATE GTest::gtest)
    target_compile_features(test_headers PRIVATE cxx_std_20)
    target_precompile_headers(test_headers PRIVATE <gtest/gtest.h> <algorithm> <array> <cmath> <filesystem> <fstream>
        <functional> <limits> <map> <memory> <numeric> <random> <sstream> <string> <thread> <tuple> <variant> <vector>)
    bandlimit_options(test_headers)
    target_compile_options(test_headers PRIVATE ${BANDLIMIT_TEST_OPTIONS})
endfunction()

# bandlimit_test_program(NAME SHARDS source...): one GoogleTest program. CTest runs it in so many shards, each a process
# with every so manieth test, which leaves a report of what its tests took in test-reports/.
function(bandlimit_test_program name shards)
    if(NOT TARGET test_headers)
        bandlimit_precompiled_test_headers()
    endif()
    add_executable(test_${name} ${ARGN})
    set_target_properties(test_${name} PROPERTIES
        OUTPUT_NAME ${name} RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
    target_link_libraries(test_${name} PRIVATE GTest::gtest_main)
    target_precompile_headers(test_${name} REUSE_FROM test_headers)
    bandlimit_options(test_${name})
    target_compile_options(test_${name} PRIVATE ${BANDLIMIT_TEST_OPTIONS})
    math(EXPR last "${shards} - 1")
    foreach(shard RANGE ${last})
        set(report ${PROJECT_BINARY_DIR}/test-reports/${name}-${shard}.json)
        set(environment GTEST_TOTAL_SHARDS=${shards} GTEST_SHARD_INDEX=${shard} GTEST_OUTPUT=json:${report} GTEST_BRIEF=1)
        add_test(NAME "${name} ${shard}" COMMAND test_${name})
        # The programs with most shards are those that take longest: they begin.
        set_tests_properties("${name} ${shard}" PROPERTIES
            ENVIRONMENT "${environment}" TIMEOUT 900 COST ${shards} LABELS ${name})
    endforeach()
endfunction()

# The tests of each room, from its *_test.cpp files: one program a room, so that rooms build and run side by side.
function(bandlimit_room_tests)
    get_property(rooms GLOBAL PROPERTY BANDLIMIT_ROOMS)
    if(BANDLIMIT_TEST_ROOMS)
        set(rooms ${BANDLIMIT_TEST_ROOMS})
    endif()
    foreach(room IN LISTS rooms)
        file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bandlimit/${room}/*_test.cpp)
        if(sources)
            get_property(component GLOBAL PROPERTY BANDLIMIT_COMPONENT_OF_${room})
            list(LENGTH sources count)
            math(EXPR shards "1 + ${count} / 4")
            bandlimit_test_program(${room} ${shards} ${sources})
            target_link_libraries(test_${room} PRIVATE bandlimit::${component})
        endif()
    endforeach()
endfunction()

# The tests of the program, one test program of all apps/*_test.cpp. They run verbs in their own process, and where the
# process matters start the program (BANDLIMIT_PROGRAM); BANDLIMIT_EXAMPLES are the files that ship with the project.
function(bandlimit_app_tests)
    if(NOT TARGET bandlimit)
        return()
    endif()
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/apps/*_test.cpp)
    bandlimit_test_program(apps 12 ${sources})
    target_link_libraries(test_apps PRIVATE bandlimit_app bandlimit::io nlohmann_json::nlohmann_json)
    target_compile_definitions(test_apps PRIVATE
        BANDLIMIT_PROGRAM="$<TARGET_FILE:bandlimit>" BANDLIMIT_EXAMPLES="${PROJECT_SOURCE_DIR}/examples")
    add_dependencies(test_apps bandlimit)
endfunction()

# "consumer: core alone" installs core, and only core, and builds and runs a small project against it.
function(bandlimit_consumer_tests)
    set(cases "core alone|core")
    if(BANDLIMIT_IO)
        list(APPEND cases "core and io|core,io")
    endif()
    if(BANDLIMIT_DESIGN)
        list(APPEND cases "core and design|core,design")
    endif()
    foreach(case IN LISTS cases)
        string(REGEX MATCH "(.*)\\|(.*)" _ ${case})
        add_test(NAME "consumer: ${CMAKE_MATCH_1}" COMMAND ${CMAKE_COMMAND}
            -D BUILD=${PROJECT_BINARY_DIR} -D COMPONENTS=${CMAKE_MATCH_2} -D COMPILER=${CMAKE_CXX_COMPILER}
            -P ${PROJECT_SOURCE_DIR}/cmake/consumer/check.cmake)
        # Both write the list of installed files.
        set_tests_properties("consumer: ${CMAKE_MATCH_1}" PROPERTIES RESOURCE_LOCK install TIMEOUT 300)
    endforeach()
endfunction()

# All installed headers in one file, so that no two of them define the same name: part of every build with tests.
function(bandlimit_headers_together)
    get_property(rooms GLOBAL PROPERTY BANDLIMIT_ROOMS)
    set(includes)
    set(libraries)
    foreach(room IN LISTS rooms)
        bandlimit_public_headers(headers ${room})
        foreach(header IN LISTS headers)
            string(APPEND includes "#include \"${header}\"\n")
        endforeach()
        get_property(component GLOBAL PROPERTY BANDLIMIT_COMPONENT_OF_${room})
        list(APPEND libraries bandlimit::${component})
    endforeach()
    list(REMOVE_DUPLICATES libraries)
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/headers_together.cpp CONTENT "${includes}")
    add_library(headers_together OBJECT ${PROJECT_BINARY_DIR}/headers_together.cpp)
    target_link_libraries(headers_together PRIVATE ${libraries})
    bandlimit_options(headers_together)
    target_compile_options(headers_together PRIVATE -O0 -g0)
endfunction()

# The target headers: each header in a translation unit of its own, with what its component gives to a consumer. But
# x.h beside x.cpp, which scripts/check-includes has include it first, is compiled alone there where nothing is
# precompiled.
function(bandlimit_header_checks)
    add_custom_target(headers)
    get_property(rooms GLOBAL PROPERTY BANDLIMIT_ROOMS)
    if(TARGET bandlimit)
        list(APPEND rooms apps)
    endif()
    foreach(room IN LISTS rooms)
        if(room STREQUAL "apps")
            set(folder apps)
            set(libraries bandlimit::job CLI11::CLI11 nlohmann_json::nlohmann_json fmt::fmt)
        else()
            set(folder bandlimit/${room})
            get_property(component GLOBAL PROPERTY BANDLIMIT_COMPONENT_OF_${room})
            set(libraries bandlimit::${component})
        endif()
        file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/${folder}/*.h)
        set(units)
        foreach(header IN LISTS headers)
            string(REGEX REPLACE "\\.h$" ".cpp" source ${PROJECT_SOURCE_DIR}/${header})
            if(EXISTS ${source} AND NOT source MATCHES "_test\\.cpp$")
                continue()
            endif()
            set(unit ${PROJECT_BINARY_DIR}/headers/${header}.cpp)
            file(CONFIGURE OUTPUT ${unit} CONTENT "#include \"${header}\"\n")
            list(APPEND units ${unit})
        endforeach()
        if(units)
            add_library(headers_${room} OBJECT EXCLUDE_FROM_ALL ${units})
            target_link_libraries(headers_${room} PRIVATE ${libraries})
            target_include_directories(headers_${room} PRIVATE ${PROJECT_SOURCE_DIR})
            bandlimit_options(headers_${room})
            target_compile_options(headers_${room} PRIVATE -O0 -g0)
            add_dependencies(headers headers_${room})
        endif()
    endforeach()
endfunction()

# The benchmarks of each room, from its *_bench.cpp files. As a test each runs for a moment, to show that it does.
function(bandlimit_benchmarks)
    get_property(rooms GLOBAL PROPERTY BANDLIMIT_ROOMS)
    foreach(room IN LISTS rooms)
        file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bandlimit/${room}/*_bench.cpp)
        if(sources)
            find_package(benchmark REQUIRED)
            get_property(component GLOBAL PROPERTY BANDLIMIT_COMPONENT_OF_${room})
            add_executable(bench_${room} ${sources})
            set_target_properties(bench_${room} PROPERTIES
                OUTPUT_NAME ${room} RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bench)
            target_link_libraries(bench_${room} PRIVATE bandlimit::${component} benchmark::benchmark_main)
            bandlimit_options(bench_${room})
            add_test(NAME "bench: ${room}" COMMAND bench_${room} --benchmark_min_time=0.001)
        endif()
    endforeach()
endfunction()

# The fuzzers, one per fuzz/NAME_fuzz.cpp; seeds, and what once made one fail, are in fuzz/corpus/NAME. As a test each
# replays these and goes on from there for ten seconds, from the same random seed every time.
function(bandlimit_fuzzers)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
        message(FATAL_ERROR "BANDLIMIT_FUZZ needs Clang; use the preset clang")
    endif()
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/fuzz/*_fuzz.cpp)
    foreach(source IN LISTS sources)
        cmake_path(GET source STEM name)
        string(REGEX REPLACE "_fuzz$" "" name ${name})
        add_executable(fuzz_${name} ${source})
        set_target_properties(fuzz_${name} PROPERTIES
            OUTPUT_NAME ${name} RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/fuzz)
        target_link_libraries(fuzz_${name} PRIVATE bandlimit::core $<TARGET_NAME_IF_EXISTS:bandlimit::io>
            $<TARGET_NAME_IF_EXISTS:bandlimit::job>)
        bandlimit_options(fuzz_${name})
        target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
        # What the fuzzer finds goes to the first folder; the project's own corpus is only read.
        set(found ${PROJECT_BINARY_DIR}/fuzz/found/${name})
        file(MAKE_DIRECTORY ${found})
        set(corpus ${PROJECT_SOURCE_DIR}/fuzz/corpus/${name})
        if(NOT EXISTS ${corpus})
            set(corpus)
        endif()
        add_test(NAME "fuzz: ${name}" WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/fuzz
            COMMAND fuzz_${name} -seed=1 -max_total_time=10 -timeout=10 -verbosity=0 ${found} ${corpus})
    endforeach()
endfunction()

# What find_package(bandlimit) reads.
function(bandlimit_package)
    include(CMakePackageConfigHelpers)
    set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/bandlimit)
    configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/bandlimitConfig.cmake.in bandlimitConfig.cmake
        INSTALL_DESTINATION ${folder} NO_SET_AND_CHECK_MACRO)
    write_basic_package_version_file(bandlimitConfigVersion.cmake COMPATIBILITY SameMinorVersion)
    install(FILES ${PROJECT_BINARY_DIR}/bandlimitConfig.cmake ${PROJECT_BINARY_DIR}/bandlimitConfigVersion.cmake
        DESTINATION ${folder} COMPONENT core)
    install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT core)
    if(BANDLIMIT_IO)
        install(FILES ${PROJECT_SOURCE_DIR}/cmake/bandlimitOpenImageIO.cmake DESTINATION ${folder} COMPONENT io)
    endif()
endfunction()
