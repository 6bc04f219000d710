# Repairs what find_package(OpenImageIO) finds on Debian: the target names the headers of OpenCV as an include
# directory, but the package does not bring them, and CMake refuses to use a target with a directory that is not there.
foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
    get_target_property(folders OpenImageIO::OpenImageIO ${property})
    set(present)
    foreach(folder IN LISTS folders)
        if(EXISTS "${folder}")
            list(APPEND present "${folder}")
        endif()
    endforeach()
    set_target_properties(OpenImageIO::OpenImageIO PROPERTIES ${property} "${present}")
endforeach()
