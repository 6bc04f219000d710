# cmake -D BUILD=... -D PICTURE=... -P check.cmake: installs the program alone into a prefix of its own, and sees that
# it loads OpenImageIO when it reads a picture, not before, and says so where the module is missing.
cmake_minimum_required(VERSION 3.25)
set(prefix ${BUILD}/consumer/program)
file(REMOVE_RECURSE ${prefix})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --component program --prefix ${prefix}
    COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
file(GLOB program ${prefix}/bin/bandlimit)
file(GLOB_RECURSE module ${prefix}/*/bandlimit_oiio.so)

execute_process(COMMAND ldd ${program} OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
if(libraries MATCHES "OpenImageIO")
    message(FATAL_ERROR "the program loads OpenImageIO when it starts:\n${libraries}")
endif()
execute_process(COMMAND ${program} info ${PICTURE} COMMAND_ERROR_IS_FATAL ANY)

file(REMOVE ${module})
execute_process(COMMAND ${program} --version COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${program} info ${PICTURE} RESULT_VARIABLE code ERROR_VARIABLE error)
if(NOT code EQUAL 1 OR NOT error MATCHES "^bandlimit: error: [^\n]*bandlimit_oiio.so[^\n]*; [^\n]*\n$")
    message(FATAL_ERROR "without the module: exit code ${code} and ${error}")
endif()
