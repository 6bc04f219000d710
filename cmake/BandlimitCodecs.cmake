# Libraries of codecs: the folders of bandlimit/io. One whose libraries take long to load is linked by whoever links
# bandlimit::io, and loaded at first use by the programs that bandlimit_load_codecs() names.

# bandlimit_codecs(NAME library...): the codecs in bandlimit/io/NAME, which need these libraries.
function(bandlimit_codecs name)
    set(target bandlimit_${name})
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bandlimit/io/${name}/*.cpp)
    add_library(${target} STATIC ${sources})
    add_library(bandlimit::${name} ALIAS ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    target_link_libraries(${target} PUBLIC bandlimit::core PRIVATE ${ARGN})
    # Nothing but a weak reference names the table: bandlimit/io/codecs.cpp asks whether it is there.
    target_link_options(${target} INTERFACE LINKER:-u,bandlimit_${name}_codecs)
    bandlimit_options(${target})
    bandlimit_precompile(${target})
    bandlimit_fuzzed(${target})
    set_target_properties(${target} PROPERTIES BANDLIMIT_LIBRARIES "${ARGN}")
    target_link_libraries(bandlimit_io INTERFACE
        $<BUILD_INTERFACE:$<$<NOT:$<BOOL:$<TARGET_PROPERTY:BANDLIMIT_LOADS_CODECS>>>:${target}>>
        $<INSTALL_INTERFACE:bandlimit::${name}>)
    install(TARGETS ${target} EXPORT bandlimit_io ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT io)
endfunction()

# bandlimit_load_codecs(PROGRAM name...): the program loads these when a picture is first read or written.
function(bandlimit_load_codecs program)
    if(NOT TARGET ${program})
        return()
    endif()
    set_target_properties(${program} PROPERTIES BANDLIMIT_LOADS_CODECS ON)
    foreach(name IN LISTS ARGN)
        # The objects of the library as a module; in the build tree it lies beside the program.
        set(module bandlimit_${name}_module)
        add_library(${module} MODULE $<TARGET_OBJECTS:bandlimit_${name}>)
        get_target_property(libraries bandlimit_${name} BANDLIMIT_LIBRARIES)
        target_link_libraries(${module} PRIVATE ${libraries})
        bandlimit_options(${module})
        set_target_properties(${module} PROPERTIES
            PREFIX "" OUTPUT_NAME bandlimit_${name} LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
        add_dependencies(${program} ${module})
        install(TARGETS ${module} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/bandlimit COMPONENT program)
    endforeach()
endfunction()

# "program: loads codecs at first use": see cmake/program/check.cmake.
function(bandlimit_load_tests)
    if(NOT TARGET bandlimit)
        return()
    endif()
    file(GLOB pictures ${PROJECT_SOURCE_DIR}/examples/*.png)
    list(GET pictures 0 picture)
    add_test(NAME "program: loads codecs at first use" COMMAND ${CMAKE_COMMAND}
        -D BUILD=${PROJECT_BINARY_DIR} -D PICTURE=${picture} -P ${PROJECT_SOURCE_DIR}/cmake/program/check.cmake)
    set_tests_properties("program: loads codecs at first use" PROPERTIES RESOURCE_LOCK install TIMEOUT 300)
endfunction()

# Where an installed program finds them, from its own folder.
file(RELATIVE_PATH modules ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/bandlimit)
set_source_files_properties(bandlimit/io/codecs.cpp PROPERTIES COMPILE_DEFINITIONS BANDLIMIT_MODULES="${modules}")
