# What the tests of the room shader run shaders with. Vulkan is optional: without it they say so and are skipped.
function(bandlimit_shader_tests)
    if(NOT TARGET test_shader)
        return()
    endif()
    find_package(Vulkan QUIET)
    if(Vulkan_FOUND)
        target_link_libraries(test_shader PRIVATE Vulkan::Vulkan)
        target_compile_definitions(test_shader PRIVATE BANDLIMIT_TEST_VULKAN)
    else()
        message(STATUS "No Vulkan headers (libvulkan-dev): the tests that execute shaders will be skipped")
    endif()
    target_link_libraries(test_shader PRIVATE ${CMAKE_DL_LIBS})
    target_compile_definitions(test_shader PRIVATE
        BANDLIMIT_SHADER_TOOLS="${PROJECT_SOURCE_DIR}/build/shader-tools"
        BANDLIMIT_SHADER_TESTS="${PROJECT_SOURCE_DIR}/bandlimit/shader"
        BANDLIMIT_CXX="${CMAKE_CXX_COMPILER}")
endfunction()
